"""Compiled quaternion arithmetic, inlined by the other kernels of this room.

Quaternions are scalar first, ``q_world_from_sensor``, and travel as tuples of four numbers. Numba
does not notice that a function in another file has changed: whoever edits this file deletes the
compiled files (``__pycache__``) of the room.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def turned(q: Quaternion, x: float, y: float, z: float, step_s: float) -> Quaternion:
    """Orientation after turning at a constant rate (sensor axes) for one step."""
    rate = math.sqrt(x * x + y * y + z * z)
    half = 0.5 * rate * step_s
    scale = math.sin(half) / rate if rate > 1e-12 else 0.5 * step_s
    c, x, y, z = math.cos(half), scale * x, scale * y, scale * z
    w0, x0, y0, z0 = q
    w1 = w0 * c - x0 * x - y0 * y - z0 * z
    x1 = w0 * x + x0 * c + y0 * z - z0 * y
    y1 = w0 * y - x0 * z + y0 * c + z0 * x
    z1 = w0 * z + x0 * y - y0 * x + z0 * c
    size = 1.0 / math.sqrt(w1 * w1 + x1 * x1 + y1 * y1 + z1 * z1)
    return w1 * size, x1 * size, y1 * size, z1 * size


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def tilted(q: Quaternion, x: float, y: float, z: float) -> Quaternion:
    """Orientation after a small rotation about world axes."""
    angle = math.sqrt(x * x + y * y + z * z)
    scale = math.sin(0.5 * angle) / angle if angle > 1e-12 else 0.5
    c, x, y, z = math.cos(0.5 * angle), scale * x, scale * y, scale * z
    w0, x0, y0, z0 = q
    return (
        c * w0 - x * x0 - y * y0 - z * z0,
        c * x0 + x * w0 + y * z0 - z * y0,
        c * y0 - x * z0 + y * w0 + z * x0,
        c * z0 + x * y0 - y * x0 + z * w0,
    )


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def rotated(q: Quaternion, x: float, y: float, z: float) -> Vector:
    """Vector in world axes."""
    w, a, b, c = q
    tx, ty, tz = 2.0 * (b * z - c * y), 2.0 * (c * x - a * z), 2.0 * (a * y - b * x)
    return (
        x + w * tx + b * tz - c * ty,
        y + w * ty + c * tx - a * tz,
        z + w * tz + a * ty - b * tx,
    )


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def matrix(q: Quaternion) -> Array:
    """Rotation matrix of a quaternion."""
    w, x, y, z = q
    out = np.empty((3, 3))
    out[0, 0], out[0, 1], out[0, 2] = (
        1 - 2 * (y * y + z * z),
        2 * (x * y - w * z),
        2 * (x * z + w * y),
    )
    out[1, 0], out[1, 1], out[1, 2] = (
        2 * (x * y + w * z),
        1 - 2 * (x * x + z * z),
        2 * (y * z - w * x),
    )
    out[2, 0], out[2, 1], out[2, 2] = (
        2 * (x * z - w * y),
        2 * (y * z + w * x),
        1 - 2 * (x * x + y * y),
    )
    return out


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def skew(v: Array) -> Array:
    """Matrix of the cross product with a vector."""
    out = np.zeros((3, 3))
    out[0, 1], out[0, 2], out[1, 2] = -v[2], v[1], -v[0]
    out[1, 0], out[2, 0], out[2, 1] = v[2], -v[1], v[0]
    return out
