"""The design of a mixed model: model matrix, column names and grouping factors, checked once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd

from swaystride.errors import ModelError
from swaystride.stats.grouping_factor import (
    FloatArray,
    GroupingFactor,
    check_distinct,
    grouping_factor,
)

# Share of a column (after the columns before it are projected out) below which it is taken as
# their linear combination. R's qr uses the same number.
_COLLINEAR = 1e-7


@dataclass(frozen=True, eq=False)
class MixedDesign:
    """Everything about a mixed model except the outcome.

    Attributes
    ----------
    X : array, shape (n, p)
        Model matrix of the fixed effects, full column rank.
    names : tuple of str
        Column names of `X`.
    factors : tuple of GroupingFactor
        One per random intercept.

    Raises
    ------
    ModelError
        If there are no rows, not more rows than columns, a value that is not finite, or
        collinear columns (which are named).

    Examples
    --------
    >>> table = pd.DataFrame({"x": [0.0, 1, 2, 0, 1, 2], "who": list("aaabbb")})
    >>> design = design_from_terms(table, ["x"], ["who"])
    >>> design.X.shape, design.names, design.factors[0].n_levels
    ((6, 2), ('Intercept', 'x'), 2)
    """

    X: FloatArray
    names: tuple[str, ...]
    factors: tuple[GroupingFactor, ...]

    def __post_init__(self) -> None:
        n, p = self.X.shape
        if n == 0:
            raise ModelError("there are no rows")
        if n <= p:
            raise ModelError(f"{n} rows cannot carry {p} fixed effects", expected="more rows")
        check_finite(self.X, self.names)
        _check_rank(self.X, self.R, self.names)

    @property
    def n(self) -> int:
        """Number of rows."""
        return int(self.X.shape[0])

    @property
    def p(self) -> int:
        """Number of fixed effects."""
        return int(self.X.shape[1])

    @cached_property
    def _qr(self) -> tuple[FloatArray, FloatArray]:
        Q, R = np.linalg.qr(self.X)
        return Q, R

    @property
    def Q(self) -> FloatArray:  # noqa: N802 - the letter of the decomposition
        """Orthonormal basis of the columns of `X`, shape (n, p)."""
        return self._qr[0]

    @property
    def R(self) -> FloatArray:  # noqa: N802 - the letter of the decomposition
        """Upper triangle with ``X = Q @ R``, shape (p, p)."""
        return self._qr[1]

    @cached_property
    def log_det_xtx(self) -> float:
        """Logarithm of the determinant of ``X.T @ X``."""
        return 2.0 * float(np.log(np.abs(np.diag(self.R))).sum())


def check_finite(values: FloatArray, names: Sequence[str]) -> None:
    """Refuse columns with values that are not finite.

    Parameters
    ----------
    values : array, shape (n, p)
    names : sequence of str
        Names of the columns.

    Raises
    ------
    ModelError
        Naming the first such column and the number of rows.

    Examples
    --------
    >>> check_finite(np.array([[1.0], [-np.inf]]), ["log(y)"])
    Traceback (most recent call last):
        ...
    swaystride.errors.ModelError: the column log(y) is not finite in 1 of 2 rows
    """
    if np.isfinite(values).all():
        return
    bad = (~np.isfinite(values)).sum(axis=0)
    at = int(np.argmax(bad > 0))
    raise ModelError(f"the column {names[at]} is not finite in {bad[at]} of {values.shape[0]} rows")


def _check_rank(X: FloatArray, R: FloatArray, names: Sequence[str]) -> None:
    """Name the first column that is zero or a combination of the columns before it."""
    norm = np.sqrt((X * X).sum(axis=0))
    for at, name in enumerate(names):
        if norm[at] == 0.0:
            raise ModelError(f"the fixed effect {name} is zero in every row")
        if abs(R[at, at]) < _COLLINEAR * norm[at]:
            weight = np.linalg.solve(R[:at, :at], R[:at, at]) * norm[:at] / norm[at]
            others = [
                other for other, w in zip(names, weight, strict=False) if abs(w) > 10 * _COLLINEAR
            ]
            raise ModelError(
                "the fixed effects are collinear", found=f"{name} is given by {', '.join(others)}"
            )


def check_columns(frame: pd.DataFrame, columns: Sequence[str]) -> None:
    """Refuse a table without rows, without a column or with missing values in it.

    Parameters
    ----------
    frame : pandas.DataFrame
    columns : sequence of str
        Columns that the model mentions.

    Raises
    ------
    ModelError
        Naming the column; for missing values also the number of rows, because rows are never
        dropped silently.

    Examples
    --------
    >>> check_columns(pd.DataFrame({"x": [1.0, None, 3.0]}), ["x"])
    Traceback (most recent call last):
        ...
    swaystride.errors.ModelError: the column x is missing in 1 of 3 rows; expected complete rows
    """
    for column in columns:
        if column not in frame.columns:
            raise ModelError(
                f"there is no column {column}",
                expected="one of " + ", ".join(map(str, frame.columns)),
            )
    if len(frame) == 0:
        raise ModelError("there are no rows")
    for column in columns:
        missing = int(frame[column].isna().sum())
        if missing:
            raise ModelError(
                f"the column {column} is missing in {missing} of {len(frame)} rows",
                expected="complete rows",
            )


def factors_from_frame(frame: pd.DataFrame, groups: Sequence[str]) -> tuple[GroupingFactor, ...]:
    """Build and check the grouping factors of a model.

    Parameters
    ----------
    frame : pandas.DataFrame
    groups : sequence of str
        ``"a"`` or ``"a:b"``.

    Returns
    -------
    tuple of GroupingFactor

    Examples
    --------
    >>> table = pd.DataFrame({"a": [1, 1, 2, 2], "b": [1, 2, 2, 2]})
    >>> [factor.name for factor in factors_from_frame(table, ["a", "b"])]
    ['a', 'b']
    """
    check_columns(frame, list(dict.fromkeys(part for name in groups for part in name.split(":"))))
    factors = tuple(grouping_factor(frame, name) for name in groups)
    check_distinct(factors)
    return factors


def design_from_terms(
    frame: pd.DataFrame, terms: Sequence[str], groups: Sequence[str]
) -> MixedDesign:
    """Design with an intercept and explicit numeric terms.

    Parameters
    ----------
    frame : pandas.DataFrame
        Numeric columns for the terms, any columns for the groups.
    terms : sequence of str
        Column names, or products of columns such as ``"block:trial_number"``.
    groups : sequence of str
        Grouping factors of the random intercepts.

    Returns
    -------
    MixedDesign

    Examples
    --------
    >>> table = pd.DataFrame({"x": [0.0, 1, 2, 3], "z": [1.0, 0, 0, 1], "who": list("aabb")})
    >>> design_from_terms(table, ["x", "x:z"], ["who"]).X.tolist()
    [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 2.0, 0.0], [1.0, 3.0, 3.0]]
    """
    X = model_matrix(frame, terms)
    return MixedDesign(X, ("Intercept", *terms), factors_from_frame(frame, groups))


def model_matrix(frame: pd.DataFrame, terms: Sequence[str]) -> FloatArray:
    """Model matrix of an intercept and explicit numeric terms.

    Parameters
    ----------
    frame : pandas.DataFrame
    terms : sequence of str
        Column names, or products of columns joined by colons.

    Returns
    -------
    array, shape (n, 1 + number of terms)

    Examples
    --------
    >>> model_matrix(pd.DataFrame({"x": [2.0, 3.0], "z": [5.0, 7.0]}), ["x:z"]).tolist()
    [[1.0, 10.0], [1.0, 21.0]]
    """
    check_columns(frame, list(dict.fromkeys(part for term in terms for part in term.split(":"))))
    X = np.ones((len(frame), 1 + len(terms)))
    for at, term in enumerate(terms, start=1):
        for part in term.split(":"):
            if not pd.api.types.is_numeric_dtype(frame[part]):
                raise ModelError(f"the column {part} is not numeric")
            X[:, at] *= frame[part].to_numpy(dtype=float)
    return X
