"""The measurement model of the filter: one small object per constraint.

Every constraint predicts three components from the states of one or two segments; what is measured
is zero (or, for the tilt, the direction of the accelerometer). The formulas of the prediction and
of its derivatives stand side by side in :mod:`swaystride.erkf._constraint_kernels`. A constraint is
applied at the samples at which it is active.

To add one: its formula there, a class here with `model`, `segments`, `vectors` and `sd`, and its
place in :func:`constraints_of`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from swaystride.erkf._constraint_kernels import (
    CONTACT_POINT,
    JOINT_AXIS,
    JOINT_CENTRE,
    TILT,
    ZERO_VELOCITY,
    linearise,
)
from swaystride.erkf.body import Body, Joint
from swaystride.erkf.noise import NoiseSet
from swaystride.erkf.options import FilterOptions
from swaystride.rotations import matrix_from_quaternion

Array = NDArray[np.float64]


class Constraint(Protocol):
    """What the filter asks of a constraint."""

    @property
    def model(self) -> int:
        """Number of the formula in the kernel."""

    @property
    def segments(self) -> tuple[int, ...]:
        """One or two segments, in the order of the formula."""

    @property
    def vectors(self) -> tuple[Array, ...]:
        """Constant vectors in the frames of these segments."""

    @property
    def sd(self) -> tuple[float, ...]:
        """Up to three standard deviations; the first is that of each component."""


@dataclass(frozen=True, eq=False)
class ZeroVelocity:
    """``0 = v``: the sensor on a foot stands still."""

    model: ClassVar[int] = ZERO_VELOCITY
    foot: int
    velocity_sd_m_s: float
    vectors: ClassVar[tuple[Array, ...]] = ()

    @property
    def segments(self) -> tuple[int, ...]:
        """The foot."""
        return (self.foot,)

    @property
    def sd(self) -> tuple[float, ...]:
        """Of the velocity."""
        return (self.velocity_sd_m_s,)


@dataclass(frozen=True, eq=False)
class ContactPoint:
    """``0 = v + R ((ω − b) × lever)``: the contact point under the sensor stands still."""

    model: ClassVar[int] = CONTACT_POINT
    foot: int
    lever_m: Array
    velocity_sd_m_s: float
    lever_sd_m: float
    rate_sd_rad_s: float

    @property
    def segments(self) -> tuple[int, ...]:
        """The foot."""
        return (self.foot,)

    @property
    def vectors(self) -> tuple[Array, ...]:
        """The lever."""
        return (self.lever_m,)

    @property
    def sd(self) -> tuple[float, ...]:
        """Of velocity, lever and rate; C = sd₀² + sd₁² |ω|² + sd₂² |lever|²."""
        return (self.velocity_sd_m_s, self.lever_sd_m, self.rate_sd_rad_s)


@dataclass(frozen=True, eq=False)
class Tilt:
    """``a / |a| = Rᵀ e_z``: a segment at rest feels gravity alone."""

    model: ClassVar[int] = TILT
    segment: int
    direction_sd: float
    vectors: ClassVar[tuple[Array, ...]] = ()

    @property
    def segments(self) -> tuple[int, ...]:
        """The segment."""
        return (self.segment,)

    @property
    def sd(self) -> tuple[float, ...]:
        """Of the unit vector."""
        return (self.direction_sd,)


@dataclass(frozen=True, eq=False)
class JointCentre:
    """``0 = (p₁ + R₁ r₁) − (p₂ + R₂ r₂)``: two segments share a point."""

    model: ClassVar[int] = JOINT_CENTRE
    segments: tuple[int, int]
    vectors: tuple[Array, Array]
    distance_sd_m: float

    @property
    def sd(self) -> tuple[float, ...]:
        """Of each component of the distance."""
        return (self.distance_sd_m,)


@dataclass(frozen=True, eq=False)
class JointAxis:
    """``0 = R₁ e₁ − R₂ e₂``: two segments share a direction."""

    model: ClassVar[int] = JOINT_AXIS
    segments: tuple[int, int]
    vectors: tuple[Array, Array]
    chord_sd: float

    @property
    def sd(self) -> tuple[float, ...]:
        """Of each component of the difference of two unit vectors."""
        return (self.chord_sd,)


class Prediction(NamedTuple):
    """Result of :func:`linearised`."""

    residual: Array
    jacobian: Array
    variance: float


def linearised(constraint: Constraint, states: Array, signals: Array) -> Prediction:
    """One constraint at one sample, as the filter sees it.

    Parameters
    ----------
    constraint : Constraint
    states : ndarray, shape (n_segments, 13)
        Position, velocity, ``q_world_from_sensor`` and gyroscope bias.
    signals : ndarray, shape (n_segments, 6)
        Accelerometer and gyroscope.

    Returns
    -------
    Prediction
        ``residual`` (3,), measured minus predicted; ``jacobian`` (2, 3, 12) of the prediction with
        respect to the errors of both segments (position, velocity, rotation, bias); variance of
        each component.
    """
    residual, jacobian = np.empty(3), np.empty((2, 3, 12))
    kind, first, second, vectors, sd = as_row(constraint)
    rotation = matrix_from_quaternion(states[:, 6:10])
    variance = linearise(
        kind, first, second, vectors, sd, states, rotation, signals, residual, jacobian
    )
    return Prediction(residual, jacobian, variance)


def as_row(constraint: Constraint) -> tuple[int, int, int, Array, Array]:
    """Numbers that the kernel takes: model, first and second segment (−1: none), vectors, sd.

    Parameters
    ----------
    constraint : Constraint
    """
    vectors, sd = np.zeros(6), np.zeros(3)
    for place, vector in enumerate(constraint.vectors):
        vectors[3 * place : 3 * place + 3] = vector
    sd[: len(constraint.sd)] = constraint.sd
    second = constraint.segments[1] if len(constraint.segments) > 1 else -1
    return constraint.model, constraint.segments[0], second, vectors, sd


def constraints_of(
    body: Body,
    noise: NoiseSet,
    options: FilterOptions,
    rate_hz: float,
    zero_velocity: NDArray[np.bool_],
    still: NDArray[np.bool_] | None,
) -> tuple[list[Constraint], NDArray[np.bool_]]:
    """All constraints of a recording and when they are active.

    Parameters
    ----------
    body : Body
    noise : NoiseSet
    options : FilterOptions
    rate_hz : float
        Sampling rate.
    zero_velocity : ndarray of bool, shape (n_feet, n_samples)
        In the order of ``body.contact_levers_m``.
    still : ndarray of bool, shape (n_segments, n_samples), optional
        When the tilt of a segment is measured; None: never.

    Returns
    -------
    constraints : list of Constraint
    active : ndarray of bool, shape (n_samples, n_constraints)
    """
    n_samples = zero_velocity.shape[1]
    constraints: list[Constraint] = []
    active: list[NDArray[np.bool_]] = []
    rate_sd = noise.at_rate(noise.gyr_sd_rad_s, rate_hz)
    for (foot, lever), flags in zip(body.contact_levers_m.items(), zero_velocity, strict=True):
        place, velocity_sd = body.index(foot), noise.zero_velocity_sd_m_s
        if options.contact_point:
            constraints.append(
                ContactPoint(place, lever, velocity_sd, noise.contact_lever_sd_m, rate_sd)
            )
        else:
            constraints.append(ZeroVelocity(place, velocity_sd))
        active.append(flags)
    if still is not None:
        for segment in np.flatnonzero(still.any(axis=1)):
            constraints.append(Tilt(int(segment), noise.tilt_sd))
            active.append(still[segment])
    ticks = np.arange(n_samples) * min(1.0, (options.joint_rate_hz or rate_hz) / rate_hz)
    due = np.diff(np.floor(ticks + 1e-9), prepend=-1.0) > 0
    for joint in body.joints:
        own = _joint_constraints(joint, body, noise, options.joint_inflation(rate_hz))
        constraints += own
        active += [due] * len(own)
    return constraints, np.ascontiguousarray(np.stack(active, axis=1))


def _joint_constraints(
    joint: Joint, body: Body, noise: NoiseSet, inflation: float
) -> list[Constraint]:
    """Centre and, where there is one, axis of a joint."""
    pair = (body.index(joint.proximal), body.index(joint.distal))
    centre_sd = {
        "hip": noise.hip_centre_sd_m,
        "knee": noise.knee_centre_sd_m,
        "ankle": noise.ankle_centre_sd_m,
    }[joint.kind]
    centres = (joint.proximal_centre_m, joint.distal_centre_m)
    found: list[Constraint] = [JointCentre(pair, centres, inflation * centre_sd)]
    axis_sd = {"hip": noise.hip_axis_sd, "knee": noise.knee_axis_sd, "ankle": None}[joint.kind]
    if axis_sd is not None and joint.proximal_axis is not None and joint.distal_axis is not None:
        axes = (joint.proximal_axis, joint.distal_axis)
        found.append(JointAxis(pair, axes, inflation * axis_sd))
    return found
