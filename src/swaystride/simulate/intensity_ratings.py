"""Latent intensity and ratings of one patient of the intensity study."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.simulate.intensity_exercises import DIFFICULTY, EXERCISES, choose_exercises
from swaystride.simulate.intensity_truth import IntensityPopulation

Array = NDArray[np.float64]
IntArray = NDArray[np.intp]


@dataclass(frozen=True)
class PatientTruth:
    """What is true of one patient. Axes: exercises in the order of the session, trials, raters.

    Parameters
    ----------
    ability : float
        Subtracted from the intensity of every exercise.
    exercises : ndarray of int, shape (n_exercises,)
        Indices into :data:`~swaystride.simulate.intensity_exercises.EXERCISES`.
    intensity : ndarray, shape (n_exercises, n_trials)
        Latent intensity.
    therapist_trial : ndarray of int, shape (n_exercises, n_trials, n_raters)
        Ratings that each therapist would give to each trial.
    therapist_exercise : ndarray of int, shape (n_exercises, n_raters)
        Ratings of exercises as a whole.
    self_trial : ndarray of int, shape (n_exercises, n_trials)
        The patient's own ratings.
    self_exercise : ndarray of int, shape (n_exercises,)
        The patient's own ratings of exercises as a whole.
    """

    ability: float
    exercises: IntArray
    intensity: Array
    therapist_trial: IntArray
    therapist_exercise: IntArray
    self_trial: IntArray
    self_exercise: IntArray


def ordinal(latent: ArrayLike, thresholds: ArrayLike) -> IntArray:
    """Rating 1 to 5 of a latent value.

    Parameters
    ----------
    latent : array
        Latent values.
    thresholds : array, shape (4,)
        Boundaries in rising order; a value on one of them is above it.

    Examples
    --------
    >>> ordinal([0.2, 1.5, 9.0], [1.5, 2.5, 3.5, 4.5]).tolist()
    [1, 2, 5]
    """
    return np.asarray(1 + np.searchsorted(np.asarray(thresholds), latent, side="right"))


def confuse(ratings: IntArray, share: float, rng: np.random.Generator) -> IntArray:
    """Turn a share of the ratings round: 1 becomes 5, 2 becomes 4.

    Parameters
    ----------
    ratings : ndarray of int
    share : float
        Probability of each rating to be turned.
    rng : numpy.random.Generator
        Source of the choice.
    """
    return np.where(rng.random(ratings.shape) < share, 6 - ratings, ratings)


def draw_patient(
    population: IntensityPopulation,
    *,
    exercise_effects: Array,
    rater_effects: Array,
    n_exercises: int,
    n_trials: int,
    rng: np.random.Generator,
) -> PatientTruth:
    """Draw the ability, the exercises, the intensities and all ratings of one patient.

    Ratings are drawn for all therapists, so that who rates whom changes nobody's data.

    Parameters
    ----------
    population : IntensityPopulation
        What is true.
    exercise_effects : ndarray, shape (54,)
        Common effects of :func:`draw_exercise_effects`.
    rater_effects : ndarray, shape (n_raters,)
        Biases of :func:`draw_rater_effects`.
    n_exercises, n_trials : int
        How many exercises the patient does, and how often each.
    rng : numpy.random.Generator
        The patient's own.

    Returns
    -------
    PatientTruth
    """
    latent = population.latent
    ability = latent.ability_sd * float(rng.standard_normal())
    expected = latent.mean + DIFFICULTY @ latent.weights - ability
    exercises = choose_exercises(
        expected + latent.planning_sd * rng.standard_normal(len(expected)),
        n_exercises,
        head_avoidance=latent.head_avoidance,
        extreme_stance_avoidance=latent.extreme_stance_avoidance,
        rng=rng,
    )
    level = (expected + exercise_effects)[exercises]
    level = level + latent.patient_exercise_sd * rng.standard_normal(n_exercises)
    intensity = level[:, None] + latent.trial_sd * rng.standard_normal((n_exercises, n_trials))
    therapist = _therapist_ratings(population, intensity, rater_effects, rng)
    own = _self_ratings(population, intensity, rng)
    return PatientTruth(ability, exercises, intensity, *therapist, *own)


def draw_exercise_effects(population: IntensityPopulation, rng: np.random.Generator) -> Array:
    """What the exercises are harder or easier than their aspects say, shape (54,).

    Parameters
    ----------
    population : IntensityPopulation
        What is true.
    rng : numpy.random.Generator
        The exercises' own.
    """
    return np.asarray(population.latent.exercise_sd * rng.standard_normal(len(EXERCISES)))


def draw_rater_effects(
    population: IntensityPopulation, n_raters: int, rng: np.random.Generator
) -> Array:
    """Biases of the therapists, shape (n_raters,).

    Parameters
    ----------
    population : IntensityPopulation
        What is true.
    n_raters : int
        How many.
    rng : numpy.random.Generator
        The therapists' own.
    """
    return np.asarray(population.therapist.rater_sd * rng.standard_normal(n_raters))


def _therapist_ratings(
    population: IntensityPopulation,
    intensity: Array,
    rater_effects: Array,
    rng: np.random.Generator,
) -> tuple[IntArray, IntArray]:
    """Ratings by every therapist: of trials, and of exercises from the mean of their trials."""
    rule = population.therapist
    (n_exercises, n_trials), n_raters = intensity.shape, len(rater_effects)
    bias = rater_effects + rule.rater_patient_sd * rng.standard_normal(n_raters)
    bias = bias + rule.rater_exercise_sd * rng.standard_normal((n_exercises, n_raters))
    noise = rule.trial_noise_sd * rng.standard_normal((n_exercises, n_trials, n_raters))
    seen = intensity[:, :, None] + bias[:, None, :] + noise
    whole = intensity.mean(axis=1)[:, None] + bias
    whole = whole + rule.exercise_noise_sd * rng.standard_normal((n_exercises, n_raters))
    return (
        confuse(ordinal(seen, rule.thresholds), rule.confused_share, rng),
        confuse(ordinal(whole, rule.thresholds), rule.confused_share, rng),
    )


def _self_ratings(
    population: IntensityPopulation, intensity: Array, rng: np.random.Generator
) -> tuple[IntArray, IntArray]:
    """The patient's own ratings of trials, and of exercises from the mean of their trials."""
    rule = population.self_rating
    n_exercises = len(intensity)
    bias = rule.patient_sd * float(rng.standard_normal())
    level = intensity.mean(axis=1) + bias
    level = level + rule.patient_exercise_sd * rng.standard_normal(n_exercises)
    noticed = rule.trial_weight * (intensity - intensity.mean(axis=1, keepdims=True))
    felt = level[:, None] + noticed + rule.trial_noise_sd * rng.standard_normal(intensity.shape)
    whole = level + rule.exercise_noise_sd * rng.standard_normal(n_exercises)
    return (
        confuse(ordinal(felt, rule.thresholds), rule.confused_share, rng),
        confuse(ordinal(whole, rule.thresholds), rule.confused_share, rng),
    )
