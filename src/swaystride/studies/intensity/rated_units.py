"""Ratings gathered by what was rated, so that resamples of patients cost a weighted sum each.

All ratings of a patient that share their predictors are one unit: the trial or exercise of a
kinematic prediction, a level of the self-rating. A resample of patients enters only through how
often each patient was drawn, and predictions, rank correlations and shares of any number of
resamples are computed side by side.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from swaystride.stats.agreement import rounded_rating
from swaystride.stats.cluster_bootstrap import cluster_codes
from swaystride.stats.grouping_factor import CodeArray, FloatArray
from swaystride.studies.intensity.design import RATINGS

# Share of the largest singular or eigenvalue below which a direction is not determined.
_UNDETERMINED = 1e-10
# Decimals to which predictions are compared for ties.
_TIE_DECIMALS = 9
_LEVELS = np.array(RATINGS, dtype=float)


@dataclass(frozen=True, eq=False)
class RatedUnits:
    """Units with their ratings; made by :func:`rated_units`.

    Parameters
    ----------
    patient : array of int, shape (n_units,)
        Patient of each unit, numbered in sorted order.
    predictors : array, shape (n_units, p)
    counts : array, shape (n_units, 5)
        How often the unit got each rating.
    basis : array, shape (n_units, q)
        Orthonormal basis of intercept and predictors over all ratings.
    unit_of_row : array of int, shape (n_rows,)
        Unit of each rating.
    """

    patient: CodeArray
    predictors: FloatArray
    counts: FloatArray
    basis: FloatArray
    unit_of_row: CodeArray

    @property
    def n_patients(self) -> int:
        """Number of patients m."""
        return int(self.patient.max()) + 1

    def predict(self, weights: npt.ArrayLike) -> FloatArray:
        """Least-squares prediction of the ratings, fitted to each resample.

        Parameters
        ----------
        weights : array, shape (n, m)
            How often each patient occurs in each resample; all ones is the sample itself.

        Returns
        -------
        array, shape (n, n_units)
            Also for units that are not in the resample.
        """
        w = np.asarray(weights, dtype=float)
        gram, right = self._normal_equations()
        coefficients = _solve(np.tensordot(w, gram, 1), w @ right)
        predicted: FloatArray = coefficients @ self.basis.T
        return predicted

    def predict_left_out(self, weights: npt.ArrayLike) -> FloatArray:
        """The same, each patient being predicted from a fit to all others.

        Parameters
        ----------
        weights : array, shape (n, m)

        Returns
        -------
        array, shape (n, n_units)
        """
        w = np.asarray(weights, dtype=float)
        gram, right = self._normal_equations()
        predicted = np.empty((len(w), len(self.patient)))
        for patient in range(self.n_patients):
            others = w.copy()
            others[:, patient] = 0.0
            own = self.patient == patient
            coefficients = _solve(np.tensordot(others, gram, 1), others @ right)
            predicted[:, own] = coefficients @ self.basis[own].T
        return predicted

    def spearman(self, predicted: FloatArray, weights: npt.ArrayLike) -> FloatArray:
        """Rank correlation of predictions and ratings in each resample, ties at their mean rank.

        Parameters
        ----------
        predicted : array, shape (n, n_units)
        weights : array, shape (n, m)

        Returns
        -------
        array, shape (n,)
            NaN where predictions or ratings do not vary.
        """
        w = self._unit_weights(weights)
        size = w * self.counts.sum(axis=1)
        total = size.sum(axis=1, keepdims=True)
        of_level = w @ self.counts
        of_unit = mean_ranks(predicted.round(_TIE_DECIMALS), size) - 0.5 * (total + 1.0)
        level_rank = np.cumsum(of_level, axis=1) - 0.5 * (of_level - 1.0) - 0.5 * (total + 1.0)
        covariance = (w * of_unit * (level_rank @ self.counts.T)).sum(axis=1)
        spread = (size * of_unit**2).sum(axis=1) * (of_level * level_rank**2).sum(axis=1)
        with np.errstate(invalid="ignore", divide="ignore"):
            r: FloatArray = np.where(spread > 0.0, covariance / np.sqrt(spread), np.nan)
        return r

    def accuracy(self, predicted: FloatArray, weights: npt.ArrayLike) -> FloatArray:
        """Share of ratings that the rounded prediction hits, in each resample.

        Parameters
        ----------
        predicted : array, shape (n, n_units)
        weights : array, shape (n, m)

        Returns
        -------
        array, shape (n,)
        """
        w = self._unit_weights(weights)
        level = rounded_rating(predicted.ravel()).reshape(predicted.shape) - 1
        hits = self.counts[np.arange(len(self.counts)), level]
        share: FloatArray = (w * hits).sum(axis=1) / (w * self.counts.sum(axis=1)).sum(axis=1)
        return share

    def share_given(
        self, predicted: FloatArray, weights: npt.ArrayLike, *, given: int, then: int
    ) -> FloatArray:
        """Share of one rating among those whose rounded prediction is another, in each resample.

        Parameters
        ----------
        predicted : array, shape (n, n_units)
        weights : array, shape (n, m)
        given : int
            Rounded prediction.
        then : int
            Rating whose share is asked for.

        Returns
        -------
        array, shape (n,)
            NaN where nothing has this prediction.
        """
        level = rounded_rating(predicted.ravel()).reshape(predicted.shape)
        w = self._unit_weights(weights) * (level == given)
        everything = w @ self.counts.sum(axis=1)
        with np.errstate(invalid="ignore", divide="ignore"):
            share: FloatArray = (w @ self.counts[:, then - 1]) / everything
        return share

    def _unit_weights(self, weights: npt.ArrayLike) -> FloatArray:
        return np.asarray(weights, dtype=float)[:, self.patient]

    def _normal_equations(self) -> tuple[FloatArray, FloatArray]:
        """Cross-products of basis and ratings, by patient."""
        sizes, sums = self.counts.sum(axis=1), self.counts @ _LEVELS
        own = [self.patient == patient for patient in range(self.n_patients)]
        gram = [(self.basis[at].T * sizes[at]) @ self.basis[at] for at in own]
        right = [self.basis[at].T @ sums[at] for at in own]
        return np.array(gram), np.array(right)


def rated_units(
    patients: npt.ArrayLike, predictors: npt.ArrayLike, ratings: npt.ArrayLike
) -> RatedUnits:
    """Gather ratings by patient and predictors.

    Parameters
    ----------
    patients : array or Series, shape (n_rows,)
        Patient of each rating.
    predictors : array, shape (n_rows, p)
        Any columns; what one adds to the others is what counts.
    ratings : array, shape (n_rows,)
        1 to 5.

    Returns
    -------
    RatedUnits

    Examples
    --------
    >>> units = rated_units(list("aabb"), [[1.0], [1.0], [1.0], [2.0]], [1, 3, 2, 5])
    >>> units.patient.tolist(), units.predict([[1, 1]]).round(9).tolist()
    ([0, 1, 1], [[2.0, 2.0, 5.0]])
    """
    codes, _ = cluster_codes(patients)
    x, y = np.asarray(predictors, dtype=float), np.asarray(ratings, dtype=float)
    rows = np.column_stack([codes, x])
    unique, inverse = np.unique(rows, axis=0, return_inverse=True)
    unit = inverse.ravel()
    counts = np.zeros((len(unique), len(RATINGS)))
    np.add.at(counts, (unit, y.astype(np.intp) - RATINGS[0]), 1.0)
    values = unique[:, 1:]
    sizes = counts.sum(axis=1)
    center = np.average(values, axis=0, weights=sizes)
    spread = np.sqrt(np.average((values - center) ** 2, axis=0, weights=sizes))
    columns = np.column_stack(
        [np.ones(len(unique)), (values - center) / np.where(spread > 0.0, spread, 1.0)]
    )
    root = np.sqrt(sizes)[:, None]
    directions, size, _ = np.linalg.svd(columns * root, full_matrices=False)
    basis = directions[:, size > _UNDETERMINED * size[0]] / root
    return RatedUnits(unique[:, 0].astype(np.intp), values, counts, basis, unit)


def mean_ranks(values: FloatArray, weights: FloatArray) -> FloatArray:
    """Mean rank of values that occur several times, row by row.

    Parameters
    ----------
    values : array, shape (n, k)
    weights : array, shape (n, k)
        How often each value occurs.

    Returns
    -------
    array, shape (n, k)

    Examples
    --------
    >>> mean_ranks(np.array([[3.0, 1.0, 3.0]]), np.array([[1.0, 2.0, 1.0]])).tolist()
    [[3.5, 1.5, 3.5]]
    """
    order = np.argsort(values, axis=1, kind="stable")
    ordered = np.take_along_axis(values, order, axis=1)
    last = np.cumsum(np.take_along_axis(weights, order, axis=1), axis=1)
    first = np.concatenate([np.zeros((len(values), 1)), last[:, :-1]], axis=1)
    new = np.ones(values.shape, dtype=bool)
    new[:, 1:] = ordered[:, 1:] != ordered[:, :-1]
    final = np.concatenate([new[:, 1:], np.ones((len(values), 1), dtype=bool)], axis=1)
    start = np.maximum.accumulate(np.where(new, first, 0.0), axis=1)
    backwards = np.where(final, last, np.inf)[:, ::-1]
    end = np.minimum.accumulate(backwards, axis=1)[:, ::-1]
    ranks = np.empty_like(ordered)
    np.put_along_axis(ranks, order, 0.5 * (start + end + 1.0), axis=1)
    return ranks


def _solve(gram: FloatArray, right: FloatArray) -> FloatArray:
    """Solve many small symmetric systems; directions that one leaves open are set to zero."""
    values, vectors = np.linalg.eigh(gram)
    known = values > _UNDETERMINED * values[:, -1:]
    inverse = np.where(known, 1.0 / np.where(known, values, 1.0), 0.0)
    projected = np.einsum("nji,nj->ni", vectors, right)
    solution: FloatArray = np.einsum("nij,nj->ni", vectors, inverse * projected)
    return solution
