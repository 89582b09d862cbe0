"""Least-squares prediction from several covariates, in sample and for clusters left out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import qr

from swaystride.errors import ModelError
from swaystride.stats.cluster_bootstrap import cluster_codes
from swaystride.stats.grouping_factor import CodeArray, FloatArray

# Share of a standardised column that its predecessors leave unexplained, below which it counts as
# their combination. Measures that are rounded to seven digits in between must still be caught.
_COLLINEAR = 1e-6


@dataclass(frozen=True, eq=False)
class LinearPrediction:
    """A least-squares prediction.

    Attributes
    ----------
    predicted : array, shape (n,)
        In sample.
    intercept : float
    coefficients : array, shape (p,)
        In the units of the covariates; zero for dropped ones.
    kept, dropped : tuple of int
        Columns that were used, and those that the others determine.
    """

    predicted: FloatArray
    intercept: float
    coefficients: FloatArray
    kept: tuple[int, ...]
    dropped: tuple[int, ...]

    def predict(self, covariates: npt.ArrayLike) -> FloatArray:
        """Predict further rows.

        Parameters
        ----------
        covariates : array, shape (m, p)
            In the order of the columns that were fitted.
        """
        x = np.asarray(covariates, dtype=float)
        result: FloatArray = self.intercept + x @ self.coefficients
        return result


def least_squares_prediction(covariates: npt.ArrayLike, outcome: npt.ArrayLike) -> LinearPrediction:
    """Ordinary least squares with an intercept; collinear columns are dropped and named.

    Columns are standardised first, so that units do not decide what is dropped. The pivoted QR
    decomposition takes the column with the most that is new first.

    Parameters
    ----------
    covariates : array, shape (n, p)
    outcome : array, shape (n,)

    Returns
    -------
    LinearPrediction

    Raises
    ------
    ModelError
        If shapes do not fit, a value is missing, or the outcome is constant.

    Examples
    --------
    >>> x = np.array([[1.0, 2.0], [2.0, 4.0], [3.0, 6.0], [4.0, 8.0]])
    >>> fit = least_squares_prediction(x, [3.0, 5.0, 7.0, 9.0])
    >>> len(fit.dropped), fit.predicted.round(9).tolist()
    (1, [3.0, 5.0, 7.0, 9.0])
    """
    x, y = _checked(covariates, outcome)
    center, spread = x.mean(axis=0), x.std(axis=0)
    usable = spread > _COLLINEAR * np.maximum(np.abs(center), np.finfo(float).tiny)
    z = np.zeros_like(x)
    z[:, usable] = (x[:, usable] - center[usable]) / spread[usable]
    triangle, order = qr(z, mode="r", pivoting=True)
    diagonal = np.abs(np.diag(triangle[: min(x.shape)]))
    rank = int((diagonal > _COLLINEAR * np.sqrt(len(y))).sum())
    kept = np.sort(order[:rank])
    weights = np.linalg.lstsq(z[:, kept], y - y.mean(), rcond=None)[0]
    coefficients = np.zeros(x.shape[1])
    coefficients[kept] = weights / spread[kept]
    intercept = float(y.mean() - center @ coefficients)
    dropped = tuple(sorted(set(range(x.shape[1])) - set(kept.tolist())))
    return LinearPrediction(
        y.mean() + z[:, kept] @ weights, intercept, coefficients, tuple(kept.tolist()), dropped
    )


def leave_one_cluster_out(
    covariates: npt.ArrayLike, outcome: npt.ArrayLike, clusters: npt.ArrayLike
) -> FloatArray:
    """Predict every cluster from a fit to all others.

    Parameters
    ----------
    covariates : array, shape (n, p)
    outcome : array, shape (n,)
    clusters : array or Series, shape (n,)
        Cluster of each row.

    Returns
    -------
    array, shape (n,)

    Raises
    ------
    ModelError
        As :func:`least_squares_prediction`, or with fewer than two clusters.

    Examples
    --------
    >>> left_out = leave_one_cluster_out([[1.0], [2], [3], [4]], [2.0, 4, 6, 8], list("aabb"))
    >>> left_out.round(9).tolist()
    [2.0, 4.0, 6.0, 8.0]
    """
    x, y = _checked(covariates, outcome)
    codes, labels = cluster_codes(clusters)
    if len(codes) != len(y):
        raise ModelError(
            "the clusters do not fit the rows", expected=f"{len(y)} labels", found=str(len(codes))
        )
    predicted = np.empty(len(y))
    for cluster in range(len(labels)):
        out: CodeArray = np.flatnonzero(codes == cluster)
        rest = np.flatnonzero(codes != cluster)
        predicted[out] = least_squares_prediction(x[rest], y[rest]).predict(x[out])
    return predicted


def dropped_names(fit: LinearPrediction, names: Sequence[str]) -> list[str]:
    """Names of the dropped columns.

    Parameters
    ----------
    fit : LinearPrediction
    names : sequence of str
        Of all columns.
    """
    return [names[at] for at in fit.dropped]


def _checked(covariates: npt.ArrayLike, outcome: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    x, y = np.asarray(covariates, dtype=float), np.asarray(outcome, dtype=float)
    if x.ndim != 2 or y.shape != (len(x),) or len(y) < 2:
        raise ModelError(
            "covariates and outcome do not fit",
            expected="(n, p) and (n,), n at least 2",
            found=f"{x.shape} and {y.shape}",
        )
    if not (np.isfinite(x).all() and np.isfinite(y).all()):
        raise ModelError("a value is missing", expected="complete rows")
    if np.ptp(y) == 0.0:
        raise ModelError("the outcome is constant", found=f"{y[0]:g}")
    return x, y
