"""Piecewise quintic polynomials through prescribed states, as smooth as they can be."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.simulate._piece_kernel import evaluate_pieces

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PiecewiseQuintic:
    """A function of time made of quintic polynomials.

    Parameters
    ----------
    start_s : ndarray, shape (n_pieces,)
        Where each piece begins, rising. The first piece also holds before its start, the last one
        for ever.
    coefficients : ndarray, shape (n_pieces, 6)
        Of the powers 0 to 5 of the time since the start of the piece.
    """

    start_s: Array
    coefficients: Array

    def __call__(self, time_s: ArrayLike) -> Array:
        """Value, first and second derivative.

        Parameters
        ----------
        time_s : array_like, shape (n,)
            Times.

        Returns
        -------
        ndarray, shape (3, n)
        """
        time = np.ascontiguousarray(time_s, dtype=np.float64)
        return np.asarray(evaluate_pieces(self.start_s, self.coefficients, time))


def joined(start_s: ArrayLike, coefficients: ArrayLike) -> PiecewiseQuintic:
    """Function whose pieces are given in rows, each row running from left to right.

    Parameters
    ----------
    start_s : array_like, shape (...)
        Starts of the pieces.
    coefficients : array_like, shape (..., 6)
        Their coefficients.

    Returns
    -------
    PiecewiseQuintic
        Pieces in the order of time.
    """
    start = np.asarray(start_s, dtype=np.float64).ravel()
    order = np.argsort(start, kind="stable")
    rows = np.asarray(coefficients, dtype=np.float64).reshape(-1, 6)[order]
    return PiecewiseQuintic(start[order], np.ascontiguousarray(rows))


def least_jerk(time_s: ArrayLike, states: ArrayLike) -> Array:
    """Quintic pieces between knots whose free derivatives minimise the integrated squared jerk.

    Value, first and second derivative are continuous. Where a state is free the third derivative
    is continuous too, as far as the number of conditions allows.

    Parameters
    ----------
    time_s : array_like, shape (n_rows, n_knots)
        Times of the knots, rising in each row.
    states : array_like, shape (n_rows, n_knots, 3)
        Value, first and second derivative at each knot; NaN where free, in all rows alike.

    Returns
    -------
    ndarray, shape (n_rows, n_knots - 1, 6)
        Coefficients of the powers of the time since the left knot.

    Examples
    --------
    From rest to rest this is the classical minimum-jerk movement.

    >>> rest = [[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]]
    >>> least_jerk([[0.0, 1.0]], rest)[0, 0].round(9).tolist()
    [0.0, 0.0, 0.0, 10.0, -15.0, 6.0]
    """
    time, state = np.asarray(time_s, dtype=np.float64), np.array(states, dtype=np.float64)
    n_rows, n_knots, _ = state.shape
    duration = np.diff(time, axis=1)
    free = np.isnan(state[0]).ravel()
    if free.any():
        cost = np.zeros((n_rows, 3 * n_knots, 3 * n_knots))
        for piece in range(n_knots - 1):
            h = duration[:, piece, None] ** np.arange(3)
            scale = np.concatenate([h, h], axis=1)
            block = scale[:, :, None] * _jerk_cost() * scale[:, None, :]
            block /= duration[:, piece, None, None] ** 5
            place = slice(3 * piece, 3 * piece + 6)
            cost[:, place, place] += block
        flat = state.reshape(n_rows, -1)
        right = -np.einsum("nij,nj->ni", cost[:, free][:, :, ~free], flat[:, ~free])
        flat[:, free] = np.linalg.solve(cost[:, free][:, :, free], right[..., None])[..., 0]
        state = flat.reshape(n_rows, n_knots, 3)
    h = duration[..., None] ** np.arange(3)
    ends = np.concatenate([state[:, :-1] * h, state[:, 1:] * h], axis=-1)
    return np.asarray((ends @ _hermite().T) / duration[..., None] ** np.arange(6))


@cache
def _hermite() -> Array:
    """Coefficients on the unit interval from value, slope and curvature at both of its ends."""
    conditions = np.zeros((6, 6))
    powers = np.arange(6)
    conditions[0, 0] = conditions[1, 1] = 1.0
    conditions[2, 2] = 2.0
    conditions[3] = 1.0
    conditions[4] = powers
    conditions[5] = powers * (powers - 1)
    return np.asarray(np.linalg.inv(conditions), dtype=np.float64)


@cache
def _jerk_cost() -> Array:
    """Quadratic form of the integrated squared jerk on the unit interval in the end states."""
    powers = np.arange(6)
    third = powers * (powers - 1) * (powers - 2)
    exponent = np.maximum(powers[:, None] + powers[None, :] - 5, 1)
    integral = third[:, None] * third[None, :] / exponent
    return np.asarray(_hermite().T @ integral @ _hermite())
