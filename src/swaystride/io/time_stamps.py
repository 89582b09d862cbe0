"""Time stamps: the sampling rate they show and the sample index of each row."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

_LONGEST_STEP = 2.0**40


@dataclass(frozen=True)
class StampedSamples:
    """What time stamps say about the time axis.

    Parameters
    ----------
    index : ndarray of int64, shape (n_rows,)
        Sample index of each row, counted from the first.
    rate_hz : float
        Number of sampling intervals over the time between the first and the last stamp.
    worst_jitter : float
        Largest distance between a stamp and its sample on the uniform axis, in sampling intervals.
    bad_rows : tuple of int
        0-based rows whose stamp does not lie after the stamp before them, or follows it by less
        than half a sampling interval; the index is meaningless if there are any.
    """

    index: NDArray[np.int64]
    rate_hz: float
    worst_jitter: float
    bad_rows: tuple[int, ...]


def index_from_time_stamps(time_s: ArrayLike) -> StampedSamples:
    """Measure the sampling rate and place every row on a uniform time axis.

    Each step is rounded to whole intervals, first with the median step, then with the mean interval
    that follows from it, so that rounding of the stamps does not accumulate.

    Parameters
    ----------
    time_s : array_like, shape (n_rows,)
        Time stamps in seconds from any origin, at least two, without NaN.

    Returns
    -------
    StampedSamples

    Raises
    ------
    ValueError
        If there are fewer than two stamps, or one is NaN.

    Examples
    --------
    >>> stamped = index_from_time_stamps([0.0, 0.01, 0.02, 0.05])
    >>> stamped.index, round(stamped.rate_hz, 9)
    (array([0, 1, 2, 5]), 100.0)
    """
    time = np.asarray(time_s, dtype=np.float64)
    if time.ndim != 1 or len(time) < 2 or not np.isfinite(time).all():
        raise ValueError("a rate needs at least two finite time stamps")
    time = time - time[0]
    steps_s = np.diff(time)
    forward = steps_s[steps_s > 0]
    if forward.size == 0:
        return StampedSamples(
            np.zeros(len(time), dtype=np.int64), float("nan"), 0.0, tuple(range(1, len(time)))
        )
    # The lower median is a step that occurs; the mean of two unlike steps would not be.
    interval = float(np.quantile(forward, 0.5, method="lower"))
    steps = _whole_steps(steps_s / interval)
    bad = tuple(int(row) for row in np.flatnonzero(steps < 1) + 1)
    if not bad:
        steps = _whole_steps(steps_s * (steps.sum() / time[-1]))
        interval = float(time[-1]) / int(steps.sum())
    index = np.concatenate([[0], np.cumsum(steps)])
    jitter = float(np.abs(time / interval - index).max())
    return StampedSamples(index, 1.0 / interval, jitter, bad)


def _whole_steps(steps: NDArray[np.float64]) -> NDArray[np.int64]:
    """Nearest whole numbers; a step beyond counting stays within the integers."""
    return np.rint(np.clip(steps, -1.0, _LONGEST_STEP)).astype(np.int64)
