"""Flattened runs of a signal: where a sensor reached its range, found without knowing it."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

#: A run counts as flattened if it lies above this share of the largest value of its channel …
_LEAST_SHARE: Final = 0.85
#: … and changes from sample to sample by less than this share of it …
_LARGEST_STEP_SHARE: Final = 0.01
#: … for at least so many steps: a smooth peak sampled at its top has fewer equal neighbours.
_FEWEST_STEPS: Final = 3


def plateau_variance(
    signal: ArrayLike, *, least_level: float, excess_share: float
) -> NDArray[np.float64]:
    """Variance of what a saturated sensor has not seen, for every step between two samples.

    A run of L flattened steps is taken to have lost an excess of standard deviation
    ``excess_share · level`` that is the same for the whole run, so that its integral over the run
    has the standard deviation ``excess_share · level · L``. Spread evenly, each step has the
    variance ``L · (excess_share · level)²``. Channels add up.

    Parameters
    ----------
    signal : array_like, shape (n_channels, n_samples)
        Without missing samples.
    least_level : float
        No sensor in question has a smaller range: flat signals below are stillness.
    excess_share : float
        See above.

    Returns
    -------
    ndarray, shape (n_samples - 1,)
        In squared units of the signal; nil outside flattened runs.

    Examples
    --------
    >>> peak = 10.0 * np.sin(np.linspace(0.0, np.pi, 60))[None, :]
    >>> clipped = np.minimum(peak, 6.0)
    >>> bool(plateau_variance(peak, least_level=4.0, excess_share=0.1).max() > 0.0)
    True
    >>> variance = plateau_variance(clipped, least_level=4.0, excess_share=0.1)
    >>> int((variance > 0).sum()), float(variance.max().round(9))
    (35, 12.6)
    """
    values = np.asarray(signal, dtype=np.float64)
    variance = np.zeros(max(values.shape[-1] - 1, 0))
    for channel in values:
        for level, side in ((channel.max(initial=0.0), channel), (-channel.min(initial=0.0), None)):
            if level >= least_level:
                for first, stop in _flat_steps(-channel if side is None else side, float(level)):
                    variance[first:stop] += (stop - first) * (excess_share * level) ** 2
    return variance


def flattened_share(signal: ArrayLike, *, least_level: float) -> float:
    """Share of the steps of a signal that lie in a flattened run of any channel.

    Parameters
    ----------
    signal : array_like, shape (n_channels, n_samples)
    least_level : float
        As in :func:`plateau_variance`.
    """
    variance = plateau_variance(signal, least_level=least_level, excess_share=1.0)
    return float(np.count_nonzero(variance) / max(variance.size, 1))


def _flat_steps(values: Array, level: float) -> NDArray[np.int64]:
    """First step and the one after the last of every flattened run near the largest value."""
    high = np.flatnonzero(values > _LEAST_SHARE * level)
    neighbours = np.diff(high) == 1
    flat = np.abs(np.diff(values[high])) < _LARGEST_STEP_SHARE * level
    steps = high[:-1][neighbours & flat]
    if steps.size == 0:
        return np.empty((0, 2), dtype=np.int64)
    breaks = np.flatnonzero(np.diff(steps) > 1)
    first = steps[np.r_[0, breaks + 1]]
    stop = steps[np.r_[breaks, steps.size - 1]] + 1
    runs = np.stack([first, stop], axis=1)
    return np.asarray(runs[stop - first >= _FEWEST_STEPS], dtype=np.int64)
