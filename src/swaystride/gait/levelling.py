"""Orientation with the right tilt and no heading: from the direction of the acceleration."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def level_quaternion(up_in_sensor: ArrayLike) -> Array:
    """Smallest rotation that takes a direction to the vertical.

    Parameters
    ----------
    up_in_sensor : array_like, shape (3,)
        Any length but nil: for example the mean acceleration at rest.

    Returns
    -------
    ndarray, shape (4,)
        ``q_world_from_sensor``, scalar first.

    Examples
    --------
    >>> level_quaternion([0.0, 0.0, 9.8]).tolist()
    [1.0, 0.0, 0.0, 0.0]
    >>> level_quaternion([0.0, 0.0, -9.8]).tolist()
    [0.0, 1.0, 0.0, 0.0]
    """
    up = np.asarray(up_in_sensor, dtype=np.float64)
    up = up / np.linalg.norm(up)
    if up[2] < -1.0 + 1e-12:
        return np.array([0.0, 1.0, 0.0, 0.0])
    quaternion = np.array([1.0 + up[2], up[1], 0.0 - up[0], 0.0])
    return np.asarray(quaternion / np.linalg.norm(quaternion))


def mean_directions(vectors: ArrayLike, samples: ArrayLike, reach: int) -> Array:
    """Unit vector of the mean of a signal around given samples.

    Parameters
    ----------
    vectors : array_like, shape (3, n_samples)
    samples : array_like of int, shape (m,)
    reach : int
        Samples to either side; windows are cut at the ends of the signal.

    Returns
    -------
    ndarray, shape (m, 3)
    """
    values = np.asarray(vectors, dtype=np.float64)
    centres = np.asarray(samples, dtype=np.int64)
    window = centres[:, None] + np.arange(-reach, reach + 1)
    inside = (window >= 0) & (window < values.shape[1])
    chosen = values[:, np.where(inside, window, 0)] * inside
    mean = chosen.sum(axis=2).T
    return np.asarray(mean / np.linalg.norm(mean, axis=1, keepdims=True))
