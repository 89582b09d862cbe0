"""Compiled kernel: how high a foot is at an instant, within the strides around it."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from swaystride.gait._quaternion_kernels import rotated, turned

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def shares_of_height(
    acc: Array,
    gyr: Array,
    step_s: float,
    at: Index,
    reach: Index,
    range_ends: tuple[float, float],
    clipped_shares: tuple[float, float],
) -> Array:
    """Height at given samples: 0 the lowest and 1 the highest of the stride around each.

    Over `reach` samples (one stride) to either side the gyroscope is integrated; the mean of the
    turned acceleration is up, because a movement that repeats itself has no mean acceleration; what
    is left along it is integrated twice, each time without its mean.

    Parameters
    ----------
    acc, gyr : array, shape (3, n)
        m/s² and rad/s.
    step_s : float
        Time step.
    at, reach : array of int, shape (k,)
        Samples in question, and one stride in samples.
    range_ends : tuple of two floats
        A sample with an axis of the acceleration (m/s²) or of the rate (rad/s) beyond is clipped.
    clipped_shares : tuple of two floats
        With a larger share of clipped samples, of the one or the other, no height is given.

    Returns
    -------
    array, shape (k,)
        NaN where there is none.
    """
    n = acc.shape[1]
    out = np.full(len(at), np.nan)
    for i in range(len(at)):
        first, stop = max(at[i] - reach[i], 0), min(at[i] + reach[i] + 1, n)
        size = stop - first
        force = np.empty((size, 3))
        q = (1.0, 0.0, 0.0, 0.0)
        sx, sy, sz, n_acc, n_gyr = 0.0, 0.0, 0.0, 0, 0
        for k in range(size):
            j = first + k
            if max(abs(acc[0, j]), abs(acc[1, j]), abs(acc[2, j])) >= range_ends[0]:
                n_acc += 1
            if max(abs(gyr[0, j]), abs(gyr[1, j]), abs(gyr[2, j])) >= range_ends[1]:
                n_gyr += 1
            x, y, z = rotated(q, acc[0, j], acc[1, j], acc[2, j])
            force[k, 0], force[k, 1], force[k, 2] = x, y, z
            sx, sy, sz = sx + x, sy + y, sz + z
            m = min(j + 1, n - 1)
            q = turned(
                q,
                0.5 * (gyr[0, j] + gyr[0, m]),
                0.5 * (gyr[1, j] + gyr[1, m]),
                0.5 * (gyr[2, j] + gyr[2, m]),
                step_s,
            )
        total = math.sqrt(sx * sx + sy * sy + sz * sz)
        if n_acc > clipped_shares[0] * size or n_gyr > clipped_shares[1] * size or total == 0.0:
            continue
        sx, sy, sz = sx / total, sy / total, sz / total
        velocity, running, mean = np.empty(size), 0.0, 0.0
        for k in range(size):
            running += force[k, 0] * sx + force[k, 1] * sy + force[k, 2] * sz - total / size
            velocity[k] = running
            mean += running / size
        own, lowest, highest = at[i] - first, math.inf, -math.inf
        height, here = 0.0, 0.0
        for k in range(size):
            height += velocity[k] - mean
            if abs(2 * (k - own)) <= reach[i]:
                lowest, highest = min(lowest, height), max(highest, height)
            if k == own:
                here = height
        if highest > lowest:
            out[i] = (here - lowest) / (highest - lowest)
    return out
