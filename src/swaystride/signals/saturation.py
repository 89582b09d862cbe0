"""A sensor of smaller range: clip the signal, and say how much of it is lost."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError


def clip_axes(signal: ArrayLike, *, limit: float) -> NDArray[np.float64]:
    """Clip every axis of a signal to ±limit, as a sensor of that range would deliver it.

    Parameters
    ----------
    signal : array_like, shape (..., n_samples)
        In any unit. Missing samples (NaN) stay missing.
    limit : float
        Range of the sensor, positive, in the unit of `signal`.

    Returns
    -------
    ndarray, shape (..., n_samples)
        A copy.

    Raises
    ------
    RecordingError
        If the range is not positive.

    Examples
    --------
    >>> clip_axes([[3.0, -9.0, 1.0]], limit=6.0)
    array([[ 3., -6.,  1.]])
    """
    if not limit > 0:
        raise RecordingError("the range of a sensor", expected="above 0", found=str(limit))
    return np.clip(np.asarray(signal, dtype=np.float64), -limit, limit)


def data_loss_percent(truncated: ArrayLike, full: ArrayLike) -> float:
    """Percentage of a signal that truncation takes away.

    ``100 (1 − ∫‖truncated‖ dt / ∫‖full‖ dt)`` over the whole recording, with ‖·‖ the magnitude over
    the axes and the integral a sum over samples of equal length (Potter et al. 2019, §2.3).

    Parameters
    ----------
    truncated, full : array_like, shape (n_axes, n_samples)
        The same recording with and without truncation, no samples missing.

    Raises
    ------
    RecordingError
        If the shapes differ, a sample is missing, or the full signal is zero throughout.

    Examples
    --------
    >>> data_loss_percent([[5.0, 5.0]], [[5.0, 15.0]])
    50.0
    """
    short, whole = (np.asarray(signal, dtype=np.float64) for signal in (truncated, full))
    if short.shape != whole.shape or whole.ndim != 2:
        raise RecordingError(
            "truncated and full signal do not belong together",
            expected="two arrays of one shape (n_axes, n_samples)",
            found=f"{short.shape} and {whole.shape}",
        )
    left, total = (float(np.linalg.norm(signal, axis=0).sum()) for signal in (short, whole))
    if not (np.isfinite(left) and np.isfinite(total)):
        raise RecordingError(
            "data loss of a signal with missing samples", expected="finite values", found="NaN"
        )
    if total == 0.0:
        raise RecordingError("data loss of a signal that is zero throughout")
    return 100.0 * (1.0 - left / total)
