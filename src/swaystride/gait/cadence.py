"""How long a stride lasts, locally: the period of a foot's movement, by autocorrelation."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import fft

Array = NDArray[np.float64]

#: Strides of people last between a sprint's and a very slow walk's.
SHORTEST_STRIDE_S: Final = 0.4
LONGEST_STRIDE_S: Final = 2.0
#: Rate at which the movement is looked at, and the window: two long strides, four of a run.
_RATE_HZ: Final = 50.0
_WINDOW_S: Final = 4.0
#: Stances and rests alike count as this still, so that a rest does not drown the rhythm beside it.
_FLOOR_RAD_S: Final = 1.0
#: Peaks this near to the highest one count as equally high.
_SHARE_OF_HIGHEST: Final = 0.8
#: A weaker correlation than this is no rhythm.
_LEAST_CORRELATION: Final = 0.3


def local_stride_s(movement: ArrayLike, rate_hz: float) -> tuple[Array, Array]:
    """Stride time in windows of 4 s, every second.

    From the autocorrelation of the logarithm of the movement: the first peak between 0.4 and 2 s that
    comes near to the highest one.

    Parameters
    ----------
    movement : array_like, shape (n_samples,)
        In rad/s, from :func:`swaystride.gait.stillness.stillness_rad_s`.
    rate_hz : float
        Sampling rate, at least 50 Hz.

    Returns
    -------
    centre_s : ndarray, shape (n_windows,)
        Middle of each window.
    stride_s : ndarray, shape (n_windows,)
        NaN where there is no rhythm. Empty for recordings shorter than a window.

    Examples
    --------
    >>> time = np.arange(2000) / 100.0
    >>> _, stride_s = local_stride_s(1.5 + np.cos(2 * np.pi * time / 0.7), 100.0)
    >>> bool(np.allclose(stride_s, 0.7, atol=0.02))
    True
    """
    values = np.log(np.maximum(np.asarray(movement, dtype=np.float64), _FLOOR_RAD_S))
    block = max(1, int(rate_hz // _RATE_HZ))
    slow_hz = rate_hz / block
    slow = values[: len(values) // block * block].reshape(-1, block).mean(axis=1)
    length, hop = round(_WINDOW_S * slow_hz), round(slow_hz)
    if len(slow) < length:
        return np.empty(0), np.empty(0)
    windows = np.lib.stride_tricks.sliding_window_view(slow, length)[::hop]
    centred = windows - windows.mean(axis=1, keepdims=True)
    power = np.abs(fft.rfft(centred, 2 * length, axis=1)) ** 2
    first, last = round(SHORTEST_STRIDE_S * slow_hz), round(LONGEST_STRIDE_S * slow_hz)
    correlation = fft.irfft(power, axis=1)[:, : last + 1]
    # pairs become fewer with the lag
    correlation *= length / (length - np.arange(correlation.shape[1]))
    correlation /= np.maximum(correlation[:, :1], 1e-12)
    inner = correlation[:, first:last]
    is_peak = (inner >= correlation[:, first - 1 : last - 1]) & (
        inner >= correlation[:, first + 1 : last + 1]
    )
    height = np.where(is_peak & (inner > _LEAST_CORRELATION), inner, -np.inf)
    # Two strides correlate as well as one: the first of the highest peaks.
    highest = height.max(axis=1, keepdims=True)
    best = np.argmax(height >= _SHARE_OF_HIGHEST * highest, axis=1)
    found = np.isfinite(highest[:, 0])
    centre_s = np.asarray(
        (np.arange(len(windows)) * hop + 0.5 * length) / slow_hz, dtype=np.float64
    )
    return centre_s, np.asarray(np.where(found, (first + best) / slow_hz, np.nan), dtype=np.float64)
