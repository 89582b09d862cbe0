"""When a foot stands, from its IMU alone: for the shading of Figures 4 and 8."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.studies.imu_design.conditions import FloatArray, Signals

#: Contact lies within this share of the stride before a zero-velocity epoch, toe-off within the
#: same share after it: in walking, stance is 0.6 of the stride and the epoch in its middle.
REACH: Final = 0.4


def stance_intervals(signals: Signals, strides: pd.DataFrame) -> FloatArray:
    """Initial contact and toe-off around each zero-velocity epoch between two strides.

    Initial contact is the instant before the epoch at which the acceleration jumps most from one
    sample to the next, the impact; toe-off the instant after it at which the foot turns fastest.
    Good enough to shade a figure; a fraction of the arrest late by construction.

    Parameters
    ----------
    signals : Signals
        Of the recording.
    strides : DataFrame
        ``start_s`` and ``stop_s`` of its strides, in order.

    Returns
    -------
    ndarray, shape (n_stances, 2)
        Start and stop in s from the first sample.
    """
    start_s, stop_s = (strides[name].to_numpy(dtype=float) for name in ("start_s", "stop_s"))
    joined = np.flatnonzero(np.isclose(stop_s[:-1], start_s[1:]))
    jumps = np.linalg.norm(np.diff(signals.acc_m_s2, axis=1), axis=0)
    impact = np.append(jumps, 0.0)
    turning = np.linalg.norm(signals.gyr_rad_s, axis=0)
    rows = [
        (
            _largest(impact, stop_s[i] - REACH * (stop_s[i] - start_s[i]), stop_s[i], signals),
            _largest(turning, stop_s[i], stop_s[i] + REACH * (stop_s[i + 1] - stop_s[i]), signals),
        )
        for i in joined
    ]
    return np.array(rows, dtype=np.float64).reshape(-1, 2)


def _largest(values: NDArray[np.float64], from_s: float, to_s: float, signals: Signals) -> float:
    """Time of the largest value within a window."""
    first = max(int(np.ceil(from_s * signals.rate_hz)), 0)
    last = max(int(np.floor(to_s * signals.rate_hz)), first)
    return (first + int(values[first : last + 1].argmax())) / signals.rate_hz
