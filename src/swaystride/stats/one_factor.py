r"""A single grouping factor in closed form, for one response or thousands at once.

With the fixed effects projected out (:math:`M = I - QQ^T`) the REML problem has one matrix,
:math:`\tilde G = Z^T M Z = U \Lambda U^T`, and its spectrum diagonalises everything:

.. math::

    \log|H| + \log|Q^T H^{-1} Q| = \sum_k \log(1 + \gamma\lambda_k), \qquad
    S(\gamma) = s_0 + \sum_k \frac{\eta_k^2}{1 + \gamma\lambda_k}

with :math:`\eta = \Lambda^{-1/2} U^T Z^T M y`. For ML, :math:`\log|H| = \sum_g\log(1+\gamma n_g)`
and S is the same. After one eigendecomposition per design, one evaluation costs a handful of
operations per level, so the best ratio is found by a search over a grid followed by safeguarded
Newton steps, for all responses side by side (the spectral method of Kang et al. 2008, EMMA).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from swaystride.errors import ModelError
from swaystride.stats.grouping_factor import FloatArray
from swaystride.stats.mixed_design import MixedDesign
from swaystride.stats.profiled_deviance import DevianceParts, Solution

# Eigenvalues below this share of the largest group are exact zeros blurred by rounding.
_NULL = 1e-11
# The search runs over u = log(1 + gamma * mean group size), the logarithm of the ratio of the
# expected mean squares: 0 is no variance between groups, 36 is 4e15 times the residual.
_U_GRID = np.linspace(0.0, 36.0, 73)
_MAX_NEWTON = 60


@dataclass(frozen=True)
class ManyRatios:
    """Best variance ratio of each of N responses.

    Attributes
    ----------
    gamma, s, logdet : array, shape (N,)
        Ratio, generalised residual sum of squares, and log-determinant part of the deviance.
    converged : array of bool, shape (N,)
        Whether the ratio satisfies the conditions of a minimum.
    iterations : int
        Newton steps taken.
    """

    gamma: FloatArray
    s: FloatArray
    logdet: FloatArray
    converged: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
    iterations: int


class OneFactorStructure:
    """Spectrum of a design with a single grouping factor.

    Parameters
    ----------
    design : MixedDesign
        With one grouping factor.

    Raises
    ------
    ModelError
        If the fixed effects already determine every level.

    Examples
    --------
    >>> import pandas as pd
    >>> from swaystride.stats.mixed_design import design_from_terms
    >>> table = pd.DataFrame({"who": list("aaabbbccc")})
    >>> structure = OneFactorStructure(design_from_terms(table, [], ["who"]))
    >>> structure.eigenvalues.round(12).tolist()  # two contrasts among three groups of three
    [3.0, 3.0]
    """

    def __init__(self, design: MixedDesign) -> None:
        (self.factor,) = design.factors
        self.design = design
        self.counts = self.factor.counts
        self.Zq = self.factor.sum_rows(design.Q)
        eigenvalues, vectors = np.linalg.eigh(np.diag(self.counts) - self.Zq @ self.Zq.T)
        keep = eigenvalues > _NULL * self.counts.max()
        if not keep.any():
            raise ModelError(
                f"the fixed effects already determine every level of {self.factor.name}"
            )
        self.eigenvalues: FloatArray = eigenvalues[keep]
        self._scaled_vectors: FloatArray = vectors[:, keep] / np.sqrt(self.eigenvalues)
        within = design.Q - (self.Zq / self.counts[:, None])[self.factor.codes]
        self._within = within.T @ within

    def bind(self, residual: FloatArray) -> OneFactorResponse:
        """Attach residuals of ordinary least squares, shape (n,) or (n, N)."""
        return OneFactorResponse(self, residual.reshape(self.design.n, -1))

    def precision(self, gamma: FloatArray) -> FloatArray:
        """``Q.T @ inv(H) @ Q`` for each ratio, shape (N, p, p), as a sum of positive parts."""
        weight = 1.0 / (self.counts * (1.0 + np.multiply.outer(gamma, self.counts)))
        outer = (self.Zq[:, :, None] * self.Zq[:, None, :]).reshape(len(self.counts), -1)
        p = self.design.p
        between: FloatArray = (weight @ outer).reshape(len(gamma), p, p)
        return self._within + between

    def precision_slopes(self, gamma: FloatArray) -> FloatArray:
        """Derivative of ``-Q.T @ inv(H) @ Q``, shape (1, p, p)."""
        scaled = self.Zq / (1.0 + gamma[0] * self.counts)[:, None]
        slopes: FloatArray = (scaled.T @ scaled)[None]
        return slopes


class OneFactorResponse:
    """N responses on the spectrum of their design.

    Parameters
    ----------
    structure : OneFactorStructure
    residual : array, shape (n, N)
        Responses with the fixed effects projected out.
    """

    def __init__(self, structure: OneFactorStructure, residual: FloatArray) -> None:
        self.structure = structure
        self.residual = residual
        factor, design = structure.factor, structure.design
        self.sums = factor.sum_rows(residual)
        eta = structure._scaled_vectors.T @ self.sums
        explained = structure._scaled_vectors @ eta
        rest = residual - explained[factor.codes] + design.Q @ (structure.Zq.T @ explained)
        self.eta2: FloatArray = (eta * eta).T
        self.s0: FloatArray = (rest * rest).sum(axis=0)

    def parts(self, gamma: FloatArray, *, reml: bool) -> DevianceParts:
        """Parts of the deviance of the first response at one ratio, shape (1,)."""
        logdet, dlogdet, d2logdet = self._logdet(gamma, reml=reml)
        s, ds, d2s = self._s(gamma)
        return DevianceParts(
            float(logdet[0]),
            dlogdet,
            d2logdet[:, None],
            float(s[0]),
            ds[:1],
            d2s[:1, None],
        )

    def value(self, gamma: FloatArray, *, reml: bool) -> tuple[float, float]:
        """Log-determinant and residual sum of squares of the first response, shape (1,)."""
        return float(self._logdet(gamma, reml=reml)[0][0]), float(self._s(gamma)[0][0])

    def _logdet(
        self, gamma: FloatArray, *, reml: bool
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Log-determinant with two derivatives, one row per ratio."""
        spectrum = self.structure.eigenvalues if reml else self.structure.counts
        scaled = np.multiply.outer(gamma, spectrum)
        slope = spectrum / (1.0 + scaled)
        return np.log1p(scaled).sum(axis=-1), slope.sum(axis=-1), -(slope * slope).sum(axis=-1)

    def _s(self, gamma: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Sum of squares with two derivatives, one row per response and ratio."""
        spectrum = self.structure.eigenvalues
        shrink = 1.0 / (1.0 + np.multiply.outer(gamma, spectrum))
        value = self.eta2 * shrink
        slope = value * (spectrum * shrink)
        return (
            self.s0 + value.sum(axis=1),
            -slope.sum(axis=1),
            2.0 * (slope * (spectrum * shrink)).sum(axis=1),
        )

    def best_ratios(self, *, reml: bool) -> ManyRatios:
        """Minimise the profiled deviance of every response over its variance ratio.

        Parameters
        ----------
        reml : bool

        Returns
        -------
        ManyRatios
        """
        design = self.structure.design
        size = design.n / self.structure.factor.n_levels
        nu = design.n - design.p if reml else design.n
        lo, u, hi, at_grid = self._bracket(size, nu, reml=reml)
        value = at_grid
        for iteration in range(1, _MAX_NEWTON + 1):  # noqa: B007 - reported
            value, slope, curvature = self._in_u(u, size, nu, reml=reml)
            lo = np.where(slope < 0.0, u, lo)
            hi = np.where(slope > 0.0, u, hi)
            with np.errstate(divide="ignore", invalid="ignore"):
                newton = u - slope / curvature
            inside = (curvature > 0.0) & (newton >= lo) & (newton <= hi)
            following = np.where(inside, newton, 0.5 * (lo + hi))
            step = np.abs(following - u)
            u = following
            if step.max() <= 1e-10:
                break
        u = np.where(u < 1e-12, 0.0, u)
        gamma = np.expm1(u) / size
        value, slope, curvature = self._in_u(u, size, nu, reml=reml)
        stationary = np.abs(slope) <= 1e-7 * np.maximum(1.0, np.abs(curvature))
        stationary |= (u == 0.0) & (slope >= 0.0)
        converged = stationary & (value <= at_grid + 1e-8) & (u < _U_GRID[-1] - 0.5)
        return ManyRatios(
            gamma, self._s(gamma)[0], self._logdet(gamma, reml=reml)[0], converged, iteration
        )

    def _bracket(
        self, size: float, nu: int, *, reml: bool
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Lower end, start and upper end around the best grid point, and the deviance there."""
        grid = np.expm1(_U_GRID) / size
        logdet = self._logdet(grid, reml=reml)[0]
        shrink = 1.0 / (1.0 + np.multiply.outer(self.structure.eigenvalues, grid))
        deviance = logdet + nu * np.log(self.s0[:, None] + self.eta2 @ shrink)
        best = deviance.argmin(axis=1)
        last = len(_U_GRID) - 1
        at_grid = deviance[np.arange(len(best)), best]
        slope_at_zero = self._in_u(np.zeros(len(best)), size, nu, reml=reml)[1]
        hi = np.where(
            (best == 0) & (slope_at_zero >= 0.0), 0.0, _U_GRID[np.minimum(best + 1, last)]
        )
        return _U_GRID[np.maximum(best - 1, 0)], np.minimum(_U_GRID[best], hi), hi, at_grid

    def _in_u(
        self, u: FloatArray, size: float, nu: int, *, reml: bool
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Profiled deviance (without constants) and its derivatives in u."""
        gamma = np.expm1(u) / size
        logdet, dlogdet, d2logdet = self._logdet(gamma, reml=reml)
        s, ds, d2s = self._s(gamma)
        ratio = ds / s
        slope = dlogdet + nu * ratio
        curvature = d2logdet + nu * (d2s / s - ratio * ratio)
        jacobian = np.exp(u) / size
        return (
            logdet + nu * np.log(s),
            slope * jacobian,
            curvature * jacobian**2 + slope * jacobian,
        )

    def shifts(self, gamma: FloatArray, precision: FloatArray) -> FloatArray:
        """Coefficients on Q that generalised adds to ordinary least squares, shape (N, p)."""
        weighted = self.sums * (gamma / (1.0 + np.multiply.outer(self.structure.counts, gamma)))
        right = -(self.structure.Zq.T @ weighted).T
        shift: FloatArray = np.linalg.solve(precision, right[:, :, None])[:, :, 0]
        return shift

    def solution(self, gamma: FloatArray) -> Solution:
        """Effects of the first response at one ratio, shape (1,)."""
        structure = self.structure
        precision = structure.precision(gamma)
        shift = self.shifts(gamma, precision)[0]
        shrunk = (self.sums[:, 0] - structure.Zq @ shift) / (1.0 + gamma[0] * structure.counts)
        random = gamma[0] * shrunk
        rest = self.residual[:, 0] - structure.design.Q @ shift - random[structure.factor.codes]
        return Solution(shift, precision[0], (random,), rest)
