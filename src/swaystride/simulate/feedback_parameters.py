"""Parameters of the simulated feedback study; their values stand in ``config/``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from swaystride.configuration import from_mapping
from swaystride.errors import ConfigurationError
from swaystride.simulate.feedback_truth import (
    FeatureTruth,
    FeedbackPopulation,
    FeedbackSpread,
)
from swaystride.simulate.inertial_sensor import SENSOR_MODELS, SensorModel
from swaystride.simulate.standing_model import StandingModel, TrialSettings
from swaystride.simulate.standing_response import FEATURES
from swaystride.simulate.worn_sensor import RadioLoss, SensorPlacement


@dataclass(frozen=True)
class GroupTable:
    """One group as printed in Table 2.1; SDs are divided by n − 1.

    Parameters
    ----------
    n, n_female : int
        Participants, and women among them.
    age_mean_years, age_sd_years, height_mean_m, height_sd_m, mass_mean_kg, mass_sd_kg : float
        Means and standard deviations.
    """

    n: int
    n_female: int
    age_mean_years: float
    age_sd_years: float
    height_mean_m: float
    height_sd_m: float
    mass_mean_kg: float
    mass_sd_kg: float


@dataclass(frozen=True)
class FeedbackProtocol:
    """Who takes part and what they do.

    Parameters
    ----------
    n_participants : int
        They alternate between the orders; the first one has concurrent feedback first.
    n_short : int
        The first participants of the study, who lack the last training trial of the terminal
        block and the last baseline trial of the concurrent block.
    baseline_trials, training_sets, trials_per_set : int
        Trials of one block; the last one of each set is without feedback.
    male_height_shift_sd : float
        How much taller men are drawn, in group SDs, before the group's mean and SD are set.
    height_mass_correlation : float
        Correlation of height and mass before the group's mean and SD are set.
    """

    n_participants: int
    n_short: int
    baseline_trials: int
    training_sets: int
    trials_per_set: int
    male_height_shift_sd: float
    height_mass_correlation: float


@dataclass(frozen=True)
class FeedbackCohort:
    """All parameters of the simulated cohort.

    Parameters
    ----------
    concurrent_first, terminal_first : GroupTable
        The two groups.
    protocol : FeedbackProtocol
        Who and what.
    population : FeedbackPopulation
        What is true.
    placement : SensorPlacement
        Where the sensor sits.
    sensor : SensorModel
        What it adds.
    radio : RadioLoss
        What gets lost.
    """

    concurrent_first: GroupTable
    terminal_first: GroupTable
    protocol: FeedbackProtocol
    population: FeedbackPopulation
    placement: SensorPlacement
    sensor: SensorModel
    radio: RadioLoss


def cohort_from_config(section: Mapping[str, Any]) -> FeedbackCohort:
    """Assemble the parameters from the section ``simulation`` of the study's configuration.

    Parameters
    ----------
    section : mapping
        Plain values (:func:`swaystride.configuration.plain_values`) with the keys ``standing``,
        ``trial``, ``population`` and ``cohort``; others are for other programs.

    Returns
    -------
    FeedbackCohort

    Raises
    ------
    ConfigurationError
        If keys are missing or unknown, or there is no such sensor.
    """
    population = {
        **section["population"],
        **{
            name: from_mapping(
                FeatureTruth, section["population"][name], place=f"population.{name}"
            )
            for name in FEATURES
        },
        "spread": from_mapping(
            FeedbackSpread, section["population"]["spread"], place="population.spread"
        ),
        "standing": from_mapping(StandingModel, section["standing"], place="standing"),
        "trial": from_mapping(TrialSettings, section["trial"], place="trial"),
    }
    cohort = dict(section["cohort"])
    if cohort.get("sensor") not in SENSOR_MODELS:
        raise ConfigurationError(
            "unknown sensor",
            place="cohort.sensor",
            expected="one of " + ", ".join(SENSOR_MODELS),
            found=repr(cohort.get("sensor")),
        )
    parts = {
        "concurrent_first": GroupTable,
        "terminal_first": GroupTable,
        "protocol": FeedbackProtocol,
        "placement": SensorPlacement,
        "radio": RadioLoss,
    }
    values = {
        **cohort,
        **{
            name: from_mapping(cls, cohort[name], place=f"cohort.{name}")
            for name, cls in parts.items()
            if name in cohort
        },
        "sensor": SENSOR_MODELS[cohort["sensor"]],
        "population": from_mapping(FeedbackPopulation, population, place="population"),
    }
    return from_mapping(FeedbackCohort, values, place="cohort")
