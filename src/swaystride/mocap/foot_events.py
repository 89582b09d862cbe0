"""First touch and toe-off of running feet from the velocity of foot markers.

A foot in contact does not move over the ground. Ghoussayni, Stevens, Durham and Ewins (Gait Posture
20, 2004, 266-272) compare the velocity of heel and toe markers in the sagittal plane with a
threshold. Here the ground is the belt; first touch is the first marker of the foot that is slow,
toe-off the forefoot's last marker that rises, and the thresholds are ours (methods §5.11).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.signals.filters import lowpass_without_lag

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ContactRule:
    """When a foot counts as standing on the ground.

    Parameters
    ----------
    speed_share : float
        A marker has touched when it is slower over the ground, in the sagittal plane, than this
        share of the running speed.
    rise_share : float
        The forefoot has left when all of its markers rise faster than this share of the running
        speed: they creep forward over the ground while the toes are still on it.
    cutoff_hz : float
        Low-pass of the markers before they are differentiated.
    shortest_s : float
        Shorter contacts are none; shorter breaks do not end one.
    """

    speed_share: float
    rise_share: float
    cutoff_hz: float
    shortest_s: float


#: Shares chosen on three trials of two runners against force plates (``make validation``), in
#: sample.
RUNNING_CONTACT: Final = ContactRule(
    speed_share=0.28, rise_share=0.18, cutoff_hz=30.0, shortest_s=0.06
)


def foot_contacts(
    heel_m: Array,
    toe_m: Array,
    *,
    rate_hz: float,
    running_speed_m_s: float,
    belt_speed_m_s: float,
    rule: ContactRule,
    file: str = "",
) -> pd.DataFrame:
    """Contacts of one foot: from the first marker that stands to the last toe that rises.

    Parameters
    ----------
    heel_m, toe_m : ndarray, shape (n_markers, n_frames, 3)
        Markers at the heel and at the forefoot; world axes, x forward, z up. Do not low-pass them
        at 10 Hz before. A contact with a missing marker near one of its ends is left out.
    rate_hz : float
        Frames per second.
    running_speed_m_s : float
        Mean speed over the ground; sets the thresholds.
    belt_speed_m_s : float
        Speed of the belt backwards in the frame of the markers: the running speed on a treadmill,
        0 over ground and for markers in the frame of the belt.
    rule : ContactRule
    file : str
        For errors.

    Returns
    -------
    DataFrame
        ``initial_contact_s`` and ``toe_off_s``, from the first frame given, of every contact that
        begins and ends inside the recording, to a fraction of a frame.

    Raises
    ------
    RecordingError
        If a marker is missing throughout, or there is no contact, as in a trial without running or
        with the wrong belt speed.
    """
    _check_seen(heel_m, toe_m, file)
    missing = ~np.isfinite(np.concatenate([heel_m, toe_m])).all(axis=(0, 2))
    heel, toe = (_velocity(m, rate_hz, belt_speed_m_s, rule) for m in (heel_m, toe_m))
    slow, rising_m_s = (share * running_speed_m_s for share in (rule.speed_share, rule.rise_share))
    speed = np.hypot(*np.concatenate([heel, toe], axis=1)).min(axis=0) - slow
    rise = toe[1].min(axis=0) - rising_m_s
    shortest = max(1, round(rule.shortest_s * rate_hz))
    beside = round(rate_hz / rule.cutoff_hz / 2.0)
    rows = []
    begins, ends = _runs(speed < 0.0, shortest)
    for first, after in zip(begins, ends, strict=True):
        rising = np.flatnonzero(rise[first:] > 0.0)
        if first == 0 or after == len(speed) or rising.size == 0 or rising[0] == 0:
            continue
        last = first + rising[0] - 1
        if any(
            missing[max(frame - beside, 0) : frame + beside + 1].any() for frame in (first, last)
        ):
            continue
        rows.append(
            {
                "initial_contact_s": (first - 1 + _crossing(speed, first - 1)) / rate_hz,
                "toe_off_s": (last + _crossing(rise, last)) / rate_hz,
            }
        )
    if not rows:
        raise RecordingError(
            "no contact of the foot",
            file=file or None,
            expected=f"a marker slower than {slow:g} m/s over ground that moves backwards at "
            f"{belt_speed_m_s:g} m/s, until the toe rises, inside the recording",
            found=f"{len(begins)} slow spells, none of them whole"
            if len(begins)
            else f"at least {float(speed.min()) + slow:.2f} m/s",
        )
    return pd.DataFrame(rows)


def _check_seen(heel_m: Array, toe_m: Array, file: str) -> None:
    """A marker that is never seen gives no velocity."""
    for place, markers in (("heel", heel_m), ("toe", toe_m)):
        seen = np.any(np.isfinite(markers).all(axis=2), axis=1)
        if not seen.all():
            raise RecordingError(
                "marker missing throughout",
                file=file or None,
                place=f"{place}, marker {int(np.flatnonzero(~seen)[0]) + 1} of {len(seen)}",
                expected="frames in which it is seen",
                found="none",
            )


def belt_speed(toe_m: Array, rate_hz: float) -> float:
    """Speed of the belt from a foot that stands on it: the toe while it is low.

    Parameters
    ----------
    toe_m : ndarray, shape (n_frames, 3)
        A marker of the forefoot without gaps.
    rate_hz : float
        Frames per second.

    Returns
    -------
    float
        Backwards speed in m/s: the median over the lowest fifth of the frames.
    """
    height = toe_m[:, 2]
    low = height <= np.quantile(height, 0.2)
    return float(-np.median(np.gradient(toe_m[:, 0])[low]) * rate_hz)


def _velocity(markers: Array, rate_hz: float, belt_m_s: float, rule: ContactRule) -> Array:
    """Forward (over the ground) and upward velocity of each marker, (2, n_markers, n_frames)."""
    smooth = lowpass_without_lag(
        _bridged(markers[..., [0, 2]].transpose(2, 0, 1)), rule.cutoff_hz, rate_hz
    )
    velocity = np.gradient(smooth, axis=-1) * rate_hz
    velocity[0] += belt_m_s
    return np.asarray(velocity)


def _bridged(signal: Array) -> Array:
    """Straight lines over missing samples, so that a filter can pass; (..., n_frames)."""
    flat = signal.reshape(-1, signal.shape[-1])
    frames = np.arange(flat.shape[1])
    rows = []
    for row in flat:
        seen = np.isfinite(row)
        rows.append(np.interp(frames, frames[seen], row[seen]))
    return np.array(rows).reshape(signal.shape)


def _runs(slow: NDArray[np.bool_], shortest: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Begins and ends (exclusive) of runs, short breaks closed and short runs left out."""
    edges = np.diff(np.r_[False, slow, False].astype(np.int8))
    begin, end = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    if begin.size:
        joined = begin[1:] - end[:-1] < shortest
        begin, end = begin[np.r_[True, ~joined]], end[np.r_[~joined, True]]
    long = end - begin >= shortest
    return begin[long], end[long]


def _crossing(excess: Array, frame: int) -> float:
    """Fraction of a frame after `frame` at which the excess is zero."""
    here, there = excess[frame], excess[frame + 1]
    return float(here / (here - there))
