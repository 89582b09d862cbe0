"""What the printed quantities of the intensity study are in the simulated population.

They are computed on many simulated patients, each with exercises and therapists of its own, so
that the scatter of a cohort of ten does not matter.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.simulate.intensity_exercises import DIFFICULTY
from swaystride.simulate.intensity_parameters import STUDY, IntensityProtocol
from swaystride.simulate.intensity_ratings import (
    PatientTruth,
    draw_exercise_effects,
    draw_patient,
    draw_rater_effects,
)
from swaystride.simulate.intensity_truth import IntensityPopulation
from swaystride.simulate.seeds import generator

Array = NDArray[np.float64]

#: The four aspects of difficulty, named as in table_3_2.csv.
ASPECTS: Final = ("surface", "stance", "visual_input", "head_movements")


def population_values(
    population: IntensityPopulation, protocol: IntensityProtocol, *, n_patients: int, seed: int
) -> pd.DataFrame:
    """Population values of the quantities that ratings alone determine.

    The reliability is the share of the variance that two therapists have in common who rate the
    same trial (or exercise) of a patient drawn at random: what ICC(2,1) estimates. The effects of
    difficulty are slopes within patient and therapist.

    Parameters
    ----------
    population : IntensityPopulation
        What is true.
    protocol : IntensityProtocol
        Exercises, trials and therapists of a patient.
    n_patients : int
        How many patients are simulated.
    seed : int
        Seed of these patients.

    Returns
    -------
    DataFrame
        ``quantity`` (as ``table_3_2/stance/per_trial`` or ``study3_text/icc_pt_per_trial``) and
        ``value``.
    """
    patients = [_patient(population, protocol, seed, number) for number in range(n_patients)]
    values: dict[str, float] = {}
    for level in ("per_trial", "per_exercise"):
        therapist, own, steps = _stacked(patients, level)
        for name, slope in zip(ASPECTS, _slopes(therapist, steps), strict=True):
            values[f"table_3_2/{name}/{level}"] = slope
        values[f"study3_text/icc_pt_{level}"] = _shared_variance(therapist)
        difference = therapist - own[..., None]
        values[f"study3_text/pt_minus_self_mean_difference_{level}"] = float(difference.mean())
        values[f"study3_text/difference_sd_{level}"] = float(difference.std())
        for given, then in ((5, 5), (4, 5)):
            share = float((therapist[own == given] == then).mean())
            word = "agrees_with_pt" if given == then else f"is_pt_{then}"
            values[f"study3_text/self_{given}_{word}_{level}_percent"] = 100.0 * share
    values["study3_text/pt_minus_self_between_trial_variance_difference"] = _variance_difference(
        patients
    )
    return pd.DataFrame({"quantity": list(values), "value": list(values.values())})


def _patient(
    population: IntensityPopulation, protocol: IntensityProtocol, seed: int, number: int
) -> PatientTruth:
    """One patient of the population, with exercise effects and therapists of its own."""
    rng = generator(seed, STUDY, "population", str(number))
    return draw_patient(
        population,
        exercise_effects=draw_exercise_effects(population, rng),
        rater_effects=draw_rater_effects(population, protocol.n_raters, rng),
        n_exercises=protocol.n_exercises,
        n_trials=protocol.n_trials,
        rng=rng,
    )


def _stacked(patients: list[PatientTruth], level: str) -> tuple[Array, Array, Array]:
    """Therapists' ratings (patients, rated things, raters), own ratings, steps of difficulty."""
    therapist, own, steps = [], [], []
    for patient in patients:
        difficulty = DIFFICULTY[patient.exercises]
        if level == "per_trial":
            n_raters = patient.therapist_trial.shape[2]
            therapist.append(patient.therapist_trial.reshape(-1, n_raters))
            own.append(patient.self_trial.ravel())
            steps.append(np.repeat(difficulty, patient.intensity.shape[1], axis=0))
        else:
            therapist.append(patient.therapist_exercise)
            own.append(patient.self_exercise)
            steps.append(difficulty)
    return np.array(therapist, float), np.array(own, float), np.array(steps)


def _slopes(therapist: Array, steps: Array) -> list[float]:
    """Slope of the rating on each aspect within patient and therapist, one aspect at a time."""
    y = therapist - therapist.mean(axis=1, keepdims=True)
    x = steps - steps.mean(axis=1, keepdims=True)
    # Every therapist has rated all of a patient's exercises: their mean carries the slope.
    mean_y = y.mean(axis=2)
    return [float((x[..., k] * mean_y).sum() / (x[..., k] ** 2).sum()) for k in range(x.shape[2])]


def _shared_variance(therapist: Array) -> float:
    """Covariance of two therapists over the variance of one, over patients and rated things."""
    centred = therapist - therapist.mean()
    n_raters = centred.shape[2]
    squared_sum = (centred.sum(axis=2) ** 2).mean()
    variance = (centred**2).mean()
    covariance = (squared_sum - n_raters * variance) / (n_raters * (n_raters - 1))
    return float(covariance / variance)


def _variance_difference(patients: list[PatientTruth]) -> float:
    """Mean variance between the trials of an exercise: therapists minus patients."""
    therapist = np.mean([p.therapist_trial.var(axis=1, ddof=1).mean() for p in patients])
    own = np.mean([p.self_trial.var(axis=1, ddof=1).mean() for p in patients])
    return float(therapist - own)
