"""Sensor-to-segment alignment from the sensors alone: gravity, and the main axis of turning.

In quiet standing the vertical is the anatomical y axis; in walking and running a leg turns mainly
about the axis from left to right (methods §4). Turns of the path are left out, and the rate is
projected on the horizontal: a U-turn is a large rate about the vertical.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import skew

from swaystride.errors import RecordingError
from swaystride.signals.filters import butterworth_lowpass

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class MainAxis:
    """Main axis of turning of a segment.

    Parameters
    ----------
    axis : ndarray, shape (3,)
        Unit vector in the sensor frame, horizontal in standing; the sign is arbitrary.
    share : float
        Part of the squared angular rate about it; above 0.8 for a shank or foot, 0.7 for a thigh.
    off_horizontal_rad : float
        Angle between the main axis of the whole rate and the horizontal; below 15° in good order.
    sd_rad : float
        Standard deviation of its direction.
    """

    axis: Array
    share: float
    off_horizontal_rad: float
    sd_rad: float


def standing_vertical(acc_m_s2: Array) -> Array:
    """Unit vector that points up in the sensor frame, mean over quiet standing.

    Parameters
    ----------
    acc_m_s2 : ndarray, shape (3, n_samples)
    """
    mean = acc_m_s2.mean(axis=1)
    return np.asarray(mean / np.linalg.norm(mean))


def straight_samples(
    gyr_rad_s: Array, vertical: Array, rate_hz: float, *, cutoff_hz: float, limit_rad_s: float
) -> NDArray[np.bool_]:
    """Samples at which the path does not turn, from the sensor on the pelvis.

    Parameters
    ----------
    gyr_rad_s : ndarray, shape (3, n_samples)
        Of the pelvis.
    vertical : ndarray, shape (3,)
        Up in its frame.
    rate_hz : float
        Sampling rate.
    cutoff_hz : float
        Low-pass of the turning rate, well below the stride frequency (0.4 Hz).
    limit_rad_s : float
        A faster turn is left out (0.3 rad/s).

    Returns
    -------
    ndarray of bool, shape (n_samples,)
    """
    turning = butterworth_lowpass(
        vertical @ gyr_rad_s,
        cutoff_hz=cutoff_hz,
        rate_hz=rate_hz,
        order=2,
        direction="zero_lag",
        pad_s=1.0 / cutoff_hz,
    )
    return np.asarray(np.abs(turning) < limit_rad_s)


def main_axis(gyr_rad_s: Array, vertical: Array, keep: NDArray[np.bool_]) -> MainAxis:
    """Horizontal axis about which a segment turns most.

    Parameters
    ----------
    gyr_rad_s : ndarray, shape (3, n_samples)
        Low-passed at about 15 Hz.
    vertical : ndarray, shape (3,)
        Up in the sensor frame in standing.
    keep : ndarray of bool, shape (n_samples,)
        Samples that count.

    Returns
    -------
    MainAxis

    Raises
    ------
    RecordingError
        If nothing turns.
    """
    rate = gyr_rad_s[:, keep]
    flat = rate - np.outer(vertical, vertical @ rate)
    scatter = rate @ rate.T
    if not np.trace(scatter) > 0.0:
        raise RecordingError("no movement to find the main axis of turning in")
    values, vectors = np.linalg.eigh(flat @ flat.T)
    whole = np.linalg.eigh(scatter)[1][:, -1]
    # of the two horizontal directions the smaller one is noise (methods §4.2)
    variance = max(values[1], 0.0) / keep.sum()
    return MainAxis(
        axis=vectors[:, -1],
        share=float(values[-1] / np.trace(scatter)),
        off_horizontal_rad=float(abs(np.arcsin(np.clip(whole @ vertical, -1.0, 1.0)))),
        sd_rad=float(np.sqrt(variance / values[-1])),
    )


def pointing_right(
    axis: Array,
    gyr_rad_s: Array,
    *,
    shank_rate: Array | None = None,
    prior: Array | None = None,
    place: str = "",
) -> Array:
    """Sign of a main axis, so that it points to the right of the person.

    About the right the forward swing is positive, short and fast: the rate of a shank is skewed to
    it. Thigh and foot swing forward when their shank does; the rate of a foot in walking can be
    skewed the other way, by its push-off. Where a mounting prior is given, it has to agree (methods
    §4.4).

    Parameters
    ----------
    axis : ndarray, shape (3,)
    gyr_rad_s : ndarray, shape (3, n_samples)
        Of the segment.
    shank_rate : ndarray, shape (n_samples,), optional
        Rate of the shank of the same leg about its own right, for a thigh or foot.
    prior : ndarray, shape (3,), optional
        Roughly to the right, from the mounting.
    place : str
        Name of the sensor, for the error.

    Returns
    -------
    ndarray, shape (3,)

    Raises
    ------
    RecordingError
        If movement and mounting disagree.
    """
    rate = axis @ gyr_rad_s
    if shank_rate is None:
        sign = 1.0 if skew(rate) > 0.0 else -1.0
    else:
        swing = shank_rate > 0.5 * np.quantile(shank_rate, 0.99)
        sign = 1.0 if rate[swing].mean() > 0.0 else -1.0
    if prior is not None and sign * (axis @ prior) < 0.0:
        raise RecordingError(
            "movement and mounting disagree on which side is right",
            place=place or None,
            expected="sensors mounted as said, walking or running forwards",
            found=f"the swing goes the other way ({np.degrees(np.arccos(sign * axis @ prior)):.0f}°)",
        )
    return sign * axis


def anatomical_frame(vertical: Array, right: Array) -> Array:
    """Mounting of a sensor; the vertical is kept, the axis to the right made horizontal.

    Parameters
    ----------
    vertical, right : ndarray, shape (3,)
        In the sensor frame.

    Returns
    -------
    ndarray, shape (3, 3)
        ``r_anatomical_from_sensor``: its rows are x (forward), y (up), z (right).

    Examples
    --------
    >>> anatomical_frame(np.array([0.0, 0.0, 1.0]), np.array([0.0, -1.0, 0.2]))
    array([[ 1.,  0.,  0.],
           [ 0.,  0.,  1.],
           [ 0., -1.,  0.]])
    """
    z = right - (right @ vertical) * vertical
    z /= np.linalg.norm(z)
    return np.stack([np.cross(vertical, z), vertical, z]) + 0.0
