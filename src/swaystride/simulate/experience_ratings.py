"""Ratings of simulated runs: affect over time, enjoyment and flow after the run.

What a run is worth on the three scales is drawn from
:class:`~swaystride.simulate.experience_population.ExperiencePopulation`. Questionnaires are that
value as a whole number. Affect is felt all the time and said now and then: it drifts and sways in
the run around the run's value, is reported at times of the runner's choice, and as a whole number.
Of the two whole numbers around what is felt, the runner says the one that makes up for what the
previous answer said too much or too little, so that the mean of the ratings, each for as long as it
holds, stays close to the run's value and correlations of run means lose little.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from swaystride.gait.rating_windows import RatingMean, mean_rating
from swaystride.simulate.experience_parameters import STUDY
from swaystride.simulate.experience_rating_parameters import (
    SCALES,
    AffectCourse,
    RatingModel,
    ScaleMargins,
)
from swaystride.simulate.seeds import generator

Array = NDArray[np.float64]
IntArray = NDArray[np.intp]

#: Seconds in which the drift is told.
_TEN_MINUTES_S: Final = 600.0


@dataclass(frozen=True)
class RatedRuns:
    """Runs that are rated.

    Parameters
    ----------
    names : sequence of str
        As ``P01_01``.
    runners : sequence of str
        Who ran each.
    duration_s : sequence of float
        Length of each run.
    known_until_s : sequence of float
        Ratings later than this are lost; the length of the run if none is.
    settled_s : float
        From here to the end of a run, felt affect has the run's value as its mean.
    """

    names: Sequence[str]
    runners: Sequence[str]
    duration_s: Sequence[float]
    known_until_s: Sequence[float]
    settled_s: float


@dataclass(frozen=True)
class AffectSeries:
    """Ratings of affect in one run.

    Parameters
    ----------
    time_s : ndarray, shape (n,)
        When they were given, from the begin of the run.
    rating : ndarray of int, shape (n,)
        Points of the Feeling Scale.
    n_clipped : int
        How many would lie beyond the ends.
    """

    time_s: Array
    rating: IntArray
    n_clipped: int


@dataclass(frozen=True)
class CohortRatings:
    """Everything that was answered in a cohort.

    Parameters
    ----------
    latent : ndarray, shape (n_runs, 3)
        Value of each run on the scales (:data:`SCALES`), points.
    affect : tuple of AffectSeries
        Of each run, lost ratings left out.
    scores : ndarray of int, shape (n_runs, 2)
        Sums of PACES and of the Flow Short Scale.
    n_clipped : tuple of int
        Answers moved to the end of each scale.
    """

    latent: Array
    affect: tuple[AffectSeries, ...]
    scores: IntArray
    n_clipped: tuple[int, int, int]


def draw_ratings(
    model: RatingModel,
    runs: RatedRuns,
    signal: ArrayLike,
    residual: ArrayLike,
    *,
    seed: int,
    cohort: str,
) -> CohortRatings:
    """Draw the ratings of all runs.

    Parameters
    ----------
    model : RatingModel
        Margins, course of affect, share of a runner.
    runs : RatedRuns
        Who ran, and for how long.
    signal : array_like, shape (n_runs, 3)
        What follows from the run, in standard deviations.
    residual : array_like, shape (3, 3)
        Covariance of the rest.
    seed : int
        Seed of the ratings.
    cohort : str
        Word that keeps cohorts on the same seed apart, as ``"ratings"`` and ``"null"``.

    Returns
    -------
    CohortRatings
        A run's answers depend on its name, its runner's and the seed, not on the other runs.
    """
    standing = np.asarray(signal, dtype=np.float64) + _residuals(
        runs, _root(residual), model.association.runner_share, seed, cohort
    )
    margins = model.margins
    latent = standing * [scale.sd for scale in margins] + [scale.mean for scale in margins]
    affect = tuple(
        affect_series(
            latent[at, 0],
            settled_s=runs.settled_s,
            duration_s=runs.duration_s[at],
            margins=margins[0],
            course=model.course,
            rng=generator(seed, STUDY, run, cohort, "affect"),
        )
        for at, run in enumerate(runs.names)
    )
    known = tuple(map(_without_lost, affect, runs.known_until_s))
    answered = [whole_scores(latent[:, at], margins[at]) for at in (1, 2)]
    return CohortRatings(
        latent=latent,
        affect=known,
        scores=np.stack([score for score, _ in answered], axis=1),
        n_clipped=(sum(run.n_clipped for run in affect), answered[0][1], answered[1][1]),
    )


def whole_scores(latent: ArrayLike, margins: ScaleMargins) -> tuple[IntArray, int]:
    """Sum scores of a questionnaire, and how many were moved to an end of the scale.

    Parameters
    ----------
    latent : array_like
        Value of each run.
    margins : ScaleMargins
        Ends of the scale.

    Examples
    --------
    >>> scores, n_clipped = whole_scores([93.6, 140.0], ScaleMargins(94.0, 14.0, 18.0, 126.0))
    >>> scores.tolist(), n_clipped
    ([94, 126], 1)
    """
    rounded = np.rint(np.asarray(latent, dtype=np.float64))
    kept = np.clip(rounded, margins.lowest, margins.highest)
    return kept.astype(np.intp), int(np.sum(kept != rounded))


def affect_series(
    mean: float,
    *,
    settled_s: float,
    duration_s: float,
    margins: ScaleMargins,
    course: AffectCourse,
    rng: np.random.Generator,
) -> AffectSeries:
    """Draw the ratings of one run.

    Parameters
    ----------
    mean : float
        Felt affect over the settled part of the run, points.
    settled_s, duration_s : float
        Begin of that part, and length of the run.
    margins : ScaleMargins
        Ends within which ratings stay.
    course : AffectCourse
        How often ratings are given and how affect changes.
    rng : numpy.random.Generator
        Source of times and changes.

    Returns
    -------
    AffectSeries
    """
    times = _rating_times(duration_s, course, rng)
    held = _held_s(times, settled_s, duration_s)
    steady = rng.random() < course.steady_share
    change = course.drift_sd * rng.standard_normal() * times / _TEN_MINUTES_S
    change += course.sway_sd * _slow_noise(times, course.sway_memory_s, rng)
    if steady:
        change[:] = 0.0
    felt = mean + change - held @ change / held.sum()
    within = np.clip(felt, margins.lowest, margins.highest)
    n_clipped = int(np.sum(np.rint(felt) != np.rint(within)))
    rating = np.rint(within) if steady else _whole_numbers(felt, within, held)
    return AffectSeries(times, rating.astype(np.intp), n_clipped)


def run_scores(
    ratings: CohortRatings, runs: RatedRuns, *, start_s: float, mean: RatingMean
) -> pd.DataFrame:
    """Scores of each run, as a study computes them.

    Parameters
    ----------
    ratings : CohortRatings
        All answers.
    runs : RatedRuns
        Who ran, and for how long.
    start_s : float
        From here on ratings of affect count.
    mean : {"time_weighted", "simple"}
        Mean rating over a run.

    Returns
    -------
    DataFrame
        ``run`` and the three scales.
    """
    affect = [
        mean_rating(series.time_s, series.rating, start_s, until, mean=mean)
        for series, until in zip(ratings.affect, runs.known_until_s, strict=True)
    ]
    columns = (affect, *ratings.scores.T.astype(np.float64))
    return pd.DataFrame({"run": list(runs.names), **dict(zip(SCALES, columns, strict=True))})


def _residuals(runs: RatedRuns, root: Array, shared: float, seed: int, cohort: str) -> Array:
    """What does not follow from the run: partly the runner's, partly its own."""

    def normal(name: str) -> Array:
        return generator(seed, STUDY, name, cohort, "experience").standard_normal(len(SCALES))

    of_runner = {runner: normal(runner) for runner in dict.fromkeys(runs.runners)}
    own = np.stack([normal(run) for run in runs.names])
    common = np.stack([of_runner[runner] for runner in runs.runners])
    return np.asarray((np.sqrt(1.0 - shared) * own + np.sqrt(shared) * common) @ root)


def _rating_times(duration_s: float, course: AffectCourse, rng: np.random.Generator) -> Array:
    """Times to a tenth of a second: one at the begin, the others anywhere, some time apart."""
    first = float(rng.uniform(0.0, min(course.first_within_s, duration_s / 2.0)))
    n = int(rng.integers(course.least_ratings, course.most_ratings + 1))
    gap = course.shortest_gap_s
    n = min(n, 1 + int((duration_s - first) / (2.0 * gap)))
    free = duration_s - first - (n - 1) * gap
    later = first + free * np.sort(rng.random(n - 1)) + gap * np.arange(1, n)
    return np.asarray(np.round(np.append(first, later), 1))


def _held_s(times: Array, start_s: float, stop_s: float) -> Array:
    """Seconds of the settled part for which each rating holds; of the whole run if none is."""
    begin = np.clip(times, start_s if start_s < stop_s else 0.0, stop_s)
    return np.diff(np.append(begin, stop_s))


def _slow_noise(times: Array, memory_s: float, rng: np.random.Generator) -> Array:
    """First-order autoregressive noise of variance one at uneven times."""
    noise = rng.standard_normal(len(times))
    kept = np.exp(-np.diff(times) / memory_s)
    for at, share in enumerate(kept, start=1):
        noise[at] = share * noise[at - 1] + np.sqrt(1.0 - share**2) * noise[at]
    return noise


def _whole_numbers(felt: Array, within: Array, held: Array) -> Array:
    """Whole number below or above what is felt, so that the mean over time stays right."""
    said, owed = np.rint(within), 0.0
    for at, weight in enumerate(held):
        if weight > 0.0:
            below, above = np.floor(within[at]), np.ceil(within[at])
            errors = [abs(owed + weight * (felt[at] - number)) for number in (below, above)]
            if errors[0] != errors[1]:
                said[at] = below if errors[0] < errors[1] else above
            owed += weight * (felt[at] - said[at])
    return said


def _without_lost(series: AffectSeries, known_until_s: float) -> AffectSeries:
    """Ratings that were recorded."""
    known = series.time_s <= known_until_s
    return AffectSeries(series.time_s[known], series.rating[known], series.n_clipped)


def _root(covariance: ArrayLike) -> Array:
    """Symmetric square root of a covariance that may be singular."""
    values, vectors = np.linalg.eigh(np.asarray(covariance, dtype=np.float64))
    return np.asarray((vectors * np.sqrt(np.maximum(values, 0.0))) @ vectors.T)
