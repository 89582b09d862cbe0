"""Toe-off of a running foot as the end of push-off: its rate of turning no longer grows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.signals.filters import lowpass_without_lag

Array = NDArray[np.float64]

#: A fall is steep from this share of the steepest one on [N].
_STEEP_SHARE: Final = 0.5


@dataclass(frozen=True)
class PushOffRule:
    """Where the end of push-off is sought.

    Parameters
    ----------
    from_share, to_share : float
        Window after initial contact, in shares of the stride.
    cutoff_hz : float
        Low-pass of the rate (4th order, zero lag).
    flat_share : float
        The fall of the rate has ended where it is slower than this share of its steepest.
    """

    from_share: float
    to_share: float
    cutoff_hz: float
    flat_share: float


#: [N] 20 Hz and 0.15 were chosen on 18 simulated runners and six real feet (`running_markers_grf`,
#: pitch of the line from heel to toe): in sample for both.
PUSH_OFF_END: Final = PushOffRule(0.12, 0.45, 20.0, 0.15)


def push_off_ends(
    pitch_rate_rad_s: ArrayLike, contacts: ArrayLike, rate_hz: float, rule: PushOffRule
) -> Array:
    """End of the push-off of every stride.

    The heel rises ever faster until the foot leaves the ground. Some feet turn faster still in early
    swing, so that the smallest pitch rate comes up to 70 ms later; the end of the first steep fall
    does not move with it.

    Parameters
    ----------
    pitch_rate_rad_s : array_like, shape (n_samples,)
        Angular rate of the foot about the medio-lateral axis, toes up positive.
    contacts : array_like of int, shape (n_strides + 1,)
        Samples of initial contact, rising and within the recording.
    rate_hz : float
        Sampling rate.
    rule : PushOffRule

    Returns
    -------
    ndarray, shape (n_strides,)
        Samples from the begin of the recording, between samples by interpolation. NaN where the
        rate does not fall, or its fall does not end in the window.

    Examples
    --------
    >>> time = np.arange(600) / 500.0
    >>> rate = np.interp(time, [0.0, 0.10, 0.25, 0.6], [0.0, 0.0, -8.0, -8.5])
    >>> found = push_off_ends(rate, [0, 350], 500.0, PUSH_OFF_END) / 500.0
    >>> bool(abs(found[0] - 0.25) < 0.012)
    True
    """
    rate = lowpass_without_lag(pitch_rate_rad_s, rule.cutoff_hz, rate_hz)
    at = np.asarray(contacts, dtype=np.int64)
    if at.size < 2:
        return np.empty(0)
    stride = np.diff(at)
    first = at[:-1] + np.ceil(rule.from_share * stride).astype(np.int64)
    last = at[:-1] + np.floor(rule.to_share * stride).astype(np.int64)
    return _ends_of_fall(rate, first, last, rule.flat_share)


def _ends_of_fall(
    signal: Array, first: NDArray[np.int64], last: NDArray[np.int64], share: float
) -> Array:
    """Where the first steep fall in each window slackens, to a fraction of a sample."""
    slope = np.gradient(signal)
    samples = first[:, None] + np.arange(int((last - first).max(initial=0)) + 1)
    inside = samples <= last[:, None]
    falls = np.where(inside, slope[np.minimum(samples, signal.size - 1)], np.inf)
    rows = np.arange(len(first))
    steepest = falls.min(axis=1)
    # a second fall, in early swing, may be the steepest
    begin = np.argmax(falls <= _STEEP_SHARE * steepest[:, None], axis=1)
    limit = share * steepest
    slack = inside & (falls >= limit[:, None]) & (np.arange(falls.shape[1]) > begin[:, None])
    after = np.argmax(slack, axis=1)
    there = slack[rows, after] & (limit < 0.0)
    before = np.maximum(after - 1, 0)
    step = falls[rows, after] - falls[rows, before]
    with np.errstate(invalid="ignore", divide="ignore"):
        part = (limit - falls[rows, before]) / step
    return np.where(there, first + before + part, np.nan)
