"""A population in which ratings of experience go with the way a run was run, as nearly as in print.

The runs are fixed: Z holds the measures of the runs, standardised over those runs whose measure is
known. Standardised ratings are ``signal + residual``, where the signal of a run is a fixed number
for each scale and the residual is drawn. The covariance of a measure with a rating is then a linear
function of the signal, ``C = A' G`` with G the signals (runs × scales), and all correlations of
measures and scales can hold together if and only if (Schur's complement of the joint matrix)

    E = R_scales − G'G/(n − 1)  is positive semidefinite,

because signals of all lengths are possible, and each direction of Z costs its share of variance. A
measure that is a function of others, as is speed of stride length and stride time, leaves no freedom
to its correlation: the printed correlations, which belong to other runs, cannot be had exactly.

Taken is the signal that minimises ``Σ w (A'G − R)²`` over all rows and scales, with w one, or one over
the printed squared standard errors, subject to E positive semidefinite and to at least a given share
of each scale that nothing explains (the diagonal of E). This is a convex problem of 3·(n − 1) numbers
at most, solved to a known gap (:mod:`swaystride.simulate.attainable_correlations`). A row of which
runs are lost counts with the covariance over the runs that it has.

How often an interval of Fisher's z covers the correlation of this population follows from the
share. The interval is made for pairs drawn anew. Here the runs stay: with ρ² the share of variance
that the row explains, η what other measures explain besides and σ² the residual, the large-sample
variance of r is

    var r = σ²/n · [(1 − ρ²)² + ρ² (η + σ²/2)],        η = 1 − ρ² − σ²,

against (1 − ρ²)²/n of the interval; for small ρ the ratio is σ². So intervals cover 99.4 % where half
the variance is explained, 97.2 % with a fifth and 95 % with none. What runs of one runner share of
the residual works against it, since their measures are alike too: the effective number of runs falls.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import ModelError
from swaystride.simulate.attainable_correlations import nearest_coefficients
from swaystride.simulate.experience_rating_parameters import AssociationModel

Array = NDArray[np.float64]

_FEWEST_RUNS: Final = 3


@dataclass(frozen=True)
class PrintedAssociations:
    """Correlations of measures with scales, and of the scales with each other.

    Parameters
    ----------
    correlation : ndarray, shape (n_measures, n_scales)
    n_runs : ndarray, shape (n_measures,)
        Runs that each row rests on.
    between_scales : ndarray, shape (n_scales, n_scales)
    significant : ndarray of bool, shape (n_measures, n_scales)
        Which are starred.
    """

    correlation: Array
    n_runs: Array
    between_scales: Array
    significant: NDArray[np.bool_]

    def weights(self, association: AssociationModel) -> Array:
        """Weight of each squared deviation, shape (n_measures, n_scales).

        Parameters
        ----------
        association : AssociationModel
            Says in what the distance is measured.
        """
        if association.distance == "plain":
            return np.ones_like(self.correlation)
        return (self.n_runs[:, None] - 3.0) / (1.0 - self.correlation**2) ** 2


@dataclass(frozen=True)
class ExperiencePopulation:
    """Attainable population next to the printed one. Ratings are in standard deviations.

    Parameters
    ----------
    signal : ndarray, shape (n_runs, n_scales)
        What follows from how a run was run; mean zero.
    residual : ndarray, shape (n_scales, n_scales)
        Covariance of the rest.
    correlation : ndarray, shape (n_measures, n_scales)
        Correlation in the population, over the runs whose measure is known; NaN if too few are.
    measure_weights : ndarray, shape (n_measures, n_scales)
        The signal is the sum of the standardised measures with these weights; of all weights that
        give it, the smallest.
    gap : float
        The objective exceeds the smallest possible by this at most, relative to it.
    """

    signal: Array
    residual: Array
    correlation: Array
    measure_weights: Array
    gap: float


@dataclass(frozen=True)
class Distance:
    """How far attainable correlations lie from printed ones.

    Parameters
    ----------
    rms : float
        Root mean square of the deviations.
    rms_standard_errors : float
        The same in printed standard errors.
    largest_significant : float
        Largest deviation among the starred correlations.
    """

    rms: float
    rms_standard_errors: float
    largest_significant: float


def attainable_population(
    measures: ArrayLike, printed: PrintedAssociations, association: AssociationModel
) -> ExperiencePopulation:
    """Find the population next to the printed one that these runs allow.

    Parameters
    ----------
    measures : array_like, shape (n_runs, n_measures)
        True measures of the runs, in any units; NaN where the row of the table lacks the run.
    printed : PrintedAssociations
        What is aimed at.
    association : AssociationModel
        Distance and least unexplained share.

    Returns
    -------
    ExperiencePopulation

    Raises
    ------
    ModelError
        If there are fewer than three runs, or the printed correlations of the scales are no
        correlation matrix.
    """
    values = np.asarray(measures, dtype=np.float64)
    n_runs = len(values)
    if n_runs < _FEWEST_RUNS:
        raise ModelError(
            "too few runs for a population", expected=f"{_FEWEST_RUNS}", found=f"{n_runs}"
        )
    if np.linalg.eigvalsh(printed.between_scales)[0] <= 0.0:
        raise ModelError("the correlations of the scales exclude each other")
    functionals = covariance_functionals(values)
    usable = np.any(functionals != 0.0, axis=0)
    left, size, _ = np.linalg.svd(functionals[:, usable], full_matrices=False)
    basis = left[:, size > 1e-10 * size[:1].sum()] * np.sqrt(n_runs - 1.0)
    weights = np.where(usable[:, None], printed.weights(association), 0.0)
    found, gap = nearest_coefficients(
        functionals.T @ basis,
        printed.correlation,
        weights,
        printed.between_scales,
        1.0 - association.unexplained_share,
    )
    signal = basis @ found
    residual = printed.between_scales - found.T @ found
    correlation = population_correlations(signal, np.diag(residual), values)
    standard = functionals * (np.sum(np.isfinite(values), axis=0) - 1.0)
    measure_weights = np.linalg.lstsq(standard, signal, rcond=1e-10)[0]
    return ExperiencePopulation(signal, residual, correlation, measure_weights, gap)


def covariance_functionals(measures: ArrayLike) -> Array:
    """Weights of the runs in the covariance of each standardised measure with anything.

    Parameters
    ----------
    measures : array_like, shape (n_runs, n_measures)
        NaN where unknown.

    Returns
    -------
    ndarray, shape (n_runs, n_measures)
        Columns sum to zero; zero for unknown runs, and for measures that are constant or known in
        fewer than three runs.

    Examples
    --------
    >>> weights = covariance_functionals([[1.0], [2.0], [3.0], [np.nan]])
    >>> round(float(weights[:, 0] @ [10.0, 20.0, 30.0, 99.0]), 12)  # standard deviation of 10, 20, 30
    10.0
    """
    values = np.asarray(measures, dtype=np.float64)
    known = np.isfinite(values)
    count = known.sum(axis=0)
    filled = np.where(known, values, 0.0)
    centred = np.where(known, filled - filled.sum(axis=0) / np.maximum(count, 1), 0.0)
    degrees = np.maximum(count - 1, 1)
    sd = np.sqrt((centred**2).sum(axis=0) / degrees)
    usable = (count >= _FEWEST_RUNS) & (sd > 1e-12 * np.abs(filled).max(axis=0))
    return np.where(usable, centred / np.where(usable, sd * degrees, 1.0), 0.0)


def population_correlations(signal: ArrayLike, residual: ArrayLike, measures: ArrayLike) -> Array:
    """Correlation of each measure with each scale in a population of these runs.

    Covariance of signal and measure over the runs whose measure is known, over the standard
    deviations of the measure and of signal and residual in the same runs.

    Parameters
    ----------
    signal : array_like, shape (n_runs, n_scales)
        Signals.
    residual : array_like, shape (n_scales,)
        Residual variances.
    measures : array_like, shape (n_runs, n_measures)
        NaN where unknown.

    Returns
    -------
    ndarray, shape (n_measures, n_scales)
        NaN where a measure is constant or known in fewer than three runs.

    Examples
    --------
    >>> population_correlations([[-1.0], [0.0], [1.0]], [1.0], [[3.0], [4.0], [5.0]]).round(3).tolist()
    [[0.707]]
    """
    values = np.asarray(measures, dtype=np.float64)
    signals = np.asarray(signal, dtype=np.float64)
    functionals = covariance_functionals(values)
    known = np.isfinite(values).astype(np.float64)
    count = np.maximum(known.sum(axis=0), 2.0)[:, None]
    variance = (known.T @ signals**2 - (known.T @ signals) ** 2 / count) / (count - 1.0)
    total = np.sqrt(np.maximum(variance, 0.0) + np.asarray(residual, dtype=np.float64))
    usable = np.any(functionals != 0.0, axis=0)[:, None]
    return np.asarray(np.where(usable, functionals.T @ signals / total, np.nan))


def distance(correlation: ArrayLike, printed: PrintedAssociations) -> Distance:
    """Measure how far correlations lie from printed ones.

    Parameters
    ----------
    correlation : array_like, shape (n_measures, n_scales)
        NaN where there is none.
    printed : PrintedAssociations

    Returns
    -------
    Distance
    """
    deviation = np.asarray(correlation, dtype=np.float64) - printed.correlation
    errors = (1.0 - printed.correlation**2) / np.sqrt(printed.n_runs - 3.0)[:, None]
    starred = np.abs(deviation[printed.significant])
    return Distance(
        rms=float(np.sqrt(np.nanmean(deviation**2))),
        rms_standard_errors=float(np.sqrt(np.nanmean((deviation / errors) ** 2))),
        largest_significant=float(np.nanmax(starred)) if starred.size else float("nan"),
    )
