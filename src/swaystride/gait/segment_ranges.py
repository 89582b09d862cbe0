"""Ranges of motion of hip and knee, and the peak roll rate of a foot, per stride (methods §7.2)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import cumulative_trapezoid

from swaystride.errors import RecordingError
from swaystride.gait.event_windows import window_maxima
from swaystride.gait.stride_curves import stride_curves
from swaystride.units import DEG_PER_RAD

Array = NDArray[np.float64]

#: Points of a stride at which an angle is looked at.
_N_PHASES: Final = 101


@dataclass(frozen=True)
class RollWindow:
    """Part of the contact in which the roll rate of a foot is judged.

    Parameters
    ----------
    contact_share : float
        From initial contact to this share of the contact time.
    """

    contact_share: float


#: Methods §7.2 [N]; the print names no window.
EARLY_STANCE: Final = RollWindow(0.5)
WHOLE_STANCE: Final = RollWindow(1.0)


def integrated(rate_rad_s: ArrayLike, rate_hz: float) -> Array:
    """Angle of a rate, from the first sample.

    Parameters
    ----------
    rate_rad_s : array_like, shape (..., n_samples)
        Missing samples are NaN.
    rate_hz : float
        Sampling rate.

    Returns
    -------
    ndarray, shape (..., n_samples)
        rad; missing where the rate is, and shifted by an unknown angle after a gap.

    Examples
    --------
    >>> integrated([2.0, 2.0, np.nan, 2.0], 2.0).tolist()
    [0.0, 1.0, nan, 2.0]
    """
    rate = np.asarray(rate_rad_s, dtype=np.float64)
    known = np.isfinite(rate)
    angle = cumulative_trapezoid(np.where(known, rate, 0.0), dx=1.0 / rate_hz, initial=0)
    return np.where(known, angle, np.nan)


def periodic_curves(
    rate_rad_s: ArrayLike, start_s: ArrayLike, stop_s: ArrayLike, rate_hz: float
) -> Array:
    """Angles over strides from a rate, taken to be alike at both ends of each stride.

    Parameters
    ----------
    rate_rad_s : array_like, shape (n_samples,)
        Angular rate, or a difference of two.
    start_s, stop_s : array_like, shape (n_strides,)
        In s from the first sample.
    rate_hz : float
        Sampling rate.

    Returns
    -------
    ndarray, shape (n_strides, 101)
        rad, zero at both ends: the line that joins them is subtracted, and with it a constant error
        of the gyroscopes.
    """
    start, stop = (np.asarray(edge, dtype=np.float64) * rate_hz for edge in (start_s, stop_s))
    curves = stride_curves(integrated(rate_rad_s, rate_hz), start, stop, _N_PHASES)
    share = np.linspace(0.0, 1.0, _N_PHASES)
    return np.asarray(curves - curves[:, :1] - share * (curves[:, -1:] - curves[:, :1]))


def joint_ranges_deg(
    distal_rate_rad_s: ArrayLike,
    proximal_rate_rad_s: ArrayLike,
    start_s: ArrayLike,
    stop_s: ArrayLike,
    rate_hz: float,
) -> Array:
    """Sagittal range of motion of a joint in each stride.

    Parameters
    ----------
    distal_rate_rad_s, proximal_rate_rad_s : array_like, shape (n_samples,)
        Angular rate of the two segments about the medio-lateral axis, after the low-pass: thigh and
        pelvis for the hip, shank and thigh for the knee.
    start_s, stop_s : array_like, shape (n_strides,)
        Initial contacts.
    rate_hz : float
        Sampling rate.

    Returns
    -------
    ndarray, shape (n_strides,)
        Degrees. Missing where a sample is missing.

    Raises
    ------
    RecordingError
        If the segments differ in length.

    Examples
    --------
    >>> time = np.arange(1000) / 500.0
    >>> thigh = np.radians(20.0) * 2.0 * np.pi * np.cos(2.0 * np.pi * time) + 0.05
    >>> joint_ranges_deg(thigh, 0.0 * time, [0.0], [1.0], 500.0).round(2).tolist()
    [40.0]
    """
    distal, proximal = (
        np.asarray(rate, dtype=np.float64) for rate in (distal_rate_rad_s, proximal_rate_rad_s)
    )
    if distal.shape != proximal.shape:
        raise RecordingError(
            "the segments of a joint do not cover the same samples",
            expected="one length",
            found=f"{distal.size} and {proximal.size}",
        )
    curves = periodic_curves(distal - proximal, start_s, stop_s, rate_hz)
    return np.asarray(DEG_PER_RAD * (curves.max(axis=1) - curves.min(axis=1)))


def peak_roll_rates_deg_s(
    roll_rate_rad_s: ArrayLike, strides: pd.DataFrame, rate_hz: float, window: RollWindow
) -> Array:
    """Largest roll rate of a foot after initial contact, whichever way it rolls.

    Parameters
    ----------
    roll_rate_rad_s : array_like, shape (n_samples,)
        Angular rate of the foot about its long axis, after the low-pass.
    strides : DataFrame
        Of this foot, with ``start_s`` and ``toe_off_s``.
    rate_hz : float
        Sampling rate.
    window : RollWindow

    Returns
    -------
    ndarray, shape (n_strides,)
        °/s.

    Examples
    --------
    >>> strides = pd.DataFrame({"start_s": [0.1], "toe_off_s": [0.3]})
    >>> rate = np.zeros(100)
    >>> rate[15], rate[28] = -np.pi, 2 * np.pi
    >>> [peak_roll_rates_deg_s(rate, strides, 100.0, window).round(6).tolist()
    ...  for window in (EARLY_STANCE, WHOLE_STANCE)]
    [[180.0], [360.0]]
    """
    start, off = strides["start_s"].to_numpy(float), strides["toe_off_s"].to_numpy(float)
    stop = start + window.contact_share * (off - start)
    size = np.abs(np.asarray(roll_rate_rad_s, dtype=np.float64))
    return DEG_PER_RAD * window_maxima(size, start, stop, rate_hz)
