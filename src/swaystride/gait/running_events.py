"""Initial contact and toe-off of both feet of a runner, step by step of the sacrum (methods §3.5)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final, Literal

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy import fft
from scipy.signal import find_peaks

from swaystride.errors import RecordingError
from swaystride.gait.initial_contact import RUNNING_IMPACT, expected_stride_s
from swaystride.gait.push_off import PushOffRule, push_off_ends
from swaystride.gait.segment_signals import ML, SegmentSignals, complete_parts, lowpassed_parts
from swaystride.gait.stride_curves import stride_curves
from swaystride.gait.toe_off import PITCH_MINIMUM, ToeOffRule, toe_offs
from swaystride.gait.unloading import UNLOADED, UnloadingRule, unloading_ends

Array = NDArray[np.float64]
Index = NDArray[np.int64]
ContactInstant = Literal["highest_peak", "sharpest_peak", "onset"]
Side = Literal["right", "left"]
OffRule = ToeOffRule | PushOffRule | UnloadingRule

SIDES: Final[tuple[Side, Side]] = ("right", "left")
EVENT_COLUMNS: Final = ("side", "initial_contact_s", "toe_off_s")

#: Markers are further apart than this share of a step [N].
_LEAST_STEP_SHARE: Final = 0.6
#: Part of the stride in which a foot swings forward, in percent (methods §4.4).
_FORWARD_SWING: Final = slice(70, 91)


@dataclass(frozen=True)
class RunningEventRule:
    """How the events of a run are found.

    Parameters
    ----------
    contact : {"highest_peak", "sharpest_peak", "onset"}
        Instant near the smoothed peak of the acceleration of the foot that counts as initial
        contact. ``highest_peak``: the largest resultant acceleration, as printed; it may be the
        arrest of the swing. ``sharpest_peak``: the peak that stands out most above the acceleration
        low-passed at `slow_hz`. ``onset``: where the rise to this peak begins, without its lag.
    acc_cutoff_hz : float
        Low-pass of the accelerations (4th order, zero lag).
    slow_hz : float
        What is slower is no impact; for ``sharpest_peak`` and ``onset``.
    reach_s : float
        The instant is sought this far to either side of the smoothed peak.
    rise_s : float
        Longest rise of an impact; for ``onset``.
    lowest_step_hz, highest_step_hz : float
        Band in which the step frequency is sought.
    spectrum_s : float
        Length of the parts of which the spectra are averaged.
    toe_off : ToeOffRule, PushOffRule or UnloadingRule
    """

    contact: ContactInstant
    acc_cutoff_hz: float
    slow_hz: float
    reach_s: float
    rise_s: float
    lowest_step_hz: float
    highest_step_hz: float
    spectrum_s: float
    toe_off: OffRule


#: Dissertation, §5.3.4.1, with the reading of methods §3.5 of what it leaves open: band, ±60 ms and
#: toe-off by the pitch rate. 20 s (a run does not keep one frequency to a thousandth) is ours [N].
PRINTED_EVENTS: Final = RunningEventRule(
    contact="highest_peak",
    acc_cutoff_hz=60.0,
    slow_hz=25.0,
    reach_s=0.06,
    rise_s=0.04,
    lowest_step_hz=2.0,
    highest_step_hz=4.0,
    spectrum_s=20.0,
    toe_off=PITCH_MINIMUM,
)
#: Contact without the lag of the peak, and toe-off where the pelvis begins to fall freely. 25 Hz,
#: 40 ms and 90 ms (at 9 km/h the smoothed peak is 50 ms early) are ours [N], seen on 18 simulated
#: runners only.
RECOMMENDED_EVENTS: Final = replace(PRINTED_EVENTS, contact="onset", reach_s=0.09, toe_off=UNLOADED)


def running_events(
    feet: Mapping[str, SegmentSignals],
    sacrum: SegmentSignals,
    *,
    rate_hz: float,
    rule: RunningEventRule,
) -> pd.DataFrame:
    """Initial contacts and toe-offs of a run.

    The resultant acceleration of the sacrum, low-passed at its dominant frequency, has one peak per
    step. Between two of them the foot with the larger smoothed acceleration is the one that lands.

    Parameters
    ----------
    feet : mapping of str to SegmentSignals
        ``right`` and ``left``, in anatomical axes, as recorded (the filters are part of the rule).
    sacrum : SegmentSignals
        Of the lumbar sensor, in any axes.
    rate_hz : float
        Sampling rate.
    rule : RunningEventRule
        :data:`PRINTED_EVENTS`, :data:`RECOMMENDED_EVENTS`, or your own.

    Returns
    -------
    DataFrame
        ``side``, ``initial_contact_s``, ``toe_off_s``; a row per contact, in the order of time, in s
        from the first sample. The toe-off is missing where no stride follows or the rule finds none.
        Nothing is rejected yet: see :func:`swaystride.gait.spatiotemporal.running_strides`. Where
        one of the three sensors has a gap, the run is cut.

    Raises
    ------
    RecordingError
        If a foot is missing, the sensors differ in length, nobody runs, or a foot sensor points
        to the wrong side.
    """
    _check_sensors(feet, sacrum)
    missing = feet["right"].missing() | feet["left"].missing() | sacrum.missing()
    found: list[pd.DataFrame] = []
    refused = RecordingError(
        "nobody runs in this recording",
        expected="samples of all three sensors",
        found=f"{missing.size / rate_hz:.1f} s, {missing.sum() / rate_hz:.1f} s of them missing",
    )
    for first, last in complete_parts(np.where(missing, np.nan, 0.0)):
        signals = {side: _part(feet[side], first, last) for side in SIDES}
        try:
            # standing, walking and scraps between two gaps hold no events of a run
            for side in SIDES:
                turning = np.linalg.norm(signals[side].gyr_rad_s, axis=0)
                expected_stride_s(turning, rate_hz, RUNNING_IMPACT, place=f"{side} foot")
        except RecordingError as error:
            refused = error
            continue
        sizes = [signals[side].acc_m_s2 for side in SIDES] + [sacrum.acc_m_s2[:, first:last]]
        resultant = np.stack([np.linalg.norm(acc, axis=0) for acc in sizes])
        acc = lowpassed_parts(resultant, rule.acc_cutoff_hz, rate_hz)
        sides, contacts = _landings(acc[:2], acc[2], rate_hz, rule)
        for k, side in enumerate(SIDES):
            own = _rising(contacts[sides == k])
            pelvis = sacrum.acc_m_s2[:, first:last]
            found.append(
                _side_events(side, own, signals[side].gyr_rad_s, pelvis, int(first), rate_hz, rule)
            )
    if not found:
        raise refused
    events: pd.DataFrame = pd.concat(found).sort_values("initial_contact_s", ignore_index=True)
    return events


def step_frequency_hz(acc_m_s2: Array, rate_hz: float, rule: RunningEventRule) -> float:
    """Dominant frequency of an acceleration in the band of steps.

    Parameters
    ----------
    acc_m_s2 : ndarray, shape (n_samples,)
        Resultant acceleration of the sacrum, complete.
    rate_hz : float
        Sampling rate.
    rule : RunningEventRule
        Band, and length of the parts of which the spectra are averaged.

    Returns
    -------
    float

    Examples
    --------
    >>> time = np.arange(5000) / 500.0
    >>> acc = 15.0 + 5.0 * np.cos(2.0 * np.pi * 2.8 * time) + np.cos(2.0 * np.pi * 1.4 * time)
    >>> round(step_frequency_hz(acc, 500.0, PRINTED_EVENTS), 2)
    2.8
    """
    n = acc_m_s2.size
    length = min(n, round(rule.spectrum_s * rate_hz))
    parts = np.stack([acc_m_s2[k : k + length] for k in range(0, n - length + 1, length)])
    padded = fft.next_fast_len(4 * length, real=True)
    centred = parts - parts.mean(axis=1, keepdims=True)
    spectrum = np.abs(fft.rfft(centred, padded, axis=1)).mean(axis=0)
    frequency = np.arange(spectrum.size) * rate_hz / padded
    inside = (frequency >= rule.lowest_step_hz) & (frequency <= rule.highest_step_hz)
    return float(frequency[inside][np.argmax(spectrum[inside])])


def _check_sensors(feet: Mapping[str, SegmentSignals], sacrum: SegmentSignals) -> None:
    """Both feet, and three sensors of one length."""
    for side in SIDES:
        if side not in feet:
            raise RecordingError(
                "a foot sensor is missing",
                expected="right and left",
                found=", ".join(feet) or "none",
            )
    lengths = [signals.acc_m_s2.shape[1] for signals in (feet["right"], feet["left"], sacrum)]
    if len(set(lengths)) > 1:
        raise RecordingError(
            "the sensors do not cover the same samples",
            expected="right foot, left foot and sacrum of one length",
            found=", ".join(str(length) for length in lengths),
        )


def _part(signals: SegmentSignals, first: int, last: int) -> SegmentSignals:
    """Samples [first, last) of a segment."""
    return SegmentSignals(signals.acc_m_s2[:, first:last], signals.gyr_rad_s[:, first:last])


def _landings(
    foot_acc: Array, sacrum_acc: Array, rate_hz: float, rule: RunningEventRule
) -> tuple[Index, Array]:
    """Foot (0 right, 1 left) and contact, in samples, of every step between two markers."""
    step_hz = step_frequency_hz(sacrum_acc, rate_hz, rule)
    smooth = lowpassed_parts(np.vstack([foot_acc, sacrum_acc]), step_hz, rate_hz)
    markers, _ = find_peaks(smooth[2], distance=max(_LEAST_STEP_SHARE * rate_hz / step_hz, 1.0))
    if markers.size < 2:
        return np.empty(0, dtype=np.int64), np.empty(0)
    begin, end = markers[:-1], markers[1:]
    window = begin[:, None] + np.arange(int((end - begin).max()))
    inside = window < end[:, None]
    height = np.where(inside, smooth[:2, np.minimum(window, smooth.shape[1] - 1)], -np.inf)
    side = np.argmax(height.max(axis=2), axis=0)
    rows = np.arange(begin.size)
    peak = begin + np.argmax(height[side, rows], axis=1)
    return side, _instants(foot_acc, side, peak, rate_hz, rule)


def _instants(
    acc: Array, side: Index, smoothed_peak: Index, rate_hz: float, rule: RunningEventRule
) -> Array:
    """Contact near the smoothed peaks; NaN too near to an end of the part."""
    reach, rise = round(rule.reach_s * rate_hz), round(rule.rise_s * rate_hz)
    judged = acc
    if rule.contact != "highest_peak":
        judged = acc - lowpassed_parts(acc, rule.slow_hz, rate_hz)
    whole = (smoothed_peak >= reach + rise + 1) & (smoothed_peak < acc.shape[1] - reach - 1)
    side, centre = side[whole], smoothed_peak[whole]
    window = centre[:, None] + np.arange(-reach, reach + 1)
    instant = centre - reach + np.argmax(judged[side[:, None], window], axis=1)
    if rule.contact == "onset":
        before = instant[:, None] + np.arange(-rise, 1)
        instant = instant - rise + np.argmin(judged[side[:, None], before], axis=1)
    out = np.full(whole.size, np.nan)
    out[whole] = instant
    return out


def _rising(contacts: Array) -> Index:
    """Contacts of one foot, each once and in order."""
    return np.unique(contacts[np.isfinite(contacts)]).astype(np.int64)


def _side_events(
    side: Side,
    contacts: Index,
    gyr: NDArray[np.floating],
    pelvis_acc: NDArray[np.floating],
    first: int,
    rate_hz: float,
    rule: RunningEventRule,
) -> pd.DataFrame:
    """Events of one foot in one part of the recording."""
    off = np.full(contacts.size, np.nan)
    if contacts.size > 1:
        _check_forward(side, gyr[ML], contacts)
        off[:-1] = _toe_offs(gyr, pelvis_acc, contacts, rate_hz, rule.toe_off)
    columns = (side, (first + contacts) / rate_hz, (first + off) / rate_hz)
    return pd.DataFrame(dict(zip(EVENT_COLUMNS, columns, strict=True)))


def _toe_offs(
    gyr: NDArray[np.floating],
    pelvis_acc: NDArray[np.floating],
    contacts: Index,
    rate_hz: float,
    rule: OffRule,
) -> Array:
    """Toe-off of every stride by any kind of rule."""
    if isinstance(rule, UnloadingRule):
        return unloading_ends(pelvis_acc, contacts, rate_hz, rule)
    if isinstance(rule, PushOffRule):
        return push_off_ends(gyr[ML], contacts, rate_hz, rule)
    return toe_offs(gyr[ML], np.linalg.norm(gyr, axis=0), contacts, rate_hz, rule)


def _check_forward(side: Side, pitch_rate: NDArray[np.floating], contacts: Index) -> None:
    """A foot swings forward with its toes going up; otherwise the sensor is turned over."""
    swing = stride_curves(pitch_rate, contacts[:-1], contacts[1:])[:, _FORWARD_SWING]
    forward = float(np.median(swing.mean(axis=1)))
    if forward <= 0.0:
        raise RecordingError(
            "the medio-lateral axis of a foot sensor does not point to the right",
            place=f"{side} foot",
            expected="a positive rate late in swing",
            found=f"{np.degrees(forward):.0f} °/s",
        )
