"""Sensors held against markers: each on its own segment, and both on one clock.

The size of the angular rate of a sensor is that of its segment, whatever the mounting. Each sensor
must move like its own segment, and all with one delay (:mod:`swaystride.signals.synchronisation`; methods §1.14).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from swaystride.erkf.optical_initialisation import segment_rates
from swaystride.errors import RecordingError
from swaystride.findings import Finding
from swaystride.lower_limb_joints import SEGMENTS
from swaystride.signals.filters import butterworth_lowpass
from swaystride.signals.synchronisation import Match, match_signals

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ClockRules:
    """How sensors and markers are compared.

    Parameters
    ----------
    cutoff_hz : float
        Low-pass of the rates of the sensors: that of the markers.
    longest_delay_s : float
        Largest delay between both that is looked for, two strides at least. Strides resemble each
        other: beyond it, the best that is found lies within a stride of it. So a delay of more than
        half of it is refused.
    least_correlation : float
        Between the rate of a sensor and that of its segment; less is another movement.
    accepted_delay_s : float
        A larger delay is reported and taken out.
    """

    cutoff_hz: float
    longest_delay_s: float
    least_correlation: float
    accepted_delay_s: float


def clock_delay_s(
    gyr_rad_s: Array,
    r_world_from_segment: Array,
    rate_hz: float,
    rules: ClockRules,
    labels: tuple[str, ...],
    file: str,
) -> tuple[float, list[Finding]]:
    """By how much the sensors lag behind the markers, once every sensor is where it should be.

    Parameters
    ----------
    gyr_rad_s : ndarray, shape (7, 3, n)
        Without missing samples, from the common begin of both.
    r_world_from_segment : ndarray, shape (m, 7, 3, 3)
        Optical orientations at the same rate.
    rate_hz : float
    rules : ClockRules
    labels : tuple of str
        Of the sensors, for messages.
    file : str
        Of the sensors, for messages.

    Returns
    -------
    delay_s : float
        0 unless larger than accepted.
    findings : list of Finding
        The delay, if it is.

    Raises
    ------
    RecordingError
        If a sensor does not move like any segment, the delay is too large, or sensors are exchanged.
    """
    n = min(gyr_rad_s.shape[2], len(r_world_from_segment))
    optical = np.linalg.norm(segment_rates(r_world_from_segment[:n], rate_hz), axis=1)
    own = butterworth_lowpass(
        gyr_rad_s[:, :, :n],
        cutoff_hz=rules.cutoff_hz,
        rate_hz=rate_hz,
        order=2,
        direction="zero_lag",
        pad_s=0.5,
    )
    match = match_signals(
        np.linalg.norm(own, axis=1), optical, rate_hz, longest_s=rules.longest_delay_s
    )
    _require_own_segments(match, rules, labels, file)
    if abs(match.delay_s) <= rules.accepted_delay_s:
        return 0.0, []
    finding = Finding(
        "clocks_out_of_step",
        "warning",
        file,
        "whole recording",
        f"sensors and markers within {1e3 * rules.accepted_delay_s:.1f} ms",
        f"sensors {abs(1e3 * match.delay_s):.1f} ms {'late' if match.delay_s > 0 else 'early'}; "
        "the markers are shifted by it",
    )
    return match.delay_s, [finding]


def _require_own_segments(
    match: Match, rules: ClockRules, labels: tuple[str, ...], file: str
) -> None:
    """Refuse another movement, a delay that cannot be told from another stride, exchanged sensors."""
    worst = int(np.argmin(match.correlation))
    if match.correlation[worst] < rules.least_correlation:
        raise RecordingError(
            "sensor and markers show different movements",
            file=file,
            place=labels[worst],
            expected=f"angular rates with a correlation of {rules.least_correlation:g} at least, "
            f"within a delay of {rules.longest_delay_s:g} s",
            found=f"{match.correlation[worst]:.2f}",
        )
    if abs(match.delay_s) > rules.longest_delay_s / 2.0:
        raise RecordingError(
            "sensors and markers are out of step by too much",
            file=file,
            expected=f"a delay of {rules.longest_delay_s / 2.0:g} s at most; "
            "a later stride looks alike",
            found=f"{abs(match.delay_s):.2f} s or more",
        )
    exchanged = [j for j, partner in enumerate(match.partner) if partner != j]
    if exchanged:
        raise RecordingError(
            "sensors are not on the segments that their labels say",
            file=file,
            place=", ".join(labels[j] for j in exchanged),
            expected="each moves like its own segment",
            found=", ".join(
                f"{labels[j]} moves like the {SEGMENTS[match.partner[j]].replace('_', ' ')}"
                for j in exchanged
            ),
        )


def shifted(position_m: Array, delay_s: float, rate_hz: float, n_samples: int) -> Array:
    """Markers at the samples of the sensors.

    Parameters
    ----------
    position_m : ndarray, shape (n_markers, 3, n_frames)
    delay_s : float
        By which the sensors are late.
    rate_hz : float
        Of both.
    n_samples : int
        Of the sensors.

    Returns
    -------
    ndarray, shape (n_markers, 3, n_samples)
        Linear between frames; NaN beside a missing one and outside the recording.

    Examples
    --------
    >>> shifted(np.arange(4.0)[None, None], 0.005, 100.0, 5)[0, 0].tolist()
    [nan, 0.5, 1.5, 2.5, nan]
    """
    at = np.arange(n_samples) - delay_s * rate_hz
    before = np.floor(at + 1e-9).astype(np.int64)
    share = np.maximum(at - before, 0.0)
    last = position_m.shape[2] - 1
    inside = (before >= 0) & (before <= last) & ((share < 1e-6) | (before < last))
    one = position_m[:, :, np.clip(before, 0, last)]
    two = position_m[:, :, np.clip(before + 1, 0, last)]
    # a missing frame that has no weight must not be felt
    mixed = np.where(share < 1e-6, one, one + share * (two - one))
    return np.where(inside, mixed, np.nan)
