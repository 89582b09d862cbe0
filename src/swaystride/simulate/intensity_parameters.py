"""Parameters of the simulated intensity study; their values stand in ``config/``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from swaystride.configuration import from_mapping
from swaystride.errors import ConfigurationError
from swaystride.simulate.inertial_sensor import SENSOR_MODELS, SensorModel
from swaystride.simulate.intensity_people import Bodies, PatientGroup, Therapists
from swaystride.simulate.intensity_truth import (
    IntensityPopulation,
    LatentIntensity,
    SelfRating,
    SwayLink,
    TherapistRating,
)
from swaystride.simulate.loss_of_balance import LossOfBalance
from swaystride.simulate.standing_model import StandingModel, TrialSettings
from swaystride.simulate.worn_sensor import RadioLoss, SensorPlacement

#: Name of the study in the keys of its random numbers.
STUDY: Final = "intensity"


@dataclass(frozen=True)
class IntensityProtocol:
    """Who takes part and what they do.

    Parameters
    ----------
    n_participants : int
        Patients.
    n_exercises, n_trials : int
        Exercises of a patient, a multiple of 5, and trials of each.
    n_raters : int
        Therapists.
    n_pairs : int
        Pairs of patient and therapist among the printed number of patients.
    raters_per_participant : tuple of int
        Fewest and most therapists of one patient.
    shortest_trial_s : float
        No trial ends earlier.
    stop_delay_s : float
        From the loss of balance that ends a trial to its end.
    """

    n_participants: int
    n_exercises: int
    n_trials: int
    n_raters: int
    n_pairs: int
    raters_per_participant: tuple[int, int]
    shortest_trial_s: float
    stop_delay_s: float


@dataclass(frozen=True)
class IntensityCohort:
    """All parameters of the simulated cohort.

    Parameters
    ----------
    older_adult, vestibular : PatientGroup
        The two groups of patients.
    bodies : Bodies
        Statures and masses.
    therapists : Therapists
        The raters.
    protocol : IntensityProtocol
        Who and what.
    population : IntensityPopulation
        What is true.
    standing : StandingModel
        The standing body.
    loss_of_balance : LossOfBalance
        What happens beyond its limits.
    trial : TrialSettings
        One recorded trial.
    placement : SensorPlacement
        Where the sensor sits.
    sensor : SensorModel
        What it adds.
    radio : RadioLoss
        What gets lost.
    """

    older_adult: PatientGroup
    vestibular: PatientGroup
    bodies: Bodies
    therapists: Therapists
    protocol: IntensityProtocol
    population: IntensityPopulation
    standing: StandingModel
    loss_of_balance: LossOfBalance
    trial: TrialSettings
    placement: SensorPlacement
    sensor: SensorModel
    radio: RadioLoss


_POPULATION = {
    "latent": LatentIntensity,
    "therapist": TherapistRating,
    "self_rating": SelfRating,
    "sway": SwayLink,
}
_COHORT = {
    "older_adult": PatientGroup,
    "vestibular": PatientGroup,
    "bodies": Bodies,
    "therapists": Therapists,
    "protocol": IntensityProtocol,
    "placement": SensorPlacement,
    "radio": RadioLoss,
}
_PHYSICS = {
    "standing": StandingModel,
    "loss_of_balance": LossOfBalance,
    "trial": TrialSettings,
}


def cohort_from_config(section: Mapping[str, Any]) -> IntensityCohort:
    """Assemble the parameters from the section ``simulation`` of the study's configuration.

    Parameters
    ----------
    section : mapping
        Plain values (:func:`swaystride.configuration.plain_values`) with the keys ``standing``,
        ``loss_of_balance``, ``trial``, ``population`` and ``cohort``.

    Returns
    -------
    IntensityCohort

    Raises
    ------
    ConfigurationError
        If keys are missing or unknown, or there is no such sensor.
    """
    cohort = dict(section["cohort"])
    sensor = cohort.get("sensor")
    if sensor not in SENSOR_MODELS:
        raise ConfigurationError(
            "unknown sensor",
            place="cohort.sensor",
            expected="one of " + ", ".join(SENSOR_MODELS),
            found=repr(sensor),
        )
    population: dict[str, Any] = {
        name: from_mapping(cls, section["population"][name], place=f"population.{name}")
        for name, cls in _POPULATION.items()
    }
    values = {
        **cohort,
        **{
            name: from_mapping(cls, cohort[name], place=f"cohort.{name}")
            for name, cls in _COHORT.items()
            if name in cohort
        },
        **{name: from_mapping(cls, section[name], place=name) for name, cls in _PHYSICS.items()},
        "sensor": SENSOR_MODELS[sensor],
        "population": from_mapping(IntensityPopulation, population, place="population"),
    }
    return from_mapping(IntensityCohort, values, place="cohort")
