"""Compiled rotation arithmetic of the filter, inlined by the other kernels of this room.

Rotations are 3×3 arrays that the caller provides; quaternions are scalar first,
``q_world_from_sensor``. Numba does not notice that a function in another file has changed: whoever
edits a kernel deletes the compiled files (``__pycache__``) of the room.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def exponential(x: float, y: float, z: float, out: Array) -> None:
    """Rotation matrix of a rotation vector."""
    square = x * x + y * y + z * z
    if square < 1e-8:
        s, c = 1.0 - square / 6.0, 0.5 - square / 24.0
    else:
        angle = math.sqrt(square)
        s, c = math.sin(angle) / angle, (1.0 - math.cos(angle)) / square
    _series(x, y, z, square, s, c, out)


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def right_jacobian(x: float, y: float, z: float, out: Array) -> None:
    """J in ``Exp(φ + d) = Exp(φ) Exp(J d)`` for small d."""
    square = x * x + y * y + z * z
    if square < 1e-8:
        s, c = -0.5 + square / 24.0, 1.0 / 6.0 - square / 120.0
    else:
        angle = math.sqrt(square)
        s = -(1.0 - math.cos(angle)) / square
        c = (angle - math.sin(angle)) / (angle * square)
    _series(x, y, z, square, s, c, out)


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def _series(x: float, y: float, z: float, square: float, s: float, c: float, out: Array) -> None:
    """``I + s [φ]× + c [φ]×²``."""
    diagonal = 1.0 - c * square
    out[0, 0], out[0, 1], out[0, 2] = diagonal + c * x * x, c * x * y - s * z, c * x * z + s * y
    out[1, 0], out[1, 1], out[1, 2] = c * x * y + s * z, diagonal + c * y * y, c * y * z - s * x
    out[2, 0], out[2, 1], out[2, 2] = c * x * z - s * y, c * y * z + s * x, diagonal + c * z * z


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def turn(q: Array, x: float, y: float, z: float) -> None:
    """Multiply a quaternion from the right by a rotation vector (sensor axes), in place."""
    square = x * x + y * y + z * z
    if square < 1e-8:
        c, s = 1.0 - square / 8.0, 0.5 - square / 48.0
    else:
        angle = math.sqrt(square)
        c, s = math.cos(0.5 * angle), math.sin(0.5 * angle) / angle
    x, y, z = s * x, s * y, s * z
    w0, x0, y0, z0 = q[0], q[1], q[2], q[3]
    w = w0 * c - x0 * x - y0 * y - z0 * z
    a = w0 * x + x0 * c + y0 * z - z0 * y
    b = w0 * y - x0 * z + y0 * c + z0 * x
    d = w0 * z + x0 * y - y0 * x + z0 * c
    size = 1.0 / math.sqrt(w * w + a * a + b * b + d * d)
    q[0], q[1], q[2], q[3] = w * size, a * size, b * size, d * size


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def to_matrix(q: Array, out: Array) -> None:
    """Rotation matrix of a unit quaternion."""
    w, x, y, z = q[0], q[1], q[2], q[3]
    out[0, 0], out[0, 1] = 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z)
    out[0, 2], out[1, 0] = 2.0 * (x * z + w * y), 2.0 * (x * y + w * z)
    out[1, 1], out[1, 2] = 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)
    out[2, 0], out[2, 1] = 2.0 * (x * z - w * y), 2.0 * (y * z + w * x)
    out[2, 2] = 1.0 - 2.0 * (x * x + y * y)


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def times_skew(r: Array, x: float, y: float, z: float, scale: float, out: Array) -> None:
    """``scale · R [u]×`` for the vector u = (x, y, z)."""
    for a in range(3):
        out[a, 0] = scale * (r[a, 1] * z - r[a, 2] * y)
        out[a, 1] = scale * (r[a, 2] * x - r[a, 0] * z)
        out[a, 2] = scale * (r[a, 0] * y - r[a, 1] * x)


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def multiply(a: Array, b: Array, scale: float, out: Array) -> None:
    """``scale · A B`` of 3×3 matrices."""
    for i in range(3):
        for j in range(3):
            out[i, j] = scale * (a[i, 0] * b[0, j] + a[i, 1] * b[1, j] + a[i, 2] * b[2, j])
