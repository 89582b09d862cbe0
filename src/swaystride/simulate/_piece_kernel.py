"""Compiled kernel: piecewise quintic polynomials with two derivatives."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]


@njit(cache=True, fastmath=False)  # type: ignore[untyped-decorator, unused-ignore]
def evaluate_pieces(start: Array, coefficients: Array, time: Array) -> Array:
    """Value, first and second derivative of a piecewise quintic at any times.

    Rising times are fastest: the search for the piece goes on where it was.

    Parameters
    ----------
    start : array, shape (n_pieces,)
        Where each piece begins, rising; the first one also holds before its start.
    coefficients : array, shape (n_pieces, 6)
        Of the powers 0 to 5 of the time since the start of the piece.
    time : array, shape (n,)
        Times.

    Returns
    -------
    array, shape (3, n)
    """
    last = len(start) - 1
    out = np.empty((3, len(time)))
    piece = 0
    for i in range(len(time)):
        t = time[i]
        while piece < last and t >= start[piece + 1]:
            piece += 1
        while piece > 0 and t < start[piece]:
            piece -= 1
        u = t - start[piece]
        c = coefficients[piece]
        value = c[5]
        first = 0.0
        half_second = 0.0
        for power in range(4, -1, -1):
            half_second = half_second * u + first
            first = first * u + value
            value = value * u + c[power]
        out[0, i] = value
        out[1, i] = first
        out[2, i] = 2.0 * half_second
    return out
