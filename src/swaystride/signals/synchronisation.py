"""Which of one set of signals belongs to which of another, and by how much they are shifted."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import fft
from scipy.optimize import linear_sum_assignment

from swaystride.errors import RecordingError

Array = NDArray[np.float64]


class Match(NamedTuple):
    """Result of :func:`match_signals`.

    ``delay_s``: the first set lags behind the second by it (its event at t is the second's at
    t − delay); ``partner`` (n,), row of the second set that belongs to each row of the first;
    ``correlation`` (n,), of each row with its partner at that delay; ``own_correlation`` (n,), with
    the row of the same number.
    """

    delay_s: float
    partner: NDArray[np.int64]
    correlation: Array
    own_correlation: Array


def match_signals(
    first: ArrayLike, second: ArrayLike, rate_hz: float, *, longest_s: float
) -> Match:
    """Delay and assignment with the largest sum of correlations.

    Periodic movement matches itself at every period, and one leg matches the other at half of it;
    what decides is that no two strides are alike. So delay and assignment are found together.

    Parameters
    ----------
    first, second : array_like, shape (n, n_samples)
        Two sets of simultaneous signals, for example the sizes of the angular rates of sensors and
        of optical segments, low-passed alike. NaN where unknown.
    rate_hz : float
        Sampling rate of both.
    longest_s : float
        Largest delay that is looked for, to either side.

    Returns
    -------
    Match

    Raises
    ------
    RecordingError
        If the sets differ in size, or are shorter than four times the longest delay.

    Examples
    --------
    >>> noise = np.random.default_rng(1).standard_normal((2, 1000))
    >>> late = np.roll(noise, 7, axis=1)[::-1]
    >>> found = match_signals(late, noise, 100.0, longest_s=0.5)
    >>> round(found.delay_s, 3), found.partner.tolist()
    (0.07, [1, 0])
    """
    a, b = (np.asarray(values, dtype=np.float64) for values in (first, second))
    reach = round(longest_s * rate_hz)
    if a.shape != b.shape or a.shape[1] < 4 * reach + 3:
        raise RecordingError(
            "signals cannot be matched",
            expected=f"two sets of equal size, {4 * reach + 3} samples at least",
            found=f"{a.shape} and {b.shape}",
        )
    correlation = _correlations(a, b, reach)
    score = np.array([_best(table)[0] for table in correlation])
    lag = int(np.argmax(score))
    partner = _best(correlation[lag])[1]
    rows = np.arange(len(a))
    return Match(
        delay_s=(lag - reach + _vertex(score, lag)) / rate_hz,
        partner=partner,
        correlation=correlation[lag, rows, partner],
        own_correlation=correlation[lag, rows, rows],
    )


def _correlations(a: Array, b: Array, reach: int) -> Array:
    """Correlation of every pair at every lag, (2 reach + 1, n, n)."""
    n = a.shape[1]
    size = fft.next_fast_len(n + reach, real=True)
    one, two = (fft.rfft(_standardised(values), size, axis=1) for values in (a, b))
    product = fft.irfft(one[:, None] * np.conj(two[None]), size, axis=2)
    lags = np.arange(-reach, reach + 1)
    # fewer samples overlap at larger lags
    overlap = n / (n - np.abs(lags))
    return np.ascontiguousarray(product[:, :, lags].transpose(2, 0, 1) * overlap[:, None, None])


def _standardised(values: Array) -> Array:
    """Zero mean and unit length, unknown samples nil."""
    known = np.isfinite(values)
    sums = np.sum(values, axis=1, keepdims=True, where=known)
    mean = sums / np.maximum(known.sum(axis=1, keepdims=True), 1)
    centred = np.where(known, values - mean, 0.0)
    length = np.linalg.norm(centred, axis=1, keepdims=True)
    return np.asarray(centred / np.maximum(length, 1e-300))


def _best(table: Array) -> tuple[float, NDArray[np.int64]]:
    """Assignment with the largest sum."""
    rows, columns = linear_sum_assignment(table, maximize=True)
    return float(table[rows, columns].sum()), columns.astype(np.int64)


def _vertex(score: Array, place: int) -> float:
    """Where the parabola through a maximum and its neighbours has its top, in samples."""
    if not 0 < place < len(score) - 1:
        return 0.0
    before, top, after = score[place - 1 : place + 2]
    curvature = before - 2.0 * top + after
    return float(0.5 * (before - after) / curvature) if curvature < 0.0 else 0.0
