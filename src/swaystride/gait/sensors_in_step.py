"""Whether the sensors of a runner run on one clock: pairs that repeat each other are laid side by side.

Both legs do the same half a stride apart, and so do both arms; pelvis, sternum and head rise and fall
together. A sensor whose clock is late breaks this symmetry. Which of a pair is late cannot be told.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from swaystride.gait.segment_signals import SegmentSignals, lowpassed_parts

Array = NDArray[np.float64]

#: Pairs that do the same half a stride apart.
_MIRRORED: Final = ("foot", "shank", "thigh", "upper_arm", "wrist")
#: Pairs that do the same at the same time.
_TOGETHER: Final = (("lumbar", "sternum"), ("lumbar", "head"))


@dataclass(frozen=True)
class StepRule:
    """When sensors count as out of step.

    Parameters
    ----------
    cutoff_hz : float
        Low-pass of the signals that are laid side by side.
    span_s : float
        Length of each part of the run that is looked at.
    n_spans : int
        How many parts, evenly spread over the run; a clock may drift.
    accepted_lag_s : float
        Largest lag of a pair.
    lowest_stride_hz, highest_stride_hz : float
        Band in which the stride frequency is sought.
    """

    cutoff_hz: float
    span_s: float
    n_spans: int
    accepted_lag_s: float
    lowest_stride_hz: float
    highest_stride_hz: float


def pair_lags_s(
    signals: Mapping[str, SegmentSignals], rate_hz: float, rule: StepRule
) -> dict[tuple[str, str], float]:
    """By how much the second sensor of each pair is later than the symmetry of running asks.

    Parameters
    ----------
    signals : mapping of str to SegmentSignals
        Running, by sensor, in any axes: only sizes are read.
    rate_hz : float
        Sampling rate.
    rule : StepRule

    Returns
    -------
    dict of tuple of str to float
        The largest lag of each pair over the parts of the run, in s; pairs of which a sensor is
        missing, or that hold no complete part, are not in it. Lags are known up to half a stride
        (half a step for sensors of the trunk).
    """
    pairs = [(f"{part}_right", f"{part}_left") for part in _MIRRORED] + list(_TOGETHER)
    found = {}
    for first, second in pairs:
        if first not in signals or second not in signals:
            continue
        mirrored = (first, second) not in _TOGETHER
        lags = []
        for begin, end in _spans(signals[first].acc_m_s2.shape[1], rate_hz, rule):
            both = [_size(signals[name], begin, end, mirrored=mirrored) for name in (first, second)]
            if np.isfinite(both).all():
                lags.append(_lag_s(np.stack(both), rate_hz, rule, mirrored=mirrored))
        if lags:
            found[first, second] = max(lags, key=abs)
    return found


def _spans(n_samples: int, rate_hz: float, rule: StepRule) -> list[tuple[int, int]]:
    """First sample of each part and the one after its last."""
    length = min(round(rule.span_s * rate_hz), n_samples)
    starts = np.linspace(0, n_samples - length, rule.n_spans + 2)[1:-1]
    return [(int(start), int(start) + length) for start in starts]


def _size(signals: SegmentSignals, begin: int, end: int, *, mirrored: bool) -> Array:
    """Size of the turning rate of a limb, or of the acceleration of the trunk."""
    source = signals.gyr_rad_s if mirrored else signals.acc_m_s2
    return np.asarray(np.linalg.norm(source[:, begin:end], axis=0), dtype=np.float64)


def _lag_s(both: Array, rate_hz: float, rule: StepRule, *, mirrored: bool) -> float:
    """Lag of the second signal, from the peak of the cross-correlation next to the expected one."""
    smooth = lowpassed_parts(both, rule.cutoff_hz, rate_hz)
    smooth = smooth - smooth.mean(axis=1, keepdims=True)
    n = fft.next_fast_len(2 * smooth.shape[1], real=True)
    spectra = fft.rfft(smooth, n, axis=1)
    correlation = fft.irfft(np.conj(spectra[0]) * spectra[1], n)
    stride = _period(fft.irfft(np.abs(spectra[0]) ** 2, n), rate_hz, rule)
    expected = stride / 2.0 if mirrored else 0.0
    # the trunk repeats itself with every step
    reach = stride / 2.0 if mirrored else stride / 4.0
    shifts = np.arange(int(np.ceil(expected - reach)), int(expected + reach) + 1)
    best = int(shifts[np.argmax(correlation[shifts % n])])
    return float((best - expected) / rate_hz)


def _period(autocorrelation: Array, rate_hz: float, rule: StepRule) -> float:
    """Stride in samples: the highest peak of the autocorrelation in the band of strides."""
    shortest = int(rate_hz / rule.highest_stride_hz)
    longest = int(rate_hz / rule.lowest_stride_hz)
    return float(shortest + np.argmax(autocorrelation[shortest : longest + 1]))
