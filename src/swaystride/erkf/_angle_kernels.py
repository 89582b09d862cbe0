"""Compiled joint angles of two segments, and their variance."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from swaystride.erkf._rotation_kernels import multiply, to_matrix

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def joint_angles(
    proximal: Array,
    distal: Array,
    proximal_anatomical: Array,
    distal_anatomical: Array,
    angles: Array,
    jacobian: Array,
) -> None:
    """Cardan angles Z-X'-Y'' of a joint and their derivatives.

    Parameters
    ----------
    proximal, distal : array, shape (13,)
        Nominal states.
    proximal_anatomical, distal_anatomical : array, shape (3, 3)
        ``r_anatomical_from_sensor``.
    angles : array, shape (3,)
        Overwritten: alpha, beta, gamma in rad.
    jacobian : array, shape (3, 6)
        Overwritten: with respect to the rotation errors of both segments.

    Notes
    -----
    The relative rotation changes by ``Exp(η)`` on its right with
    ``η = A₂ (δθ₂ − (R₁ᵀ R₂)ᵀ δθ₁)``, and η is linear in the changes of the angles.
    """
    work = np.empty((6, 3, 3))
    r1, r2, between, left, r, rate = work[0], work[1], work[2], work[3], work[4], work[5]
    to_matrix(proximal[6:10], r1)
    to_matrix(distal[6:10], r2)
    multiply(r1.T, r2, 1.0, between)
    multiply(proximal_anatomical, between, 1.0, left)
    multiply(left, distal_anatomical.T, 1.0, r)
    angles[1] = math.asin(min(1.0, max(-1.0, r[2, 1])))
    angles[0] = math.atan2(-r[0, 1], r[1, 1])
    angles[2] = math.atan2(-r[2, 0], r[2, 2])
    sine, cosine = math.sin(angles[2]), math.cos(angles[2])
    tangent, secant = math.tan(angles[1]), 1.0 / math.cos(angles[1])
    rate[0, 0], rate[0, 1], rate[0, 2] = -sine * secant, 0.0, cosine * secant
    rate[1, 0], rate[1, 1], rate[1, 2] = cosine, 0.0, sine
    rate[2, 0], rate[2, 1], rate[2, 2] = sine * tangent, 1.0, -cosine * tangent
    multiply(rate, distal_anatomical, 1.0, left)
    for a in range(3):
        for b in range(3):
            jacobian[a, 3 + b] = left[a, b]
    multiply(left, between.T, -1.0, jacobian[:, 0:3])


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def angle_variance(p: Array, first: int, second: int, d: int, jacobian: Array, out: Array) -> None:
    """Diagonal of ``J P Jᵀ``.

    Parameters
    ----------
    p : array, shape (n, n)
        Covariance of the error.
    first, second, d : int
        Segments, and states per segment.
    jacobian : array, shape (3, 6)
        As from :func:`joint_angles`.
    out : array, shape (3,)
        Overwritten.
    """
    for a in range(3):
        total = 0.0
        for b in range(6):
            row = d * (first if b < 3 else second) + 6 + b % 3
            inner = 0.0
            for c in range(6):
                column = d * (first if c < 3 else second) + 6 + c % 3
                inner += p[row, column] * jacobian[a, c]
            total += jacobian[a, b] * inner
        out[a] = total
