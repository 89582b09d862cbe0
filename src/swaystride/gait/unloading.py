"""Toe-off of a runner as the end of unloading: from then on the pelvis falls freely."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.gait.segment_signals import lowpassed_parts
from swaystride.units import GRAVITY_M_S2

Array = NDArray[np.float64]

#: The push is over its top within this share of the stride after initial contact [N].
_TOP_SHARE: Final = 0.2


@dataclass(frozen=True)
class UnloadingRule:
    """Where the end of unloading is sought.

    Parameters
    ----------
    from_share, to_share : float
        Window after initial contact, in shares of the stride.
    cutoff_hz : float
        Low-pass of the acceleration (4th order, zero lag).
    high_g, low_g : float
        The straight line through these two levels of the falling acceleration is followed to zero,
        where nothing holds the pelvis any more.
    """

    from_share: float
    to_share: float
    cutoff_hz: float
    high_g: float
    low_g: float


#: [N] Levels above what swinging legs do to the pelvis in flight. Chosen on nine simulated runners
#: (within 3 ms, but their flight is free fall by construction) and six real feet of
#: `running_markers_grf`, where toe-off is 7 to 25 ms early.
UNLOADED: Final = UnloadingRule(0.1, 0.55, 30.0, 0.5, 0.3)


def unloading_ends(
    pelvis_acc_m_s2: ArrayLike, contacts: ArrayLike, rate_hz: float, rule: UnloadingRule
) -> Array:
    """End of the unloading after each contact of one foot.

    The force on the ground falls almost linearly at the end of a contact, and with it the
    acceleration of the pelvis along the vertical, which is taken to be its mean direction.

    Parameters
    ----------
    pelvis_acc_m_s2 : array_like, shape (3, n_samples)
        Proper acceleration of the pelvis, in any axes, without missing samples.
    contacts : array_like of int, shape (n_strides + 1,)
        Samples of initial contact of one foot, rising and within the recording.
    rate_hz : float
        Sampling rate.
    rule : UnloadingRule

    Returns
    -------
    ndarray, shape (n_strides,)
        Samples from the begin of the recording, between samples by interpolation. NaN where the
        acceleration does not fall below both levels in the window.

    Examples
    --------
    A push of half a sine over 0.2 s, then flight, twice in each stride:

    >>> time = np.arange(1400) / 500.0 % 0.35
    >>> push = np.where(time < 0.2, 2.7 * 9.80665 * np.sin(np.pi * time / 0.2), 0.0)
    >>> acc = np.stack([0 * push, push, 0 * push])
    >>> found = unloading_ends(acc, [0, 350, 700, 1050], 500.0, UNLOADED)
    >>> bool(np.all(abs(found / 500.0 - [0.2, 0.9, 1.6]) < 0.004))
    True
    """
    at = np.asarray(contacts, dtype=np.int64)
    if at.size < 2:
        return np.empty(0)
    acc = np.asarray(pelvis_acc_m_s2, dtype=np.float64)
    up = acc.mean(axis=1)
    vertical = lowpassed_parts(up @ acc / np.linalg.norm(up), rule.cutoff_hz, rate_hz)
    stride = np.diff(at)
    first = at[:-1] + np.ceil(rule.from_share * stride).astype(np.int64)
    last = at[:-1] + np.floor(rule.to_share * stride).astype(np.int64)
    samples = first[:, None] + np.arange(int((last - first).max()) + 1)
    inside = samples <= last[:, None]
    size = np.where(inside, vertical[np.minimum(samples, vertical.size - 1)], np.inf)
    size = size / GRAVITY_M_S2
    near = samples <= (at[:-1] + np.ceil(_TOP_SHARE * stride))[:, None]
    top = np.argmax(np.where(near & inside, size, -np.inf), axis=1)
    high, low = (_fallen_below(size, top, level) for level in (rule.high_g, rule.low_g))
    return np.asarray(first + low + (low - high) * rule.low_g / (rule.high_g - rule.low_g))


def _fallen_below(size: Array, top: NDArray[np.int64], level: float) -> Array:
    """Where each row falls below a level after its top, to a fraction of a sample; NaN if never."""
    columns, rows = np.arange(size.shape[1]), np.arange(len(size))
    below = (size < level) & (columns > top[:, None])
    at = np.argmax(below, axis=1)
    there = below[rows, at]
    at = np.maximum(at, 1)
    before, after = size[rows, at - 1], size[rows, at]
    with np.errstate(invalid="ignore", divide="ignore"):
        part = (level - before) / (after - before)
    return np.where(there, at - 1 + part, np.nan)
