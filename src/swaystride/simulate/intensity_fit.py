"""Quick statistics of simulated intensity cohorts, to fit the population to the printed numbers.

They stand for the models of the analysis where those would be too slow to repeat thousands of
times: slopes within patient and therapist for the mixed models, pair covariances for the ICC.
Nothing of the analysis uses them; recovery judges the result with the real models.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from swaystride.simulate.intensity_exercises import DIFFICULTY
from swaystride.simulate.intensity_ratings import PatientTruth
from swaystride.stats.correlation import spearman

Array = NDArray[np.float64]
IntArray = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class RatedRows:
    """All ratings of one kind of a cohort, one row per rating.

    Parameters
    ----------
    patient, exercise, trial, rater : ndarray of int, shape (n,)
        Positions; of an exercise as a whole the trial is 0.
    rating, own : ndarray, shape (n,)
        The therapist's and the patient's own rating.
    steps : ndarray, shape (n, 4)
        Steps of difficulty.
    """

    patient: IntArray
    exercise: IntArray
    trial: IntArray
    rater: IntArray
    rating: Array
    own: Array
    steps: Array


def rated_rows(
    patients: Sequence[PatientTruth], assigned: Sequence[IntArray], *, trials: bool
) -> RatedRows:
    """Stack the ratings of a cohort.

    Parameters
    ----------
    patients : sequence of PatientTruth
    assigned : sequence of ndarray of int
        Therapists of each patient.
    trials : bool
        Ratings of trials, or of exercises.
    """
    parts = []
    for number, (patient, raters) in enumerate(zip(patients, assigned, strict=True)):
        if trials:
            given, own = patient.therapist_trial[:, :, raters], patient.self_trial
        else:
            given, own = patient.therapist_exercise[:, None, raters], patient.self_exercise[:, None]
        e, t, r = (index.ravel() for index in np.indices(given.shape))
        steps = DIFFICULTY[patient.exercises[e]]
        head = [np.full(given.size, number), e, t, raters[r], given.ravel(), own[e, t]]
        parts.append(np.column_stack([*head, steps]))
    table = np.concatenate(parts)
    index = table[:, :4].astype(np.intp).T
    patient, exercise, trial, rater = index
    return RatedRows(patient, exercise, trial, rater, table[:, 4], table[:, 5], table[:, 6:])


def rating_statistics(rows: RatedRows) -> dict[str, float]:
    """Quick versions of what the chapter prints about ratings.

    Parameters
    ----------
    rows : RatedRows

    Returns
    -------
    dict of str to float
        ``icc``, slopes and their standard errors by dimension, ``spearman_self``,
        ``mean_difference``, ``difference_sd``, ``self_accuracy``, ``self_5_is_5``, ``self_4_is_5``
        (shares).
    """
    values = {"icc": _pair_icc(rows)}
    for k, name in enumerate(("surface", "stance", "visual_input", "head_movements")):
        values[name], values[f"{name}_se"] = _within_slope(rows, rows.steps[:, k])
    difference = rows.rating - rows.own
    predicted = np.clip(np.round(_fitted(rows.rating, rows.own[:, None])), 1, 5)
    return {
        **values,
        "spearman_self": spearman(rows.own, rows.rating).r,
        "mean_difference": float(difference.mean()),
        "difference_sd": float(difference.std(ddof=1)),
        "self_accuracy": float((predicted == rows.rating).mean()),
        "self_5_is_5": _share(rows.own, rows.rating, 5, 5),
        "self_4_is_5": _share(rows.own, rows.rating, 4, 5),
    }


def sway_statistics(rows: RatedRows, features: Array, names: Sequence[str]) -> dict[str, float]:
    """Quick versions of Table 3.3.

    Parameters
    ----------
    rows : RatedRows
        Of trials.
    features : ndarray, shape (n_patients, n_exercises, n_trials, n_features)
    names : sequence of str
        Of the features.

    Returns
    -------
    dict of str to float
        Marginal correlations ``<feature>/none`` and ``<feature>/log``.
    """
    x = features[rows.patient, rows.exercise, rows.trial]
    found = {}
    for k, name in enumerate(names):
        found[f"{name}/none"] = _marginal(rows, x[:, k])
        found[f"{name}/log"] = _marginal(rows, np.log(x[:, k]))
    return found


def prediction_statistics(rows: RatedRows, features: Array) -> dict[str, float]:
    """Quick versions of what the chapter prints about predictions from sway.

    Parameters
    ----------
    rows : RatedRows
        Of trials, or of exercises.
    features : ndarray, shape (n_patients, n_exercises, n_trials, n_features)
        Of a trial its own are used, of an exercise those of all its trials.
    """
    if rows.trial.any():
        x = features[rows.patient, rows.exercise, rows.trial]
    else:
        x = features[rows.patient, rows.exercise].reshape(len(rows.rating), -1)
    predicted = _fitted(rows.rating, x)
    rounded = np.clip(np.round(predicted), 1, 5)
    return {
        "spearman_sway": spearman(predicted, rows.rating).r,
        "sway_accuracy": float((rounded == rows.rating).mean()),
        "sway_5_is_5": _share(rounded, rows.rating, 5, 5),
        "sway_4_is_5": _share(rounded, rows.rating, 4, 5),
        "sway_4_is_4": _share(rounded, rows.rating, 4, 4),
    }


def variance_difference(patients: Sequence[PatientTruth], assigned: Sequence[IntArray]) -> float:
    """Variance between the trials of an exercise, therapists minus patients.

    Parameters
    ----------
    patients : sequence of PatientTruth
    assigned : sequence of ndarray of int
        Therapists of each patient.
    """
    parts = []
    for patient, raters in zip(patients, assigned, strict=True):
        own = patient.self_trial.var(axis=1, ddof=1)
        given = patient.therapist_trial[:, :, raters].var(axis=1, ddof=1)
        parts.append((given - own[:, None]).ravel())
    return float(np.concatenate(parts).mean())


def _pair_icc(rows: RatedRows) -> float:
    """Covariance of two therapists who rate the same thing, over the variance of all ratings."""
    thing = np.ravel_multi_index(
        (rows.patient, rows.exercise, rows.trial),
        (rows.patient.max() + 1, rows.exercise.max() + 1, rows.trial.max() + 1),
    )
    y = rows.rating - rows.rating.mean()
    sums, squares = np.bincount(thing, y), np.bincount(thing, y * y)
    n = np.bincount(thing)
    return float((sums**2 - squares).sum() / (n * (n - 1)).sum() / y.var())


def _centred(values: Array, group: IntArray) -> Array:
    return values - (np.bincount(group, values) / np.bincount(group))[group]


def _within_slope(rows: RatedRows, x: Array) -> tuple[float, float]:
    """Slope within patient and therapist, with the standard error of independent rows."""
    y = rows.rating
    for _ in range(6):
        y = _centred(_centred(y, rows.patient), rows.rater)
        x = _centred(_centred(x, rows.patient), rows.rater)
    slope = float((x @ y) / (x @ x))
    rest = y - slope * x
    return slope, float(np.sqrt(rest @ rest / len(y) / (x @ x)))


def _marginal(rows: RatedRows, x: Array) -> float:
    """Marginal correlation with moment estimates of the two variances."""
    group, y = rows.patient, rows.rating
    x_in, y_in = _centred(x, group), _centred(y, group)
    slope = float((x_in @ y_in) / (x_in @ x_in))
    rest = y_in - slope * x_in
    n = np.bincount(group)
    residual = float(rest @ rest / (len(y) - len(n) - 1))
    means = np.bincount(group, y - slope * x) / n
    between = max(float(means.var(ddof=1)) - residual / float(n.mean()), 0.0)
    explained = slope**2 * float(x.var())
    return float(np.sign(slope) * np.sqrt(explained / (explained + between + residual)))


def _fitted(y: Array, x: Array) -> Array:
    """Least-squares fit of y on standardised columns of x."""
    z = np.column_stack([np.ones(len(y)), (x - x.mean(axis=0)) / x.std(axis=0)])
    return np.asarray(z @ np.linalg.lstsq(z, y, rcond=1e-9)[0])


def _share(given: Array, then: Array, value: int, outcome: int) -> float:
    chosen = given == value
    return float((then[chosen] == outcome).mean()) if chosen.any() else float("nan")
