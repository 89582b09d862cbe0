"""What happens in windows around events: largest values, and mean squares over strides."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError

Array = NDArray[np.float64]


def window_maxima(
    signal: ArrayLike, start_s: ArrayLike, stop_s: ArrayLike, rate_hz: float
) -> Array:
    """Largest value of a signal in each of many windows.

    Parameters
    ----------
    signal : array_like, shape (n_samples,)
        Missing samples are NaN.
    start_s, stop_s : array_like, shape (n_windows,)
        Both ends included, in s from the first sample; rounded to samples.
    rate_hz : float
        Sampling rate.

    Returns
    -------
    ndarray, shape (n_windows,)
        NaN where an end is missing or outside the recording, the window is empty, or a sample in it
        is missing.

    Examples
    --------
    >>> window_maxima([0.0, 3.0, 1.0, 5.0, np.nan], [0.0, 2.0, 3.0], [2.0, 3.0, 4.0], 1.0).tolist()
    [3.0, 5.0, nan]
    """
    values = np.asarray(signal, dtype=np.float64)
    start, stop = (np.asarray(edge, dtype=np.float64) * rate_hz for edge in (start_s, stop_s))
    out = np.full(start.shape, np.nan)
    with np.errstate(invalid="ignore"):
        good = (np.rint(start) >= 0) & (np.rint(stop) < values.size) & (stop >= start)
    if not good.any():
        return out
    first, last = (np.rint(edge[good]).astype(np.int64) for edge in (start, stop))
    samples = first[:, None] + np.arange(int((last - first).max()) + 1)
    inside = samples <= last[:, None]
    gathered = np.where(inside, values[np.minimum(samples, values.size - 1)], -np.inf)
    out[good] = gathered.max(axis=1)
    return out


def stride_rms(
    signals: ArrayLike,
    start_s: ArrayLike,
    stop_s: ArrayLike,
    rate_hz: float,
    *,
    remove_mean: bool,
) -> Array:
    """Root mean square of signals over each stride.

    Parameters
    ----------
    signals : array_like, shape (n_channels, n_samples)
        Missing samples are NaN.
    start_s, stop_s : array_like, shape (n_strides,)
        In s from the first sample; the sample at the stop belongs to the next stride.
    rate_hz : float
        Sampling rate.
    remove_mean : bool
        Whether the mean of each channel over the stride is subtracted first.

    Returns
    -------
    ndarray, shape (n_channels, n_strides)
        NaN where a sample of the stride is missing.

    Raises
    ------
    RecordingError
        If a stride is empty or lies outside the recording.

    Examples
    --------
    >>> stride_rms([[3.0, -3.0, 1.0, 1.0]], [0.0, 2.0], [2.0, 4.0], 1.0, remove_mean=False).tolist()
    [[3.0, 1.0]]
    >>> stride_rms([[3.0, -3.0, 1.0, 1.0]], [0.0, 2.0], [2.0, 4.0], 1.0, remove_mean=True).tolist()
    [[3.0, 0.0]]
    """
    values = np.asarray(signals, dtype=np.float64)
    first, last = (
        np.rint(np.asarray(edge, dtype=np.float64) * rate_hz).astype(np.int64)
        for edge in (start_s, stop_s)
    )
    if first.size == 0:
        return np.empty((values.shape[0], 0))
    if first.min() < 0 or last.max() > values.shape[1] or np.any(last <= first):
        raise RecordingError(
            "a stride lies outside the recording",
            expected=f"samples from 0 to {values.shape[1]}",
            found=f"{first.min()} to {last.max()}",
        )
    length = last - first
    mean = _sums(values, first, last) / length
    if not remove_mean:
        return np.asarray(np.sqrt(_sums(values**2, first, last) / length))
    # about the mean of the recording first, so that two large numbers are not subtracted
    known = np.isfinite(values)
    count = np.maximum(known.sum(axis=1, keepdims=True), 1)
    centre = np.where(known, values, 0.0).sum(axis=1, keepdims=True) / count
    square = _sums((values - centre) ** 2, first, last) / length
    return np.asarray(np.sqrt(np.maximum(square - (mean - centre) ** 2, 0.0)))


def _sums(values: Array, first: NDArray[np.int64], last: NDArray[np.int64]) -> Array:
    """Sums over [first, last) of each channel."""
    edges = np.stack([first, last], axis=1).ravel()
    # reduceat cannot begin a slice at the end of the signal
    padded = np.pad(values, ((0, 0), (0, 1)))
    return np.asarray(np.add.reduceat(padded, edges, axis=1)[:, ::2])
