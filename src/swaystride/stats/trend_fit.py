"""Least squares of one outcome on a predictor and time, in an orthonormal basis of the terms."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.special import stdtr

from swaystride.errors import ModelError
from swaystride.stats.grouping_factor import CodeArray, FloatArray
from swaystride.stats.residual_autocorrelation import AutoregressiveErrors, autoregressive_errors

BoolArray = npt.NDArray[np.bool_]

#: Level, time, predictor.
N_TERMS: Final = 3
_FEWEST = N_TERMS + 2
#: A predictor of which less is left without time says nothing that time does not.
_COLLINEAR = 1e-9


@dataclass(frozen=True, eq=False)
class TrendFit:
    """Least squares of ``outcome ~ 1 + predictor + time``; made by :func:`fit_trend`.

    Attributes
    ----------
    rows : array of bool, shape (n_all,)
        Rows without a missing value; what follows is about these n rows.
    place : array of int, shape (n,)
        Place in the series.
    basis : array, shape (n, 3)
        Orthonormal: level, time, predictor without time.
    share : array, shape (2,)
        Coordinates of the predictor along time and along its own direction, of length one.
    coordinates : array, shape (2,)
        Of the outcome, likewise.
    residuals : array, shape (n,)
    p_time : float
        Two-sided p-value of time, for independent errors.
    """

    rows: BoolArray
    place: CodeArray
    basis: FloatArray
    share: FloatArray
    coordinates: FloatArray
    residuals: FloatArray
    p_time: float

    @property
    def n(self) -> int:
        """Number of rows."""
        return len(self.residuals)

    @property
    def r(self) -> float:
        """Correlation of predictor and outcome."""
        rest = self.residuals @ self.residuals
        return float(
            self.share @ self.coordinates / np.sqrt(self.coordinates @ self.coordinates + rest)
        )

    @property
    def r_partial(self) -> float:
        """Correlation of both once time is taken out of each; NaN if nothing of the outcome is left."""
        own = self.coordinates[1]
        left = np.hypot(own, np.linalg.norm(self.residuals))
        return float(own / left) if left > 0.0 else float("nan")

    @cached_property
    def autoregressive(self) -> AutoregressiveErrors:
        """Correlation of neighbouring errors, and their standard deviation."""
        return autoregressive_errors(self.residuals, self.basis, self.place)


def fit_trend(
    predictor: npt.ArrayLike, outcome: npt.ArrayLike, time: npt.ArrayLike, place: npt.ArrayLike
) -> TrendFit:
    """Fit one predictor and time to an outcome; rows with a missing value are left out.

    Parameters
    ----------
    predictor, outcome, time : array, shape (n,)
        NaN where missing.
    place : array of int, shape (n,)
        Place of each row in the series, rising; a place that is left out is a gap.

    Returns
    -------
    TrendFit

    Raises
    ------
    ModelError
        If fewer than five rows are complete, or in them the predictor or the outcome is constant or
        the predictor moves with time exactly.

    Examples
    --------
    >>> fit = fit_trend([1, 3, 2, 5, 4, 6], [1, 2, 2, 3, 3, 3], range(6), range(6))
    >>> round(fit.r, 3), round(fit.r_partial, 3)
    (0.917, 0.564)
    """
    columns = [np.asarray(values, dtype=float) for values in (predictor, outcome, time)]
    rows: BoolArray = np.isfinite(np.stack(columns)).all(axis=0)
    x, y, t = (values[rows] for values in columns)
    if len(x) < _FEWEST:
        raise ModelError("too few complete rows", expected=f"{_FEWEST} or more", found=str(len(x)))
    centred = []
    for name, values in (("predictor", x), ("outcome", y), ("time", t)):
        if np.ptp(values) <= 1e-14 * np.abs(values).max():
            raise ModelError(f"the {name} is constant", found=f"{values[0]:g}")
        centred.append(values - values.mean())
    x, y, t = centred
    along_time = t / np.linalg.norm(t)
    own = _without(x, along_time)
    if np.linalg.norm(own) <= _COLLINEAR * np.linalg.norm(x):
        raise ModelError("the predictor moves with time exactly")
    own_direction = own / np.linalg.norm(own)
    directions = np.stack([along_time, own_direction])
    coordinates = directions @ y
    residuals = y - coordinates @ directions
    sd = np.linalg.norm(residuals) / np.sqrt(len(y) - N_TERMS)
    time_left = _without(t, x / np.linalg.norm(x))
    with np.errstate(divide="ignore", invalid="ignore"):
        t_value = (time_left @ y) / np.linalg.norm(time_left) / sd
    level = np.full((len(y), 1), len(y) ** -0.5)
    return TrendFit(
        rows=rows,
        place=np.asarray(place, dtype=np.intp)[rows],
        basis=np.column_stack([level, directions.T]),
        share=directions @ x / np.linalg.norm(x),
        coordinates=coordinates,
        residuals=residuals,
        p_time=float(2.0 * stdtr(len(y) - N_TERMS, -abs(t_value))),
    )


def _without(values: FloatArray, direction: FloatArray) -> FloatArray:
    """Values without their part along a direction of length one; twice, against rounding."""
    for _ in range(2):
        values = values - (values @ direction) * direction
    return values
