"""Orientation by integration of the gyroscope alone: what every correction is measured against."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.gait._strapdown_kernels import orientation_with_tilt

Array = NDArray[np.float64]


def integrated_orientation(gyr_rad_s: ArrayLike, rate_hz: float, start: ArrayLike) -> Array:
    """Integrate the angular rate from a known orientation; nothing stops its drift.

    Parameters
    ----------
    gyr_rad_s : array_like, shape (3, n_samples)
        In the sensor frame, without bias.
    rate_hz : float
        Sampling rate.
    start : array_like, shape (4,)
        ``q_world_from_sensor`` at the first sample.

    Returns
    -------
    ndarray, shape (n_samples, 4)
        ``q_world_from_sensor``.

    Examples
    --------
    Half a turn about z in one second:

    >>> turning = np.tile([[0.0], [0.0], [np.pi]], 101)
    >>> integrated_orientation(turning, 100.0, [1.0, 0.0, 0.0, 0.0])[-1].round(6) + 0.0
    array([0., 0., 0., 1.])
    """
    turned: Array = orientation_with_tilt(
        np.ascontiguousarray(gyr_rad_s, dtype=np.float64),
        1.0 / rate_hz,
        np.array(start, dtype=np.float64),
        np.empty(0, dtype=np.int64),
        np.empty((0, 3)),
        np.empty(0),
        0.0,
        0.0,
    )
    return turned
