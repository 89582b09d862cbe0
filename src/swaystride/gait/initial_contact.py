"""Initial contacts of a running foot: the primary peaks of its acceleration (dissertation, §4.3.4.3)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.signal import find_peaks

from swaystride.errors import RecordingError
from swaystride.gait.cadence import SHORTEST_STRIDE_S, local_stride_s
from swaystride.gait.zero_velocity import gyro_energy
from swaystride.signals.filters import lowpass_without_lag

Array = NDArray[np.float64]
Index = NDArray[np.int64]
PrimaryPeak = Literal["highest", "sharpest"]

#: Below this (rad/s) a foot counts as equally still: noise has no order.
_STILL_FLOOR_RAD_S: Final = 0.5
#: One rhythm must be found in this share of the windows of a trial; its stride times differ by less
#: than the second share.
_LEAST_RHYTHM_SHARE: Final = 0.5
_SAME_RHYTHM_SHARE: Final = 0.25


@dataclass(frozen=True)
class InitialContactRule:
    """Which peak of the acceleration is the impact.

    Parameters
    ----------
    peak : {"highest", "sharpest"}
        ``highest``: the largest resultant acceleration. ``sharpest``: the peak that stands out most
        above the acceleration low-passed at `slow_hz`. Late in swing the foot is slowed down by
        almost as much as by the impact, over a longer time; the highest peak may be that one.
    cutoff_hz, filter_from_rate_hz : float
        Low-pass of the acceleration (4th order, zero lag), where the sampling rate is at least the
        second value.
    slow_hz : float
        What is slower is no impact; for ``sharpest``.
    least_distance_share : float
        Two stances are further apart than this share of the expected stride time.
    least_height_share, height_quantile : float
        A peak is at least this share of this quantile of the acceleration.
    stance_share : float
        The stillest instant of the stance follows within this share of the stride time.
    quiet_window_s : float
        Window of the gyroscopic energy that says how still a foot is.
    longest_stride_s : float
        Longer strides are not those of a run.
    """

    peak: PrimaryPeak
    cutoff_hz: float
    filter_from_rate_hz: float
    slow_hz: float
    least_distance_share: float
    least_height_share: float
    height_quantile: float
    stance_share: float
    quiet_window_s: float
    longest_stride_s: float


#: Methods §3.1; the sharpest peak, 25 Hz, the window and 1 s are ours [N].
RUNNING_IMPACT: Final = InitialContactRule(
    peak="sharpest",
    cutoff_hz=60.0,
    filter_from_rate_hz=200.0,
    slow_hz=25.0,
    least_distance_share=0.6,
    least_height_share=0.5,
    height_quantile=0.95,
    stance_share=0.35,
    quiet_window_s=0.05,
    longest_stride_s=1.0,
)


def initial_contacts(
    acc_m_s2: ArrayLike,
    gyr_rad_s: ArrayLike,
    rate_hz: float,
    rule: InitialContactRule,
    *,
    place: str = "",
) -> Index:
    """Initial contacts of one running foot.

    Peaks count only if the stance follows: the instants at which the foot turns least, one per
    stride, are found first, and a contact is the peak in the 0.35 strides before one of them. A
    stance nearer than that to an end of the recording is left out: it may be the turn of a swing.

    Parameters
    ----------
    acc_m_s2 : array_like, shape (n_samples,)
        Size of the proper acceleration, without missing samples.
    gyr_rad_s : array_like, shape (n_samples,)
        Size of the angular rate.
    rate_hz : float
        Sampling rate, at least 50 Hz.
    rule : InitialContactRule
    place : str
        Named in errors, for example ``right foot``.

    Returns
    -------
    ndarray of int, shape (n_contacts,)
        Samples, rising; at least two. The peak lies after the first touch, by 11 to 12 ms in the
        simulated runner at 14 km/h, more in life (methods §3.3); it cancels in stride times.

    Raises
    ------
    RecordingError
        If the foot does not run: no rhythm, strides that are too long, no peaks before stances. If
        samples are missing.

    Examples
    --------
    >>> phase = (np.arange(1600) / 200.0 % 0.7) / 0.7
    >>> acc = 15.0 + 100.0 * np.exp(-(((phase - 0.1) / 0.01) ** 2))
    >>> gyr = 6.0 - 6.0 * np.cos(2 * np.pi * (phase - 0.25))
    >>> contacts = initial_contacts(acc, gyr, 200.0, RUNNING_IMPACT)
    >>> contacts[:3].tolist(), len(contacts)
    ([154, 294, 434], 10)
    """
    acc = np.asarray(acc_m_s2, dtype=np.float64)
    gyr = np.asarray(gyr_rad_s, dtype=np.float64)
    _check_complete(acc, "acceleration", place)
    stride = rate_hz * expected_stride_s(gyr, rate_hz, rule, place=place)
    if rate_hz >= rule.filter_from_rate_hz:
        acc = lowpass_without_lag(acc, rule.cutoff_hz, rate_hz)
    outstanding = (
        acc if rule.peak == "highest" else acc - lowpass_without_lag(acc, rule.slow_hz, rate_hz)
    )
    least = rule.least_height_share * float(np.quantile(acc, rule.height_quantile))
    stances, reach = _stances(gyr, rate_hz, stride, rule)
    contacts = _primary_peaks(acc, outstanding, stances, reach, least)
    if contacts.size < 2:
        raise RecordingError(
            "this foot does not run",
            place=place or None,
            expected=f"peaks of the acceleration before the stances, every {stride / rate_hz:.2f} s",
            found=f"{contacts.size}",
        )
    return contacts


def expected_stride_s(
    gyr_rad_s: ArrayLike, rate_hz: float, rule: InitialContactRule, *, place: str = ""
) -> float:
    """Stride time of a run, from the autocorrelation of the angular rate of a foot.

    Parameters
    ----------
    gyr_rad_s : array_like, shape (n_samples,)
        Size of the angular rate.
    rate_hz : float
        Sampling rate, at least 50 Hz.
    rule : InitialContactRule
        ``longest_stride_s``.
    place : str
        Named in errors.

    Returns
    -------
    float
        Median over windows of 4 s.

    Raises
    ------
    RecordingError
        If there is no rhythm, as in standing, or a slower one, as in walking; if samples are missing.

    Examples
    --------
    >>> time = np.arange(2000) / 200.0
    >>> round(expected_stride_s(5 + 4 * np.sin(2 * np.pi * time / 0.7), 200.0, RUNNING_IMPACT), 2)
    0.7
    """
    gyr = np.asarray(gyr_rad_s, dtype=np.float64)
    _check_complete(gyr, "angular rate", place)
    _, strides_s = local_stride_s(gyr, rate_hz)
    known = strides_s[np.isfinite(strides_s)]
    stride_s = float(np.median(known)) if known.size else np.nan
    n_alike = int(np.sum(np.abs(known - stride_s) < _SAME_RHYTHM_SHARE * stride_s))
    found = None
    if strides_s.size == 0:
        found = f"a recording of {gyr.size / rate_hz:.1f} s, too short for a rhythm"
    elif n_alike < _LEAST_RHYTHM_SHARE * strides_s.size:
        found = f"one rhythm in {n_alike} of {strides_s.size} windows of 4 s"
    elif stride_s > rule.longest_stride_s:
        found = f"strides of {stride_s:.2f} s"
    if found:
        raise RecordingError(
            "this foot does not run",
            place=place or None,
            expected=f"strides of {SHORTEST_STRIDE_S:g} to {rule.longest_stride_s:g} s",
            found=found,
        )
    return stride_s


def _check_complete(signal: Array, name: str, place: str) -> None:
    """Neither a filter nor a rhythm passes a gap."""
    missing = int(np.sum(~np.isfinite(signal)))
    if missing:
        raise RecordingError(
            "cannot find contacts across missing samples",
            place=place or None,
            expected=f"the {name} at every sample",
            found=f"{missing} of {signal.size} missing",
        )


def _stances(
    gyr: Array, rate_hz: float, stride: float, rule: InitialContactRule
) -> tuple[Index, int]:
    """Stillest sample of each stance, and how many samples before it the contact may be."""
    window = max(1, round(rule.quiet_window_s * rate_hz)) | 1
    energy = gyro_energy(gyr[None], window) / window
    stillness = -np.log(np.maximum(energy, 0.0) + _STILL_FLOOR_RAD_S**2)
    # the stillest ones within the distance remain
    stances, _ = find_peaks(stillness, distance=max(rule.least_distance_share * stride, 1.0))
    reach = int(rule.stance_share * stride)
    # near the ends a lower minimum may lie outside
    inside = (stances >= reach) & (stances < gyr.size - reach)
    return np.asarray(stances[inside], dtype=np.int64), reach


def _primary_peaks(
    acc: Array, outstanding: Array, stances: Index, reach: int, least: float
) -> Index:
    """Of the high peaks of the acceleration before each stance the most outstanding one."""
    peaks, _ = find_peaks(acc, height=least)
    height = np.full(acc.size, -np.inf)
    height[peaks] = outstanding[peaks]
    windows = stances[:, None] + np.arange(-reach, 1)
    chosen = np.argmax(height[windows], axis=1)
    found = windows[np.arange(stances.size), chosen]
    return np.asarray(found[np.isfinite(height[found])], dtype=np.int64)
