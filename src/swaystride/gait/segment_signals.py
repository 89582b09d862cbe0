"""Signals of one body segment of a runner in anatomical axes, and their low-pass (dissertation, §5.3.4.1)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError
from swaystride.signals.filters import lowpass_without_lag
from swaystride.signals.gaps import missing_runs

Array = NDArray[np.float64]

#: Rows of acceleration and rate: forward (x), up along the segment (y), to the right (z).
AP: Final = 0
VERTICAL: Final = 1
ML: Final = 2


@dataclass(frozen=True, eq=False)
class SegmentSignals:
    """Signals of the sensor of one segment, turned into anatomical axes.

    Parameters
    ----------
    acc_m_s2 : ndarray, shape (3, n_samples)
        Proper acceleration; x forward, y up along the segment, z to the right of the person on both
        sides. Missing samples are NaN.
    gyr_rad_s : ndarray, shape (3, n_samples)
        Angular rate; about z, toes up and a leg swinging forward are positive.

    Raises
    ------
    RecordingError
        If the shapes do not fit.
    """

    acc_m_s2: NDArray[np.floating]
    gyr_rad_s: NDArray[np.floating]

    def __post_init__(self) -> None:
        """Refuse what cannot be three axes of the same samples."""
        shapes = self.acc_m_s2.shape, self.gyr_rad_s.shape
        if shapes[0] != shapes[1] or len(shapes[0]) != 2 or shapes[0][0] != 3:
            raise RecordingError(
                "acceleration and angular rate of a segment do not fit",
                expected="two arrays of shape (3, n)",
                found=f"{shapes[0]} and {shapes[1]}",
            )

    def missing(self) -> NDArray[np.bool_]:
        """Flag the samples of which a channel is missing, shape (n_samples,)."""
        flags = np.isnan(self.acc_m_s2).any(axis=0) | np.isnan(self.gyr_rad_s).any(axis=0)
        return np.asarray(flags, dtype=np.bool_)


@dataclass(frozen=True)
class SignalFilters:
    """Low-pass of the signals (4th order, zero lag).

    Parameters
    ----------
    acc_cutoff_hz, gyr_cutoff_hz : float
        Cut-off of acceleration and angular rate.
    """

    acc_cutoff_hz: float
    gyr_cutoff_hz: float


#: Dissertation, §5.3.4.1; the direction is not printed, zero lag is ours [N].
PRINTED_FILTERS: Final = SignalFilters(60.0, 50.0)


def filtered(signals: SegmentSignals, rate_hz: float, filters: SignalFilters) -> SegmentSignals:
    """Signals of a segment after the low-pass.

    Parameters
    ----------
    signals : SegmentSignals
        As recorded.
    rate_hz : float
        Sampling rate.
    filters : SignalFilters

    Returns
    -------
    SegmentSignals
        Missing samples stay missing.

    Examples
    --------
    >>> still = SegmentSignals(np.ones((3, 100)), np.zeros((3, 100)))
    >>> float(filtered(still, 500.0, PRINTED_FILTERS).acc_m_s2.round(9).max())
    1.0
    """
    return SegmentSignals(
        lowpassed_parts(signals.acc_m_s2, filters.acc_cutoff_hz, rate_hz),
        lowpassed_parts(signals.gyr_rad_s, filters.gyr_cutoff_hz, rate_hz),
    )


def lowpassed_parts(signal: ArrayLike, cutoff_hz: float, rate_hz: float) -> Array:
    """Low-pass (4th order, zero lag) of every uninterrupted part of a signal.

    Parameters
    ----------
    signal : array_like, shape (..., n_samples)
        Missing samples are NaN; no filter passes them, so that each part between two gaps is
        filtered by itself.
    cutoff_hz : float
        Cut-off.
    rate_hz : float
        Sampling rate.

    Returns
    -------
    ndarray, shape (..., n_samples)
        NaN in all channels where one is missing.

    Examples
    --------
    >>> lowpassed_parts([1.0, 1.0, np.nan, 2.0, 2.0], 10.0, 100.0).round(6).tolist()
    [1.0, 1.0, nan, 2.0, 2.0]
    """
    values = np.asarray(signal)
    out = np.full(values.shape, np.nan)
    for first, last in complete_parts(values):
        out[..., first:last] = lowpass_without_lag(values[..., first:last], cutoff_hz, rate_hz)
    return out


def complete_parts(signal: ArrayLike) -> NDArray[np.int64]:
    """Uninterrupted parts of a signal.

    Parameters
    ----------
    signal : array_like, shape (..., n_samples)
        A sample is missing if one of its channels is NaN.

    Returns
    -------
    ndarray of int, shape (n_parts, 2)
        First sample of each part and the one after its last.

    Examples
    --------
    >>> complete_parts([np.nan, 1.0, 1.0, np.nan, 1.0]).tolist()
    [[1, 3], [4, 5]]
    """
    values = np.asarray(signal)
    gaps = missing_runs(values)
    start = gaps["start"].to_numpy()
    first = np.r_[0, start + gaps["length"].to_numpy()]
    last = np.r_[start, values.shape[-1]]
    parts = np.stack([first, last], axis=1).astype(np.int64)
    return np.asarray(parts[parts[:, 1] > parts[:, 0]])
