"""Compiled arithmetic of jets: a value with its first and second derivative in time.

A jet is a tuple (x, x', x''). Whatever is computed with jets is differentiated exactly, by the
chain rule and not by differences. The compiler does not see that a function of this module has
changed: whoever edits it deletes the compiled files of the kernels that use it.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Jet = tuple[float, float, float]


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def quintic(c: Array, i: int, j: int, k: int, u: float) -> Jet:
    """Quintic polynomial whose coefficients of the powers 0 to 5 are ``c[i, j, k:]``."""
    c0, c1, c2 = c[i, j, k], c[i, j, k + 1], c[i, j, k + 2]
    c3, c4, c5 = c[i, j, k + 3], c[i, j, k + 4], c[i, j, k + 5]
    value = ((((c5 * u + c4) * u + c3) * u + c2) * u + c1) * u + c0
    first = (((5 * c5 * u + 4 * c4) * u + 3 * c3) * u + 2 * c2) * u + c1
    second = ((20 * c5 * u + 12 * c4) * u + 6 * c3) * u + 2 * c2
    return value, first, second


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def add(a: Jet, b: Jet) -> Jet:
    """Sum."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def sub(a: Jet, b: Jet) -> Jet:
    """Difference."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def scaled(a: Jet, factor: float) -> Jet:
    """Multiple."""
    return factor * a[0], factor * a[1], factor * a[2]


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def mul(a: Jet, b: Jet) -> Jet:
    """Product."""
    return a[0] * b[0], a[1] * b[0] + a[0] * b[1], a[2] * b[0] + 2 * a[1] * b[1] + a[0] * b[2]


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def chain(a: Jet, value: float, first: float, second: float) -> Jet:
    """Function of a jet, from its value and its two derivatives there."""
    return value, first * a[1], first * a[2] + second * a[1] * a[1]


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def over(a: Jet, b: Jet) -> Jet:
    """Quotient."""
    inverse = 1.0 / b[0]
    result: Jet = mul(a, chain(b, inverse, -(inverse**2), 2 * inverse**3))
    return result


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def root(a: Jet) -> Jet:
    """Square root."""
    value = math.sqrt(a[0])
    result: Jet = chain(a, value, 0.5 / value, -0.25 / (value * a[0]))
    return result


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def sine_cosine(a: Jet) -> tuple[Jet, Jet]:
    """Sine and cosine."""
    s, c = math.sin(a[0]), math.cos(a[0])
    return chain(a, s, c, -s), chain(a, c, -s, -c)


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def arcsine(a: Jet) -> Jet:
    """Angle within ±π/2 that has this sine."""
    x = a[0]
    slope = 1.0 / math.sqrt(1.0 - x * x)
    result: Jet = chain(a, math.asin(x), slope, x * slope**3)
    return result


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def arctangent(y: Jet, x: Jet) -> Jet:
    """Angle of the point (x, y), within ±π."""
    square = x[0] * x[0] + y[0] * y[0]
    rate = (x[0] * y[1] - y[0] * x[1]) / square
    second = (x[0] * y[2] - y[0] * x[2]) / square
    growth = 2.0 * (x[0] * x[1] + y[0] * y[1]) / square
    return math.atan2(y[0], x[0]), rate, second - rate * growth


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def smooth_step(a: Jet) -> Jet:
    """From 0 to 1 with least jerk while the argument goes from 0 to 1; its end values beyond."""
    x = a[0]
    if x <= 0.0:
        return 0.0, 0.0, 0.0
    if x >= 1.0:
        return 1.0, 0.0, 0.0
    value = x * x * x * (10.0 + x * (-15.0 + 6.0 * x))
    y = x * (1.0 - x)
    result: Jet = chain(a, value, 30.0 * y * y, 60.0 * y * (1.0 - 2.0 * x))
    return result
