"""The fixed response of standing sway to its physical parameters, and its inverse.

Expected log features of a trial (true angles after the filter of the analysis) are polynomials of
the physical inputs, fitted once on a designed set of simulated trials
(``scripts/fit_standing_response.py``) and stored in ``standing_response.json``. The inverse takes
wanted expectations to inputs by Newton's method on the polynomials: nothing is simulated, and no
trial is ever repeated until it hits a value.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import ConfigurationError
from swaystride.simulate.response_terms import monomials, scatter_terms, slopes
from swaystride.simulate.standing_model import StandingModel, TrialSettings

Array = NDArray[np.float64]

INPUTS: Final = ("ln_noise_ap", "ln_noise_ml", "activity", "pendulum_height_m")
#: The features that a simulated trial can have as wanted truth; the others follow from them.
FEATURES: Final = ("ap_rms", "ml_rms", "phi_mv")

_FILE: Final = Path(__file__).with_name("standing_response.json")
_MAX_ITERATIONS: Final = 50
_TOLERANCE: Final = 1e-11
#: How far beyond the fitted range Newton's method may look on its way, in half-ranges.
_SEARCH_LIMIT: Final = 1.5


@dataclass(frozen=True)
class PhysicalInputs:
    """Physical inputs of trials, and whether they give exactly what was wanted.

    Parameters
    ----------
    ln_noise_ap, ln_noise_ml : ndarray
        Logarithms of the noise torques' standard deviations over m g h.
    activity : ndarray
        Position on the path of activity.
    in_range : ndarray of bool
        False where what was wanted lies outside the fitted range: the inputs were moved to its
        border, keeping the RMS features if they can be kept.
    """

    ln_noise_ap: Array
    ln_noise_ml: Array
    activity: Array
    in_range: NDArray[np.bool_]

    @property
    def n_clipped(self) -> int:
        """How many trials could not have what was wanted."""
        return int(np.count_nonzero(~self.in_range))


@dataclass(frozen=True)
class StandingResponse:
    """Response surface of standing sway.

    Parameters
    ----------
    low, high : ndarray, shape (4,)
        Fitted range of each of :data:`INPUTS`.
    exponents : ndarray of int, shape (n_terms, 4)
        Powers of the inputs, scaled to −1…1, in each term.
    coefficients : ndarray, shape (n_terms, 3)
        Coefficient of each term for each of :data:`FEATURES`.
    scatter_coefficients : ndarray, shape (6, 6)
        Covariance of the log features of single trials about their expectation: coefficients of
        the :func:`scatter_terms` for the upper triangle by rows.
    fisher_z_coefficients : ndarray, shape (6,)
        Variance of Fisher's z of the correlation of AP and ML sway, likewise.
    model, trial : StandingModel, TrialSettings
        Settings for which the surface holds.
    record : mapping
        Size, seed and quality of the fit.
    """

    low: Array
    high: Array
    exponents: NDArray[np.int64]
    coefficients: Array
    scatter_coefficients: Array
    fisher_z_coefficients: Array
    model: StandingModel
    trial: TrialSettings
    record: Mapping[str, Any]

    def expected(self, inputs: ArrayLike) -> Array:
        """Expected log features.

        Parameters
        ----------
        inputs : array_like, shape (..., 4)
            In the order of :data:`INPUTS`.

        Returns
        -------
        ndarray, shape (..., 3)
            Logarithms of AP RMS and ML RMS (deg) and of the mean velocity (deg/s).
        """
        return np.asarray(monomials(self.scaled(inputs), self.exponents) @ self.coefficients)

    def scaled(self, inputs: ArrayLike) -> Array:
        """Inputs scaled to −1…1 over the fitted range."""
        values = np.asarray(inputs, dtype=np.float64)
        return np.asarray((2.0 * values - self.low - self.high) / (self.high - self.low))

    def process_covariance(self, inputs: PhysicalInputs) -> Array:
        """Covariance of the log features of single trials with the same physical inputs.

        Parameters
        ----------
        inputs : PhysicalInputs
            Of n trials.

        Returns
        -------
        ndarray, shape (n, 3, 3)
        """
        triangle = self._scatter_terms(inputs) @ self.scatter_coefficients
        full = np.empty((len(triangle), 3, 3))
        rows, columns = np.triu_indices(3)
        full[:, rows, columns] = triangle
        full[:, columns, rows] = triangle
        return full

    def fisher_z_sd(self, inputs: PhysicalInputs) -> Array:
        """Standard deviation of Fisher's z of the correlation of AP and ML sway, shape (n,)."""
        return np.asarray(np.sqrt(self._scatter_terms(inputs) @ self.fisher_z_coefficients))

    def _scatter_terms(self, inputs: PhysicalInputs) -> Array:
        """Terms of the scatter at the scaled activity and the logarithmic noise ratio."""
        scaled = (2.0 * inputs.activity - self.low[2] - self.high[2]) / (self.high[2] - self.low[2])
        return scatter_terms(scaled, inputs.ln_noise_ap - inputs.ln_noise_ml)

    def invert(self, wanted: ArrayLike, pendulum_height_m: ArrayLike) -> PhysicalInputs:
        """Physical inputs whose expected log features are the wanted ones.

        Parameters
        ----------
        wanted : array_like, shape (n, 3)
            Expected log features, in the order of :data:`FEATURES`.
        pendulum_height_m : array_like, shape (n,) or scalar
            Height of the centre of mass.

        Returns
        -------
        PhysicalInputs
            Arrays of shape (n,).

        Raises
        ------
        ConfigurationError
            If a height lies outside the fitted range.

        Examples
        --------
        >>> response = standing_response()
        >>> wanted = np.log([[1.2, 1.0, 1.4]])
        >>> found = response.invert(wanted, 0.88)
        >>> back = response.expected([[found.ln_noise_ap[0], found.ln_noise_ml[0],
        ...                            found.activity[0], 0.88]])
        >>> np.exp(back).round(9).tolist()
        [[1.2, 1.0, 1.4]]
        """
        target = np.asarray(wanted, dtype=np.float64)
        height = np.broadcast_to(np.asarray(pendulum_height_m, dtype=np.float64), len(target))
        outside = (height < self.low[3]) | (height > self.high[3])
        if outside.any():
            raise ConfigurationError(
                "pendulum height outside the response surface",
                expected=f"{self.low[3]:g} to {self.high[3]:g} m",
                found=f"{height[outside][0]:g} m",
            )
        points = np.zeros((len(target), 4))
        points[:, 3] = (2.0 * height - self.low[3] - self.high[3]) / (self.high[3] - self.low[3])
        solved = self._newton(points, target, free=(0, 1, 2))
        inside = solved & (np.abs(points[:, :3]) <= 1.0).all(axis=1)
        if not inside.all():
            points[~inside] = self._onto_border(points[~inside], target[~inside])
        inputs = (points * (self.high - self.low) + self.low + self.high) / 2.0
        return PhysicalInputs(inputs[:, 0], inputs[:, 1], inputs[:, 2], inside)

    def _onto_border(self, points: Array, target: Array) -> Array:
        """Nearest attainable points: activity at its border, noise such that the RMS fit."""
        nearest = points.copy()
        nearest[:, 2] = np.clip(nearest[:, 2], -1.0, 1.0)
        self._newton(nearest, target, free=(0, 1))
        nearest[:, :2] = np.clip(nearest[:, :2], -1.0, 1.0)
        return nearest

    def _newton(self, points: Array, target: Array, *, free: tuple[int, ...]) -> NDArray[np.bool_]:
        """Move the free inputs of `points` (in place) to the first targets; where it succeeded."""
        n = len(free)
        columns = list(free)
        missed = np.full(len(points), np.inf)
        for _ in range(_MAX_ITERATIONS):
            residual = (monomials(points, self.exponents) @ self.coefficients - target)[:, :n]
            missed = np.abs(residual).max(axis=1, initial=0.0)
            if (missed < _TOLERANCE).all():
                break
            jacobian = np.stack(
                [(slopes(points, self.exponents, j) @ self.coefficients)[:, :n] for j in free],
                axis=-1,
            )
            step = np.linalg.solve(jacobian, residual[..., None])[..., 0]
            moved = points[:, columns] - np.clip(step, -0.5, 0.5)
            points[:, columns] = np.clip(moved, -_SEARCH_LIMIT, _SEARCH_LIMIT)
        return np.asarray(missed < 1e-9)


@cache
def standing_response() -> StandingResponse:
    """The response surface that belongs to this version of the library."""
    return response_from_record(json.loads(_FILE.read_text(encoding="utf-8")))


def checked_response(model: StandingModel, trial: TrialSettings) -> StandingResponse:
    """The response surface, after checking that it was fitted for these settings.

    Parameters
    ----------
    model, trial : StandingModel, TrialSettings
        Settings that the caller is about to simulate with.

    Raises
    ------
    ConfigurationError
        If a setting differs from the one for which the surface was fitted.
    """
    response = standing_response()
    for wanted, fitted in ((model, response.model), (trial, response.trial)):
        stored = asdict(fitted)
        for name, value in asdict(wanted).items():
            if value != stored[name]:
                raise ConfigurationError(
                    "the response surface was fitted for another setting",
                    place=name,
                    expected=f"{stored[name]!r}, or a new scripts/fit_standing_response.py",
                    found=repr(value),
                )
    return response


def response_from_record(record: Mapping[str, Any]) -> StandingResponse:
    """Assemble the response surface from its record.

    Parameters
    ----------
    record : mapping
        As :func:`swaystride.simulate.standing_response_fit.fit_standing_response` returns it.
    """
    ranges = np.array([record["ranges"][name] for name in INPUTS])
    return StandingResponse(
        low=ranges[:, 0],
        high=ranges[:, 1],
        exponents=np.array(record["exponents"], dtype=np.int64),
        coefficients=np.array([record["coefficients"][name] for name in FEATURES]).T,
        scatter_coefficients=np.array(record["scatter_covariance"]).T,
        fisher_z_coefficients=np.array(record["fisher_z_variance"]),
        model=StandingModel(**record["model"]),
        trial=TrialSettings(**record["trial"]),
        record=record["fit"],
    )
