"""Correlations nearest to wanted ones that can hold together: a convex problem, solved to a known gap.

Wanted are covariances ``design B`` of measures with standardised scales, where the columns of B are
the coefficients of each scale on orthonormal directions of the measures. The joint correlation matrix
is positive semidefinite if and only if ``between − B'B`` is, with `between` the correlations of the
scales; its diagonal is the share of each scale that the measures leave unexplained.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Weights of the objective against the barrier; the last sets the gap.
_BARRIER: Final = tuple(10.0**power for power in range(9))
_MOST_STEPS: Final = 60


def nearest_coefficients(
    design: Array, target: Array, weights: Array, between: Array, most_explained: float
) -> tuple[Array, float]:
    """Coefficients B that minimise ``½ Σ weights (design B − target)²`` under the two limits.

    The limits are ``between − B'B`` positive semidefinite and a diagonal of B'B of at most
    `most_explained`. Interior-point method: the barrier ``−log det(between − B'B) − Σ log(most −
    diag B'B)`` over a rising weight t; its minimum lies within 2 · n_scales/t of the smallest
    objective.

    Parameters
    ----------
    design : ndarray, shape (n_measures, n_directions)
        Orthonormal directions of the signals, seen by the measures.
    target, weights : ndarray, shape (n_measures, n_scales)
        Wanted correlations and weights of their deviations.
    between : ndarray, shape (n_scales, n_scales)
        Correlations of the scales, positive definite.
    most_explained : float
        Largest diagonal of B'B, below one.

    Returns
    -------
    coefficients : ndarray, shape (n_directions, n_scales)
    gap : float
        Bound of the excess over the smallest objective, relative to the objective at zero.
    """
    n_directions, n_scales = design.shape[1], target.shape[1]
    found = np.zeros((n_directions, n_scales))
    at_zero = 0.5 * float(np.sum(weights * target**2))
    if most_explained <= 0.0 or at_zero == 0.0:
        return found, 0.0
    curvature = np.einsum("pi,ps,pk->sik", design, weights / at_zero, design)
    pull = design.T @ (weights * target) / at_zero

    def objective(b: Array, t: float) -> float:
        rest = between - b.T @ b
        slack = most_explained - np.sum(b**2, axis=0)
        if slack.min() <= 0.0 or np.linalg.eigvalsh(rest)[0] <= 0.0:
            return float("inf")
        fit = 0.5 * np.einsum("is,sik,ks->", b, curvature, b) - np.sum(pull * b)
        return float(t * fit - np.linalg.slogdet(rest)[1] - np.log(slack).sum())

    for t in _BARRIER:
        for _ in range(_MOST_STEPS):
            gradient, hessian = _derivatives(found, t, curvature, pull, between, most_explained)
            step = -np.linalg.solve(hessian, gradient.ravel()).reshape(found.shape)
            decrement = -float(np.sum(gradient * step))
            if decrement < 1e-12:
                break
            now, length = objective(found, t), 1.0
            while objective(found + length * step, t) > now - 1e-4 * length * decrement:
                length *= 0.5
                if length < 1e-10:
                    break
            if length < 1e-10:
                break
            found = found + length * step
    return found, 2.0 * n_scales / _BARRIER[-1]


def _derivatives(
    b: Array, t: float, curvature: Array, pull: Array, between: Array, most_explained: float
) -> tuple[Array, Array]:
    """Gradient, and Hessian over the raveled coefficients, of the objective with its barrier."""
    n_directions, n_scales = b.shape
    inverse = np.linalg.inv(between - b.T @ b)
    slack = most_explained - np.sum(b**2, axis=0)
    p = b @ inverse
    gradient = t * (np.einsum("sik,ks->is", curvature, b) - pull) + 2.0 * p + 2.0 * b / slack
    inside = np.eye(n_directions) + p @ b.T
    hessian = 2.0 * np.einsum("ik,lj->ijkl", inside, inverse)
    hessian += 2.0 * np.einsum("il,kj->ijkl", p, p)
    scale = np.arange(n_scales)
    # Advanced indices put the scale first.
    hessian[:, scale, :, scale] += (
        t * curvature
        + 2.0 * np.eye(n_directions) / slack[:, None, None]
        + 4.0 * np.einsum("is,ks->sik", b, b) / slack[:, None, None] ** 2
    )
    return gradient, hessian.reshape(n_directions * n_scales, -1)
