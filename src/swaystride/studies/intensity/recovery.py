"""Many simulated cohorts against the printed numbers and against the population."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Final

import numpy as np
import pandas as pd

#: Share of the cohorts that lies below and above the central 95 %.
_TAILS: Final = (0.025, 0.975)

#: Largest accepted difference between the mean ICC of the cohorts and that of the population.
LARGEST_ICC_BIAS: Final = 0.01

#: In what share of the cohorts the participant-level interval must hold the mean of the cohorts.
COVERAGE: Final = (0.90, 0.98)

#: Printed quantities that simulated cohorts do not reach, and why.
KNOWN_DEVIATIONS: Final[Mapping[str, str]] = {}

RECOVERY_COLUMNS: Final = (
    "quantity",
    "check",
    "value",
    "reference",
    "low",
    "high",
    "within",
)


def printed_quantities(
    table_3_2: pd.DataFrame, table_3_3: pd.DataFrame, study3_text: pd.DataFrame
) -> pd.Series[float]:
    """All printed point estimates under one kind of name.

    Parameters
    ----------
    table_3_2, table_3_3, study3_text : DataFrame
        As in data/published.

    Returns
    -------
    Series
        By ``table_3_2/<aspect>/<rating>``, ``table_3_3/<feature>/<transform>`` and
        ``study3_text/<quantity>``.

    Examples
    --------
    >>> effects = pd.DataFrame({"aspect": ["stance"], "rating": ["per_trial"], "estimate": [0.6]})
    >>> features = pd.DataFrame({"feature": ["ml_rms"], "transform": ["log"], "r": [0.7]})
    >>> text = pd.DataFrame({"quantity": ["icc_pt_per_trial"], "value": [0.868]})
    >>> printed_quantities(effects, features, text).to_dict()["table_3_3/ml_rms/log"]
    0.7
    """
    values: dict[str, float] = {}
    for row in table_3_2.to_dict("records"):
        values[f"table_3_2/{row['aspect']}/{row['rating']}"] = float(row["estimate"])
    for row in table_3_3.to_dict("records"):
        values[f"table_3_3/{row['feature']}/{row['transform']}"] = float(row["r"])
    for row in study3_text.to_dict("records"):
        values[f"study3_text/{row['quantity']}"] = float(row["value"])
    return pd.Series(values, dtype=float)


def recovery_table(
    cohorts: Iterable[pd.DataFrame],
    printed: pd.Series[float],
    population: pd.Series[float],
    known_deviations: Mapping[str, str],
) -> pd.DataFrame:
    """What many cohorts say about print, estimators and intervals.

    Parameters
    ----------
    cohorts : iterable of DataFrame
        One per cohort: ``quantity``, ``estimate``, ``participant_ci_low``,
        ``participant_ci_high`` (NaN where there is no interval).
    printed : Series
        As from :func:`printed_quantities`.
    population : Series
        Population value of each quantity that has one.
    known_deviations : mapping of str to str
        Printed quantities that the simulation does not reach, with the reason.

    Returns
    -------
    DataFrame
        One row per check: ``printed number`` (the printed value between `low` and `high`, the
        central 95 % of the cohorts), ``mean of the estimator`` (against the population value) and
        ``coverage`` (share of the cohorts whose participant-level interval holds the mean of the
        cohorts). ``within`` is ``yes``, ``no``, ``explained`` or ``reported``.
    """
    frames = list(cohorts)
    estimates = _wide(frames, "estimate")
    low, high = _wide(frames, "participant_ci_low"), _wide(frames, "participant_ci_high")
    rows: list[tuple[str, str, float, float, float, float, str]] = []
    for quantity in estimates.columns:
        drawn = estimates[quantity].dropna()
        mean = float(drawn.mean())
        if quantity in printed.index:
            tails = np.quantile(drawn, _TAILS)
            inside = bool(tails[0] <= printed[quantity] <= tails[1])
            verdict = "yes" if inside else "explained" if quantity in known_deviations else "no"
            rows.append(
                (quantity, "printed number", mean, printed[quantity], *tails.tolist(), verdict)
            )
        if quantity in population.index:
            rows.append(_bias(quantity, mean, float(population[quantity])))
        covered = (low[quantity] <= mean) & (high[quantity] >= mean)
        judged = low[quantity].notna()
        if judged.any():
            rows.append(_coverage(quantity, float(covered[judged].mean())))
    return pd.DataFrame(rows, columns=list(RECOVERY_COLUMNS))


def _wide(frames: list[pd.DataFrame], column: str) -> pd.DataFrame:
    """One row per cohort, one column per quantity, in the order of the first cohort."""
    parts = [frame.set_index("quantity")[column] for frame in frames]
    return pd.DataFrame(parts).reset_index(drop=True)[parts[0].index]


def _bias(
    quantity: str, mean: float, truth: float
) -> tuple[str, str, float, float, float, float, str]:
    """The mean of an estimator against the population; the ICC is judged, the rest reported."""
    limits = (truth - LARGEST_ICC_BIAS, truth + LARGEST_ICC_BIAS)
    if "/icc_" in quantity:
        verdict = "yes" if limits[0] <= mean <= limits[1] else "no"
        return (quantity, "mean of the estimator", mean, truth, *limits, verdict)
    return (quantity, "mean of the estimator", mean, truth, np.nan, np.nan, "reported")


def _coverage(quantity: str, share: float) -> tuple[str, str, float, float, float, float, str]:
    """Coverage of the participant-level interval; Table 3.2 is judged, the rest reported."""
    verdict = "yes" if COVERAGE[0] <= share <= COVERAGE[1] else "no"
    if not quantity.startswith("table_3_2/"):
        verdict = "reported"
    return (quantity, "coverage", share, 0.95, *COVERAGE, verdict)
