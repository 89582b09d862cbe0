"""Signals of a point of a moving foot: rigid-body kinematics with analytic derivatives."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.simulate.foot_motion import FootPose
from swaystride.units import GRAVITY_M_S2

Array = NDArray[np.float64]


def r_world_from_foot(pose: FootPose) -> Array:
    """Orientation of the foot (x to the toes, y left, z up).

    Parameters
    ----------
    pose : FootPose
        Angles ψ, ρ, φ.

    Returns
    -------
    ndarray, shape (3, 3, n)
        ``Rz(ψ) Rx(ρ) Ry(−φ)``; the last axis is time.
    """
    cy, sy = np.cos(pose.heading_rad[0]), np.sin(pose.heading_rad[0])
    cr, sr = np.cos(pose.roll_rad[0]), np.sin(pose.roll_rad[0])
    cp, sp = np.cos(pose.pitch_rad[0]), np.sin(pose.pitch_rad[0])
    # Columns of Rx(ρ) Ry(−φ): where the axes of the foot point before the heading turns them.
    toes = (cp, -sr * sp, cr * sp)
    left = (np.zeros_like(cr), cr, sr)
    up = (-sp, -sr * cp, cr * cp)
    return np.stack(
        [np.stack([cy * a - sy * b, sy * a + cy * b, c]) for a, b, c in (toes, left, up)], axis=1
    )


def angular_velocity(pose: FootPose) -> tuple[Array, Array]:
    """Angular velocity and acceleration of the foot, in its own axes.

    Parameters
    ----------
    pose : FootPose
        Angles with two derivatives.

    Returns
    -------
    rad_s, rad_s2 : ndarray, shape (3, n)
    """
    heading, roll, pitch = pose.heading_rad, pose.roll_rad, pose.pitch_rad
    cr, sr = np.cos(roll[0]), np.sin(roll[0])
    cp, sp = np.cos(pitch[0]), np.sin(pitch[0])
    # u: turning of the heading and the roll in axes that roll with the foot but do not pitch.
    u = (roll[1], heading[1] * sr, heading[1] * cr)
    v = (
        roll[2],
        heading[2] * sr + heading[1] * cr * roll[1],
        heading[2] * cr - heading[1] * sr * roll[1],
    )
    omega = np.stack([cp * u[0] + sp * u[2], u[1] - pitch[1], cp * u[2] - sp * u[0]])
    alpha = np.stack(
        [
            cp * v[0] + sp * v[2] + pitch[1] * omega[2],
            v[1] - pitch[2],
            cp * v[2] - sp * v[0] - pitch[1] * omega[0],
        ]
    )
    return omega, alpha


def point_position(pose: FootPose, point_m: ArrayLike) -> Array:
    """Position of a point of the foot in the world.

    Parameters
    ----------
    pose : FootPose
        Motion of the foot.
    point_m : array_like, shape (3,)
        From the ankle, in axes of the foot.

    Returns
    -------
    ndarray, shape (3, n)
    """
    return np.asarray(
        pose.ankle_m[0] + np.einsum("ijn,j->in", r_world_from_foot(pose), np.asarray(point_m))
    )


def point_velocity(pose: FootPose, point_m: ArrayLike) -> Array:
    """Velocity of a point of the foot in the world.

    Parameters
    ----------
    pose : FootPose
        Motion of the foot.
    point_m : array_like, shape (3,) or (3, n)
        From the ankle, in axes of the foot.

    Returns
    -------
    ndarray, shape (3, n)
    """
    point = np.asarray(point_m, dtype=np.float64).reshape(3, -1)
    turning = cross(angular_velocity(pose)[0], point)
    return np.asarray(pose.ankle_m[1] + np.einsum("ijn,jn->in", r_world_from_foot(pose), turning))


def point_signals(pose: FootPose, point_m: ArrayLike) -> tuple[Array, Array]:
    """Ideal signals of an inertial sensor at a point of the foot, in axes of the foot.

    Parameters
    ----------
    pose : FootPose
        Motion of the foot.
    point_m : array_like, shape (3,)
        From the ankle, in axes of the foot.

    Returns
    -------
    acc_m_s2, gyr_rad_s : ndarray, shape (3, n)
        Proper acceleration (at rest up, of size g) and angular velocity.
    """
    point = np.asarray(point_m, dtype=np.float64)[:, None]
    omega, alpha = angular_velocity(pose)
    pull = pose.ankle_m[2].copy()
    pull[2] += GRAVITY_M_S2
    acc = np.einsum("ijn,in->jn", r_world_from_foot(pose), pull)
    acc += cross(alpha, point) + cross(omega, cross(omega, point))
    return acc, omega


def cross(a: Array, b: Array) -> Array:
    """Cross product along the first axis.

    Parameters
    ----------
    a, b : ndarray, shape (3, n)
        Vectors.
    """
    return np.stack(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )
