"""Parameters of the simulated IMU-design study; their values stand in ``config/``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from swaystride.configuration import from_mapping
from swaystride.errors import ConfigurationError
from swaystride.simulate.foot_course import CourseParameters
from swaystride.simulate.foot_person import FootSensorPlacement, PersonScatter, SoleShape
from swaystride.simulate.foot_trial import StrideScatter
from swaystride.simulate.inertial_sensor import FOOT_SENSOR_MODELS, SensorModel
from swaystride.simulate.intensity_people import Bodies, PatientGroup

#: Name of the study, the first part of the key of all its random numbers.
STUDY: Final = "imu_design"


@dataclass(frozen=True)
class RunnersProtocol:
    """Who takes part, and the mean speeds of the trials.

    Parameters
    ----------
    n_participants : int
        People.
    n_walking, n_running : int
        Trials at rising mean speeds: walking first, then running.
    slow_walk_m_s, fast_walk_m_s, slow_run_m_s, sprint_m_s : tuple of float
        Range, between people, of the mean speed of the first and the last trial of each kind.
    speed_jitter : float
        Scatter of the trials between them, over the step from one trial to the next.
    """

    n_participants: int
    n_walking: int
    n_running: int
    slow_walk_m_s: tuple[float, float]
    fast_walk_m_s: tuple[float, float]
    slow_run_m_s: tuple[float, float]
    sprint_m_s: tuple[float, float]
    speed_jitter: float


@dataclass(frozen=True)
class FootSensor:
    """One of the two sensors on a foot.

    Parameters
    ----------
    model : SensorModel
        What it adds.
    rate_hz : float
        Sampling rate.
    simulation_rate_hz : float
        Rate at which it saturates, a multiple of the sampling rate.
    """

    model: SensorModel
    rate_hz: float
    simulation_rate_hz: float


@dataclass(frozen=True)
class ImuDesignCohort:
    """All parameters of the simulated cohort.

    Parameters
    ----------
    protocol : RunnersProtocol
        Who and how fast.
    people : PatientGroup
        Number, ages and sexes of the printed participants.
    bodies : Bodies
        Statures and masses.
    sole : SoleShape
        Shoes.
    placement : FootSensorPlacement
        Where the sensors sit.
    course : CourseParameters
        Distance, start, stop and rest.
    person : PersonScatter
        Between people.
    stride : StrideScatter
        From stride to stride.
    imu_1, imu_2 : FootSensor
        The sensors.
    """

    protocol: RunnersProtocol
    people: PatientGroup
    bodies: Bodies
    sole: SoleShape
    placement: FootSensorPlacement
    course: CourseParameters
    person: PersonScatter
    stride: StrideScatter
    imu_1: FootSensor
    imu_2: FootSensor

    def imu(self, name: str) -> FootSensor:
        """Return the sensor ``imu_1`` or ``imu_2``."""
        return {"imu_1": self.imu_1, "imu_2": self.imu_2}[name]


_COHORT = {
    "protocol": RunnersProtocol,
    "people": PatientGroup,
    "bodies": Bodies,
    "placement": FootSensorPlacement,
}
_FOOT = {
    "sole": SoleShape,
    "course": CourseParameters,
    "person": PersonScatter,
    "stride": StrideScatter,
}


def cohort_from_config(section: Mapping[str, Any]) -> ImuDesignCohort:
    """Assemble the parameters from the section ``simulation`` of the study's configuration.

    Parameters
    ----------
    section : mapping
        Plain values (:func:`swaystride.configuration.plain_values`) with the keys ``cohort``,
        ``foot`` and ``sensors``.

    Returns
    -------
    ImuDesignCohort

    Raises
    ------
    ConfigurationError
        If keys are missing or unknown, or there is no such sensor.
    """
    parts: dict[str, Any] = {}
    for group, classes in (("cohort", _COHORT), ("foot", _FOOT)):
        values = section[group]
        if set(values) != set(classes):
            raise ConfigurationError(
                "keys do not match what the code takes",
                place=group,
                expected=", ".join(sorted(classes)),
                found=", ".join(sorted(values)),
            )
        for name, cls in classes.items():
            parts[name] = from_mapping(cls, values[name], place=f"{group}.{name}")
    for name, values in section["sensors"].items():
        model = values.get("model")
        if model not in FOOT_SENSOR_MODELS:
            raise ConfigurationError(
                "unknown sensor",
                place=f"sensors.{name}.model",
                expected="one of " + ", ".join(FOOT_SENSOR_MODELS),
                found=repr(model),
            )
        named = {**values, "model": FOOT_SENSOR_MODELS[model]}
        parts[name] = from_mapping(FootSensor, named, place=f"sensors.{name}")
    return from_mapping(ImuDesignCohort, parts, place="simulation")
