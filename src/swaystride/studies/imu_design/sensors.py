"""What the makers of the two IMUs say about them (Table 1)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from swaystride.configuration import from_mapping
from swaystride.studies.imu_design.design import IMUS, Imu


@dataclass(frozen=True)
class SensorSpecification:
    """What the maker says about one IMU (Table 1).

    Parameters
    ----------
    model, manufacturer : str
    accelerometer_range_g : float
    gyro_range_deg_s : float
    """

    model: str
    manufacturer: str
    accelerometer_range_g: float
    gyro_range_deg_s: float


def sensor_specifications(values: Mapping[str, Any]) -> dict[Imu, SensorSpecification]:
    """Specifications by IMU from the configuration.

    Parameters
    ----------
    values : mapping
        Section ``analysis.sensors``.
    """
    return {
        imu: from_mapping(SensorSpecification, values[imu], place=f"analysis.sensors.{imu}")
        for imu in IMUS
    }
