"""Motion of one foot: rolling in closed form, smooth swings, a sharp arrest.

The foot is a rigid body. With heading ψ, roll ρ and pitch φ (toes up positive)

    r_world_from_foot = Rz(ψ) Rx(ρ) Ry(−φ).

From first touch to last touch the sole, a convex blade, rolls without slip along its heading; it
leans by ρ about the line of its contact. With the support function s the ankle is at

    (x₀ − ∫ s dφ, −s sin ρ, s cos ρ)

along the heading, to the left and up: closed form, and the touching point of the sole is at rest.
At first touch the ankle is faster than rolling by Δv. A raised cosine of deceleration takes that
away within the arrest T, during which the shoe gives way by Δv·T/2. Pitch, roll and the swing of
the ankle are quintic pieces that continue value, velocity and acceleration.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.simulate.foot_spline import PiecewiseQuintic
from swaystride.simulate.foot_stances import FootStances
from swaystride.simulate.sole import Sole

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FootPose:
    """Position and angles of the foot with two derivatives.

    Parameters
    ----------
    ankle_m : ndarray, shape (3, 3, n)
        Position, velocity, acceleration; x forward, y left, z up.
    heading_rad, roll_rad, pitch_rad : ndarray, shape (3, n)
        Angle, rate, acceleration.
    """

    ankle_m: Array
    heading_rad: Array
    roll_rad: Array
    pitch_rad: Array


@dataclass(frozen=True)
class FootMotion:
    """Motion of one foot over a trial.

    Parameters
    ----------
    sole : Sole
        Its sole.
    stances : FootStances
        Where and how it stands.
    pitch, roll, heading : PiecewiseQuintic
        The angles.
    swing : tuple of PiecewiseQuintic
        Coordinates of the ankle between toe-off and contact, one piece at least per swing.
    excess_m_s : ndarray, shape (3, n_stances)
        Velocity of the ankle at first touch beyond that of rolling.
    """

    sole: Sole
    stances: FootStances
    pitch: PiecewiseQuintic
    roll: PiecewiseQuintic
    heading: PiecewiseQuintic
    swing: tuple[PiecewiseQuintic, PiecewiseQuintic, PiecewiseQuintic]
    excess_m_s: Array

    def pose(self, time_s: ArrayLike) -> FootPose:
        """Where the foot is at any times.

        Parameters
        ----------
        time_s : array_like, shape (n,)
            Times.

        Returns
        -------
        FootPose
        """
        time = np.asarray(time_s, dtype=np.float64)
        pitch, roll, heading = self.pitch(time), self.roll(time), self.heading(time)
        stances = self.stances
        stance = np.searchsorted(stances.contact_s[1:], time, side="right")
        swinging = time >= np.where(np.isnan(stances.toe_off_s), np.inf, stances.toe_off_s)[stance]
        ankle = np.empty((3, 3, len(time)))
        for axis, coordinate in enumerate(self.swing):
            ankle[:, axis, swinging] = coordinate(time[swinging])
        standing = ~swinging
        stance, time = stance[standing], time[standing]
        place = np.stack([stances.x_m[stance], stances.y_m[stance]])
        rolling = rolling_ankle(
            self.sole, pitch[:, standing], roll[:, standing], heading[0, standing], place
        )
        since = time - np.where(np.isnan(stances.contact_s), -np.inf, stances.contact_s)[stance]
        duration = np.where(np.isnan(stances.arrest_s), 0.0, stances.arrest_s)[stance]
        early = since < duration
        rolling[:, :, early] += arrest(
            self.excess_m_s[:, stance[early]], since[early], duration[early]
        )
        ankle[:, :, standing] = rolling
        return FootPose(ankle, heading, roll, pitch)


def rolling_ankle(
    sole: Sole, pitch: ArrayLike, roll: ArrayLike, heading_rad: ArrayLike, place_m: ArrayLike
) -> Array:
    """Position, velocity and acceleration of the ankle of a rolling foot.

    Parameters
    ----------
    sole : Sole
        Its sole.
    pitch, roll : array_like, shape (3, n)
        Angle, rate, acceleration.
    heading_rad : array_like, shape (n,)
        Direction of the foot, constant while it rolls.
    place_m : array_like, shape (2, n)
        Where the ankle of the level foot is.

    Returns
    -------
    ndarray, shape (3, 3, n)
        Derivative, axis, sample.
    """
    (angle, rate, acceleration), (lean, lean_rate, lean_acc) = np.asarray(pitch), np.asarray(roll)
    integral, s, s1, s2 = sole.rolling(angle)
    s_rate = s1 * rate
    s_acc = s2 * rate * rate + s1 * acceleration
    sine, cosine = np.sin(lean), np.cos(lean)
    # The three coordinates of the ankle along the heading, to the left, and up.
    along = (-integral, -s * rate, -s_rate * rate - s * acceleration)
    turn = lean_rate * lean_rate
    left = (
        -s * sine,
        -s_rate * sine - s * cosine * lean_rate,
        -s_acc * sine - 2 * s_rate * cosine * lean_rate + s * (sine * turn - cosine * lean_acc),
    )
    up = (
        s * cosine,
        s_rate * cosine - s * sine * lean_rate,
        s_acc * cosine - 2 * s_rate * sine * lean_rate - s * (cosine * turn + sine * lean_acc),
    )
    c, n = np.cos(heading_rad), np.sin(heading_rad)
    ankle = np.stack(
        [
            np.stack([c * a - n * b, n * a + c * b, h])
            for a, b, h in zip(along, left, up, strict=True)
        ]
    )
    ankle[0, :2] += place_m
    return ankle


def arrest(excess_m_s: ArrayLike, since_s: ArrayLike, duration_s: ArrayLike) -> Array:
    """Motion beyond rolling while a raised cosine of deceleration takes the excess velocity away.

    Parameters
    ----------
    excess_m_s : array_like, shape (3, n)
        Excess velocity at first touch.
    since_s, duration_s : array_like, shape (n,)
        Time since first touch, at most the duration of the arrest.

    Returns
    -------
    ndarray, shape (3, 3, n)
        Derivative, axis, sample; all zero at the end of the arrest. At first touch the position is
        minus half the excess velocity times the duration, the acceleration is zero.
    """
    excess, since, duration = (np.asarray(a) for a in (excess_m_s, since_s, duration_s))
    turn = 2.0 * np.pi * since / duration
    quarter = duration / (4.0 * np.pi**2)
    position = since - since**2 / (2 * duration) - duration / 2 + quarter * (1.0 - np.cos(turn))
    velocity = 1.0 - since / duration + np.sin(turn) / (2.0 * np.pi)
    acceleration = -(1.0 - np.cos(turn)) / duration
    return np.stack([position * excess, velocity * excess, acceleration * excess])
