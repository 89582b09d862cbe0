"""How the lumbar sensor of a standing person is worn, and what its radio link loses."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class SensorPlacement:
    """How the lumbar sensor sits on the body.

    Parameters
    ----------
    pendulum_height_ratio, sensor_height_ratio : float
        Height of the centre of mass and of the sensor above the ankle, over stature.
    sensor_behind_m : float
        Distance of the sensor behind the body's axis.
    tilt_sd_deg, heading_sd_deg : float
        Standard deviations of the mounting rotation, about each horizontal axis and about the
        vertical.

    Examples
    --------
    >>> placement = SensorPlacement(0.5, 0.6, 0.1, tilt_sd_deg=3.0, heading_sd_deg=3.0)
    >>> placement.pendulum_height_m(1.8), placement.position_m(1.75)
    (0.9, (-0.1, 0.0, 1.05))
    """

    pendulum_height_ratio: float
    sensor_height_ratio: float
    sensor_behind_m: float
    tilt_sd_deg: float
    heading_sd_deg: float

    def pendulum_height_m(self, height_m: float) -> float:
        """Height of the centre of mass above the ankle of a person of this stature."""
        return self.pendulum_height_ratio * height_m

    def position_m(self, height_m: float) -> tuple[float, float, float]:
        """Position of the sensor from the ankle: x forward, y left, z up."""
        return (-self.sensor_behind_m, 0.0, self.sensor_height_ratio * height_m)


@dataclass(frozen=True)
class RadioLoss:
    """What the radio link loses.

    Parameters
    ----------
    n_lost_trials : int
        Trials of the cohort whose link is lost: the file ends early or has a long hole.
    hole_share : float
        Probability that it is a hole.
    hole_s : tuple of float
        Shortest and longest hole.
    end_fraction : tuple of float
        Smallest and largest part of the trial that a file which ends early holds.
    few_packets_share : float
        Probability that any other trial loses one to `few_packets` single packets.
    few_packets : int
        See there.
    """

    n_lost_trials: int
    hole_share: float
    hole_s: tuple[float, float]
    end_fraction: tuple[float, float]
    few_packets_share: float
    few_packets: int
