"""Linear mixed models with random intercepts, from a formula and a table."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt
import pandas as pd

from swaystride.errors import ModelError
from swaystride.stats.contrasts import (
    DegreesOfFreedom,
    Weights,
    contrast_label,
    contrast_rows,
    contrast_tests,
)
from swaystride.stats.formula_design import design_from_formula
from swaystride.stats.grouping_factor import FloatArray
from swaystride.stats.mixed_fit import DesignFit, fit_design
from swaystride.stats.mixed_formula import parse_mixed_formula
from swaystride.stats.mixed_intervals import bootstrap_intervals, profile_intervals
from swaystride.stats.mixed_refits import Refits, Seed, refit_responses, simulate_responses

IntervalMethod = Literal["wald", "profile", "bootstrap"]


def fit_mixed_model(
    formula: str, frame: pd.DataFrame, *, reml: bool = True, family: str = "gaussian"
) -> MixedModelFit:
    """Fit a linear mixed model with any number of crossed or nested random intercepts.

    Parameters
    ----------
    formula : str
        As in lme4: ``"y ~ x*z + (1|a) + (1|b) + (1|a:b)"``. The fixed part is read by formulaic.
    frame : pandas.DataFrame
        One row per observation, complete in all columns that the formula mentions.
    reml : bool, optional
        Restricted maximum likelihood (default) or maximum likelihood.
    family : str, optional
        Distribution of the outcome given the random effects; only ``"gaussian"``.

    Returns
    -------
    MixedModelFit

    Raises
    ------
    ModelError
        If the model is out of scope (random slopes, another family) or not identifiable, or the
        table lacks a column or a value. Rows are never dropped silently.

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> table = pd.DataFrame({"who": np.repeat(list("abcdefgh"), 6), "x": np.tile(range(6), 8)})
    >>> table["y"] = 2 * table["x"] + np.repeat(rng.normal(size=8), 6) + rng.normal(size=48)
    >>> fit = fit_mixed_model("y ~ x + (1|who)", table)
    >>> fit.converged, fit.n_groups
    (True, {'who': 8})
    >>> fit.refit_many(fit.simulate(500, seed=7)).estimates.shape
    (500, 2)
    """
    if family != "gaussian":
        raise ModelError(
            "generalised linear mixed models are out of scope",
            expected="family 'gaussian'",
            found=repr(family),
        )
    design, y = design_from_formula(parse_mixed_formula(formula), frame)
    return MixedModelFit(formula, fit_design(design, y, reml=reml), frame.index)


@dataclass(frozen=True, eq=False)
class MixedModelFit:
    """A fitted linear mixed model; made by :func:`fit_mixed_model`.

    Attributes
    ----------
    formula : str
        As written.
    estimates : DesignFit
        The same fit as plain arrays.
    index : pandas.Index
        Row labels of the table.
    """

    formula: str
    estimates: DesignFit
    index: pd.Index

    @property
    def reml(self) -> bool:
        """Whether the fit is by REML."""
        return self.estimates.reml

    @property
    def loglik(self) -> float:
        """Log-likelihood; for REML minus half of lme4's REML criterion."""
        return self.estimates.loglik

    @property
    def aic(self) -> float:
        """Akaike's criterion; fixed effects, components and residual all count, as in lme4."""
        return self.estimates.aic

    @property
    def is_singular(self) -> bool:
        """Whether a variance component is estimated as zero."""
        return self.estimates.is_singular

    @property
    def converged(self) -> bool:
        """Whether the conditions of a minimum were verified."""
        return self.estimates.converged

    @property
    def message(self) -> str:
        """What the optimiser reports."""
        return self.estimates.message

    @property
    def n_observations(self) -> int:
        """Number of rows."""
        return self.estimates.design.n

    @property
    def n_groups(self) -> dict[str, int]:
        """Number of levels by grouping factor."""
        return {factor.name: factor.n_levels for factor in self.estimates.design.factors}

    @property
    def variance_components(self) -> pd.Series[float]:
        """Variances by group as written in the formula, then ``Residual``."""
        return pd.Series(self.estimates.variances, index=[*self.n_groups, "Residual"])

    @property
    def covariance(self) -> pd.DataFrame:
        """Covariance matrix of the fixed effects."""
        names = self.estimates.design.names
        return pd.DataFrame(self.estimates.covariance, index=[*names], columns=[*names])

    @property
    def residuals(self) -> pd.Series[float]:
        """Outcome minus fixed and predicted random effects, by row."""
        return pd.Series(self.estimates.residual, index=self.index)

    @property
    def fitted(self) -> pd.Series[float]:
        """Fixed plus predicted random effects, by row."""
        return pd.Series(self.estimates.response - self.estimates.residual, index=self.index)

    def random_effects(self) -> dict[str, pd.Series[float]]:
        """Predict the random effects (BLUPs).

        Returns
        -------
        dict of str to pandas.Series
            By grouping factor, then by level; levels of ``a:b`` are joined by a colon.
        """
        return {
            factor.name: pd.Series(values, index=factor.levels)
            for factor, values in zip(
                self.estimates.design.factors, self.estimates.random, strict=True
            )
        }

    def fixed_effects(
        self, df: DegreesOfFreedom = "satterthwaite", *, level: float = 0.95
    ) -> pd.DataFrame:
        """Estimates and tests of the fixed effects.

        Parameters
        ----------
        df : {"satterthwaite", "residual"}, optional
            Degrees of freedom of the t distribution; "residual" is rows minus fixed effects.
        level : float, optional
            Confidence level.

        Returns
        -------
        pandas.DataFrame
            ``estimate, se, df, t, p, ci_low, ci_high`` by term.
        """
        fit, names = self.estimates, [*self.estimates.design.names]
        return contrast_tests(fit, np.eye(len(names)), names, df=df, level=level)

    def contrast(
        self,
        L: Weights,
        df: DegreesOfFreedom = "satterthwaite",
        *,
        level: float = 0.95,
    ) -> pd.DataFrame:
        """Estimate and test linear combinations of the fixed effects.

        Parameters
        ----------
        L : mapping of str to float, or array of shape (p,) or (m, p)
            Weights by term, in a vector, or one combination per row of a matrix.
        df : {"satterthwaite", "residual"}, optional
        level : float, optional
            Confidence level.

        Returns
        -------
        pandas.DataFrame
            ``estimate, se, df, t, p, ci_low, ci_high``, one row per combination, labelled by it.

        Raises
        ------
        ModelError
            If a term is unknown, a row is zero, or the shape does not fit.

        Examples
        --------
        >>> table = pd.DataFrame(
        ...     {"y": [1.0, 3, 2, 6, 5, 9], "s": list("uvuvuv"), "who": list("aabbcc")}
        ... )
        >>> fit = fit_mixed_model("y ~ s + (1|who)", table)
        >>> fit.contrast({"Intercept": 1, "s[T.v]": 0.5})["estimate"].round(6).to_dict()
        {'Intercept + 0.5*s[T.v]': 4.333333}
        """
        rows = contrast_rows(self.estimates.design, L)
        labels = [contrast_label(self.estimates.design, row) for row in rows]
        return contrast_tests(self.estimates, rows, labels, df=df, level=level)

    def confint(
        self,
        method: IntervalMethod = "wald",
        *,
        level: float = 0.95,
        df: DegreesOfFreedom = "satterthwaite",
        n: int = 1000,
        seed: Seed | None = None,
    ) -> pd.DataFrame:
        """Confidence intervals.

        Parameters
        ----------
        method : {"wald", "profile", "bootstrap"}, optional
            Wald intervals cover the fixed effects; the others also the variance components, in
            rows ``var(group)``. Profiles are of the ML likelihood, as in lme4. The bootstrap is
            parametric with percentile limits.
        level : float, optional
            Confidence level.
        df : {"satterthwaite", "residual"}, optional
            For Wald intervals.
        n : int, optional
            Number of bootstrap responses.
        seed : int, sequence of int or numpy.random.SeedSequence, optional
            Needed for the bootstrap.

        Returns
        -------
        pandas.DataFrame
            ``estimate, ci_low, ci_high``.

        Raises
        ------
        ModelError
            If the method is unknown or a seed is missing.
        """
        if not 0.0 < level < 1.0:
            raise ModelError("the confidence level is no probability", found=str(level))
        if method == "wald":
            return self.fixed_effects(df, level=level)[["estimate", "ci_low", "ci_high"]]
        if method == "profile":
            return profile_intervals(self.estimates, level=level)
        if method == "bootstrap":
            if seed is None:
                raise ModelError("the bootstrap needs a seed")
            return bootstrap_intervals(self.estimates, level=level, n=n, seed=seed)
        raise ModelError(
            "unknown kind of interval", expected="wald, profile or bootstrap", found=str(method)
        )

    def simulate(self, n: int, seed: Seed) -> FloatArray:
        """Draw responses from the fitted model, with new random effects.

        Parameters
        ----------
        n : int
            Number of responses.
        seed : int, sequence of int or numpy.random.SeedSequence

        Returns
        -------
        array, shape (n, n_observations)
        """
        return simulate_responses(self.estimates, n, seed)

    def refit_many(self, responses: npt.ArrayLike, *, processes: int = 1) -> Refits:
        """Fit the same model to many responses.

        Parameters
        ----------
        responses : array, shape (N, n_observations)
            One response per row, as :meth:`simulate` returns them.
        processes : int, optional
            Processes that share the work if there are several grouping factors; the result does
            not depend on their number. A script that asks for more than one protects its own
            start by ``if __name__ == "__main__":``.

        Returns
        -------
        Refits
            Estimates, standard errors, variance components, log-likelihoods, convergence.
        """
        fit, values = self.estimates, np.asarray(responses, dtype=float)
        return refit_responses(
            fit.design, values, reml=self.reml, start=fit.gamma, processes=processes
        )
