"""Strides of simulated recordings beside the truth: which trajectory errs how much, and at what gait.

The truth of a stride is the displacement of the very sensor between the two instants that the
estimate calls its zero-velocity epochs.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.units import DEG_PER_RAD

#: Kinds of gait, slow to fast.
GAITS: Final = ("walking", "running", "sprinting")

STRIDE_ERROR_COLUMNS: Final = (
    "participant",
    "trial",
    "foot",
    "imu",
    "method",
    "gait",
    "speed_m_s",
    "is_half",
    "length_m",
    "true_length_m",
    "angle_deg",
    "true_angle_deg",
)

#: Position of a sensor in the world: from instants (n,) in s to (n, 3) in m.
Position = Callable[[NDArray[np.float64]], NDArray[np.float64]]


def gait_of(duty_factor: float, speed_m_s: float, sprint_speed_m_s: float) -> str:
    """Name the gait: in walking a foot stands for more than half of its stride.

    Parameters
    ----------
    duty_factor : float
        Duration of a stance over that of a stride.
    speed_m_s : float
        Mean speed of the trial.
    sprint_speed_m_s : float
        From this mean speed on, running is called sprinting.

    Examples
    --------
    >>> gait_of(0.6, 1.9, 5.5), gait_of(0.35, 2.4, 5.5), gait_of(0.25, 6.0, 5.5)
    ('walking', 'running', 'sprinting')
    """
    if duty_factor > 0.5:
        return "walking"
    return "sprinting" if speed_m_s >= sprint_speed_m_s else "running"


def true_strides(strides: pd.DataFrame, position: Position) -> pd.DataFrame:
    """Length and angle that the sensor's true path has between the epochs of the estimate.

    Parameters
    ----------
    strides : DataFrame
        ``start_s``, ``stop_s``, ``length_m``, ``angle_rad`` and ``is_half``, of one recording.
    position : callable
        True position of the sensor.

    Returns
    -------
    DataFrame
        ``is_half``, ``length_m``, ``true_length_m``, ``angle_deg``, ``true_angle_deg``.
    """
    start_s, stop_s = (strides[name].to_numpy(dtype=float) for name in ("start_s", "stop_s"))
    vectors = position(stop_s) - position(start_s)
    angle = np.full(len(strides), np.nan)
    if len(strides) > 1:
        cross = np.linalg.norm(np.cross(vectors[:-1], vectors[1:]), axis=1)
        angle[:-1] = np.arctan2(cross, (vectors[:-1] * vectors[1:]).sum(axis=1))
    estimated = strides["angle_rad"].to_numpy(dtype=float)
    angle[np.isnan(estimated)] = np.nan
    return pd.DataFrame(
        {
            "is_half": strides["is_half"].to_numpy(dtype=bool),
            "length_m": strides["length_m"].to_numpy(dtype=float),
            "true_length_m": np.linalg.norm(vectors, axis=1),
            "angle_deg": DEG_PER_RAD * estimated,
            "true_angle_deg": DEG_PER_RAD * angle,
        }
    )


def error_table(strides: pd.DataFrame) -> pd.DataFrame:
    """Errors of stride length and angle by method, IMU and gait.

    Parameters
    ----------
    strides : DataFrame
        :data:`STRIDE_ERROR_COLUMNS` of all participants.

    Returns
    -------
    DataFrame
        ``method``, ``imu``, ``gait``, ``n_strides``, ``mean_length_m``, mean, standard deviation,
        median and root mean square of the length error in percent of the true length, and the
        median of the size of the angle error in degrees. Half strides are left out.
    """
    whole = strides[~strides["is_half"].astype(bool)]
    relative = 100.0 * (whole["length_m"] / whole["true_length_m"] - 1.0)
    turned = (whole["angle_deg"] - whole["true_angle_deg"]).abs()
    frame = whole.assign(relative=relative, squared=relative**2, turned=turned)
    frame["gait"] = pd.Categorical(frame["gait"], categories=list(GAITS), ordered=True)
    frame["method"] = pd.Categorical(frame["method"], categories=list(frame["method"].unique()))
    grouped = frame.groupby(["method", "imu", "gait"], sort=True, observed=True)
    table = grouped.agg(
        n_strides=("relative", "size"),
        mean_length_m=("true_length_m", "mean"),
        mean_error_percent=("relative", "mean"),
        sd_error_percent=("relative", "std"),
        median_error_percent=("relative", "median"),
        rms_error_percent=("squared", "mean"),
        median_angle_error_deg=("turned", "median"),
    ).reset_index()
    table["rms_error_percent"] = np.sqrt(table["rms_error_percent"])
    return table.astype({"method": str, "gait": str})
