"""Marginal correlation: the share of variance that one predictor explains in a mixed model.

For ``y ~ 1 + x + (1|group)`` with variance components s_a² (groups) and s_e² (residual)::

    R² = var(b x) / (var(b x) + s_a² + s_e²),    R = sign(b) sqrt(R²)

the marginal R² of Nakagawa & Schielzeth (2013), Methods Ecol. Evol. 4:133, with the sign of the
slope. ``var`` is the sample variance (divisor n - 1).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
import pandas as pd

from swaystride.errors import ModelError
from swaystride.stats.contrasts import DegreesOfFreedom
from swaystride.stats.grouping_factor import FloatArray
from swaystride.stats.mixed_model import MixedModelFit, fit_mixed_model
from swaystride.stats.mixed_refits import Seed

_FORMULA = "y ~ 1 + x + (1|group)"


@dataclass(frozen=True)
class MarginalCorrelation:
    """Marginal correlation and the fit it comes from.

    Attributes
    ----------
    r, r_squared : float
        The coefficient with the sign of the slope, and its square.
    ci_low, ci_high : float
        Confidence limits of `r`.
    p : float
        Two-sided p-value of the slope.
    beta, beta_se : float
        Slope and its standard error, in units of the outcome per unit of the predictor.
    predictor_variance, group_variance, residual_variance : float
        The three parts of the variance of the outcome.
    n, n_groups : int
        Rows and groups.
    converged : bool
        Whether the fit converged.
    n_not_converged : int
        Bootstrap refits that did not; 0 without a bootstrap.
    """

    r: float
    r_squared: float
    ci_low: float
    ci_high: float
    p: float
    beta: float
    beta_se: float
    predictor_variance: float
    group_variance: float
    residual_variance: float
    n: int
    n_groups: int
    converged: bool
    n_not_converged: int = 0


def marginal_correlation(
    y: npt.ArrayLike,
    x: npt.ArrayLike,
    groups: npt.ArrayLike,
    *,
    level: float = 0.95,
    reml: bool = True,
    df: DegreesOfFreedom = "satterthwaite",
) -> MarginalCorrelation:
    """Marginal correlation of an outcome with a predictor, rows being grouped.

    The limits are those of the slope, put into the formula of R with both variance components at
    their estimates. R rises with the slope, so the interval excludes zero exactly if the slope
    differs from zero at this level. It leaves out the uncertainty of the components;
    :func:`bootstrap_marginal_correlation` does not.

    Parameters
    ----------
    y, x : array, shape (n,)
        Outcome and predictor.
    groups : array, shape (n,)
        Label of the group of each row.
    level : float, optional
        Confidence level.
    reml : bool, optional
        REML (default) or ML.
    df : {"satterthwaite", "residual"}, optional
        Degrees of freedom of test and interval of the slope.

    Returns
    -------
    MarginalCorrelation

    Raises
    ------
    ModelError
        If the lengths differ, a value is missing, a variable is constant, or there are fewer than
        two groups.

    Examples
    --------
    >>> found = marginal_correlation(
    ...     [1.0, 2, 4, 3, 5, 6, 2, 3, 3], [1, 2, 3, 1, 2, 3, 1, 2, 3], list("aaabbbccc"))
    >>> round(found.r, 3), round(found.beta, 3), round(found.group_variance, 3)
    (0.598, 1.167, 1.47)
    """
    return _from_fit(_fit(y, x, groups, reml=reml), level=level, df=df)


def bootstrap_marginal_correlation(
    y: npt.ArrayLike,
    x: npt.ArrayLike,
    groups: npt.ArrayLike,
    *,
    n: int,
    seed: Seed,
    level: float = 0.95,
    reml: bool = True,
    df: DegreesOfFreedom = "satterthwaite",
) -> MarginalCorrelation:
    """Marginal correlation with percentile limits of the parametric bootstrap.

    Parameters
    ----------
    y, x : array, shape (n_rows,)
        Outcome and predictor.
    groups : array, shape (n_rows,)
        Label of the group of each row.
    n : int
        Number of simulated outcomes; groups and residuals are drawn anew, `x` stays.
    seed : int, sequence of int or numpy.random.SeedSequence
    level : float, optional
        Confidence level.
    reml : bool, optional
        REML (default) or ML.
    df : {"satterthwaite", "residual"}, optional
        Degrees of freedom of the test of the slope.

    Returns
    -------
    MarginalCorrelation
        As from :func:`marginal_correlation`, with the limits of the bootstrap.

    Raises
    ------
    ModelError
        As for :func:`marginal_correlation`, or if `n` is less than two.

    Examples
    --------
    >>> found = bootstrap_marginal_correlation(
    ...     [1.0, 2, 4, 3, 5, 6, 2, 3, 3], [1, 2, 3, 1, 2, 3, 1, 2, 3], list("aaabbbccc"),
    ...     n=200, seed=1)
    >>> found.ci_low < found.r < found.ci_high
    True
    """
    if n < 2:
        raise ModelError("too few draws for an interval", expected="2 or more", found=str(n))
    fit = _fit(y, x, groups, reml=reml)
    found = _from_fit(fit, level=level, df=df)
    refits = fit.refit_many(fit.simulate(n, seed))
    components = refits.variance_components
    draws = _signed_root(
        refits.estimates["x"].to_numpy(),
        _variance(fit),
        components["group"].to_numpy() + components["Residual"].to_numpy(),
    )
    low, high = np.quantile(draws, [(1.0 - level) / 2.0, (1.0 + level) / 2.0]).tolist()
    failed = int((~refits.converged).sum())
    return replace(found, ci_low=low, ci_high=high, n_not_converged=failed)


def _fit(y: npt.ArrayLike, x: npt.ArrayLike, groups: npt.ArrayLike, *, reml: bool) -> MixedModelFit:
    """The mixed model of checked columns."""
    columns = {"y": np.asarray(y), "x": np.asarray(x), "group": np.asarray(groups)}
    shapes = {values.shape for values in columns.values()}
    if len(shapes) != 1 or len(next(iter(shapes))) != 1:
        raise ModelError(
            "outcome, predictor and groups must be of the same rows",
            expected="three lists of one length",
            found="shapes " + ", ".join(str(values.shape) for values in columns.values()),
        )
    for name, label in (("y", "outcome"), ("x", "predictor")):
        values = columns[name] = columns[name].astype(float)
        bad = int((~np.isfinite(values)).sum())
        if bad:
            raise ModelError(f"the {label} is not finite in {bad} of {len(values)} rows")
        if len(values) and np.ptp(values) == 0.0:
            raise ModelError(f"the {label} is constant", found=str(values[0]))
    return fit_mixed_model(_FORMULA, pd.DataFrame(columns), reml=reml)


def _variance(fit: MixedModelFit) -> float:
    """Sample variance of the predictor."""
    return float(np.var(fit.estimates.design.X[:, 1], ddof=1))


def _signed_root(beta: FloatArray, variance: float, rest: FloatArray) -> FloatArray:
    """R of slopes, given the variance of the predictor and all other variance."""
    explained = beta**2 * variance
    root: FloatArray = np.sign(beta) * np.sqrt(explained / (explained + rest))
    return root


def _from_fit(fit: MixedModelFit, *, level: float, df: DegreesOfFreedom) -> MarginalCorrelation:
    """Coefficient, test and the limits of the slope on the scale of R."""
    if not 0.0 < level < 1.0:
        raise ModelError("the confidence level is no probability", found=str(level))
    names = ["estimate", "ci_low", "ci_high", "se", "p"]
    slope = fit.fixed_effects(df, level=level).loc["x", names].to_numpy(dtype=float)
    group, residual = fit.variance_components[["group", "Residual"]].tolist()
    variance = _variance(fit)
    r, low, high = _signed_root(slope[:3], variance, np.full(3, group + residual)).tolist()
    beta, se, p = slope[[0, 3, 4]].tolist()
    return MarginalCorrelation(
        r=r,
        r_squared=r**2,
        ci_low=low,
        ci_high=high,
        p=p,
        beta=beta,
        beta_se=se,
        predictor_variance=beta**2 * variance,
        group_variance=group,
        residual_variance=residual,
        n=fit.n_observations,
        n_groups=fit.n_groups["group"],
        converged=fit.converged,
    )
