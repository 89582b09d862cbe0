"""A foot that walks in closed form: a wheel in stance, a polynomial in swing.

In stance the sole is a wheel of radius `height_m` with the sensor in its centre: it turns at
`roll_rad_s` and moves at `roll_rad_s * height_m`, and its contact point stands still. In swing,
position and pitch follow polynomials that match position, velocity and acceleration at both ends.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from swaystride.units import GRAVITY_M_S2


@dataclass(frozen=True)
class Walk:
    """Signals of one foot and the truth about them; time runs along the last axis."""

    rate_hz: float
    acc: np.ndarray
    gyr: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    matrix: np.ndarray
    stances: np.ndarray


def blend(u, start, slope0, stop, slope1):
    """Quintic with given values and slopes and no curvature at the ends, with two derivatives."""
    d = stop - start
    c = [
        start,
        slope0,
        0.0,
        10 * d - 6 * slope0 - 4 * slope1,
        -15 * d + 8 * slope0 + 7 * slope1,
        6 * d - 3 * slope0 - 3 * slope1,
    ]
    p = np.polynomial.Polynomial(c)
    return p(u), p.deriv(1)(u), p.deriv(2)(u)


def walk(
    *,
    n_strides=8,
    stride_m=1.4,
    stride_s=1.1,
    stance_s=0.4,
    rest_s=1.5,
    rate_hz=200.0,
    roll_rad_s=0.0,
    height_m=0.08,
    turn_rad_s=0.0,
    mounting=None,
):
    """Walk from rest to rest; `turn_rad_s` turns the heading all the time while walking.

    Each period is half a stance, a swing, half a stance. The first and last half stances do not
    roll, so that the foot starts and stops at rest.
    """
    swing_s = stride_s - stance_s
    duration = 2 * rest_s + n_strides * stride_s
    time = np.arange(round(duration * rate_hz) + 1) / rate_hz
    x, z, pitch = (np.zeros((3, time.size)) for _ in range(3))
    since = time - rest_s
    number = np.clip(np.floor(since / stride_s), 0, n_strides - 1).astype(int)
    for stride in range(n_strides):
        own = (number == stride) & (since >= 0) & (since <= n_strides * stride_s)
        tau = since[own] - stride * stride_s
        roll0 = roll_rad_s if stride > 0 else 0.0
        roll1 = roll_rad_s if stride < n_strides - 1 else 0.0
        before, after = tau < stance_s / 2, tau > stance_s / 2 + swing_s
        a = roll0 * np.minimum(tau, stance_s / 2)
        b = roll1 * (np.maximum(tau, stance_s / 2 + swing_s) - stride_s)
        u = np.clip((tau - stance_s / 2) / swing_s, 0.0, 1.0)
        half = stance_s / 2
        for out, scale, travel, bump in ((x, height_m, stride_m, 0.0), (pitch, 1.0, 0.0, 215.0)):
            v0, v1 = scale * roll0, scale * roll1
            p, dp, ddp = blend(u, v0 * half, v0 * swing_s, travel - v1 * half, v1 * swing_s)
            # the heel rises first, then the toes: the pitch turns fast in the middle of the swing
            w = bump * np.polynomial.Polynomial([0, 1, -1]) ** 3 * np.polynomial.Polynomial([1, -2])
            p, dp, ddp = p + w(u), dp + w.deriv(1)(u), ddp + w.deriv(2)(u)
            value = np.where(before, scale * a, np.where(after, travel + scale * b, p))
            rate = np.where(before, v0, np.where(after, v1, dp / swing_s))
            accel = np.where(before | after, 0.0, ddp / swing_s**2)
            out[:, own] = np.stack([value, rate, accel])
        w = np.polynomial.Polynomial([0, 1, -1]) ** 3 * 8.0
        z[:, own] = np.stack([w(u), w.deriv(1)(u) / swing_s, w.deriv(2)(u) / swing_s**2])
        z[1:, own] *= ~(before | after)
        x[0, own] += stride * stride_m
    x[0, since > n_strides * stride_s] = n_strides * stride_m
    moving = (since > 0) & (since < n_strides * stride_s)
    heading = turn_rad_s * np.clip(since, 0, n_strides * stride_s)
    # the path bends with the heading: integrate along it by a fine sum of circular arcs
    cosine, sine = np.cos(heading), np.sin(heading)
    turning = turn_rad_s * moving
    velocity = np.stack([x[1] * cosine, x[1] * sine, z[1]])
    accel = np.stack(
        [
            x[2] * cosine - x[1] * turning * sine,
            x[2] * sine + x[1] * turning * cosine,
            z[2],
        ]
    )
    if turn_rad_s:
        step = 0.5 / rate_hz * (velocity[:, 1:] + velocity[:, :-1])
        position = np.concatenate([np.zeros((3, 1)), np.cumsum(step, axis=1)], axis=1)
    else:
        position = np.stack([x[0], np.zeros_like(time), z[0]])
    r_world_from_foot = Rotation.from_euler("ZY", np.stack([heading, pitch[0]], axis=1)).as_matrix()
    gyr_foot = np.stack([-turning * np.sin(pitch[0]), pitch[1], turning * np.cos(pitch[0])])
    force = accel + np.array([[0.0], [0.0], [GRAVITY_M_S2]])
    acc_foot = np.einsum("nij,in->jn", r_world_from_foot, force)
    r = np.eye(3) if mounting is None else mounting
    stances = np.array([rest_s + k * stride_s for k in range(1, n_strides)])
    return Walk(
        rate_hz,
        r @ acc_foot,
        r @ gyr_foot,
        position,
        velocity,
        r_world_from_foot @ r.T,
        np.round(stances * rate_hz).astype(int),
    )
