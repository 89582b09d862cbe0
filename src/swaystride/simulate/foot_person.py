"""Feet of one person: soles, manner of walking and running, and where the sensors sit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from swaystride.rotations import exp_map
from swaystride.simulate.sole import Sole, SoleEdge
from swaystride.units import RAD_PER_DEG

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SoleShape:
    """Shape of a shod foot; lengths are shares of the foot length.

    Parameters
    ----------
    foot_length : float
        Foot length over stature.
    length_log_sd : float
        Scatter of the logarithm of the foot length.
    ankle_height : float
        Ankle over the sole.
    heel_behind : float
        End of the flat part of the sole behind the ankle.
    flat_length, toe_length, heel_length : float
        Length of the flat part, of the rocker under the toes and of the bevel of the heel.
    flat_half_width_deg : float
        The flat part is rolled over within ± this pitch.
    toe_angle_deg, toe_half_width_deg, heel_angle_deg, heel_half_width_deg : float
        Pitch at which rocker and bevel lie on the ground, and ± the pitch over which they do.
    corner_radius_m : float
        Radius of the corners.
    """

    foot_length: float
    length_log_sd: float
    ankle_height: float
    heel_behind: float
    flat_length: float
    toe_length: float
    heel_length: float
    flat_half_width_deg: float
    toe_angle_deg: float
    toe_half_width_deg: float
    heel_angle_deg: float
    heel_half_width_deg: float
    corner_radius_m: float

    def sole(self, foot_length_m: float) -> Sole:
        """Sole of a foot of this length.

        Parameters
        ----------
        foot_length_m : float
            Length.
        """
        edges = (
            _edge(self.heel_angle_deg, self.heel_length * foot_length_m, self.heel_half_width_deg),
            _edge(0.0, self.flat_length * foot_length_m, self.flat_half_width_deg),
            _edge(self.toe_angle_deg, self.toe_length * foot_length_m, self.toe_half_width_deg),
        )
        ahead = self.flat_length / 2.0 - self.heel_behind
        return Sole(
            edges,
            corner_radius_m=self.corner_radius_m,
            ankle_height_m=self.ankle_height * foot_length_m,
            contact_ahead_m=ahead * foot_length_m,
        )


def _edge(angle_deg: float, length_m: float, half_width_deg: float) -> SoleEdge:
    return SoleEdge(angle_deg * RAD_PER_DEG, length_m, half_width_deg * RAD_PER_DEG)


@dataclass(frozen=True)
class FootSensorPlacement:
    """Where two sensors, strapped together, sit on the dorsum of the foot.

    Parameters
    ----------
    ahead_m, ahead_sd_m : float
        Distance ahead of the ankle: mean, and scatter between feet.
    height_m : tuple of float
        Lowest and highest height of the first sensor over the sole, between persons.
    aside_sd_m : float
        Scatter of the distance from the midline of the foot.
    slope_deg : float
        The dorsum falls towards the toes by this angle.
    second_offset_m : tuple of float
        From the first to the second sensor in axes of the sensor.
    tilt_sd_deg, heading_sd_deg : float
        Scatter of the mounting about each horizontal axis, and about the vertical.
    """

    ahead_m: float
    ahead_sd_m: float
    height_m: tuple[float, float]
    aside_sd_m: float
    slope_deg: float
    second_offset_m: tuple[float, float, float]
    tilt_sd_deg: float
    heading_sd_deg: float


@dataclass(frozen=True)
class PersonScatter:
    """Scatter of the manner of walking and running between persons.

    Parameters
    ----------
    reference_height_m : float
        Stature to which the stride times of the anchors belong.
    stride_time_log_sd, impact_log_sd, arrest_log_sd, quiet_rate_log_sd, rise_log_sd : float
        Of the logarithms of factors on the anchors.
    contact_pitch_sd_deg, toe_off_pitch_sd_deg, swing_pitch_sd_deg, toe_out_sd_deg : float
        Of what is added to the anchors.
    foot_share : float
        Scatter between the two feet of a person over that between persons.
    """

    reference_height_m: float
    stride_time_log_sd: float
    impact_log_sd: float
    arrest_log_sd: float
    quiet_rate_log_sd: float
    rise_log_sd: float
    contact_pitch_sd_deg: float
    toe_off_pitch_sd_deg: float
    swing_pitch_sd_deg: float
    toe_out_sd_deg: float
    foot_share: float


@dataclass(frozen=True)
class FootManner:
    """How one foot of one person differs from the anchors.

    Parameters
    ----------
    impact, arrest, quiet_rate, rise : float
        Factors.
    contact_pitch_rad, toe_off_pitch_rad, swing_pitch_rad, toe_out_rad : float
        Added.
    """

    impact: float
    arrest: float
    quiet_rate: float
    rise: float
    contact_pitch_rad: float
    toe_off_pitch_rad: float
    swing_pitch_rad: float
    toe_out_rad: float


@dataclass(frozen=True)
class Foot:
    """One foot with its shoe and both sensors.

    Parameters
    ----------
    side : str
        ``left`` or ``right``.
    sole : Sole
        Of the shoe.
    manner : FootManner
        How it moves.
    sensor_m : ndarray, shape (2, 3)
        Both sensors from the ankle, in axes of the foot.
    r_sensor_from_foot : ndarray, shape (3, 3)
        Mounting of both.
    """

    side: str
    sole: Sole
    manner: FootManner
    sensor_m: Array
    r_sensor_from_foot: Array

    @property
    def right(self) -> float:
        """1 for a right foot, −1 for a left one."""
        return 1.0 if self.side == "right" else -1.0


@dataclass(frozen=True)
class Person:
    """Both feet of a person.

    Parameters
    ----------
    stride_time : float
        Stride time over that of the anchors.
    feet : tuple of Foot
        Left and right.
    """

    stride_time: float
    feet: tuple[Foot, Foot]


def draw_person(
    height_m: float,
    *,
    shape: SoleShape,
    placement: FootSensorPlacement,
    scatter: PersonScatter,
    rng: np.random.Generator,
) -> Person:
    """Draw the feet of one person.

    Parameters
    ----------
    height_m : float
        Stature.
    shape : SoleShape
        Of the shoes.
    placement : FootSensorPlacement
        Of the sensors.
    scatter : PersonScatter
        Between persons.
    rng : numpy.random.Generator
        Source of the numbers.

    Returns
    -------
    Person
    """
    length = shape.foot_length * height_m * np.exp(shape.length_log_sd * rng.standard_normal())
    sole = shape.sole(float(length))
    # Longer legs swing more slowly, as a pendulum does.
    stride_time = np.sqrt(height_m / scatter.reference_height_m) * np.exp(
        scatter.stride_time_log_sd * rng.standard_normal()
    )
    own = rng.standard_normal(8)
    sensor_height_m = rng.uniform(*placement.height_m)
    feet = []
    for side in ("left", "right"):
        z = own + scatter.foot_share * rng.standard_normal(8)
        manner = FootManner(
            impact=float(np.exp(scatter.impact_log_sd * z[0])),
            arrest=float(np.exp(scatter.arrest_log_sd * z[1])),
            quiet_rate=float(np.exp(scatter.quiet_rate_log_sd * z[2])),
            rise=float(np.exp(scatter.rise_log_sd * z[3])),
            contact_pitch_rad=float(scatter.contact_pitch_sd_deg * z[4]) * RAD_PER_DEG,
            toe_off_pitch_rad=float(scatter.toe_off_pitch_sd_deg * z[5]) * RAD_PER_DEG,
            swing_pitch_rad=float(scatter.swing_pitch_sd_deg * z[6]) * RAD_PER_DEG,
            toe_out_rad=float(scatter.toe_out_sd_deg * z[7]) * RAD_PER_DEG,
        )
        mounting = _mounting(placement, rng)
        ahead = placement.ahead_m + placement.ahead_sd_m * rng.standard_normal()
        aside = placement.aside_sd_m * rng.standard_normal()
        first = np.array([ahead, aside, sensor_height_m - sole.ankle_height_m])
        second = first + mounting.T @ np.asarray(placement.second_offset_m)
        feet.append(Foot(side, sole, manner, np.stack([first, second]), mounting))
    return Person(float(stride_time), (feet[0], feet[1]))


def _mounting(placement: FootSensorPlacement, rng: np.random.Generator) -> Array:
    """Rotation ``r_sensor_from_foot``: down the slope of the dorsum, and a random rotation."""
    random_deg = rng.standard_normal(3) * [
        placement.tilt_sd_deg,
        placement.tilt_sd_deg,
        placement.heading_sd_deg,
    ]
    slope = exp_map([0.0, placement.slope_deg * RAD_PER_DEG, 0.0])
    return np.asarray(exp_map(random_deg * RAD_PER_DEG) @ slope.T)
