r"""Variance ratio of a random intercept, estimated in many resamples of clusters side by side.

A cluster of n rows with :math:`H = I + \gamma 11^T` contributes

.. math::

    W^T H^{-1} W = \sum (W - \bar W)^T (W - \bar W) + \frac{n}{1 + \gamma n} \bar W^T \bar W,
    \qquad \log|H| = \log(1 + \gamma n)

for its rows W of fixed effects and outcome. Both are weighted sums over clusters, so the profiled
deviance of all resamples and its derivatives cost a few small matrix products per ratio.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from swaystride.stats.grouping_factor import CodeArray, FloatArray

BoolArray = npt.NDArray[np.bool_]

# The search runs over u = log(1 + gamma * mean cluster size); 0 is no variance between clusters,
# 36 is 4e15 times the residual. The grid is dense near zero, where a second minimum may hide.
_U_GRID = np.linspace(0.0, 6.0, 25) ** 2
_MAX_NEWTON = 60
# Steps of u below which the search ends, and u below which the ratio is zero.
_STEP, _ZERO = 1e-10, 1e-12
# Largest Newton step that a minimum may still ask for.
_STATIONARY = 1e-7


class RandomInterceptSums:
    """Cross-products of resamples of the rows of a random-intercept model.

    Parameters
    ----------
    rows : array, shape (n_rows, p + 1)
        Fixed effects and, in the last column, the outcome.
    codes : array of int, shape (n_rows,)
        Cluster of each row.
    weights : array, shape (n, n_clusters)
        Multiplicity of each cluster in each resample.
    reml : bool

    Attributes
    ----------
    n_rows, nu : array, shape (n,)
        Rows of each resample, and the divisor of the residual variance.
    sums : array, shape (n, p + 1)
        Column sums.
    total : array, shape (n, p + 1, p + 1)
        Cross-products of the rows.
    """

    def __init__(
        self, rows: FloatArray, codes: CodeArray, weights: FloatArray, *, reml: bool
    ) -> None:
        m, width = weights.shape[1], rows.shape[1]
        self.counts = np.bincount(codes, minlength=m).astype(float)
        indicator = (codes[None, :] == np.arange(m)[:, None]).astype(float)
        means = (indicator @ rows) / self.counts[:, None]
        deviations = rows - means[codes]
        within = np.stack([deviations[codes == at].T @ deviations[codes == at] for at in range(m)])
        self.reml = reml
        self.p = width - 1
        self.weights = weights
        self.size = len(rows) / m
        self._between = self.counts[:, None, None] * means[:, :, None] * means[:, None, :]
        self._within = self._weighted(weights, within)
        self.n_rows = weights @ self.counts
        self.nu = self.n_rows - (self.p if reml else 0)
        self.sums = weights @ (self.counts[:, None] * means)
        self.total = self._within + self._weighted(weights, self._between)

    def _weighted(self, weights: FloatArray, parts: FloatArray) -> FloatArray:
        """Weighted sum over clusters of matrices, one per resample."""
        summed: FloatArray = weights @ parts.reshape(len(parts), -1)
        return summed.reshape(-1, *parts.shape[1:])

    def value(self, gamma: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Profiled deviance without constants, and generalised residual sum of squares.

        Parameters
        ----------
        gamma : array, shape (n,)

        Returns
        -------
        tuple of array, shape (n,)
        """
        shrink = 1.0 / (1.0 + np.multiply.outer(gamma, self.counts))
        A = self._within + self._weighted(self.weights * shrink, self._between)
        _, s = self._solve(A)
        logdet = -(self.weights * np.log(shrink)).sum(axis=1)
        if self.reml:
            logdet = logdet + np.linalg.slogdet(A[:, :-1, :-1])[1]
        with np.errstate(divide="ignore", invalid="ignore"):
            return logdet + self.nu * np.log(s), s

    def _solve(self, A: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Coefficients, and what they leave of the outcome."""
        beta = np.linalg.solve(A[:, :-1, :-1], A[:, :-1, -1:])[:, :, 0]
        return beta, A[:, -1, -1] - (beta * A[:, :-1, -1]).sum(axis=1)

    def residual_within(self) -> FloatArray:
        """What the fixed effects leave of the outcome within clusters, shape (n,)."""
        top = np.expm1(_U_GRID[-1]) / self.size
        return self.value(np.full(len(self.weights), top))[1]

    def derivatives(self, u: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Slope and curvature of the profiled deviance in u, coefficients, sum of squares.

        Parameters
        ----------
        u : array, shape (n,)
            Logarithm of one plus ratio times mean cluster size.

        Returns
        -------
        tuple of array
            Shapes (n,), (n,), (n, p), (n,).
        """
        shrink = 1.0 / (1.0 + np.multiply.outer(np.expm1(u) / self.size, self.counts))
        rate = self.counts * shrink
        scaled = self.weights * shrink
        A = self._within + self._weighted(scaled, self._between)
        dA = -self._weighted(scaled * rate, self._between)
        d2A = 2.0 * self._weighted(scaled * rate * rate, self._between)
        beta, s = self._solve(A)
        v = np.column_stack([-beta, np.ones(len(beta))])
        gradient = np.einsum("bij,bj->bi", dA, v)
        ds = (v * gradient).sum(axis=1)
        both = np.linalg.solve(
            A[:, :-1, :-1],
            np.concatenate([gradient[:, :-1, None], dA[:, :-1, :-1], d2A[:, :-1, :-1]], axis=2),
        )
        d2s = np.einsum("bi,bij,bj->b", v, d2A, v)
        d2s = d2s - 2.0 * (gradient[:, :-1] * both[:, :, 0]).sum(axis=1)
        dlogdet = (self.weights * rate).sum(axis=1)
        d2logdet = -(self.weights * rate * rate).sum(axis=1)
        if self.reml:
            first, second = both[:, :, 1 : 1 + self.p], both[:, :, 1 + self.p :]
            dlogdet = dlogdet + np.trace(first, axis1=1, axis2=2)
            d2logdet = d2logdet + np.trace(second, axis1=1, axis2=2)
            d2logdet = d2logdet - np.einsum("bij,bji->b", first, first)
        slope = dlogdet + self.nu * ds / s
        curvature = d2logdet + self.nu * (d2s / s - (ds / s) ** 2)
        jacobian = np.exp(u) / self.size
        return slope * jacobian, curvature * jacobian**2 + slope * jacobian, beta, s


@dataclass(frozen=True)
class ResampledRatios:
    """Best variance ratio of each resample, and what follows from it.

    Attributes
    ----------
    gamma, s : array, shape (n,)
        Ratio, and generalised residual sum of squares.
    shift : array, shape (n, p)
        Coefficients.
    converged : array of bool, shape (n,)
    """

    gamma: FloatArray
    s: FloatArray
    shift: FloatArray
    converged: BoolArray


def best_resampled_ratios(sums: RandomInterceptSums) -> ResampledRatios:
    """Minimise the profiled deviance of every resample over its variance ratio.

    A search over a grid is followed by Newton steps within the bracket of the best grid point; a
    step that leaves the bracket is replaced by its middle.

    Parameters
    ----------
    sums : RandomInterceptSums

    Returns
    -------
    ResampledRatios
    """
    lo, u, hi, at_grid = _bracket(sums)
    for _ in range(_MAX_NEWTON):
        slope, curvature, _, _ = sums.derivatives(u)
        lo = np.where(slope < 0.0, u, lo)
        hi = np.where(slope > 0.0, u, hi)
        with np.errstate(divide="ignore", invalid="ignore"):
            newton = u - slope / curvature
        inside = (curvature > 0.0) & (newton >= lo) & (newton <= hi)
        following = np.where(inside, newton, 0.5 * (lo + hi))
        step = np.abs(following - u)
        u = following
        if step.max(initial=0.0) <= _STEP:
            break
    u = np.where(u < _ZERO, 0.0, u)
    gamma = np.expm1(u) / sums.size
    slope, curvature, shift, s = sums.derivatives(u)
    stationary = np.abs(slope) <= _STATIONARY * np.maximum(1.0, np.abs(curvature))
    stationary |= (u == 0.0) & (slope >= 0.0)
    converged = stationary & (sums.value(gamma)[0] <= at_grid + 1e-8) & (u < _U_GRID[-2])
    return ResampledRatios(gamma, s, shift, converged)


def _bracket(sums: RandomInterceptSums) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Lower end, start and upper end around the best grid point, and the deviance there."""
    n = len(sums.weights)
    deviance = np.column_stack(
        [sums.value(np.full(n, g))[0] for g in np.expm1(_U_GRID) / sums.size]
    )
    best = deviance.argmin(axis=1)
    slope_at_zero = sums.derivatives(np.zeros(n))[0]
    upper = _U_GRID[np.minimum(best + 1, len(_U_GRID) - 1)]
    hi = np.where((best == 0) & (slope_at_zero >= 0.0), 0.0, upper)
    at_grid: FloatArray = deviance[np.arange(n), best]
    return _U_GRID[np.maximum(best - 1, 0)], np.minimum(_U_GRID[best], hi), hi, at_grid
