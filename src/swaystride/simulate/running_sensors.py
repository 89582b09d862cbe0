"""Inertial sensors worn by a runner: where they sit, and what they record."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.rotations import exp_map
from swaystride.simulate._running_points import sensor_signals
from swaystride.simulate.inertial_sensor import (
    OPAL_HIGH_RANGE,
    SensorModel,
    SensorUnit,
    draw_unit,
    measure,
)
from swaystride.simulate.running_body import SEGMENTS, RunnerBody
from swaystride.simulate.running_motion import RunningMotion
from swaystride.simulate.running_tissue import SkinPoints, TissueSize, skin_points
from swaystride.simulate.sampling import decimation_factor, filter_reach
from swaystride.units import GRAVITY_M_S2, RAD_PER_DEG

Array = NDArray[np.float64]

#: APDM Opal with its ±16 g accelerometer, spec §9.1, table "Sensor errors": noise 120 µg/√Hz [M].
OPAL_LOW_RANGE: Final = replace(
    OPAL_HIGH_RANGE,
    acc_range_m_s2=16.0 * GRAVITY_M_S2,
    acc_noise_density_m_s2_rthz=120e-6 * GRAVITY_M_S2,
)

#: Rate of the simulation: the elements clip and vibrate long before they are sampled (issue: ≥ 2 kHz).
SIMULATION_RATE_HZ: Final = 2000.0

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
    table = pd.read_csv(Path(__file__).with_name("running_sensors.csv"), index_col="sensor")
    return {
        str(name): SensorPlace(
            name=str(name),
            segment=SEGMENTS.index(row["segment"]),
            ahead_m=float(row["ahead_m"]),
            up_m=float(row["up_m"]),
            up_share=float(row["up_share"]),
            outward_m=float(row["outward_m"]),
            high_range=bool(row["high_range"]),
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


@dataclass(frozen=True)
class SensorChunk:
    """Part of a recording.

    Parameters
    ----------
    first : int
        Index of its first sample in the recording.
    acc_m_s2, gyr_rad_s : ndarray, shape (n_sensors, 3, n)
        As the sensors report.
    """

    first: int
    acc_m_s2: NDArray[np.float32]
    gyr_rad_s: NDArray[np.float32]


def n_samples(motion: RunningMotion, rate_hz: float) -> int:
    """Samples of a recording of a motion.

    Parameters
    ----------
    motion : RunningMotion
        What is recorded.
    rate_hz : float
        Sampling rate.
    """
    return int(np.floor(motion.duration_s * rate_hz + 1e-9))


def recorded(
    motion: RunningMotion,
    sensors: WornSensors,
    *,
    rate_hz: float,
    rng: np.random.Generator,
    chunk_s: float = 20.0,
) -> Iterator[SensorChunk]:
    """Record a motion, part by part, so that the memory does not grow with its length.

    Parameters
    ----------
    motion : RunningMotion
        What happens.
    sensors : WornSensors
        What records it.
    rate_hz : float
        Output rate; the simulation runs at 2 kHz, of which it is an integer part.
    rng : numpy.random.Generator
        Source of the noise.
    chunk_s : float
        Length of the parts; it decides the order of the random numbers.

    Yields
    ------
    SensorChunk
    """
    factor = decimation_factor(SIMULATION_RATE_HZ, rate_hz)
    reach = filter_reach(SIMULATION_RATE_HZ, rate_hz)
    total = n_samples(motion, rate_hz)
    every = max(1, round(chunk_s * rate_hz))
    for first in range(0, total, every):
        n = min(every, total - first)
        fine = (n - 1) * factor + 1 + 2 * reach
        ideal = ideal_signals(
            motion, sensors.skin, SIMULATION_RATE_HZ, first * factor - reach, fine
        )
        acc = np.empty((len(sensors.names), 3, n), dtype=np.float32)
        gyr = np.empty_like(acc)
        for k, (model, unit) in enumerate(zip(sensors.models, sensors.units, strict=True)):
            acc[k], gyr[k] = measure(
                model,
                unit,
                acc_m_s2=ideal[k, :3],
                gyr_rad_s=ideal[k, 3:],
                rate_hz=SIMULATION_RATE_HZ,
                output_rate_hz=rate_hz,
                rng=rng,
            )
        yield SensorChunk(first, acc, gyr)


def ideal_signals(
    motion: RunningMotion, skin: SkinPoints, rate_hz: float, first: int, n: int
) -> Array:
    """Signals of perfect sensors in axes of their segment (turned with the soft tissue).

    Parameters
    ----------
    motion : RunningMotion
        What happens.
    skin : SkinPoints
        Where the sensors are.
    rate_hz : float
        Sampling rate; sample 0 is at the begin of the recording.
    first, n : int
        First sample and number of samples.

    Returns
    -------
    ndarray, shape (n_sensors, 6, n)
        Proper acceleration (m/s²) and angular velocity (rad/s).
    """
    out = np.empty((len(skin.rows), 6, n))
    sensor_signals(
        motion.tables,
        0.0,
        rate_hz,
        first,
        n,
        skin.rows,
        skin.points_m,
        skin.tissue,
        GRAVITY_M_S2,
        out,
    )
    return out
