"""Prediction by ordinary least squares, also of clusters that the fit has not seen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from swaystride.errors import ModelError
from swaystride.stats.cluster_bootstrap import cluster_codes
from swaystride.stats.grouping_factor import FloatArray
from swaystride.stats.mixed_design import check_columns, check_finite

# Share of a standardised column that must be left after the columns kept before it: above what
# rounding to eight digits in a file leaves of a combination if the spread is a tenth of the mean,
# far below what real measures leave. R's lm, which does not centre the columns, has 1e-7.
_COLLINEAR = 1e-6


@dataclass(frozen=True, eq=False)
class LinearPrediction:
    """Ordinary least squares with an intercept.

    Attributes
    ----------
    kept, dropped : tuple of str
        Columns used, and columns that are constant or a combination of those kept before them.
    coefficients : pandas.Series
        ``Intercept``, then the kept columns.
    predictions : pandas.Series
        Of the rows that were fitted.
    """

    kept: tuple[str, ...]
    dropped: tuple[str, ...]
    coefficients: pd.Series[float]
    predictions: pd.Series[float]

    def predict(self, X: pd.DataFrame) -> pd.Series[float]:
        """Predict rows from their columns.

        Parameters
        ----------
        X : pandas.DataFrame
            With the kept columns.

        Returns
        -------
        pandas.Series
            Indexed as `X`.

        Raises
        ------
        ModelError
            If a column is absent, not numeric or not finite.
        """
        values = _numbers(X, self.kept) @ self.coefficients.to_numpy()[1:]
        return pd.Series(self.coefficients.iloc[0] + values, index=X.index, name="prediction")


@dataclass(frozen=True, eq=False)
class LeftOutPrediction:
    """Predictions of each cluster by a fit to all others.

    Attributes
    ----------
    predictions : pandas.Series
        By row of the table.
    dropped : dict
        Columns that the fit without a cluster dropped, by cluster.
    """

    predictions: pd.Series[float]
    dropped: dict[Any, tuple[str, ...]]


def least_squares_prediction(
    X: pd.DataFrame, y: npt.ArrayLike | pd.Series[float]
) -> LinearPrediction:
    """Fit an outcome by ordinary least squares on an intercept and columns.

    Columns are standardised and orthogonalised in their order; one of which nothing is left is
    moved behind the others and dropped (QR with limited pivoting, as in R's ``lm``). So of
    collinear columns the later is dropped, whatever their units: pivoting by size would leave the
    choice between two equivalent columns to rounding.

    Parameters
    ----------
    X : pandas.DataFrame
        One numeric column per predictor, without an intercept.
    y : array or pandas.Series, shape (n,)
        Outcome; a Series has the index of `X`.

    Returns
    -------
    LinearPrediction

    Raises
    ------
    ModelError
        If rows do not match, a value is missing or not finite, or there are not more rows than
        coefficients.

    Examples
    --------
    >>> speed = pd.DataFrame({"mean_speed": [1.0, 2, 4, 3], "path_length": [30.0, 60, 120, 90]})
    >>> fit = least_squares_prediction(speed, [3.0, 5.0, 9.0, 7.0])
    >>> fit.kept, fit.dropped, fit.coefficients.round(9).tolist()
    (('mean_speed',), ('path_length',), [1.0, 2.0])
    """
    names = tuple(X.columns)
    values, outcome = _numbers(X, names), _outcome(X, y)
    mean = values.mean(axis=0)
    centred = values - mean
    kept = _independent(values, centred)
    if len(values) <= len(kept) + 1:
        raise ModelError(
            f"{len(values)} rows cannot carry {len(kept) + 1} coefficients", expected="more rows"
        )
    scale = np.sqrt((centred[:, kept] ** 2).sum(axis=0))
    Q, R = np.linalg.qr(centred[:, kept] / scale)
    middle = outcome.mean()
    slopes = np.linalg.solve(R, Q.T @ (outcome - middle)) / scale
    used = tuple(names[at] for at in kept)
    return LinearPrediction(
        kept=used,
        dropped=tuple(name for at, name in enumerate(names) if at not in kept),
        coefficients=pd.Series(
            np.append(middle - mean[kept] @ slopes, slopes), index=["Intercept", *used]
        ),
        predictions=pd.Series(middle + centred[:, kept] @ slopes, index=X.index, name="prediction"),
    )


def leave_one_cluster_out(
    X: pd.DataFrame, y: npt.ArrayLike | pd.Series[float], clusters: npt.ArrayLike
) -> LeftOutPrediction:
    """Predict each cluster by a fit to the rows of all other clusters.

    Which columns are dropped is decided anew in every fit, from its own rows alone.

    Parameters
    ----------
    X : pandas.DataFrame
        One numeric column per predictor, without an intercept.
    y : array or pandas.Series, shape (n,)
        Outcome; a Series has the index of `X`.
    clusters : array or pandas.Series, shape (n,)
        Cluster of each row.

    Returns
    -------
    LeftOutPrediction

    Raises
    ------
    ModelError
        As :func:`least_squares_prediction`, and if there are fewer than two clusters.

    Examples
    --------
    >>> X = pd.DataFrame({"x": [0.0, 1, 2, 3, 4, 5]})
    >>> left_out = leave_one_cluster_out(X, [0.0, 1, 2, 9, 9, 9], list("aaabbb"))
    >>> left_out.predictions.round(9).tolist()  # rows of a from those of b, and the reverse
    [9.0, 9.0, 9.0, 3.0, 4.0, 5.0]
    """
    codes, labels = cluster_codes(clusters)
    if len(codes) != len(X):
        raise ModelError(
            "the clusters do not fit the rows", expected=f"{len(X)} rows", found=f"{len(codes)}"
        )
    outcome = _outcome(X, y)
    predictions = np.empty(len(X))
    dropped = {}
    for at, label in enumerate(labels):
        out = codes == at
        fit = least_squares_prediction(X[~out], outcome[~out])
        predictions[out] = fit.predict(X[out])
        dropped[label] = fit.dropped
    return LeftOutPrediction(pd.Series(predictions, index=X.index, name="prediction"), dropped)


def _independent(values: FloatArray, centred: FloatArray) -> list[int]:
    """Columns that are no combination of the intercept and the kept columns before them."""
    kept: list[int] = []
    basis = np.zeros((len(values), 0))
    for at in range(values.shape[1]):
        norm = np.linalg.norm(centred[:, at])
        if norm <= _COLLINEAR * np.linalg.norm(values[:, at]):
            continue
        rest = centred[:, at] / norm
        for _ in range(2):  # the second pass removes what rounding left of the first
            rest = rest - basis @ (basis.T @ rest)
        left = np.linalg.norm(rest)
        if left > _COLLINEAR:
            kept.append(at)
            basis = np.column_stack([basis, rest / left])
    return kept


def _numbers(X: pd.DataFrame, columns: tuple[str, ...]) -> FloatArray:
    if not X.columns.is_unique:
        raise ModelError(f"the column {X.columns[X.columns.duplicated()][0]} occurs twice")
    check_columns(X, columns)
    for column in columns:
        if not pd.api.types.is_numeric_dtype(X[column]):
            raise ModelError(f"the column {column} is not numeric")
    values = X[list(columns)].to_numpy(dtype=float)
    check_finite(values, list(map(str, columns)))
    return values


def _outcome(X: pd.DataFrame, y: npt.ArrayLike | pd.Series[float]) -> FloatArray:
    if isinstance(y, pd.Series) and not y.index.equals(X.index):
        raise ModelError("outcome and columns are labelled by other rows")
    values = np.asarray(y, dtype=float)
    if values.shape != (len(X),):
        raise ModelError(
            "the outcome does not fit the rows",
            expected=f"{len(X)} values",
            found=str(values.shape),
        )
    check_finite(values[:, None], ["y"])
    return values
