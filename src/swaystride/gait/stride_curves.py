"""Curves over the stride: resampled to phases, with their mean and scatter."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError

Array = NDArray[np.float64]

#: Every percent of the stride, both ends included (dissertation, §4.3.4.3).
N_PHASES: Final = 101


def stride_curves(
    signals: ArrayLike, start: ArrayLike, stop: ArrayLike, n_phases: int = N_PHASES
) -> Array:
    """Cut signals into strides of equal length.

    Parameters
    ----------
    signals : array_like, shape (..., n_samples)
        Missing samples are NaN and make the phases beside them NaN.
    start, stop : array_like, shape (n_strides,)
        First and last sample of each stride; between samples is interpolated linearly.
    n_phases : int
        Points of a stride; the last is the begin of the next stride.

    Returns
    -------
    ndarray, shape (..., n_strides, n_phases)

    Raises
    ------
    RecordingError
        If a stride lies outside the recording.

    Examples
    --------
    >>> stride_curves(np.arange(20.0), [0, 10], [10, 14], n_phases=3).tolist()
    [[0.0, 5.0, 10.0], [10.0, 12.0, 14.0]]
    """
    values = np.asarray(signals, dtype=np.float64)
    begin, end = (np.asarray(edge, dtype=np.float64) for edge in (start, stop))
    n = values.shape[-1]
    if begin.size and not (begin.min() >= 0.0 and end.max() <= n - 1 and np.all(end > begin)):
        raise RecordingError(
            "a stride lies outside the recording",
            expected=f"samples from 0 to {n - 1}",
            found=f"{begin.min():g} to {end.max():g}",
        )
    at = begin[:, None] + (end - begin)[:, None] * np.linspace(0.0, 1.0, n_phases)
    at = np.round(at, 9)  # rounding errors must not ask for a neighbour, which may be missing
    before = np.minimum(at.astype(np.int64), n - 1)
    after = np.minimum(before + 1, n - 1)
    share = at - before
    left = values[..., before]
    right = np.where(share > 0.0, values[..., after], left)
    return np.asarray(left + share * (right - left))


def ensemble(curves: ArrayLike) -> tuple[Array, Array]:
    """Mean and standard deviation over strides.

    Parameters
    ----------
    curves : array_like, shape (..., n_strides, n_phases)
        Missing phases are NaN and do not count.

    Returns
    -------
    mean, sd : ndarray, shape (..., n_phases)
        The SD is divided by n − 1; NaN where there are too few strides.

    Examples
    --------
    >>> mean, sd = ensemble([[1.0, 2.0], [3.0, np.nan]])
    >>> mean.tolist(), sd.round(3).tolist()
    ([2.0, 2.0], [1.414, nan])
    """
    values = np.asarray(curves, dtype=np.float64)
    known = np.isfinite(values)
    n = known.sum(axis=-2)
    some = np.where(n > 0, n, np.nan)
    mean = np.where(known, values, 0.0).sum(axis=-2) / some
    squared = np.where(known, values - mean[..., None, :], 0.0) ** 2
    sd = np.sqrt(squared.sum(axis=-2) / np.where(n > 1, n - 1, np.nan))
    return mean, sd
