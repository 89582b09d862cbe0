"""Profile-likelihood and bootstrap confidence intervals of a mixed model."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pandas as pd
from scipy.optimize import brentq
from scipy.special import ndtri

from swaystride.errors import ModelError
from swaystride.stats.grouping_factor import FloatArray
from swaystride.stats.mixed_design import MixedDesign
from swaystride.stats.mixed_fit import (
    DesignFit,
    fit_design,
    mean_group_sizes,
    ols_residual,
    structure_of,
)
from swaystride.stats.mixed_optimiser import minimise_over_ratios
from swaystride.stats.mixed_refits import Seed, refit_responses, simulate_responses
from swaystride.stats.profiled_deviance import (
    BoundResponse,
    Derivatives,
    at_component_variance,
    at_residual_variance,
)

_MAX_EXPANSIONS = 60


def profile_intervals(fit: DesignFit, *, level: float) -> pd.DataFrame:
    """Invert the likelihood-ratio test of every parameter, with ML as lme4's profile does.

    Parameters
    ----------
    fit : DesignFit
        A REML fit is refitted by ML first.
    level : float
        Confidence level between 0 and 1.

    Returns
    -------
    pandas.DataFrame
        ``estimate`` (of ML), ``ci_low``, ``ci_high`` by fixed effect and by ``var(group)``.

    Raises
    ------
    ModelError
        If the deviance does not rise to the level within a plausible range.

    Examples
    --------
    >>> from swaystride.stats.mixed_design import design_from_terms
    >>> table = pd.DataFrame({"who": list("aabbcc")})
    >>> fit = fit_design(design_from_terms(table, [], ["who"]), np.array([1.0, 2, 4, 5, 8, 9]))
    >>> profile_intervals(fit, level=0.95).index.tolist()
    ['Intercept', 'var(who)', 'var(Residual)']
    """
    ml = fit_design(fit.design, fit.response, reml=False)
    rise = float(ndtri(0.5 + level / 2.0)) ** 2
    rows = [_fixed_effect(ml, at, rise) for at in range(ml.design.p)]
    rows += [_variance(ml, at, rise) for at in range(len(ml.variances))]
    return _table(ml, np.append(ml.beta, ml.variances), np.array(rows))


def bootstrap_intervals(fit: DesignFit, *, level: float, n: int, seed: Seed) -> pd.DataFrame:
    """Percentile intervals of the parametric bootstrap.

    Parameters
    ----------
    fit : DesignFit
    level : float
        Confidence level between 0 and 1.
    n : int
        Number of simulated responses.
    seed : int, sequence of int or numpy.random.SeedSequence

    Returns
    -------
    pandas.DataFrame
        ``estimate``, ``ci_low``, ``ci_high`` by fixed effect and by ``var(group)``.

    Examples
    --------
    >>> from swaystride.stats.mixed_design import design_from_terms
    >>> table = pd.DataFrame({"who": list("aabbcc")})
    >>> fit = fit_design(design_from_terms(table, [], ["who"]), np.array([1.0, 2, 4, 5, 8, 9]))
    >>> bootstrap_intervals(fit, level=0.95, n=100, seed=3).shape
    (3, 3)
    """
    responses = simulate_responses(fit, n, seed)
    refits = refit_responses(fit.design, responses, reml=fit.reml, start=fit.gamma)
    drawn = np.hstack([refits.estimates.to_numpy(), refits.variance_components.to_numpy()])
    tail = (1.0 - level) / 2.0
    limits = np.quantile(drawn, [tail, 1.0 - tail], axis=0).T
    return _table(fit, np.append(fit.beta, fit.variances), limits)


def _table(fit: DesignFit, estimates: FloatArray, limits: FloatArray) -> pd.DataFrame:
    components = [*(factor.name for factor in fit.design.factors), "Residual"]
    return pd.DataFrame(
        {"estimate": estimates, "ci_low": limits[:, 0], "ci_high": limits[:, 1]},
        index=[*fit.design.names, *(f"var({name})" for name in components)],
    )


def _fixed_effect(ml: DesignFit, at: int, rise: float) -> tuple[float, float]:
    """Both ends for one fixed effect: its column becomes an offset."""
    design, column = ml.design, ml.design.X[:, at]
    rest = MixedDesign(
        np.delete(design.X, at, axis=1),
        tuple(np.delete(np.array(design.names, dtype=object), at)),
        design.factors,
    )
    se = float(np.sqrt(ml.covariance[at, at]))

    def excess(value: float) -> float:
        held = fit_design(rest, ml.response - value * column, reml=False)
        return 2.0 * (ml.loglik - held.loglik) - rise

    step = float(np.sqrt(rise)) * se
    estimate = float(ml.beta[at])
    name = design.names[at]
    return (
        _crossing(excess, estimate, lambda i: estimate - step * 1.3**i, name),
        _crossing(excess, estimate, lambda i: estimate + step * 1.3**i, name),
    )


def _variance(ml: DesignFit, at: int, rise: float) -> tuple[float, float]:
    """Both ends for one variance component or the residual, searched on its square root."""
    bound = structure_of(ml.design).bind(ols_residual(ml.design, ml.response))
    name = [*(factor.name for factor in ml.design.factors), "Residual"][at]
    size = mean_group_sizes(ml.design)
    sd = float(np.sqrt(ml.variances[at]))
    typical = max(sd, 0.1 * float(np.sqrt(ml.sigma2 / np.append(size, 1.0)[at])))

    def excess(value: float) -> float:
        return _deviance_at(ml, bound, at, value**2) + 2.0 * ml.loglik - rise

    high = _crossing(excess, sd, lambda i: sd + typical * (1.3**i - 1.0), name)
    if at < len(size) and (sd == 0.0 or excess(0.0) <= 0.0):
        return 0.0, high**2
    return _crossing(excess, sd, lambda i: sd * 0.8**i, name) ** 2, high**2


def _deviance_at(ml: DesignFit, bound: BoundResponse, at: int, variance: float) -> float:
    """ML deviance minimised over everything but one variance."""
    n, k = ml.design.n, len(ml.gamma)
    size = mean_group_sizes(ml.design)
    free = np.arange(k)
    if at < k and variance == 0.0:
        free = np.delete(free, at)

    def objective(ratios: FloatArray) -> Derivatives:
        gamma = np.zeros(k)
        gamma[free] = ratios
        parts = bound.parts(gamma, reml=False)
        if at == k:
            return at_residual_variance(parts, n, variance)
        if variance > 0.0:
            return at_component_variance(parts, n, gamma, at, variance)
        value, gradient, hessian = at_residual_variance(parts, n, parts.s / n)
        relative = parts.s_gradient / parts.s
        hessian = hessian - n * np.outer(relative, relative)
        return value, gradient[free], hessian[np.ix_(free, free)]

    start = np.maximum(ml.gamma, 0.01 / size)
    if at < k and variance > 0.0:
        start[at] = variance / ml.sigma2
    return minimise_over_ratios(objective, size[free], start[free]).value


def _crossing(
    excess: Callable[[float], float], inside: float, outward: Callable[[int], float], name: str
) -> float:
    """Where the excess over the level changes sign between the estimate and far outside."""
    near = inside
    for i in range(1, _MAX_EXPANSIONS):
        far = outward(i)
        if excess(far) > 0.0:
            return float(brentq(excess, near, far, xtol=1e-10 * (abs(far) + abs(far - inside))))
        near = far
    raise ModelError(f"the profile of {name} has no end")
