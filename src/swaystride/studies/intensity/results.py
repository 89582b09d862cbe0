"""Rows of results: one quantity, its model interval and its participant-level interval."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from swaystride.stats.cluster_bootstrap import Scale, bootstrap_interval, cluster_weights
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


def patient_weights(n_patients: int, plan: IntensityPlan) -> FloatArray:
    """Draw how often each patient occurs in each resample of the patients.

    The same draws serve every statistic. The rare resample that consists of one patient alone has
    no variance between patients and is left out.

    Parameters
    ----------
    n_patients : int
    plan : IntensityPlan

    Returns
    -------
    array, shape (at most cluster_bootstrap_n, n_patients)
    """
    weights = cluster_weights(n_patients, plan.cluster_bootstrap_n, plan.cluster_bootstrap_seed)
    several: FloatArray = weights[weights.max(axis=1) < n_patients].astype(float)
    return several


def participant_interval(
    draws: FloatArray, estimate: float, scale: Scale, n_patients: int, plan: IntensityPlan
) -> tuple[float, float]:
    """Interval over patients of one statistic.

    Parameters
    ----------
    draws : array, shape (n,)
        The statistic on resamples of patients; NaN where it is undefined.
    estimate : float
        The statistic of all patients.
    scale : {"identity", "fisher_z", "logit"}
        Scale on which the interval is computed.
    n_patients : int
    plan : IntensityPlan

    Returns
    -------
    tuple of float
        Both limits, NaN where the statistic is undefined in many resamples.
    """
    defined = draws[np.isfinite(draws)]
    if 1.0 - len(defined) / len(draws) > _UNDEFINED_SHARE or not np.isfinite(estimate):
        return _UNKNOWN
    interval = bootstrap_interval(
        estimate, defined, n_clusters=n_patients, level=plan.confidence_level, scale=scale
    )
    return (interval.low, interval.high)


def mean_draws(values: FloatArray, patients: CodeArray, weights: FloatArray) -> FloatArray:
    """Mean of a column in resamples of patients.

    Parameters
    ----------
    values : array, shape (n_rows,)
    patients : array of int, shape (n_rows,)
        Patient of each row, numbered as the columns of `weights`.
    weights : array, shape (n, m)

    Returns
    -------
    array, shape (n,)

    Examples
    --------
    >>> values, patients = np.array([1.0, 3.0, 8.0]), np.array([0, 0, 1])
    >>> mean_draws(values, patients, np.array([[1, 1], [2, 0]])).tolist()
    [4.0, 2.0]
    """
    m = weights.shape[1]
    sums = np.bincount(patients, weights=values, minlength=m)
    means: FloatArray = (weights @ sums) / (weights @ np.bincount(patients, minlength=m))
    return means
