"""Toe-off of a running foot from its angular rate (methods §3.2, item 4)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError
from swaystride.signals.filters import lowpass_without_lag

Array = NDArray[np.float64]
ToeOffSignal = Literal["pitch_minimum", "resultant_minimum"]


@dataclass(frozen=True)
class ToeOffRule:
    """Where toe-off is sought.

    Parameters
    ----------
    signal : {"pitch_minimum", "resultant_minimum"}
        ``pitch_minimum``: the foot turns fastest towards the toes. ``resultant_minimum``: the print
        taken literally (dissertation, §5.3.4.1), which is mid-stance (register I-27).
    from_share, to_share : float
        Window after initial contact, in shares of the stride.
    cutoff_hz : float
        Low-pass of the rate (4th order, zero lag).
    """

    signal: ToeOffSignal
    from_share: float
    to_share: float
    cutoff_hz: float


#: Methods §3.2; cut-off of the angular rate from the dissertation, §5.3.4.1.
PITCH_MINIMUM: Final = ToeOffRule("pitch_minimum", 0.2, 0.45, 50.0)
#: The literal rule, in the window in which it falls on mid-stance; 0.05 keeps off the impact [N].
RESULTANT_MINIMUM: Final = ToeOffRule("resultant_minimum", 0.05, 0.5, 50.0)


def toe_offs(
    pitch_rate_rad_s: ArrayLike,
    gyr_rad_s: ArrayLike,
    contacts: ArrayLike,
    rate_hz: float,
    rule: ToeOffRule,
) -> Array:
    """Toe-off of every stride.

    Parameters
    ----------
    pitch_rate_rad_s : array_like, shape (n_samples,)
        Angular rate of the foot about the medio-lateral axis, toes up positive; read for
        ``pitch_minimum``.
    gyr_rad_s : array_like, shape (n_samples,)
        Size of the angular rate; read for ``resultant_minimum``.
    contacts : array_like of int, shape (n_strides + 1,)
        Samples of initial contact, rising.
    rate_hz : float
        Sampling rate.
    rule : ToeOffRule

    Returns
    -------
    ndarray, shape (n_strides,)
        Samples from the begin of the recording, between samples by a parabola. NaN where the window
        holds no local minimum.

    Raises
    ------
    RecordingError
        If contacts do not rise or lie outside the recording.

    Examples
    --------
    >>> phase = (np.arange(600) / 200.0 % 0.7) / 0.7
    >>> pitch = -8.0 * np.exp(-(((phase - 0.3) / 0.1) ** 2))
    >>> toe_offs(pitch, abs(pitch), [0, 140, 280], 200.0, PITCH_MINIMUM).round(1).tolist()
    [42.0, 182.0]
    """
    chosen = pitch_rate_rad_s if rule.signal == "pitch_minimum" else gyr_rad_s
    rate = lowpass_without_lag(chosen, rule.cutoff_hz, rate_hz)
    at = np.asarray(contacts, dtype=np.int64)
    if at.size and (np.any(np.diff(at) <= 0) or at[0] < 0 or at[-1] >= rate.size):
        raise RecordingError(
            "contacts do not fit the recording",
            expected=f"rising samples from 0 to {rate.size - 1}",
            found=f"{at.min()} to {at.max()}" if np.all(np.diff(at) > 0) else "a fall",
        )
    if at.size < 2:
        return np.empty(0)
    stride = np.diff(at)
    first = at[:-1] + np.ceil(rule.from_share * stride).astype(np.int64)
    last = at[:-1] + np.floor(rule.to_share * stride).astype(np.int64)
    return _deepest_minima(rate, first, last)


def _deepest_minima(
    signal: Array, first: NDArray[np.int64], last: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Lowest local minimum of each window, to a fraction of a sample; NaN where there is none."""
    minimum = np.zeros(signal.size, dtype=np.bool_)
    minimum[1:-1] = (signal[1:-1] < signal[:-2]) & (signal[1:-1] <= signal[2:])
    widest = int((last - first).max()) + 1
    samples = first[:, None] + np.arange(max(widest, 1))
    inside = samples <= last[:, None]
    samples = np.minimum(samples, signal.size - 1)
    depth = np.where(inside & minimum[samples], signal[samples], np.inf)
    chosen = np.argmin(depth, axis=1)
    rows = np.arange(len(first))
    there = np.isfinite(depth[rows, chosen])
    k = np.clip(samples[rows, chosen], 1, signal.size - 2)
    before, here, after = signal[k - 1], signal[k], signal[k + 1]
    curvature = before - 2.0 * here + after
    shift = 0.5 * (before - after) / np.where(curvature > 0.0, curvature, np.inf)
    return np.where(there, k + shift, np.nan)
