"""Numbers of the running text of the chapter, from this cohort."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.stats.correlation import pearson
from swaystride.studies.experience.plan import HEART_RATE
from swaystride.studies.experience.table_options import TableOptions

Array = NDArray[np.float64]

#: Pairs of scales whose correlation the text prints.
_PAIRS: Final = {
    "r_fss_paces": ("flow", "activity_enjoyment"),
    "r_fs_fss": ("affective_valence", "flow"),
    "r_fs_paces": ("affective_valence", "activity_enjoyment"),
}
_COLUMNS: Final = ("quantity", "value", "ci_low", "ci_high", "p", "n", "rule")
#: Quantity, value, how many it rests on, rule.
Row = tuple[str, float, int, str]


def study5_text(
    runs: pd.DataFrame,
    observations: pd.DataFrame,
    affect: pd.DataFrame,
    scores: pd.DataFrame,
    options: TableOptions,
) -> pd.DataFrame:
    """The quantities of ``study5_text.csv``, each by a stated rule.

    Parameters
    ----------
    runs : DataFrame
        The lab's ``runs.tsv``.
    observations : DataFrame
        Analysed runs, with measures, scales and ``pattern``.
    affect : DataFrame
        Ratings over time: ``run``, ``feeling_scale``.
    scores : DataFrame
        ``run``, ``activity_enjoyment``, ``flow``, ``n_ratings``.
    options : TableOptions

    Returns
    -------
    DataFrame
        ``quantity, value, ci_low, ci_high, p`` as printed (the interval of a correlation by
        Fisher's transformation, not printed), then ``n`` and ``rule``.
    """
    rows = [
        *_counts(runs, observations),
        *_ratings(affect, scores),
        *_questionnaires(scores),
    ]
    table = pd.DataFrame(rows, columns=["quantity", "value", "n", "rule"])
    limits = [
        ("duty_factor_aerial_below", options.aerial_below, pd.NA, "as configured"),
        ("duty_factor_terrestrial_above", options.terrestrial_above, pd.NA, "as configured"),
    ]
    parts = [
        table,
        _correlations(observations),
        pd.DataFrame(_heart_rates(observations), columns=table.columns),
        pd.DataFrame(limits, columns=table.columns),
    ]
    joined = pd.DataFrame([row for part in parts for row in part.to_dict("records")])
    joined = joined.reindex(columns=list(_COLUMNS))
    numbers = dict.fromkeys(("value", "ci_low", "ci_high", "p"), "float64")
    return joined.astype({**numbers, "n": "Int64"})


def _counts(runs: pd.DataFrame, observations: pd.DataFrame) -> list[Row]:
    """People and runs."""
    per_person = runs.groupby(runs["participant"].astype(str)).size().to_numpy(dtype=float)
    n_people = per_person.size
    sd = float(np.std(per_person, ddof=1)) if n_people > 1 else float("nan")
    pattern = observations["pattern"]
    by_duty = "mean duty factor of the run"
    return [
        ("n_participants", n_people, n_people, "with a run listed by the lab"),
        ("n_runs", len(runs), len(runs), "listed by the lab"),
        *(
            (f"n_{name}_runs", int((pattern == name).sum()), len(pattern), by_duty)
            for name in ("aerial", "terrestrial")
        ),
        ("runs_per_participant_mean", float(per_person.mean()), n_people, "of listed runs"),
        ("runs_per_participant_sd", sd, n_people, "n − 1"),
    ]


def _ratings(affect: pd.DataFrame, scores: pd.DataFrame) -> list[Row]:
    """Ratings of affect, over the whole run."""
    number = scores["n_ratings"].to_numpy(dtype=float)
    number = number[number > 0]
    rating = affect["feeling_scale"].to_numpy(dtype=float)
    whole = "of a run with ratings, warm-up included"
    every = "of all ratings, warm-up included"
    return [
        ("ratings_per_run_min", _or_nan(np.min, number), number.size, whole),
        ("ratings_per_run_max", _or_nan(np.max, number), number.size, whole),
        ("ratings_per_run_mean", _or_nan(np.mean, number), number.size, whole),
        ("feeling_scale_min", _or_nan(np.min, rating), rating.size, every),
        ("feeling_scale_max", _or_nan(np.max, rating), rating.size, every),
    ]


def _questionnaires(scores: pd.DataFrame) -> list[Row]:
    """Sums of the two questionnaires."""
    rows: list[Row] = []
    for name, column in (("paces", "activity_enjoyment"), ("fss", "flow")):
        sums = scores[column].dropna().to_numpy(dtype=float)
        for part, statistic in (
            ("min", np.min),
            ("max", np.max),
            ("median", np.median),
            ("mean", np.mean),
        ):
            rows.append((f"{name}_{part}", _or_nan(statistic, sums), sums.size, "over runs"))
    return rows


def _correlations(observations: pd.DataFrame) -> pd.DataFrame:
    """Correlations between the scales."""
    rows = []
    for quantity, (first, second) in _PAIRS.items():
        pairs = observations[[first, second]].dropna().to_numpy(dtype=float)
        row: dict[str, object] = {
            "quantity": quantity, "n": len(pairs), "rule": "Pearson, over runs"
        }  # fmt: skip
        if len(pairs) > 3 and np.ptp(pairs, axis=0).all():
            found = pearson(pairs[:, 0], pairs[:, 1])
            row |= {
                "value": found.r, "ci_low": found.ci_low, "ci_high": found.ci_high, "p": found.p
            }  # fmt: skip
        rows.append(row)
    return pd.DataFrame(rows)


def _heart_rates(observations: pd.DataFrame) -> list[Row]:
    """Run means of the heart rate, after the warm-up."""
    rate = observations[HEART_RATE].dropna().to_numpy(dtype=float)
    shares = {"q1": 0.25, "median": 0.5, "q3": 0.75, "min": 0.0, "max": 1.0}
    rule = "over runs, of means after the warm-up, linear between runs"
    return [
        (
            f"heart_rate_{name}",
            float(np.quantile(rate, share)) if rate.size else np.nan,
            rate.size,
            rule,
        )
        for name, share in shares.items()
    ]


def _or_nan(statistic: Callable[[Array], Any], values: Array) -> float:
    """A statistic, missing where there is nothing."""
    return float(statistic(values)) if len(values) else float("nan")
