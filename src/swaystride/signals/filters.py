"""Low-pass filters with every choice spelled out."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.signal import butter, sosfilt, sosfilt_zi, sosfiltfilt

from swaystride.errors import RecordingError

Direction = Literal["zero_lag", "causal"]


def butterworth_lowpass(
    signal: ArrayLike,
    *,
    cutoff_hz: float,
    rate_hz: float,
    order: int,
    direction: Direction,
    pad_s: float,
) -> NDArray[np.float64]:
    """Low-pass filter along the last axis.

    Parameters
    ----------
    signal : array_like, shape (..., n_samples)
        Without missing samples.
    cutoff_hz : float
        Cut-off of one pass (−3 dB); ``zero_lag`` filters twice, so that its net attenuation there
        is 6 dB and its net order is twice `order`.
    rate_hz : float
        Sampling rate of `signal`.
    order : int
        Order of one pass.
    direction : {"zero_lag", "causal"}
        Forward and backward, or forward only (started in the steady state of the first sample).
    pad_s : float
        Length of the odd extension at both ends for ``zero_lag``; cut to ``n_samples − 1``.

    Returns
    -------
    ndarray, shape (..., n_samples)

    Raises
    ------
    RecordingError
        If the cut-off does not lie below half the sampling rate, or samples are missing.

    Examples
    --------
    A constant passes unchanged:

    >>> butterworth_lowpass(np.ones(50), cutoff_hz=2.0, rate_hz=100.0, order=2,
    ...                     direction="zero_lag", pad_s=3.0).round(12).min()
    np.float64(1.0)
    """
    values = np.asarray(signal, dtype=np.float64)
    if not 0 < cutoff_hz < rate_hz / 2:
        raise RecordingError(
            "the cut-off frequency does not fit the sampling rate",
            expected=f"0 < cutoff_hz < {rate_hz / 2:g}",
            found=f"{cutoff_hz:g}",
        )
    if not np.all(np.isfinite(values)):
        raise RecordingError(
            "cannot filter across missing samples", expected="finite values", found="NaN"
        )
    sections = butter(order, cutoff_hz, fs=rate_hz, output="sos")
    if direction == "zero_lag":
        padding = min(round(pad_s * rate_hz), values.shape[-1] - 1)
        return np.asarray(sosfiltfilt(sections, values, axis=-1, padlen=padding))
    steady_state = sosfilt_zi(sections).reshape(len(sections), *([1] * (values.ndim - 1)), 2)
    filtered, _ = sosfilt(sections, values, axis=-1, zi=steady_state * values[..., :1])
    return np.asarray(filtered)


def lowpass_without_lag(signal: ArrayLike, cutoff_hz: float, rate_hz: float) -> NDArray[np.float64]:
    """The usual filter of movement: second order, forward and backward, padded by three periods.

    Parameters
    ----------
    signal : array_like, shape (..., n_samples)
        Without missing samples.
    cutoff_hz : float
        Cut-off of one pass, as in :func:`butterworth_lowpass`; "fourth order" in the literature.
    rate_hz : float
        Sampling rate of `signal`.

    Returns
    -------
    ndarray, shape (..., n_samples)

    Examples
    --------
    >>> lowpass_without_lag([0.0, 0.0, 1.0, 0.0, 0.0], 10.0, 50.0).argmax()
    np.int64(2)
    """
    return butterworth_lowpass(
        signal,
        cutoff_hz=cutoff_hz,
        rate_hz=rate_hz,
        order=2,
        direction="zero_lag",
        pad_s=3.0 / cutoff_hz,
    )
