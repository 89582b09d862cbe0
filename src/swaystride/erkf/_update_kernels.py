"""Compiled measurement update: one constraint at a time, injection and reset, and their adjoints.

All constraints of a sample are linearised at the predicted state and applied one after another;
the mean of the error is accumulated, so that the result equals one stacked update. A constraint
touches two segments: the product with its Jacobian reads their rows of the covariance only.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from swaystride.erkf._rotation_kernels import turn

Array = NDArray[np.float64]


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def _invert(s: Array, out: Array) -> None:
    """Inverse of a symmetric positive 3×3 matrix by its Cholesky factor."""
    a = math.sqrt(s[0, 0])
    b, c = s[1, 0] / a, s[2, 0] / a
    d = math.sqrt(s[1, 1] - b * b)
    e = (s[2, 1] - b * c) / d
    f = math.sqrt(s[2, 2] - c * c - e * e)
    # inverse of the factor, then its own product
    ia, id_, if_ = 1.0 / a, 1.0 / d, 1.0 / f
    ib = -b * ia * id_
    ie = -e * id_ * if_
    ic = -(c * ia + e * ib) * if_
    out[0, 0] = ia * ia + ib * ib + ic * ic
    out[1, 1] = id_ * id_ + ie * ie
    out[2, 2] = if_ * if_
    out[0, 1] = out[1, 0] = ib * id_ + ic * ie
    out[0, 2] = out[2, 0] = ic * if_
    out[1, 2] = out[2, 1] = ie * if_


@njit(cache=True, fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def _project(p: Array, o: int, d: int, jacobian: Array, rows: Array) -> None:
    """Add ``J P`` of one segment to three rows; zeros of the Jacobian cost nothing."""
    n = p.shape[1]
    for a in range(3):
        for c in range(d):
            factor = jacobian[a, c]
            if factor != 0.0:
                for k in range(n):
                    rows[a, k] += factor * p[o + c, k]


@njit(cache=True, fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def _sweep(p: Array, gain: Array, rows: Array, slack: Array) -> None:
    """``P ← P − K B + W Kᵀ``, three rows at a time (their number is a multiple of three)."""
    n = p.shape[1]
    for i in range(0, p.shape[0], 3):
        for a in range(3):
            k0, k1, k2 = gain[a, i], gain[a, i + 1], gain[a, i + 2]
            w0, w1, w2 = slack[a, i], slack[a, i + 1], slack[a, i + 2]
            for k in range(n):
                g, b = gain[a, k], rows[a, k]
                p[i, k] += w0 * g - k0 * b
                p[i + 1, k] += w1 * g - k1 * b
                p[i + 2, k] += w2 * g - k2 * b


@njit(cache=True, fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def apply_constraint(
    p: Array,
    mean: Array,
    first: int,
    second: int,
    d: int,
    residual: Array,
    jacobian: Array,
    variance: float,
    gate: float,
    gain: Array,
    weighted: Array,
    inverse: Array,
) -> bool:
    """Update mean and covariance by one constraint, in place.

    The Joseph form ``(I − K H) P (I − K H)ᵀ + K C Kᵀ`` is written with B = H P and S = B Hᵀ + C as
    ``P − K B − (Bᵀ − K S) Kᵀ``. The bracket is the rounding error of the gain; with it the result
    depends on that error at second order only, as the Joseph form does, at the price of one sweep.

    Parameters
    ----------
    p : array, shape (n, w)
        Covariance; columns beyond n are nil and make the width a multiple of 16.
    mean : array, shape (n,)
        Of the error, from the constraints before.
    first, second : int
        Segments; `second` is negative if there is one only.
    d : int
        States per segment.
    residual, jacobian : array, shape (3,) and (2, 3, 12)
        At the predicted state.
    variance : float
        Of each component.
    gate : float
        Largest squared, normalised innovation that is believed.
    gain, weighted, inverse : array, shape (3, w), (3,), (3, 3)
        Overwritten by Kᵀ, ``S⁻¹ e`` and ``S⁻¹``.

    Returns
    -------
    bool
        Whether the constraint was believed.
    """
    n = p.shape[1]
    rows = np.zeros((3, n))
    slack = np.empty((3, n))
    s = np.zeros((3, 3))
    e = residual.copy()
    for side in range(2 if second >= 0 else 1):
        _project(p, d * (second if side else first), d, jacobian[side], rows)
    for side in range(2 if second >= 0 else 1):
        o = d * (second if side else first)
        for a in range(3):
            for c in range(d):
                factor = jacobian[side, a, c]
                if factor != 0.0:
                    e[a] -= factor * mean[o + c]
                    for b in range(3):
                        s[a, b] += factor * rows[b, o + c]
    for a in range(3):
        s[a, a] += variance
        for b in range(a):
            s[a, b] = s[b, a] = 0.5 * (s[a, b] + s[b, a])
    _invert(s, inverse)
    square = 0.0
    for a in range(3):
        weighted[a] = inverse[a, 0] * e[0] + inverse[a, 1] * e[1] + inverse[a, 2] * e[2]
        square += weighted[a] * e[a]
    if square > gate:
        return False
    for a in range(3):
        i0, i1, i2 = inverse[a, 0], inverse[a, 1], inverse[a, 2]
        for k in range(n):
            gain[a, k] = i0 * rows[0, k] + i1 * rows[1, k] + i2 * rows[2, k]
    for a in range(3):
        s0, s1, s2 = s[a, 0], s[a, 1], s[a, 2]
        for k in range(n):
            slack[a, k] = s0 * gain[0, k] + s1 * gain[1, k] + s2 * gain[2, k] - rows[a, k]
    e0, e1, e2 = e[0], e[1], e[2]
    for k in range(mean.shape[0]):
        mean[k] += e0 * gain[0, k] + e1 * gain[1, k] + e2 * gain[2, k]
    _sweep(p, gain, rows, slack)
    return True


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def inject(state: Array, error: Array, d: int) -> None:
    """Add an error to nominal states, in place.

    Parameters
    ----------
    state : array, shape (m, 13)
        Nominal states.
    error : array, shape (m · d,)
        Their errors.
    d : int
        States per segment.
    """
    for j in range(state.shape[0]):
        o = d * j
        for a in range(6):
            state[j, a] += error[o + a]
        turn(state[j, 6:10], error[o + 6], error[o + 7], error[o + 8])
        if d > 9:
            for a in range(3):
                state[j, 10 + a] += error[o + 9 + a]


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def reset(p: Array, error: Array, d: int, transposed: bool) -> None:
    """``P ← G P Gᵀ`` after an injection, exactly symmetric; or ``Gᵀ P G`` for the adjoint.

    G is one but for ``I − ½ [δθ]×`` at the rotation of every segment.

    Parameters
    ----------
    p : array, shape (n, w)
        Symmetric; changed in place.
    error : array, shape (n,)
        What was injected.
    d : int
        States per segment.
    transposed : bool
        Whether Gᵀ takes the place of G.
    """
    n = p.shape[0]
    half = -0.5 if transposed else 0.5
    for o in range(6, n, d):
        x, y, z = half * error[o], half * error[o + 1], half * error[o + 2]
        for k in range(p.shape[1]):
            a, b, c = p[o, k], p[o + 1, k], p[o + 2, k]
            p[o, k] = a + z * b - y * c
            p[o + 1, k] = b - z * a + x * c
            p[o + 2, k] = c + y * a - x * b
    for o in range(6, n, d):
        x, y, z = half * error[o], half * error[o + 1], half * error[o + 2]
        for k in range(o + 3):
            a, b, c = p[k, o], p[k, o + 1], p[k, o + 2]
            p[k, o] = a + z * b - y * c
            p[k, o + 1] = b - z * a + x * c
            p[k, o + 2] = c + y * a - x * b
    for i in range(n):
        for j in range(i + 1, n):
            p[j, i] = p[i, j]


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def reset_adjoint(adjoint: Array, error: Array, d: int) -> None:
    """``λ ← Gᵀ λ``, in place.

    Parameters
    ----------
    adjoint, error : array, shape (n,)
        λ, and what was injected.
    d : int
        States per segment.
    """
    for o in range(6, adjoint.shape[0], d):
        x, y, z = -0.5 * error[o], -0.5 * error[o + 1], -0.5 * error[o + 2]
        a, b, c = adjoint[o], adjoint[o + 1], adjoint[o + 2]
        adjoint[o] = a + z * b - y * c
        adjoint[o + 1] = b - z * a + x * c
        adjoint[o + 2] = c + y * a - x * b


@njit(cache=True, fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def retract_constraint(
    information: Array,
    adjoint: Array,
    first: int,
    second: int,
    d: int,
    jacobian: Array,
    gain: Array,
    weighted: Array,
    inverse: Array,
) -> None:
    """Adjoint of :func:`apply_constraint`, in place.

    ``λ ← (I − K H)ᵀ λ + Hᵀ S⁻¹ e`` and ``Λ ← (I − K H)ᵀ Λ (I − K H) + Hᵀ S⁻¹ H``; only rows and
    columns of the two segments change.

    Parameters
    ----------
    information, adjoint : array, shape (n, w) and (n,)
        Λ and λ.
    first, second, d, jacobian, gain, weighted, inverse
        As of :func:`apply_constraint`.
    """
    size, n = information.shape
    product = np.zeros((3, n))
    inner = inverse.copy()
    pull = weighted.copy()
    for i in range(size):
        k0, k1, k2 = gain[0, i], gain[1, i], gain[2, i]
        for k in range(n):
            product[0, k] += k0 * information[i, k]
            product[1, k] += k1 * information[i, k]
            product[2, k] += k2 * information[i, k]
        pull[0] -= k0 * adjoint[i]
        pull[1] -= k1 * adjoint[i]
        pull[2] -= k2 * adjoint[i]
    for a in range(3):
        for b in range(3):
            for k in range(size):
                inner[a, b] += product[a, k] * gain[b, k]
    # information −= Hᵀ M + Mᵀ H − Hᵀ (S⁻¹ + M K) H, with M = Kᵀ information
    for side in range(2 if second >= 0 else 1):
        o = d * (second if side else first)
        for c in range(d):
            for a in range(3):
                factor = jacobian[side, a, c]
                if factor != 0.0:
                    adjoint[o + c] += factor * pull[a]
                    for k in range(n):
                        information[o + c, k] -= factor * product[a, k]
                    for k in range(size):
                        information[k, o + c] -= factor * product[a, k]
    small = np.empty((2, 3, d))
    for side in range(2 if second >= 0 else 1):
        for a in range(3):
            for c in range(d):
                total = 0.0
                for b in range(3):
                    total += inner[a, b] * jacobian[side, b, c]
                small[side, a, c] = total
    for side in range(2 if second >= 0 else 1):
        o = d * (second if side else first)
        for c in range(d):
            for a in range(3):
                factor = jacobian[side, a, c]
                if factor != 0.0:
                    for other in range(2 if second >= 0 else 1):
                        q = d * (second if other else first)
                        for b in range(d):
                            information[o + c, q + b] += factor * small[other, a, b]
