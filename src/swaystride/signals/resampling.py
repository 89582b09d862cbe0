"""A lower sampling rate: by leaving samples out, or with a low-pass filter before it.

Both functions keep the samples 0, r, 2r, …, so that the first sample, and with it the time axis,
stays where it was. MATLAB's ``decimate`` aligns the kept samples to the end of the record instead;
the two differ by a shift of less than one new sample and by nothing else.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.signal import cheby1, sosfiltfilt

from swaystride.errors import RecordingError


@dataclass(frozen=True)
class DecimationFilter:
    """The low-pass filter of a decimation: Chebyshev, type I, forward and backward.

    Parameters
    ----------
    order : int
        Order of one pass.
    ripple_db : float
        Ripple of one pass in the pass band.
    edge : float
        Edge of the pass band as a share of the new Nyquist frequency, below 1.
    """

    order: int
    ripple_db: float
    edge: float


def whole_factor(rate_hz: float, target_hz: float, *, tolerance: float = 0.01) -> int:
    """By which whole number a rate must be divided to reach another.

    Parameters
    ----------
    rate_hz, target_hz : float
        The rate that is there, and the one wanted.
    tolerance : float
        Largest relative distance of the quotient from a whole number: a rate that was measured
        from time stamps is never round.

    Raises
    ------
    RecordingError
        If the quotient is no whole number.

    Examples
    --------
    >>> whole_factor(999.8, 62.5)
    16
    """
    quotient = rate_hz / target_hz
    factor = round(quotient)
    if factor < 1 or abs(quotient - factor) > tolerance * factor:
        raise RecordingError(
            "the sampling rate is no whole multiple of the one wanted",
            expected=f"a multiple of {target_hz:g} Hz",
            found=f"{rate_hz:g} Hz",
        )
    return factor


def keep_every(signal: ArrayLike, factor: int) -> NDArray[np.float64]:
    """Keep every `factor`-th sample along the last axis, without any filter.

    What lies above the new Nyquist frequency folds back (aliasing).

    Parameters
    ----------
    signal : array_like, shape (..., n_samples)
    factor : int
        1 or more.

    Returns
    -------
    ndarray, shape (..., ceil(n_samples / factor))

    Raises
    ------
    RecordingError
        If the factor is below 1.

    Examples
    --------
    >>> keep_every([0.0, 1.0, 2.0, 3.0, 4.0], 2)
    array([0., 2., 4.])
    """
    if factor < 1:
        raise RecordingError("factor of a lower rate", expected="1 or more", found=str(factor))
    kept = np.asarray(signal, dtype=np.float64)[..., ::factor]
    return np.ascontiguousarray(kept)


def decimate(signal: ArrayLike, factor: int, *, lowpass: DecimationFilter) -> NDArray[np.float64]:
    """Low-pass filter, then keep every `factor`-th sample, along the last axis.

    One stage for every factor, as MATLAB's ``decimate`` does it. The filter runs forward and
    backward in second-order sections (an order of 8 with its edge at 1/20 of the Nyquist
    frequency is no matter for a polynomial), with SciPy's default odd extension at both ends.
    A filter of even order has the gain −ripple at zero frequency: two passes of order 8 with
    0.05 dB scale a constant, gravity too, by 0.989.

    Parameters
    ----------
    signal : array_like, shape (..., n_samples)
        Without missing samples.
    factor : int
        1 or more; 1 returns the signal as it is.
    lowpass : DecimationFilter

    Returns
    -------
    ndarray, shape (..., ceil(n_samples / factor))

    Raises
    ------
    RecordingError
        If the factor is below 1, the edge is not below the new Nyquist frequency, samples are
        missing, or the signal is shorter than the extension of the filter.

    Examples
    --------
    >>> lowpass = DecimationFilter(order=8, ripple_db=0.05, edge=0.8)
    >>> decimate(np.full(64, 9.81), 16, lowpass=lowpass).round(3)
    array([9.698, 9.698, 9.698, 9.698])
    """
    values = np.asarray(signal, dtype=np.float64)
    if factor == 1:
        return keep_every(values, 1)
    if not 0 < lowpass.edge < 1:
        raise RecordingError(
            "edge of the decimation filter",
            expected="a share of the new Nyquist frequency, below 1",
            found=f"{lowpass.edge:g}",
        )
    if not np.all(np.isfinite(values)):
        raise RecordingError(
            "cannot filter across missing samples", expected="finite values", found="NaN"
        )
    sections = cheby1(lowpass.order, lowpass.ripple_db, lowpass.edge / max(factor, 1), output="sos")
    shortest = 3 * (2 * len(sections) + 1)
    if values.shape[-1] <= shortest:
        raise RecordingError(
            "the recording is too short for the decimation filter",
            expected=f"more than {shortest} samples",
            found=str(values.shape[-1]),
        )
    return keep_every(sosfiltfilt(sections, values, axis=-1), factor)
