"""Residuals of a hinge between two sensors, and the search for their smallest sum of squares.

The unknowns are two spherical angles per axis, in a frame whose pole is far from the axis.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

Array = NDArray[np.float64]


class HingeSamples(NamedTuple):
    """Chosen samples of both sensors and their weights.

    ``rates`` and ``forces``, two arrays (n, 3) each; ``rate_weight`` and ``acc_weight``, by which
    residuals are multiplied before they are squared.
    """

    rates: tuple[Array, Array]
    forces: tuple[Array, Array]
    rate_weight: float
    acc_weight: float


class Minimum(NamedTuple):
    """Result of :func:`nearest_minimum`.

    ``proximal`` and ``distal`` (3,), unit vectors; ``cost``, weighted sum of squares.
    """

    proximal: Array
    distal: Array
    cost: float


def residuals(
    one: Array, two: Array, rates: tuple[Array, Array], forces: tuple[Array, Array]
) -> tuple[Array, Array]:
    """What both kinds of samples leave over: ``|ω₁ × j₁| − |ω₂ × j₂|`` and ``j₁·a₁ − j₂·a₂``.

    Parameters
    ----------
    one, two : ndarray, shape (3,)
        Unit vectors in the frames of the sensors.
    rates, forces : (ndarray, ndarray), each of shape (n, 3)
        Angular rates, and accelerometers in slow movement.

    Returns
    -------
    rate_rad_s, acc_m_s2 : ndarray, shape (n,)

    Examples
    --------
    >>> z = np.array([0.0, 0.0, 1.0])
    >>> rates = np.array([[3.0, 4.0, 1.0]]), np.array([[0.0, 5.0, -2.0]])
    >>> forces = np.array([[0.0, 9.8, 1.0]]), np.array([[9.8, 0.0, 1.0]])
    >>> residuals(z, z, rates, forces)
    (array([0.]), array([0.]))
    """
    sizes = [np.linalg.norm(np.cross(w, j), axis=1) for w, j in zip(rates, (one, two), strict=True)]
    return sizes[0] - sizes[1], np.asarray(forces[0] @ one - forces[1] @ two)


def _frame(axis: Array) -> Array:
    """Orthonormal columns, the first of which is an axis."""
    columns = np.linalg.svd(axis[:, None])[0]
    columns[:, 0] = axis
    return np.asarray(columns)


def _turned(frames: tuple[Array, Array], angles: Array) -> tuple[Array, Array]:
    """Unit vectors at two spherical angles each, from the first column of each frame."""
    (a, b, c, d), (one, two) = angles, frames
    local = [
        np.array([np.cos(u) * np.cos(v), np.cos(u) * np.sin(v), np.sin(u)])
        for u, v in ((a, b), (c, d))
    ]
    return one @ local[0], two @ local[1]


def _slopes(frames: tuple[Array, Array], angles: Array) -> tuple[Array, Array]:
    """Derivatives of both vectors by their own angles, (3, 2) each."""
    found = []
    for frame, (u, v) in zip(frames, (angles[:2], angles[2:]), strict=True):
        su, cu, sv, cv = np.sin(u), np.cos(u), np.sin(v), np.cos(v)
        found.append(frame @ np.array([[-su * cv, -cu * sv], [-su * sv, cu * cv], [cu, 0.0]]))
    return found[0], found[1]


def _weighted(one: Array, two: Array, samples: HingeSamples) -> Array:
    """Residuals of both kinds, over their standard deviations."""
    rate, acc = residuals(one, two, samples.rates, samples.forces)
    return np.concatenate([samples.rate_weight * rate, samples.acc_weight * acc])


def _jacobian(frames: tuple[Array, Array], angles: Array, samples: HingeSamples) -> Array:
    """Derivatives of the weighted residuals by the four angles."""
    axes, slopes = _turned(frames, angles), _slopes(frames, angles)
    columns = []
    for j, w, a, slope, sign in zip(
        axes, samples.rates, samples.forces, slopes, (1.0, -1.0), strict=True
    ):
        # of |ω × j| = √(|ω|² − (ω·j)²)
        size = np.linalg.norm(np.cross(w, j), axis=1)
        by_axis = -((w @ j) / np.maximum(size, 1e-12))[:, None] * w
        rows = [samples.rate_weight * by_axis @ slope, samples.acc_weight * a @ slope]
        columns.append(sign * np.concatenate(rows))
    return np.concatenate(columns, axis=1)


def nearest_minimum(one: Array, two: Array, samples: HingeSamples) -> Minimum:
    """Descend from a pair of axes by Levenberg-Marquardt.

    Parameters
    ----------
    one, two : ndarray, shape (3,)
        Unit vectors in the frames of the sensors.
    samples : HingeSamples

    Returns
    -------
    Minimum
    """
    frames = (_frame(one), _frame(two))

    def values(angles: Array) -> Array:
        return _weighted(*_turned(frames, angles), samples)

    def slopes(angles: Array) -> Array:
        return _jacobian(frames, angles, samples)

    found = least_squares(values, np.zeros(4), jac=slopes, method="lm", xtol=1e-10, ftol=1e-12)
    return Minimum(*_turned(frames, found.x), float(2.0 * found.cost))


def direction_variances(one: Array, two: Array, samples: HingeSamples) -> Array:
    """Variance of the direction of each axis, mean of both components, as if residuals were white.

    Parameters
    ----------
    one, two : ndarray, shape (3,)
        Axes at a minimum.
    samples : HingeSamples

    Returns
    -------
    ndarray, shape (2,)
        rad².
    """
    jacobian = _jacobian((_frame(one), _frame(two)), np.zeros(4), samples)
    square = np.mean(_weighted(one, two, samples) ** 2)
    covariance = square * np.linalg.pinv(jacobian.T @ jacobian)
    return np.asarray(np.diag(covariance).reshape(2, 2).mean(axis=1))
