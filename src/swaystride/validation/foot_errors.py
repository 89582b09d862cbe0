"""Errors of stride length, pooled over strides and by trial."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.validation.foot_recording import FloatArray
from swaystride.validation.foot_strides import METHODS, FootTrial

ERROR_COLUMNS: Final = (
    "n",
    "rmse_m",
    "bias_m",
    "sd_m",
    "median_abs_m",
    "median_trial_rmse_m",
    "rmse_scaled_m",
)


def pooled_errors(strides: pd.DataFrame, column: str, reference: str = "reference_m") -> pd.Series:
    """Errors of one method over all strides of a table.

    Parameters
    ----------
    strides : DataFrame
        ``trial``, the lengths of the method and the reference; strides without a value are left
        out.
    column, reference : str
        Lengths of the method, and what they are held against.

    Returns
    -------
    Series
        ``n``; ``rmse_m``; ``bias_m``, the mean error; ``sd_m`` around it (divisor n, so that
        RMSE² = bias² + SD²); ``median_abs_m``; ``median_trial_rmse_m``, the median over trials of
        their RMSE; ``rmse_scaled_m``, the RMSE after a constant correction: one factor for all
        lengths of a trial, fitted to the other trials by least squares. Whoever is much better
        after it has a constant error; nobody's other numbers use it.

    Examples
    --------
    >>> table = pd.DataFrame({"trial": list("aabb"), "x": [1.1, 1.0, 2.1, 2.0],
    ...                       "reference_m": [1.0, 1.1, 2.0, 2.1]})
    >>> pooled_errors(table, "x")[["n", "rmse_m", "bias_m"]].round(9).tolist()
    [4.0, 0.1, 0.0]
    """
    seen = strides[["trial", column, reference]].dropna()
    if seen.empty:
        return pd.Series({name: 0.0 if name == "n" else np.nan for name in ERROR_COLUMNS})
    length, truth = (seen[name].to_numpy(dtype=np.float64) for name in (column, reference))
    trial = seen["trial"].to_numpy()
    error = length - truth
    by_trial = pd.Series(error**2).groupby(trial).mean().to_numpy(dtype=np.float64)
    values: dict[str, float] = {
        "n": float(len(seen)),
        "rmse_m": float(np.sqrt(np.mean(error**2))),
        "bias_m": float(np.mean(error)),
        "sd_m": float(np.std(error)),
        "median_abs_m": float(np.median(np.abs(error))),
        "median_trial_rmse_m": float(np.median(np.sqrt(by_trial))),
        "rmse_scaled_m": _rmse_scaled(length, truth, trial),
    }
    return pd.Series(values)


def _rmse_scaled(length: FloatArray, truth: FloatArray, trial: NDArray[np.object_]) -> float:
    """RMSE with one factor per trial, fitted to all other trials; NaN with one trial only."""
    names, which = np.unique(trial, return_inverse=True)
    if len(names) < 2:
        return float("nan")
    products, squares = (np.bincount(which, weights=length * by) for by in (truth, length))
    factor = (products.sum() - products) / (squares.sum() - squares)
    return float(np.sqrt(np.mean((factor[which] * length - truth) ** 2)))


def comparison_table(strides: pd.DataFrame, gaits: Sequence[str]) -> pd.DataFrame:
    """Pooled errors of every method that has values, by gait.

    Parameters
    ----------
    strides : DataFrame
        As from :func:`swaystride.validation.foot_strides.all_strides`.
    gaits : sequence of str
        In the order of the rows.
    """
    rows = []
    for gait in gaits:
        chosen = strides[strides["gait"] == gait]
        for column, name in METHODS.items():
            errors = pooled_errors(chosen, column)
            if errors["n"] > 0:
                rows.append({"gait": gait, "method": name, **errors.to_dict()})
    return pd.DataFrame(rows).astype({"n": int})


def trial_table(trials: Sequence[FootTrial]) -> pd.DataFrame:
    """Each trial: errors, and the sum of its stride lengths against that of the reference.

    Parameters
    ----------
    trials : sequence of FootTrial
    """
    rows = []
    for trial in trials:
        strides = trial.strides
        ours, reference = strides["length_m"].sum(), strides["reference_m"].sum()
        row: dict[str, object] = {
            "trial": trial.recording.trial,
            "gait": trial.recording.gait,
            "strides": len(strides),
            "own_strides": len(trial.own_strides),
        }
        for column in METHODS:
            row[f"rmse_{column}"] = pooled_errors(strides, column)["rmse_m"]
        row |= {"distance_m": ours, "reference_distance_m": reference}
        rows.append(row | {"distance_error_percent": 100.0 * (ours / reference - 1.0)})
    return pd.DataFrame(rows)
