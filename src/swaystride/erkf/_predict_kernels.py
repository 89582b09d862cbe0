"""Compiled prediction: strapdown step of every segment, and of the covariance.

A row of the nominal state holds position (0-2), velocity (3-5), orientation (6-9) and gyroscope
bias (10-12) of one segment. Its error has position, velocity, a small rotation in the sensor frame
(``R_true = R Exp(δθ)``) and, if it has twelve states, the bias.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from swaystride.erkf._rotation_kernels import (
    exponential,
    multiply,
    right_jacobian,
    times_skew,
    to_matrix,
    turn,
)
from swaystride.units import GRAVITY_M_S2

Array = NDArray[np.float64]

#: Entries of a nominal state per segment.
NOMINAL_SIZE = 13


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def predict_segment(
    state: Array, before: Array, after: Array, step_s: float, midpoint: bool, transition: Array
) -> None:
    """One strapdown step of one segment, with the transition of its error.

    Parameters
    ----------
    state : array, shape (13,)
        Overwritten by the state after the step.
    before, after : array, shape (6,)
        Accelerometer and gyroscope at both ends of the step.
    step_s : float
        Duration of the step.
    midpoint : bool
        Whether the rate is the mean of both samples and the force the mean of both ends, each in
        the orientation of its end; otherwise the first sample alone is held over the step.
    transition : array, shape (9, 6)
        Rows position, velocity, rotation; columns rotation and bias of the error before the step.
        The rest of the transition is constant: ones on the diagonal, ``step_s`` from velocity to
        position.
    """
    work = np.empty((5, 3, 3))
    r, turned, jacobian, product, arm = work[0], work[1], work[2], work[3], work[4]
    share = 0.5 if midpoint else 0.0
    x = (before[3] + share * (after[3] - before[3]) - state[10]) * step_s
    y = (before[4] + share * (after[4] - before[4]) - state[11]) * step_s
    z = (before[5] + share * (after[5] - before[5]) - state[12]) * step_s
    to_matrix(state[6:10], r)
    exponential(x, y, z, turned)
    right_jacobian(x, y, z, jacobian)
    transition[:] = 0.0
    sx, sy, sz = before[0], before[1], before[2]
    if midpoint:
        ax, ay, az = after[0], after[1], after[2]
        sx = 0.5 * (sx + turned[0, 0] * ax + turned[0, 1] * ay + turned[0, 2] * az)
        sy = 0.5 * (sy + turned[1, 0] * ax + turned[1, 1] * ay + turned[1, 2] * az)
        sz = 0.5 * (sz + turned[2, 0] * ax + turned[2, 1] * ay + turned[2, 2] * az)
        # a bias turns the force at the end of the step
        times_skew(turned, ax, ay, az, 0.5 * step_s * step_s, product)
        multiply(product, jacobian, 1.0, arm)
        multiply(r, arm, 1.0, transition[3:6, 3:6])
    times_skew(r, sx, sy, sz, -step_s, transition[3:6, 0:3])
    for a in range(3):
        for b in range(6):
            transition[a, b] = 0.5 * step_s * transition[3 + a, b]
    for a in range(3):
        for b in range(3):
            transition[6 + a, b] = turned[b, a]
            transition[6 + a, 3 + b] = -step_s * jacobian[a, b]
        force = r[a, 0] * sx + r[a, 1] * sy + r[a, 2] * sz
        if a == 2:
            force -= GRAVITY_M_S2
        state[a] += step_s * (state[3 + a] + 0.5 * step_s * force)
        state[3 + a] += step_s * force
    turn(state[6:10], x, y, z)


@njit(cache=True, fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def _add_three(p: Array, target: int, source: int, c: Array) -> None:
    """Add a combination of three neighbouring rows to a row."""
    c0, c1, c2 = c[0], c[1], c[2]
    for k in range(p.shape[1]):
        p[target, k] += c0 * p[source, k] + c1 * p[source + 1, k] + c2 * p[source + 2, k]


@njit(cache=True, fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def _transition_rows(p: Array, o: int, with_bias: bool, f: Array, step_s: float) -> None:
    """Rows of one segment in ``F P``, in place."""
    n = p.shape[1]
    for a in range(6):
        if a < 3:
            for k in range(n):
                p[o + a, k] += step_s * p[o + 3 + a, k]
        _add_three(p, o + a, o + 6, f[a, 0:3])
        if with_bias:
            _add_three(p, o + a, o + 9, f[a, 3:6])
    c = f[6:9]
    for k in range(n):
        x, y, z = p[o + 6, k], p[o + 7, k], p[o + 8, k]
        p[o + 6, k] = c[0, 0] * x + c[0, 1] * y + c[0, 2] * z
        p[o + 7, k] = c[1, 0] * x + c[1, 1] * y + c[1, 2] * z
        p[o + 8, k] = c[2, 0] * x + c[2, 1] * y + c[2, 2] * z
    if with_bias:
        for a in range(3):
            _add_three(p, o + 6 + a, o + 9, c[a, 3:6])


@njit(cache=True, fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def predict_covariance(p: Array, transition: Array, step_s: float, noise: Array) -> None:
    """``P ← F P Fᵀ + Q`` in place, exactly symmetric.

    Parameters
    ----------
    p : array, shape (m · d, w)
        Covariance of m segments with d = 9 or 12 states; columns beyond m · d are nil and make the
        width a multiple of 16.
    transition : array, shape (m, 9, 6)
        As from :func:`predict_segment`.
    step_s : float
        Duration of the step.
    noise : array, shape (d,)
        Variance that a step adds to each state of a segment.
    """
    m, d = transition.shape[0], noise.shape[0]
    with_bias = d > 9
    for j in range(m):
        _transition_rows(p, d * j, with_bias, transition[j], step_s)
    new = np.empty(9)
    for i in range(m):
        for j in range(i, m):
            f = transition[j]
            for r in range(d * i, d * i + d):
                o = d * j
                x, y, z = p[r, o + 6], p[r, o + 7], p[r, o + 8]
                for a in range(9):
                    new[a] = f[a, 0] * x + f[a, 1] * y + f[a, 2] * z
                if with_bias:
                    x, y, z = p[r, o + 9], p[r, o + 10], p[r, o + 11]
                    for a in range(9):
                        new[a] += f[a, 3] * x + f[a, 4] * y + f[a, 5] * z
                for a in range(3):
                    p[r, o + a] += step_s * p[r, o + 3 + a] + new[a]
                    p[r, o + 3 + a] += new[3 + a]
                    p[r, o + 6 + a] = new[6 + a]
    n = m * d
    for i in range(n):
        p[i, i] += noise[i % d]
        for j in range(i + 1, n):
            p[j, i] = p[i, j]


@njit(cache=True, fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def retreat(adjoint: Array, p: Array, transition: Array, step_s: float, d: int) -> None:
    """``λ ← Fᵀ λ`` and ``Λ ← Fᵀ Λ F`` in place, exactly symmetric.

    Parameters
    ----------
    adjoint : array, shape (m · d,)
        λ of the smoother.
    p : array, shape (m · d, w)
        Λ of the smoother.
    transition : array, shape (m, 9, 6)
        As from :func:`predict_segment`.
    step_s : float
        Duration of the step.
    d : int
        States per segment.
    """
    m, n = transition.shape[0], p.shape[1]
    columns = d - 6
    row = np.empty((6, n))
    for j in range(m):
        f, o = transition[j], d * j
        for b in range(columns):
            total = 0.0 if b < 3 else adjoint[o + 6 + b]
            for a in range(9):
                total += f[a, b] * adjoint[o + a]
            row[b, 0] = total
        for b in range(columns):
            adjoint[o + 6 + b] = row[b, 0]
        for b in range(columns):
            for k in range(n):
                row[b, k] = 0.0 if b < 3 else p[o + 6 + b, k]
            for a in range(0, 9, 3):
                c0, c1, c2 = f[a, b], f[a + 1, b], f[a + 2, b]
                for k in range(n):
                    row[b, k] += c0 * p[o + a, k] + c1 * p[o + a + 1, k] + c2 * p[o + a + 2, k]
        for b in range(columns):
            for k in range(n):
                p[o + 6 + b, k] = row[b, k]
        for a in range(3):
            adjoint[o + 3 + a] += step_s * adjoint[o + a]
            for k in range(n):
                p[o + 3 + a, k] += step_s * p[o + a, k]
    new = np.empty(6)
    for i in range(m):
        for j in range(i, m):
            f, o = transition[j], d * j
            for r in range(d * i, d * i + d):
                for b in range(columns):
                    total = 0.0 if b < 3 else p[r, o + 6 + b]
                    for a in range(9):
                        total += f[a, b] * p[r, o + a]
                    new[b] = total
                for b in range(columns):
                    p[r, o + 6 + b] = new[b]
                for a in range(3):
                    p[r, o + 3 + a] += step_s * p[r, o + a]
    for i in range(m * d):
        for j in range(i + 1, m * d):
            p[j, i] = p[i, j]
