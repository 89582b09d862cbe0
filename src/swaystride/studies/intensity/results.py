"""Rows of results: one quantity, its model interval and its participant-level interval."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import pandas as pd

from swaystride.stats.cluster_bootstrap import Scale, bootstrap_interval, cluster_resamples
from swaystride.stats.grouping_factor import CodeArray, FloatArray
from swaystride.stats.mixed_model import MixedModelFit
from swaystride.studies.intensity.plan import RESULT_COLUMNS, IntensityPlan

_UNKNOWN = (float("nan"), float("nan"))

#: Draws that may be undefined (a rating that never occurs) before the interval is.
_UNDEFINED_SHARE = 0.05


def result_row(
    quantity: str,
    estimate: float,
    *,
    n: int,
    se: float = float("nan"),
    df: float = float("nan"),
    p: float = float("nan"),
    ci: tuple[float, float] = _UNKNOWN,
    participant_ci: tuple[float, float] = _UNKNOWN,
) -> dict[str, object]:
    """One result.

    Parameters
    ----------
    quantity : str
        As ``table_3_2/stance/per_trial``.
    estimate : float
    n : int
        Rows behind it.
    se, df, p : float, optional
        Of the model.
    ci, participant_ci : tuple of float, optional
        Intervals of the model, and over patients.
    """
    return {
        "quantity": quantity, "estimate": estimate, "se": se, "df": df, "n": n,
        "ci_low": ci[0], "ci_high": ci[1], "p": p,
        "participant_ci_low": participant_ci[0], "participant_ci_high": participant_ci[1],
    }  # fmt: skip


def results(rows: Sequence[Mapping[str, object]]) -> pd.DataFrame:
    """Table of results.

    Parameters
    ----------
    rows : sequence of mapping
        From :func:`result_row`.
    """
    return pd.DataFrame(rows, columns=list(RESULT_COLUMNS))


def tested_effect(fit: MixedModelFit, term: str, plan: IntensityPlan) -> dict[str, float]:
    """Estimate, test and interval of one fixed effect.

    Parameters
    ----------
    fit : MixedModelFit
    term : str
        Name of the fixed effect.
    plan : IntensityPlan

    Returns
    -------
    dict of str to float
        ``estimate, se, df, t, p, ci_low, ci_high``.
    """
    table = fit.fixed_effects(plan.degrees_of_freedom, level=plan.confidence_level)
    values = table.loc[[term]].to_numpy(dtype=float)[0].tolist()
    return dict(zip(table.columns, values, strict=True))


def share_given(given: FloatArray, then: FloatArray, value: int, outcome: int) -> float:
    """Share of `outcome` in one rating where the other one is `value`; NaN where it never is.

    Parameters
    ----------
    given, then : array, shape (n,)
        The two ratings.
    value, outcome : int
        What the first one is, and what is looked for in the second.

    Examples
    --------
    >>> share_given(np.array([5.0, 5, 4]), np.array([5.0, 4, 5]), value=5, outcome=5)
    0.5
    """
    chosen = given == value
    return float((then[chosen] == outcome).mean()) if chosen.any() else float("nan")


def participant_intervals(
    statistics: Callable[[CodeArray], Mapping[str, float]],
    patients: pd.Series,
    estimates: Mapping[str, float],
    scales: Mapping[str, Scale],
    plan: IntensityPlan,
) -> dict[str, tuple[float, float]]:
    """Intervals of several statistics from one bootstrap over patients.

    Parameters
    ----------
    statistics : callable
        From row numbers to the statistics by name.
    patients : Series
        Patient of each row.
    estimates : mapping of str to float
        The statistics of all rows.
    scales : mapping of str to str
        Scale on which each interval is computed.
    plan : IntensityPlan

    Returns
    -------
    dict of str to tuple
        Both limits, NaN where a statistic is undefined in many resamples.
    """
    if patients.nunique() < 2:
        return dict.fromkeys(estimates, _UNKNOWN)
    resamples = cluster_resamples(patients, plan.cluster_bootstrap_n, plan.cluster_bootstrap_seed)
    drawn = [statistics(rows) for rows in resamples]
    intervals = {}
    for name, estimate in estimates.items():
        values = np.array([draw[name] for draw in drawn])
        draws = values[np.isfinite(values)]
        undefined = 1.0 - len(draws) / len(drawn)
        if undefined > _UNDEFINED_SHARE or not np.isfinite(estimate):
            intervals[name] = _UNKNOWN
            continue
        intervals[name] = bootstrap_interval(
            estimate,
            draws,
            n_clusters=patients.nunique(),
            level=plan.confidence_level,
            scale=scales[name],
        )
    return intervals
