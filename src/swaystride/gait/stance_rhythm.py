"""Which candidates are stances: one per stride, with the foot low, and none left out of a rhythm."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import maximum_filter1d

from swaystride.gait.cadence import local_stride_s
from swaystride.gait.foot_height import height_shares

Array = NDArray[np.float64]
Index = NDArray[np.int64]

#: Two stances of a foot are further apart than this share of a stride.
_LEAST_STRIDE_SHARE: Final = 0.6
#: Candidates whole strides apart agree in their phase to this share of a stride.
_SAME_PHASE_SHARE: Final = 0.08
#: Candidates are judged together with those this many whole strides before and after.
_STRIDES_JUDGED: Final = 3
#: The mean squared rate over this window says how fast a candidate turns.
_TURN_WINDOW_S: Final = 0.03
#: A rhythm holds this long from the middle of the window in which it was found, one second beyond
#: its ends: first and last strides.
_RHYTHM_HOLDS_S: Final = 3.0
#: In stance the foot is in the lower part of its range. In the simulated sprints stances came out
#: below .1 of the range and turns of the swing above .45; where the window is cut by the end of the
#: recording or full of start or stop, a stance reaches .43, which its neighbours outvote.
_HIGHEST_STANCE: Final = 0.4
#: A stance may be up to this share of a stride off the middle between its neighbours.
_UNEVEN_SHARE: Final = 0.3
#: The longest hole in strides: beyond it the number of strides in it is no longer certain.
_LONGEST_HOLE: Final = 10


def stances_in_rhythm(
    candidates: Index,
    movement_rad_s: Array,
    acc_m_s2: ArrayLike,
    gyr_rad_s: ArrayLike,
    rate_hz: float,
    rests: Index,
) -> Index:
    """Choose the stances among candidates, and put back those that a steady rhythm misses.

    1. Where candidates do not follow each other stride by stride, those with a high foot go: they
       are turns of the swing.
    2. Within 0.6 local stride times only the one remains that moves and turns least.
    3. Where one to nine stances are missing between two that are whole strides apart, without a rest
       between them, the stillest sample near each expected instant is taken.

    In 1 and 2 candidates are judged together with those up to three whole strides before and after:
    at the turn of a swing a foot may for once be as still as in a stance, but not in stride after
    stride. Where there is no rhythm nothing is changed.

    Parameters
    ----------
    candidates : ndarray of int, shape (k,)
        Minima of the movement outside rests, rising.
    movement_rad_s : ndarray, shape (n_samples,)
        From :func:`swaystride.gait.stillness.stillness_rad_s`.
    acc_m_s2, gyr_rad_s : array_like, shape (3, n_samples)
        Proper acceleration and angular rate in the sensor frame.
    rate_hz : float
        Sampling rate.
    rests : ndarray of int, shape (n_rests, 2)
        As from :func:`swaystride.gait.stillness.find_rests`.

    Returns
    -------
    ndarray of int
        Rising.

    Examples
    --------
    A stance that is no candidate is put back:

    >>> phase = 2 * np.pi * np.arange(1200) / 100.0
    >>> movement = 1.5 - np.cos(phase)
    >>> still = np.tile([[0.0], [9.80665], [0.0]], 1200)
    >>> given = np.array([200, 300, 500, 600])
    >>> none = np.empty((0, 2), dtype=int)
    >>> stances_in_rhythm(given, movement, still, 0 * still, 100.0, none).tolist()
    [200, 300, 400, 500, 600]
    """
    period = _stride_samples(candidates, movement_rad_s, rate_hz)
    if candidates.size < 2 or not period.any():
        return candidates
    gyr = np.asarray(gyr_rad_s, dtype=np.float64)
    high = _high_foot(candidates, period, acc_m_s2, gyr, rate_hz)
    candidates, period = candidates[~high], period[~high]
    unrest = _unrest(candidates, movement_rad_s, gyr, rate_hz)
    kept = _one_per_stride(candidates, _over_strides(candidates, unrest, period), period)
    return _holes_filled(candidates[kept], period[kept], movement_rad_s, rests)


def _stride_samples(candidates: Index, movement: Array, rate_hz: float) -> Array:
    """Local stride time at each candidate in samples; 0 without a rhythm."""
    centre_s, stride_s = local_stride_s(movement, rate_hz)
    known = np.isfinite(stride_s)
    if not known.any():
        return np.zeros(candidates.size)
    centre_s, stride_s = centre_s[known], stride_s[known]
    at_s = candidates / rate_hz
    nearest = np.searchsorted(0.5 * (centre_s[1:] + centre_s[:-1]), at_s)
    holds = np.abs(centre_s[nearest] - at_s) <= _RHYTHM_HOLDS_S
    return np.where(holds, stride_s[nearest] * rate_hz, 0.0)


def _high_foot(
    candidates: Index, period: Array, acc_m_s2: ArrayLike, gyr: Array, rate_hz: float
) -> NDArray[np.bool_]:
    """Candidates, up to three places from an uneven interval, at whose phase the foot is high."""
    # Before the first and after the last there is no interval: both are judged.
    gap = np.r_[np.inf, np.diff(candidates), np.inf]
    uneven = np.abs(gap[1:] - period) > _UNEVEN_SHARE * period
    uneven |= np.abs(gap[:-1] - period) > _UNEVEN_SHARE * period
    near = np.flatnonzero(maximum_filter1d(uneven, 2 * _STRIDES_JUDGED + 1, mode="nearest"))
    heights = np.full(candidates.size, np.nan)
    if near.size:
        heights[near] = height_shares(acc_m_s2, gyr, rate_hz, candidates[near], period[near])
    return np.asarray(_over_strides(candidates, heights, period) > _HIGHEST_STANCE)


def _unrest(candidates: Index, movement: Array, gyr: Array, rate_hz: float) -> Array:
    """Logarithm of movement and turning at each candidate."""
    reach = int(0.5 * _TURN_WINDOW_S * rate_hz)
    window = np.clip(candidates[:, None] + np.arange(-reach, reach + 1), 0, gyr.shape[1] - 1)
    turning = np.mean(np.sum(gyr[:, window] ** 2, axis=0), axis=1)
    still = 2.0 * np.log(np.maximum(movement[candidates], 1e-3))
    return np.asarray(np.log(np.maximum(turning, 1e-6)) + still)


def _over_strides(candidates: Index, values: Array, period: Array) -> Array:
    """Mean of a value over each candidate and those up to three strides before and after it.

    Missing values do not count; without any the mean is missing.
    """
    if candidates.size < 2:
        return values
    known = np.isfinite(values)
    values = np.where(known, values, 0.0)
    total, count = values.copy(), known.astype(np.float64)
    for strides in range(-_STRIDES_JUDGED, _STRIDES_JUDGED + 1):
        if strides == 0:
            continue
        wanted = candidates + strides * period
        other = np.clip(np.searchsorted(candidates, wanted), 1, candidates.size - 1)
        before = wanted - candidates[other - 1] < candidates[other] - wanted
        other = np.where(before, other - 1, other)
        there = np.abs(candidates[other] - wanted) < _SAME_PHASE_SHARE * period
        total += np.where(there, values[other], 0.0)
        count += there & known[other]
    return np.where(count > 0, total / np.maximum(count, 1.0), np.nan)


def _one_per_stride(candidates: Index, unrest: Array, period: Array) -> NDArray[np.bool_]:
    """Keep the candidate of least unrest within 0.6 local stride times."""
    reach = _LEAST_STRIDE_SHARE * period
    first = np.searchsorted(candidates, candidates - reach, side="right")
    stop = np.searchsorted(candidates, candidates + reach, side="left")
    kept = np.ones(candidates.size, dtype=np.bool_)
    for this in np.argsort(unrest, kind="stable"):
        if kept[this]:
            kept[first[this] : stop[this]] = False
            kept[this] = True
    return kept


def _holes_filled(stances: Index, period: Array, movement: Array, rests: Index) -> Index:
    """Put back up to nine stances between two that are whole strides apart."""
    gap = np.diff(stances)
    stride = np.maximum(period[1:], period[:-1])
    n_strides = np.round(gap / np.maximum(stride, 1.0)).astype(np.int64)
    whole = np.abs(gap - n_strides * stride) <= _UNEVEN_SHARE * stride
    rested = np.diff(np.searchsorted(rests[:, 0], stances)) > 0
    few = (n_strides >= 2) & (n_strides <= _LONGEST_HOLE)
    holes = np.flatnonzero(whole & few & (stride > 0) & ~rested)
    found = []
    for hole in holes:
        reach = round(_SAME_PHASE_SHARE * stride[hole])
        for number in range(1, n_strides[hole]):
            first = stances[hole] + round(gap[hole] * number / n_strides[hole]) - reach
            found.append(first + int(np.argmin(movement[first : first + 2 * reach + 1])))
    return np.union1d(stances, np.asarray(found, dtype=np.int64))
