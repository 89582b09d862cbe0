"""What the participants wear: labels of the sensors, names of the markers, and what was measured."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import pandas as pd

from swaystride.lower_limb_joints import SEGMENTS
from swaystride.mocap.anthropometrics import Anthropometrics
from swaystride.mocap.marker_set import CONVENTIONAL_GAIT


@dataclass(frozen=True)
class SensorLabels:
    """Label of the sensor on each segment, as the vendor's file has it.

    Parameters
    ----------
    pelvis, right_thigh, left_thigh, right_shank, left_shank, right_foot, left_foot : str
    """

    pelvis: str
    right_thigh: str
    left_thigh: str
    right_shank: str
    left_shank: str
    right_foot: str
    left_foot: str

    def in_order(self) -> tuple[str, ...]:
        """Labels in the order of ``SEGMENTS``."""
        return tuple(getattr(self, segment) for segment in SEGMENTS)


@dataclass(frozen=True)
class Markers:
    """Markers beside those of the conventional set, and their size.

    Parameters
    ----------
    faces : SensorLabels
        Marker on the face of the sensor of each segment.
    marker_radius_m, base_plate_m : float
        Of the markers.
    """

    faces: SensorLabels
    marker_radius_m: float
    base_plate_m: float

    def names(self) -> tuple[str, ...]:
        """Markers that have to be there in motion."""
        return (*CONVENTIONAL_GAIT.motion_markers(), *self.faces.in_order())


def measured_lengths(
    person: pd.Series[float] | Mapping[str, float], markers: Markers
) -> Anthropometrics:
    """Lengths and widths of a participant.

    Parameters
    ----------
    person : Series or mapping
        Row of participants.tsv.
    markers : Markers

    Returns
    -------
    Anthropometrics
    """

    def pair(name: str) -> tuple[float, float]:
        return float(person[f"{name}_right_m"]), float(person[f"{name}_left_m"])

    return Anthropometrics(
        pair("leg_length"),
        pair("knee_width"),
        pair("ankle_width"),
        markers.marker_radius_m,
        markers.base_plate_m,
    )
