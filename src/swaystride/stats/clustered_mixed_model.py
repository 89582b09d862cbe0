"""Mixed models on resamples of whole clusters, without fitting each resample from scratch.

A resample enters only through how often each cluster was drawn: everything else is computed once
per cluster, and a resample is a weighted sum.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from swaystride.errors import ModelError
from swaystride.stats.cluster_bootstrap import cluster_codes
from swaystride.stats.grouping_factor import CodeArray, FloatArray, GroupingFactor
from swaystride.stats.mixed_model import MixedModelFit

# The search runs over log(1 + m·γ), m the mean cluster size: a grid, then golden sections.
_GRID = np.linspace(0.0, 14.0, 57)
_GOLDEN = (np.sqrt(5.0) - 1.0) / 2.0
_SECTIONS = 48


def resampled_fixed_effects(
    fit: MixedModelFit, clusters: npt.ArrayLike, weights: npt.ArrayLike
) -> FloatArray:
    """Fixed effects of cluster resamples, with the variance ratios of the fit.

    Generalised least squares of every resample. A cluster that is drawn twice has new levels of
    every grouping factor nested in it; factors that cross clusters keep their levels.

    Parameters
    ----------
    fit : MixedModelFit
        Fit to all rows.
    clusters : array or Series, shape (n_rows,)
        Cluster of each row.
    weights : array of int, shape (n, n_clusters)
        From :func:`swaystride.stats.cluster_bootstrap.cluster_weights`; clusters in sorted order.

    Returns
    -------
    array, shape (n, n_fixed_effects)

    Raises
    ------
    ModelError
        If `clusters` or `weights` do not fit, or a resample does not determine the fixed effects.

    Examples
    --------
    >>> import pandas as pd
    >>> from swaystride.stats.mixed_model import fit_mixed_model
    >>> rng = np.random.default_rng(1)
    >>> table = pd.DataFrame({"who": np.repeat(list("abcd"), 9), "x": np.tile(range(9), 4)})
    >>> table["y"] = table["x"] + np.repeat(rng.normal(size=4), 9) + rng.normal(size=36)
    >>> fit = fit_mixed_model("y ~ x + (1|who)", table)
    >>> whole = resampled_fixed_effects(fit, table["who"], np.ones((1, 4), dtype=int))
    >>> bool(np.allclose(whole[0], fit.fixed_effects()["estimate"]))
    True
    """
    codes, n_clusters = _codes(clusters, fit.n_observations)
    w = _checked_weights(weights, n_clusters)
    systems, n_border = _cluster_systems(fit, codes, n_clusters)
    totals = np.einsum("nc,cij->nij", w, systems)
    n_fixed = fit.estimates.design.p
    border = np.arange(n_border)
    totals[:, border, border] += 1.0
    size = n_border + n_fixed
    try:
        solved = np.linalg.solve(totals[:, :size, :size], totals[:, :size, size:])
    except np.linalg.LinAlgError:
        raise ModelError("a resample does not determine the fixed effects") from None
    effects: FloatArray = solved[:, n_border:, 0]
    return effects


def _cluster_systems(
    fit: MixedModelFit, codes: CodeArray, n_clusters: int
) -> tuple[FloatArray, int]:
    """Cross-products of border, fixed effects and outcome of each cluster, weighted by H⁻¹."""
    estimates = fit.estimates
    design = estimates.design
    nested: list[tuple[GroupingFactor, float]] = []
    crossing: list[tuple[GroupingFactor, float]] = []
    for factor, ratio in zip(design.factors, estimates.gamma.tolist(), strict=True):
        if ratio == 0.0:
            continue
        pairs = np.unique(factor.codes * n_clusters + codes)
        (nested if len(pairs) == factor.n_levels else crossing).append((factor, ratio))
    border = [
        np.sqrt(ratio) * (factor.codes[:, None] == np.arange(factor.n_levels))
        for factor, ratio in crossing
    ]
    columns = np.column_stack([*border, design.X, estimates.response])
    systems = np.empty((n_clusters, columns.shape[1], columns.shape[1]))
    for cluster in range(n_clusters):
        rows = np.flatnonzero(codes == cluster)
        covariance = np.eye(len(rows))
        for factor, ratio in nested:
            own = factor.codes[rows]
            covariance += ratio * (own[:, None] == own)
        half = np.linalg.solve(np.linalg.cholesky(covariance), columns[rows])
        systems[cluster] = half.T @ half
    return systems, columns.shape[1] - design.p - 1


@dataclass(frozen=True, eq=False)
class ResampledFits:
    """Random-intercept fits of cluster resamples.

    Attributes
    ----------
    estimates : array, shape (n, p)
        Intercept and slopes.
    cluster_variance, residual_variance : array, shape (n,)
    """

    estimates: FloatArray
    cluster_variance: FloatArray
    residual_variance: FloatArray


def resampled_random_intercepts(
    y: npt.ArrayLike,
    x: npt.ArrayLike,
    clusters: npt.ArrayLike,
    weights: npt.ArrayLike,
    *,
    reml: bool,
) -> ResampledFits:
    """Fit ``y ~ 1 + x + (1|cluster)`` to resamples of its clusters.

    The variance ratio is estimated anew in every resample, all of them side by side.

    Parameters
    ----------
    y : array, shape (n_rows,)
        Outcome.
    x : array, shape (n_rows,) or (n_rows, k)
        Covariates.
    clusters : array or Series, shape (n_rows,)
        Cluster of each row.
    weights : array of int, shape (n, n_clusters)
        From :func:`swaystride.stats.cluster_bootstrap.cluster_weights`.
    reml : bool
        REML or ML.

    Returns
    -------
    ResampledFits

    Raises
    ------
    ModelError
        If shapes do not fit or a value is missing.

    Examples
    --------
    >>> y = [1.0, 2.0, 4.0, 5.0, 8.0, 9.3]
    >>> fits = resampled_random_intercepts(
    ...     y, [0, 1, 0, 1, 0, 1], list("aabbcc"), np.ones((1, 3)), reml=True)
    >>> fits.estimates.round(6).tolist(), bool(fits.cluster_variance[0] > 12)
    ([[4.333333, 1.1]], True)
    """
    outcome = np.asarray(y, dtype=float)
    covariates = np.asarray(x, dtype=float).reshape(len(outcome), -1)
    columns = np.column_stack([np.ones(len(outcome)), covariates, outcome])
    if not np.isfinite(columns).all():
        raise ModelError("a value is missing", expected="complete rows")
    codes, n_clusters = _codes(clusters, len(outcome))
    problem = _WeightedClusters(columns, codes, _checked_weights(weights, n_clusters), reml=reml)
    u = problem.best()
    ratio = np.expm1(u) / problem.mean_size
    beta, _, variance, _ = problem.solve(ratio)
    return ResampledFits(beta, ratio * variance, variance)


class _WeightedClusters:
    """Cross-products of every cluster, and the profiled deviance of weighted sums of them."""

    def __init__(
        self, columns: FloatArray, codes: CodeArray, weights: FloatArray, *, reml: bool
    ) -> None:
        n_clusters = weights.shape[1]
        self.reml, self.weights = reml, weights
        # Centred columns keep digits; the intercept takes the shift.
        self.shift = np.append(0.0, columns[:, 1:].mean(axis=0))
        centred = columns - self.shift
        own = [centred[codes == cluster] for cluster in range(n_clusters)]
        self.products = np.array([part.T @ part for part in own])
        self.sums = np.array([part.sum(axis=0) for part in own])
        self.sizes = np.array([len(part) for part in own], dtype=float)
        self.mean_size = float(self.sizes.mean())
        self.n_rows = weights @ self.sizes
        self.p = columns.shape[1] - 1

    def solve(self, ratio: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Fixed effects, X'H⁻¹X, residual variance and log-determinant of H at ratios (n,)."""
        inflation = 1.0 + ratio[:, None] * self.sizes
        shrink = self.weights * (ratio[:, None] / inflation)
        outer = self.sums[:, :, None] * self.sums[:, None, :]
        total = np.einsum("nc,cij->nij", self.weights, self.products)
        total -= np.einsum("nc,cij->nij", shrink, outer)
        precision, right = total[:, :-1, :-1], total[:, :-1, -1]
        beta = np.linalg.solve(precision, right[..., None])[..., 0]
        rest = total[:, -1, -1] - np.einsum("ni,ni->n", beta, right)
        nu = self.n_rows - (self.p if self.reml else 0)
        logdet = (self.weights * np.log(inflation)).sum(axis=1)
        back = beta.copy()
        back[:, 0] += self.shift[-1] - beta[:, 1:] @ self.shift[1:-1]
        return back, precision, rest / nu, logdet

    def deviance(self, u: FloatArray) -> FloatArray:
        """Profiled deviance at ``u = log(1 + m·γ)``, up to a constant, shape (n,)."""
        _, precision, variance, logdet = self.solve(np.expm1(u) / self.mean_size)
        nu = self.n_rows - (self.p if self.reml else 0)
        value: FloatArray = nu * np.log(variance) + logdet
        if self.reml:
            value = value + np.linalg.slogdet(precision)[1]
        return value

    def best(self) -> FloatArray:
        """Minimum of the deviance for every resample: a grid, then golden sections around it."""
        n = len(self.weights)
        values = np.array([self.deviance(np.full(n, u)) for u in _GRID])
        at = values.argmin(axis=0)
        low, high = _GRID[np.maximum(at - 1, 0)], _GRID[np.minimum(at + 1, len(_GRID) - 1)]
        left, right = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
        at_left, at_right = self.deviance(left), self.deviance(right)
        for _ in range(_SECTIONS):
            go_left = at_left < at_right
            low, high = np.where(go_left, low, left), np.where(go_left, right, high)
            probe = np.where(go_left, high - _GOLDEN * (high - low), low + _GOLDEN * (high - low))
            value = self.deviance(probe)
            left, right = np.where(go_left, probe, right), np.where(go_left, left, probe)
            at_left, at_right = (
                np.where(go_left, value, at_right),
                np.where(go_left, at_left, value),
            )
        middle: FloatArray = 0.5 * (low + high)
        zero = self.deviance(np.zeros(n)) <= self.deviance(middle)
        return np.where(zero, 0.0, middle)


def _codes(clusters: npt.ArrayLike, n_rows: int) -> tuple[CodeArray, int]:
    codes, labels = cluster_codes(clusters)
    if len(codes) != n_rows:
        raise ModelError(
            "the clusters do not fit the rows", expected=f"{n_rows} labels", found=str(len(codes))
        )
    return codes, len(labels)


def _checked_weights(weights: npt.ArrayLike, n_clusters: int) -> FloatArray:
    w = np.asarray(weights, dtype=float)
    if w.ndim != 2 or w.shape[1] != n_clusters:
        raise ModelError(
            "the weights do not fit the clusters",
            expected=f"an array of shape (n, {n_clusters})",
            found=str(w.shape),
        )
    return w
