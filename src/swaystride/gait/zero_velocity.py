"""Zero-velocity epochs: the samples at which a foot is taken to stand still."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError
from swaystride.gait.foot_methods import FootMethod
from swaystride.gait.stillness import find_rests, find_stances

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@dataclass(frozen=True)
class ZeroVelocity:
    """Rests and stances of one foot.

    Parameters
    ----------
    rests : ndarray of int, shape (n_rests, 2)
        First sample of each rest and the one after its last.
    stances : ndarray of int, shape (n_stances,)
        One epoch for each stance outside the rests, rising.
    flags : ndarray of bool, shape (n_samples,)
        True at the samples that count as still: rests, and those of each stance.
    """

    rests: Index
    stances: Index
    flags: NDArray[np.bool_]


def find_zero_velocity(
    acc_m_s2: ArrayLike, gyr_rad_s: ArrayLike, rate_hz: float, method: FootMethod
) -> ZeroVelocity:
    """Find rests and one epoch per stance by the rule of a method.

    Parameters
    ----------
    acc_m_s2, gyr_rad_s : array_like, shape (3, n_samples)
        Proper acceleration and angular rate in the sensor frame.
    rate_hz : float
        Sampling rate.
    method : FootMethod

    Returns
    -------
    ZeroVelocity
    """
    gyr = np.asarray(gyr_rad_s, dtype=np.float64)
    rests = find_rests(acc_m_s2, gyr, rate_hz, method)
    stillest = find_stances(acc_m_s2, gyr, rate_hz, method, rests)
    flags = rest_flags(gyr.shape[1], rests)
    # Between the middle of a stance and a rest lies a swing: what is stillest nearer to a rest
    # belongs to it, or is the slow end of a last swing.
    margin = round(method.shortest_step_s * rate_hz)
    beside = rest_flags(gyr.shape[1], rests + np.array([-margin, margin]))
    stillest = stillest[~beside[stillest]]
    if method.zero_velocity == "gyro_energy":
        stances, in_stance = _energy_epochs(gyr, rate_hz, stillest, method)
        flags |= in_stance
    else:
        stances = stillest
        if method.zero_velocity == "gyro_minimum":
            reach = round(method.minimum_reach_s * rate_hz)
            stances = gyro_minima(gyr, stillest, reach)
        flags[stances] = True
    return ZeroVelocity(rests, stances, flags)


def rest_flags(n_samples: int, rests: Index) -> NDArray[np.bool_]:
    """Flag the samples of all `rests` in a recording of `n_samples`.

    Examples
    --------
    >>> rest_flags(5, np.array([[-1, 2], [4, 9]])).tolist()
    [True, True, False, False, True]
    """
    inside = np.zeros(n_samples, dtype=np.bool_)
    for first, stop in rests:
        inside[max(first, 0) : stop] = True
    return inside


def gyro_minima(gyr_rad_s: ArrayLike, around: ArrayLike, reach: int) -> Index:
    """Sample of the smallest angular rate within `reach` samples of each given one.

    Parameters
    ----------
    gyr_rad_s : array_like, shape (3, n_samples)
    around : array_like of int
        Samples in stance, rising.
    reach : int
        Samples to either side.

    Returns
    -------
    ndarray of int
        Rising; equal ones once.

    Examples
    --------
    >>> gyr = np.array([[5.0, 3.0, 1.0, 2.0, 4.0], [0.0] * 5, [0.0] * 5])
    >>> gyro_minima(gyr, [3], reach=2).tolist()
    [2]
    """
    gyr = np.asarray(gyr_rad_s, dtype=np.float64)
    rate = np.pad(np.einsum("ij,ij->j", gyr, gyr), reach, constant_values=np.inf)
    centres = np.asarray(around, dtype=np.int64)
    if centres.size == 0:
        return centres
    windows = sliding_window_view(rate, 2 * reach + 1)[centres]
    return np.unique(centres + np.argmin(windows, axis=1) - reach)


def gyro_energy(gyr_rad_s: ArrayLike, window: int) -> Array:
    """Gyroscopic energy: sum of the squared angular rate over a window (dissertation, §4.3.4.2).

    ``E(t) = Σ ‖ω‖²`` over `window` samples, attributed to the centre of the window (the print lets
    the window begin at t, a lead of half a window). At either end the window is cut.

    Parameters
    ----------
    gyr_rad_s : array_like, shape (3, n_samples)
    window : int
        Odd number of samples.

    Returns
    -------
    ndarray, shape (n_samples,)
        (rad/s)².

    Examples
    --------
    >>> gyro_energy([[0.0, 1.0, 2.0, 0.0], [0.0] * 4, [0.0] * 4], 3).tolist()
    [1.0, 5.0, 5.0, 4.0]
    """
    gyr = np.asarray(gyr_rad_s, dtype=np.float64)
    squared = np.einsum("ij,ij->j", gyr, gyr)
    return np.convolve(squared, np.ones(window), mode="same")


def energy_threshold(energy: ArrayLike, n_samples: int) -> float:
    """Smallest threshold below which at least `n_samples` samples lie: an order statistic.

    The rule of the dissertation ("the average number of samples per stride is at least five") is
    met exactly by the value just above the n-th smallest, with n five times the number of strides.

    Parameters
    ----------
    energy : array_like
        Of all samples that may be chosen.
    n_samples : int
        Number of samples, five for each stride at 200 Hz.

    Returns
    -------
    float
        ``(energy < threshold).sum() >= n_samples``; with equal energies at the edge there are more.

    Raises
    ------
    RecordingError
        If there are fewer samples.

    Examples
    --------
    >>> threshold = energy_threshold([4.0, 1.0, 3.0, 2.0], 2)
    >>> [e < threshold for e in (1.0, 2.0, 3.0)]
    [True, True, False]
    """
    values = np.asarray(energy, dtype=np.float64)
    if not 1 <= n_samples <= values.size:
        raise RecordingError(
            "too few samples for the threshold of gyroscopic energy",
            expected=f"between 1 and {values.size} samples",
            found=str(n_samples),
        )
    return float(np.nextafter(np.partition(values, n_samples - 1)[n_samples - 1], np.inf))


def _energy_epochs(
    gyr: Array, rate_hz: float, stillest: Index, method: FootMethod
) -> tuple[Index, NDArray[np.bool_]]:
    """Samples of low energy in stance; the epoch of a stance is the middle one of its own.

    Only samples near a stance are candidates, because the rate is small at the turn of the swing
    too. A stance without any sample below the threshold falls back to its smallest energy.
    """
    flags = np.zeros(gyr.shape[1], dtype=np.bool_)
    if stillest.size == 0:
        return stillest, flags
    energy = gyro_energy(gyr, max(1, round(method.energy_window_s * rate_hz)) | 1)
    reach = round(method.minimum_reach_s * rate_hz)
    spans = [slice(max(k - reach, 0), k + reach + 1) for k in stillest]
    candidates = np.zeros_like(flags)
    for span in spans:
        candidates[span] = True
    wanted = int(np.ceil(method.energy_time_per_stride_s * rate_hz * stillest.size - 1e-9))
    threshold = energy_threshold(energy[candidates], min(wanted, int(candidates.sum())))
    flags = candidates & (energy < threshold)
    epochs = []
    for span in spans:
        own = np.flatnonzero(flags[span]) + span.start
        if own.size == 0:
            own = np.array([span.start + int(np.argmin(energy[span]))])
            flags[own] = True
        epochs.append(int(own[own.size // 2]))
    return np.unique(np.array(epochs, dtype=np.int64)), flags
