"""Flattened runs of a signal: where a sensor reached its range, found without knowing it."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Index = NDArray[np.int64]

#: A run counts as flattened if it lies above this share of the largest value of its channel …
_LEAST_SHARE: Final = 0.85
#: … and changes from sample to sample by less than this share of it …
_LARGEST_STEP_SHARE: Final = 0.01
#: … for at least so many steps: a smooth peak sampled at its top has fewer equal neighbours.
_FEWEST_STEPS: Final = 3
#: … and if the flanks are steeper than the run by more than this factor: at the top of a smooth peak
#: the steps grow in proportion to the distance, and the flanks are twice as steep as their mean.
_EDGE_RATIO: Final = 5.0
#: Half of the estimated excess is its standard deviation.
_EXCESS_UNCERTAINTY: Final = 0.5


def restore_plateaus(signal: ArrayLike, *, least_level: float) -> tuple[Array, Array]:
    """Put back what a saturated sensor has most likely cut off, and say how uncertain that is.

    A run of T flattened steps between two flanks of mean slope s (per step) is taken to hide a
    parabola: ``s t (1 − t/T)`` above the plateau. Its mean s·T/6 is uncertain by half of itself, and
    this error is the same for the whole run: its integral has the standard deviation T times that.
    Spread evenly, each step has the variance T times its square. Channels add up. A smooth peak
    that only looks flat has no edges and is left as it is.

    Parameters
    ----------
    signal : array_like, shape (n_channels, n_samples)
        Without missing samples.
    least_level : float
        No sensor in question has a smaller range: flat signals below are stillness.

    Returns
    -------
    restored : ndarray, shape (n_channels, n_samples)
        The signal itself, not a copy, if nothing is flattened.
    variance : ndarray, shape (n_samples - 1,)
        Of every step, in squared units of the signal; nil outside flattened runs.

    Examples
    --------
    >>> hidden = 10.0 * np.sin(np.linspace(0.0, np.pi, 200))[None, :]
    >>> restored, variance = restore_plateaus(np.minimum(hidden, 7.0), least_level=4.0)
    >>> lost = hidden.sum() - np.minimum(hidden, 7.0).sum()
    >>> bool(abs(hidden.sum() - restored.sum()) < 0.25 * lost)
    True
    """
    values = np.asarray(signal, dtype=np.float64)
    restored = values
    variance = np.zeros(max(values.shape[-1] - 1, 0))
    for number, sign, runs in _flat_runs(values, least_level):
        if restored is values:
            restored = values.copy()
        flank = sign * values[number]
        slopes = 0.5 * (_rises(flank, runs[:, 0], -1) + _rises(flank, runs[:, 1], 1))
        for (first, stop), slope in zip(runs.tolist(), slopes.tolist(), strict=True):
            steps = stop - first
            t = np.arange(steps + 1)
            restored[number, first : stop + 1] += sign * slope * t * (1.0 - t / steps)
            spread = _EXCESS_UNCERTAINTY * slope * steps / 6.0
            variance[first:stop] += steps * spread**2
    return restored, variance


def flattened_share(signal: ArrayLike, *, least_level: float) -> float:
    """Share of the steps of a signal that lie in a flattened run of any channel.

    Parameters
    ----------
    signal : array_like, shape (n_channels, n_samples)
    least_level : float
        As in :func:`restore_plateaus`.
    """
    values = np.asarray(signal, dtype=np.float64)
    flat = np.zeros(max(values.shape[-1] - 1, 0), dtype=np.bool_)
    for _, _, runs in _flat_runs(values, least_level):
        for first, stop in runs.tolist():
            flat[first:stop] = True
    return float(np.count_nonzero(flat) / max(flat.size, 1))


def _rises(flank: Array, edges: Index, step: int) -> Array:
    """Rise towards each plateau over the last step before it (`step` −1) or after it (1), if any.

    The step next to the plateau is cut by it; the one before is not.
    """
    near, far = edges + step, edges + 2 * step
    inside = (far >= 0) & (far < len(flank))
    rise = flank[np.where(inside, near, 0)] - flank[np.where(inside, far, 0)]
    return np.asarray(np.maximum(rise, 0.0))


def _flat_runs(values: Array, least_level: float) -> list[tuple[int, float, Index]]:
    """Channel, sign and runs (first and last sample) wherever something is flattened."""
    found = []
    for number, channel in enumerate(values):
        for sign, level in ((1.0, channel.max(initial=0.0)), (-1.0, -channel.min(initial=0.0))):
            if level >= least_level:
                runs = _flat_steps(channel if sign > 0 else -channel, float(level))
                if len(runs):
                    found.append((number, sign, runs))
    return found


def _flat_steps(values: Array, level: float) -> Index:
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
    long = stop - first >= _FEWEST_STEPS
    runs = np.stack([first[long], stop[long]], axis=1).astype(np.int64)
    return runs[_have_edges(values, runs)] if len(runs) else runs


def _have_edges(values: Array, runs: Index) -> NDArray[np.bool_]:
    """Flag runs that begin or end abruptly, as no smooth peak does."""
    first, stop = runs.T
    travelled = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(values)))])
    inside = (travelled[stop] - travelled[first]) / (stop - first)
    steepest = np.maximum(_rises(values, first, -1), _rises(values, stop, 1))
    return np.asarray(steepest > _EDGE_RATIO * inside)
