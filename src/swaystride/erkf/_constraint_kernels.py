"""Compiled models of the constraints: residual, Jacobian and noise of each kind.

Each model reads the states (one row per segment), their rotation matrices and the signals of the
sample, and writes

* ``residual`` (3,): what is measured minus what the state predicts;
* ``jacobian`` (2, 3, 12): derivatives of the prediction with respect to the errors of the first and
  of the second segment (position, velocity, rotation, bias), zero on entry;
and returns the variance of each component of the measurement.

A new kind needs its model here, a line in :func:`linearise` and a class in
:mod:`swaystride.erkf.constraints`.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from swaystride.erkf._rotation_kernels import times_skew

Array = NDArray[np.float64]
Index = NDArray[np.int64]

ZERO_VELOCITY, CONTACT_POINT, TILT, JOINT_CENTRE, JOINT_AXIS = range(5)


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def zero_velocity(state: Array, sd: Array, residual: Array, jacobian: Array) -> float:
    """``0 = v``."""
    for a in range(3):
        residual[a] = -state[3 + a]
        jacobian[0, a, 3 + a] = 1.0
    return float(sd[0] ** 2)


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def contact_point(
    state: Array, r: Array, rate: Array, lever: Array, sd: Array, residual: Array, jacobian: Array
) -> float:
    """``0 = v + R ((ω − b) × lever)``; the lever and the rate are uncertain themselves."""
    wx, wy, wz = rate[0] - state[10], rate[1] - state[11], rate[2] - state[12]
    x, y, z = lever[0], lever[1], lever[2]
    sx, sy, sz = wy * z - wz * y, wz * x - wx * z, wx * y - wy * x
    for a in range(3):
        residual[a] = -state[3 + a] - (r[a, 0] * sx + r[a, 1] * sy + r[a, 2] * sz)
        jacobian[0, a, 3 + a] = 1.0
    times_skew(r, sx, sy, sz, -1.0, jacobian[0, :, 6:9])
    times_skew(r, x, y, z, 1.0, jacobian[0, :, 9:12])
    square = x * x + y * y + z * z
    turning = wx * wx + wy * wy + wz * wz
    return float(sd[0] ** 2 + sd[1] ** 2 * turning + sd[2] ** 2 * square)


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def tilt(r: Array, acc: Array, sd: Array, residual: Array, jacobian: Array) -> float:
    """``a / |a| = Rᵀ e_z``: at rest the accelerometer points up."""
    size = math.sqrt(acc[0] ** 2 + acc[1] ** 2 + acc[2] ** 2)
    for a in range(3):
        residual[a] = acc[a] / size - r[2, a]
    jacobian[0, 0, 7], jacobian[0, 0, 8] = -r[2, 2], r[2, 1]
    jacobian[0, 1, 6], jacobian[0, 1, 8] = r[2, 2], -r[2, 0]
    jacobian[0, 2, 6], jacobian[0, 2, 7] = -r[2, 1], r[2, 0]
    return float(sd[0] ** 2)


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def _difference(r1: Array, r2: Array, vectors: Array, residual: Array, jacobian: Array) -> None:
    """``0 = R₁ u₁ − R₂ u₂``, the part that joint centre and joint axis share."""
    u = vectors
    for a in range(3):
        residual[a] = r2[a, 0] * u[3] + r2[a, 1] * u[4] + r2[a, 2] * u[5]
        residual[a] -= r1[a, 0] * u[0] + r1[a, 1] * u[1] + r1[a, 2] * u[2]
    times_skew(r1, u[0], u[1], u[2], -1.0, jacobian[0, :, 6:9])
    times_skew(r2, u[3], u[4], u[5], 1.0, jacobian[1, :, 6:9])


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def joint_centre(
    state1: Array,
    state2: Array,
    r1: Array,
    r2: Array,
    vectors: Array,
    sd: Array,
    residual: Array,
    jacobian: Array,
) -> float:
    """``0 = (p₁ + R₁ r₁) − (p₂ + R₂ r₂)``."""
    _difference(r1, r2, vectors, residual, jacobian)
    for a in range(3):
        residual[a] += state2[a] - state1[a]
        jacobian[0, a, a], jacobian[1, a, a] = 1.0, -1.0
    return float(sd[0] ** 2)


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def joint_axis(
    r1: Array, r2: Array, vectors: Array, sd: Array, residual: Array, jacobian: Array
) -> float:
    """``0 = R₁ e₁ − R₂ e₂``."""
    _difference(r1, r2, vectors, residual, jacobian)
    return float(sd[0] ** 2)


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def linearise(
    kind: int,
    first: int,
    second: int,
    vectors: Array,
    sd: Array,
    state: Array,
    rotation: Array,
    signals: Array,
    residual: Array,
    jacobian: Array,
) -> float:
    """Residual, Jacobian and variance of one constraint at one sample.

    Parameters
    ----------
    kind, first, second : int
        Which model; the segments that it touches (`second` is ignored by models of one segment).
    vectors : array, shape (6,)
        A vector in the frame of each segment.
    sd : array, shape (3,)
        Standard deviations; their meaning is the model's.
    state : array, shape (m, 13)
        Nominal states.
    rotation : array, shape (m, 3, 3)
        Their rotation matrices.
    signals : array, shape (m, 6)
        Accelerometers and gyroscopes.
    residual, jacobian : array, shape (3,) and (2, 3, 12)
        Overwritten.

    Returns
    -------
    float
        Variance of each of the three components.
    """
    jacobian[:] = 0.0
    x, r = state[first], rotation[first]
    if kind == ZERO_VELOCITY:
        variance = zero_velocity(x, sd, residual, jacobian)
    elif kind == CONTACT_POINT:
        variance = contact_point(x, r, signals[first, 3:6], vectors[0:3], sd, residual, jacobian)
    elif kind == TILT:
        variance = tilt(r, signals[first, 0:3], sd, residual, jacobian)
    elif kind == JOINT_CENTRE:
        variance = joint_centre(
            x, state[second], r, rotation[second], vectors, sd, residual, jacobian
        )
    else:
        variance = joint_axis(r, rotation[second], vectors, sd, residual, jacobian)
    return float(variance)
