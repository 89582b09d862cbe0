"""Fit a linear mixed model to a checked design: the engine below formulas and tables."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from swaystride.errors import ModelError
from swaystride.stats.crossed_factors import CrossedResponse, CrossedStructure
from swaystride.stats.grouping_factor import FloatArray
from swaystride.stats.mixed_design import MixedDesign
from swaystride.stats.mixed_optimiser import Minimum, minimise_over_ratios
from swaystride.stats.one_factor import OneFactorResponse, OneFactorStructure
from swaystride.stats.profiled_deviance import (
    BoundResponse,
    Derivatives,
    profiled,
    profiled_value,
)

# Above this number of levels the eigenvectors of the closed form cost more than they save.
_MAX_SPECTRUM = 400
# Share of the outcome's spread below which what is left over is rounding.
_ROUNDING = 1e-12
# Share of the outcome's variance at which a fit that did not converge is one without residual.
_VANISHED = 1e-7
# Standard deviation ratio below which a component counts as zero, as in lme4's isSingular.
_SINGULAR = 1e-4
# Variance ratio of the second start that singular fits with several factors get.
_LARGE = 30.0


@dataclass(frozen=True, eq=False)
class DesignFit:
    """Estimates of one mixed model, as arrays.

    Attributes
    ----------
    design : MixedDesign
    response : array, shape (n,)
    reml : bool
    gamma : array, shape (k,)
        Variance ratios, component over residual.
    sigma2 : float
        Residual variance.
    loglik : float
        Log-likelihood, or the REML criterion's equivalent as in lme4.
    beta : array, shape (p,)
    random : tuple of array
        Predicted random effects (BLUPs) per grouping factor.
    residual : array, shape (n,)
        Outcome minus fixed and random effects.
    converged : bool
    message : str
    """

    design: MixedDesign
    response: FloatArray
    reml: bool
    gamma: FloatArray
    sigma2: float
    loglik: float
    beta: FloatArray
    precision: FloatArray
    random: tuple[FloatArray, ...]
    residual: FloatArray
    converged: bool
    message: str

    @property
    def nu(self) -> int:
        """Divisor of the residual variance: n for ML, n - p for REML."""
        return self.design.n - (self.design.p if self.reml else 0)

    @property
    def variances(self) -> FloatArray:
        """Variance components in the order of the factors, then the residual, shape (k + 1,)."""
        return np.append(self.gamma * self.sigma2, self.sigma2)

    @property
    def is_singular(self) -> bool:
        """Whether a variance component is zero."""
        return bool((np.sqrt(self.gamma) < _SINGULAR).any())

    @property
    def aic(self) -> float:
        """Akaike's criterion; fixed effects, components and residual all count, as in lme4."""
        return -2.0 * self.loglik + 2.0 * (self.design.p + len(self.gamma) + 1)

    @cached_property
    def covariance(self) -> FloatArray:
        """Covariance matrix of the fixed effects, shape (p, p)."""
        root = np.linalg.solve(self.design.R, np.linalg.inv(np.linalg.cholesky(self.precision)).T)
        covariance: FloatArray = self.sigma2 * (root @ root.T)
        return covariance


def fit_design(
    design: MixedDesign, y: FloatArray, *, reml: bool = True, start: FloatArray | None = None
) -> DesignFit:
    """Fit a mixed model to a design and an outcome.

    Parameters
    ----------
    design : MixedDesign
    y : array, shape (n,)
    reml : bool, optional
        REML (default) or ML.
    start : array, shape (k,), optional
        Variance ratios to start from with several grouping factors; a single one needs none.

    Returns
    -------
    DesignFit

    Raises
    ------
    ModelError
        If the outcome is constant or is reproduced exactly.

    Examples
    --------
    >>> import pandas as pd
    >>> from swaystride.stats.mixed_design import design_from_terms
    >>> table = pd.DataFrame({"who": list("aabbcc")})
    >>> fit = fit_design(design_from_terms(table, [], ["who"]), np.array([1.0, 2, 4, 5, 8, 9]))
    >>> fit.variances.round(9).tolist()  # mean squares 24.666667 and 0.5
    [12.083333333, 0.5]
    """
    residual = ols_residual(design, y)
    structure = structure_of(design)
    bound = structure.bind(residual)
    check_outcome(y, residual, bound)
    minimum = _best_ratios(design, bound, start, reml=reml)
    fit = fit_at(
        design, y, bound, minimum.gamma, reml=reml, message=(minimum.converged, minimum.message)
    )
    vanished = fit.sigma2 < _VANISHED * float(residual @ residual) / design.n
    if start is None and vanished and not fit.converged:
        raise ModelError("the groups reproduce the outcome: no residual variance is left")
    return fit


def fit_at(
    design: MixedDesign,
    y: FloatArray,
    bound: BoundResponse,
    gamma: FloatArray,
    *,
    reml: bool,
    message: tuple[bool, str],
) -> DesignFit:
    """Assemble the estimates at given variance ratios.

    Parameters
    ----------
    design : MixedDesign
    y : array, shape (n,)
    bound : BoundResponse
        Design and residual of ordinary least squares.
    gamma : array, shape (k,)
    reml : bool
    message : tuple of bool and str
        Whether the optimiser converged, and its words.

    Returns
    -------
    DesignFit
    """
    logdet, s = bound.value(gamma, reml=reml)
    solution = bound.solution(gamma)
    nu = design.n - (design.p if reml else 0)
    beta: FloatArray = np.linalg.solve(design.R, design.Q.T @ y + solution.shift)
    deviance = profiled_value(logdet, s, nu) + (design.log_det_xtx if reml else 0.0)
    return DesignFit(
        design=design,
        response=y,
        reml=reml,
        gamma=gamma,
        sigma2=s / nu,
        loglik=-0.5 * deviance,
        beta=beta,
        precision=solution.precision,
        random=solution.random,
        residual=solution.residual,
        converged=message[0],
        message=message[1],
    )


def structure_of(design: MixedDesign) -> OneFactorStructure | CrossedStructure:
    """What is computed once per design; kept with the design.

    Parameters
    ----------
    design : MixedDesign

    Returns
    -------
    OneFactorStructure or CrossedStructure
        A closed form for a single grouping factor, the block form otherwise.
    """
    kept: OneFactorStructure | CrossedStructure | None = design.__dict__.get("_structure")
    if kept is None:
        single = len(design.factors) == 1 and design.factors[0].n_levels <= _MAX_SPECTRUM
        kept = OneFactorStructure(design) if single else CrossedStructure(design)
        design.__dict__["_structure"] = kept
    return kept


def ols_residual(design: MixedDesign, y: FloatArray) -> FloatArray:
    """Project the fixed effects out of responses, twice so that a large mean leaves no trace.

    Parameters
    ----------
    design : MixedDesign
    y : array, shape (n,) or (n, N)

    Returns
    -------
    array of the same shape
    """
    once = y - design.Q @ (design.Q.T @ y)
    twice: FloatArray = once - design.Q @ (design.Q.T @ once)
    return twice


def check_outcome(y: FloatArray, residual: FloatArray, bound: BoundResponse) -> None:
    """Refuse an outcome that leaves no residual variance to estimate.

    Parameters
    ----------
    y, residual : array, shape (n,)
    bound : BoundResponse
        What is left of it within groups is checked for a single grouping factor.

    Raises
    ------
    ModelError
    """
    scale = float(np.abs(y).max())
    if not np.isfinite(scale):
        raise ModelError("the outcome is not finite")
    if float(np.ptp(y)) <= _ROUNDING * scale:
        raise ModelError("the outcome is constant", found=f"{y[0]:g} in all {len(y)} rows")
    if float(np.abs(residual).max()) <= _ROUNDING * scale:
        raise ModelError("the fixed effects reproduce the outcome exactly")
    if isinstance(bound, OneFactorResponse) and float(np.sqrt(bound.s0[0])) <= (
        10.0 * _ROUNDING * scale
    ):
        raise ModelError("the groups reproduce the outcome: no residual variance is left")


def _best_ratios(
    design: MixedDesign,
    bound: OneFactorResponse | CrossedResponse,
    start: FloatArray | None,
    *,
    reml: bool,
) -> Minimum:
    """Closed-form search for one factor, projected Newton for several."""
    nu = design.n - (design.p if reml else 0)
    if isinstance(bound, OneFactorResponse):
        many = bound.best_ratios(reml=reml)
        converged = bool(many.converged[0])
        return Minimum(
            many.gamma[:1],
            float(many.s[0]),
            converged,
            f"{'converged' if converged else 'not converged'} after {many.iterations} Newton steps",
            many.iterations,
        )
    size = mean_group_sizes(design)
    objective = _CrossedDeviance(bound, nu, reml=reml)
    if start is not None:
        start = np.maximum(start, 0.1 / size)
        bound.structure.keep(start)
        return minimise_over_ratios(objective, _effective_sizes(bound, start, reml=reml), start)
    first = minimise_over_ratios(objective, size, 1.0 / size)
    if first.converged and (first.gamma > 0.0).all():
        return first
    # The boundary can hold a second, lower hill: approach it from the other side as well.
    known = first if first.converged else None
    second = minimise_over_ratios(objective, size, np.full(len(size), _LARGE), known)
    better = second.value < first.value - 1e-9 * abs(first.value)
    return second if second.converged and (better or not first.converged) else first


def _effective_sizes(bound: CrossedResponse, gamma: FloatArray, *, reml: bool) -> FloatArray:
    """What the rows per level are worth beside the other components, shape (k,).

    The slope of the log-determinant of a lone balanced factor is its number of levels times
    ``size / (1 + gamma * size)``; solved for the size.
    """
    factors = bound.structure.design.factors
    levels = np.array([factor.n_levels for factor in factors])
    slope = bound.structure.at(gamma).logdet_gradient(reml=reml) / levels
    sizes: FloatArray = slope / np.maximum(1.0 - slope * gamma, 1e-3)
    return sizes


class _CrossedDeviance:
    """Profiled deviance of one response with several grouping factors."""

    def __init__(self, bound: CrossedResponse, nu: int, *, reml: bool) -> None:
        self.bound, self.nu, self.reml = bound, nu, reml

    def sketch(self, gamma: FloatArray) -> tuple[Derivatives, FloatArray]:
        """Without the Hessian of the log-determinant; the gradient of the latter."""
        parts = self.bound.sketch(gamma, reml=self.reml)
        return profiled(parts, self.nu), parts.logdet_gradient

    def costly_hessian(self, gamma: FloatArray) -> FloatArray:
        """Hessian of the log-determinant."""
        return self.bound.structure.at(gamma).logdet_hessian(reml=self.reml)


def mean_group_sizes(design: MixedDesign) -> FloatArray:
    """Rows per level of each grouping factor, shape (k,).

    Parameters
    ----------
    design : MixedDesign

    Returns
    -------
    array, shape (k,)
    """
    return np.array([design.n / factor.n_levels for factor in design.factors])
