"""Where a foot is still: rests, and the stillest instant of every stance.

One measure serves both. Around every sample, over a short window, the root mean square of the
angular rate and of the deviation of the acceleration from gravity are joined into one number in
rad/s. It falls in every stance, in walking to 0.1 rad/s, in running to about 1 rad/s, and rises by
an order of magnitude in between; so a stance is a minimum that stands out on a logarithmic scale,
whatever the speed. No threshold in rad/s is needed for stances.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import maximum_filter1d, minimum_filter1d, uniform_filter1d
from scipy.signal import find_peaks

from swaystride.gait.foot_methods import FootMethod
from swaystride.gait.stance_rhythm import stances_in_rhythm
from swaystride.units import GRAVITY_M_S2

Array = NDArray[np.float64]
Index = NDArray[np.int64]

#: Below this (rad/s) differences of stillness are noise of the sensor, not movement.
_STILL_FLOOR_RAD_S: Final = 0.05


def stillness_rad_s(
    acc_m_s2: ArrayLike,
    gyr_rad_s: ArrayLike,
    rate_hz: float,
    *,
    window_s: float,
    acc_m_s2_per_rad_s: float,
) -> Array:
    """How much a foot moves around each sample: root mean square of rate and of acceleration.

    Parameters
    ----------
    acc_m_s2, gyr_rad_s : array_like, shape (3, n_samples)
        Proper acceleration and angular rate in the sensor frame, in any orientation.
    rate_hz : float
        Sampling rate.
    window_s : float
        Length of the moving mean.
    acc_m_s2_per_rad_s : float
        Deviation of the size of the acceleration from gravity that counts like 1 rad/s.

    Returns
    -------
    ndarray, shape (n_samples,)
        In rad/s; small is still.

    Examples
    --------
    >>> acc, gyr = np.tile([[0.0], [0.0], [9.80665]], 50), np.full((3, 50), 0.1)
    >>> stillness_rad_s(acc, gyr, 100.0, window_s=0.05, acc_m_s2_per_rad_s=5.0)[25].round(4)
    np.float64(0.1732)
    """
    acc, gyr = np.asarray(acc_m_s2, dtype=np.float64), np.asarray(gyr_rad_s, dtype=np.float64)
    excess = np.sqrt(np.einsum("ij,ij->j", acc, acc)) - GRAVITY_M_S2
    movement = np.einsum("ij,ij->j", gyr, gyr) + (excess / acc_m_s2_per_rad_s) ** 2
    mean = uniform_filter1d(movement, _odd_samples(window_s, rate_hz), mode="reflect")
    return np.asarray(np.sqrt(np.maximum(mean, 0.0)))


def find_rests(
    acc_m_s2: ArrayLike, gyr_rad_s: ArrayLike, rate_hz: float, method: FootMethod
) -> Index:
    """Spans of rest: first sample and the one after the last.

    A rest inside the recording must be longer than the stillest stance of a slow walk; at either
    end, where the foot may have rested for long before, half of that is enough.

    Parameters
    ----------
    acc_m_s2, gyr_rad_s : array_like, shape (3, n_samples)
        Proper acceleration and angular rate in the sensor frame.
    rate_hz : float
        Sampling rate.
    method : FootMethod
        ``rest_rate_rad_s``, ``rest_acc_m_s2``, ``rest_window_s``, ``shortest_rest_s``.

    Returns
    -------
    ndarray of int, shape (n_rests, 2)

    Examples
    --------
    >>> from swaystride.gait.foot_methods import RECOMMENDED
    >>> acc, gyr = np.tile([[0.0], [9.80665], [0.0]], 300), np.zeros((3, 300))
    >>> gyr[:, 100:180] = 3.0
    >>> find_rests(acc, gyr, 100.0, RECOMMENDED).tolist()
    [[0, 95], [185, 300]]
    """
    movement = stillness_rad_s(
        acc_m_s2,
        gyr_rad_s,
        rate_hz,
        window_s=method.rest_window_s,
        acc_m_s2_per_rad_s=method.rest_acc_m_s2 / method.rest_rate_rad_s,
    )
    edges = np.flatnonzero(np.diff(np.r_[False, movement < method.rest_rate_rad_s, False]))
    spans = edges.reshape(-1, 2)
    at_an_end = (spans[:, 0] == 0) | (spans[:, 1] == movement.size)
    shortest = method.shortest_rest_s * rate_hz * np.where(at_an_end, 0.5, 1.0)
    return np.asarray(spans[spans[:, 1] - spans[:, 0] >= np.round(shortest)], dtype=np.int64)


def find_stances(
    acc_m_s2: ArrayLike, gyr_rad_s: ArrayLike, rate_hz: float, method: FootMethod, rests: Index
) -> Index:
    """Stillest sample of every stance outside the rests.

    A minimum of the logarithm of stillness is a candidate if it rises to either side by the factor
    ``stance_ratio`` before it falls lower (within ``stance_context_s``) and if it lies nearer to the
    stillest candidate around it than to the least still instant. Rests are no candidates, because a
    running foot is never as still as a standing one. Among the candidates the rhythm decides:
    :func:`swaystride.gait.stance_rhythm.stances_in_rhythm`.

    Parameters
    ----------
    acc_m_s2, gyr_rad_s : array_like, shape (3, n_samples)
        Proper acceleration and angular rate in the sensor frame.
    rate_hz : float
        Sampling rate.
    method : FootMethod
        ``stillness_window_s``, ``stillness_acc_m_s2_per_rad_s``, ``stance_ratio``,
        ``stance_depth``, ``stance_context_s``.
    rests : ndarray of int, shape (n_rests, 2)
        As from :func:`find_rests`.

    Returns
    -------
    ndarray of int, shape (n_stances,)

    Examples
    --------
    >>> from swaystride.gait.foot_methods import RECOMMENDED
    >>> phase = 2 * np.pi * np.arange(1000) / 200.0
    >>> gyr = np.zeros((3, 1000)); gyr[1] = 4.0 * (1.0 - np.cos(phase))
    >>> acc = np.tile([[0.0], [0.0], [9.80665]], 1000)
    >>> find_stances(acc, gyr, 200.0, RECOMMENDED, np.empty((0, 2), dtype=int)).tolist()
    [200, 400, 600, 800]
    """
    movement = stillness_rad_s(
        acc_m_s2,
        gyr_rad_s,
        rate_hz,
        window_s=method.stillness_window_s,
        acc_m_s2_per_rad_s=method.stillness_acc_m_s2_per_rad_s,
    )
    depth = -np.log(np.maximum(movement, _STILL_FLOOR_RAD_S))
    # Below the floor the order is kept, so that two equally deep minima of one stance do not count
    # as two.
    depth -= 1e-6 * np.log(np.maximum(movement, 1e-3))
    around = 2 * round(method.stance_context_s * rate_hz) + 1
    # A longer stillness is a rest, found by itself; here it only costs time.
    minima, _ = find_peaks(
        depth,
        prominence=np.log(method.stance_ratio),
        wlen=around,
        plateau_size=(1, max(around // 2, 1)),
    )
    least = minimum_filter1d(depth, around, mode="nearest")[minima]
    still = np.full(movement.size, -np.inf)
    still[minima] = depth[minima]
    for first, stop in rests:
        still[first:stop] = -np.inf
    most = np.maximum(maximum_filter1d(still, around, mode="nearest")[minima], depth[minima])
    is_stance = depth[minima] - least > method.stance_depth * (most - least)
    candidates = np.asarray(minima[is_stance & np.isfinite(still[minima])], dtype=np.int64)
    return stances_in_rhythm(candidates, movement, acc_m_s2, gyr_rad_s, rate_hz, rests)


def _odd_samples(duration_s: float, rate_hz: float) -> int:
    """Odd number of samples, at least one, that lasts about as long."""
    return max(1, round(duration_s * rate_hz)) | 1
