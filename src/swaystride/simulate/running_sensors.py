"""Inertial sensors worn by a runner: where they sit, and how they are put on."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.rotations import exp_map
from swaystride.simulate.inertial_sensor import (
    OPAL_HIGH_RANGE,
    SensorModel,
    SensorUnit,
    draw_unit,
)
from swaystride.simulate.running_body import SEGMENTS, RunnerBody
from swaystride.simulate.running_tissue import SkinPoints, TissueSize, skin_points
from swaystride.units import GRAVITY_M_S2, RAD_PER_DEG

Array = NDArray[np.float64]

#: APDM Opal with its ±16 g accelerometer, spec §9.1, table "Sensor errors": noise 120 µg/√Hz [M].
OPAL_LOW_RANGE: Final = replace(
    OPAL_HIGH_RANGE,
    acc_range_m_s2=16.0 * GRAVITY_M_S2,
    acc_noise_density_m_s2_rthz=120e-6 * GRAVITY_M_S2,
)

#: Nominal axes of a sensor: x forward, y left, z up, when the person stands.
R_NOMINAL_FROM_SEGMENT: Final = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


@dataclass(frozen=True)
class SensorPlace:
    """Where a sensor sits.

    Parameters
    ----------
    name : str
        Of the sensor.
    segment : int
        Row of :data:`~swaystride.simulate.running_body.SEGMENTS`.
    ahead_m, up_m, outward_m : float
        From the origin of the segment; outward is to the right on right limbs, to the left on left
        ones.
    up_share : float
        Added to `up_m`, in lengths of the segment.
    high_range : bool
        Whether it has the ±200 g accelerometer.
    """

    name: str
    segment: int
    ahead_m: float
    up_m: float
    up_share: float
    outward_m: float
    high_range: bool


@cache
def sensor_places() -> dict[str, SensorPlace]:
    """The 13 places of the source, from ``running_sensors.csv`` in this folder."""
    return read_places("running_sensors.csv")


def read_places(file: str) -> dict[str, SensorPlace]:
    """Places on the body from a table in this folder.

    Parameters
    ----------
    file : str
        Name of the table: the name of the place in the first column, then the fields of
        :class:`SensorPlace`; without a column ``high_range`` there is no such range.
    """
    table = pd.read_csv(Path(__file__).with_name(file), index_col=0)
    return {
        str(name): SensorPlace(
            name=str(name),
            segment=SEGMENTS.index(row["segment"]),
            ahead_m=float(row["ahead_m"]),
            up_m=float(row["up_m"]),
            up_share=float(row["up_share"]),
            outward_m=float(row["outward_m"]),
            high_range=bool(row.get("high_range", False)),
        )
        for name, row in table.iterrows()
    }


@dataclass(frozen=True)
class Mounting:
    """How carefully sensors are put on.

    Parameters
    ----------
    place_sd_m : float
        Scatter of the place along each axis.
    most_rad : float
        Largest mounting rotation.
    lumbar_yaw_rad : float
        Largest turn of the lumbar sensor about the vertical, and of its roll.
    """

    place_sd_m: float
    most_rad: float
    lumbar_yaw_rad: float


#: Spec §9.1: mounting rotations up to 25°, lumbar yaw up to 3°; by eye to 5 mm [N].
USUAL_MOUNTING: Final = Mounting(0.005, 25.0 * RAD_PER_DEG, 3.0 * RAD_PER_DEG)


@dataclass(frozen=True)
class WornSensors:
    """Sensors on one person for one session.

    Parameters
    ----------
    names : tuple of str
        In the order of all arrays.
    models : tuple of SensorModel
        Types.
    units : tuple of SensorUnit
        Constant errors and mounting, from axes of the segment.
    skin : SkinPoints
        Places and soft tissue.
    """

    names: tuple[str, ...]
    models: tuple[SensorModel, ...]
    units: tuple[SensorUnit, ...]
    skin: SkinPoints


def wear_sensors(
    body: RunnerBody,
    names: tuple[str, ...],
    *,
    mounting: Mounting,
    tissue: dict[str, TissueSize],
    common: Array,
    rng: np.random.Generator,
) -> WornSensors:
    """Put sensors on a person.

    Parameters
    ----------
    body : RunnerBody
        Of the person.
    names : tuple of str
        Which of :func:`sensor_places`.
    mounting : Mounting
        How they are put on.
    tissue : dict of str to TissueSize
        Soft tissue; empty for sensors on bone.
    common : ndarray, shape (13, 5, 3)
        From :func:`~swaystride.simulate.running_tissue.common_tissue`.
    rng : numpy.random.Generator
        Source of all that is random.

    Returns
    -------
    WornSensors
    """
    places = [sensor_places()[name] for name in names]
    models = tuple(OPAL_HIGH_RANGE if p.high_range else OPAL_LOW_RANGE for p in places)
    points = np.array([place_point_m(place, body) for place in places])
    points += mounting.place_sd_m * rng.standard_normal(points.shape)
    units = []
    for place, model in zip(places, models, strict=True):
        unit = draw_unit(model, tilt_sd_deg=0.0, heading_sd_deg=0.0, rng=rng)
        turned = _mounted(place.name, mounting, rng)
        units.append(replace(unit, r_sensor_from_body=turned @ R_NOMINAL_FROM_SEGMENT))
    skin = skin_points([p.segment for p in places], points, tissue, common, rng)
    return WornSensors(names, models, tuple(units), skin)


def _mounted(name: str, mounting: Mounting, rng: np.random.Generator) -> Array:
    """Rotation from nominal axes to those of a sensor as it was strapped on."""
    draws = rng.uniform(-1.0, 1.0, 3)
    if name == "lumbar":
        tilt = exp_map([0.0, mounting.most_rad * draws[0], 0.0])
        turn = mounting.lumbar_yaw_rad * draws
        return np.asarray(exp_map([turn[1], 0.0, 0.0]) @ tilt @ exp_map([0.0, 0.0, turn[2]]))
    axis = rng.standard_normal(3)
    return np.asarray(exp_map(mounting.most_rad * draws[0] * axis / np.linalg.norm(axis)))


def place_point_m(place: SensorPlace, body: RunnerBody) -> Array:
    """Place in axes of the segment, shape (3,).

    Parameters
    ----------
    place : SensorPlace
        Where it is meant to be.
    body : RunnerBody
        Lengths of the segments.
    """
    lengths = {
        "thigh": body.thigh_m,
        "shank": body.shank_m,
        "trunk": body.trunk_m,
        "upper_arm": body.upper_arm_m,
        "forearm": body.forearm_m,
    }
    name = SEGMENTS[place.segment]
    length = lengths.get(name.removesuffix("_right").removesuffix("_left"), 0.0)
    outward = -place.outward_m if name.endswith("_left") else place.outward_m
    return np.array([place.ahead_m, place.up_m + place.up_share * length, outward])
