"""Any number of crossed or nested grouping factors: deviance and effects of a response."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.sparse import csr_array

from swaystride.errors import ModelError
from swaystride.stats.block_factorisation import BlockFactorisation
from swaystride.stats.block_layout import block_batches, block_layout
from swaystride.stats.grouping_factor import FloatArray
from swaystride.stats.mixed_design import MixedDesign
from swaystride.stats.profiled_deviance import DevianceParts, Solution

_NULL = 1e-11


class CrossedStructure:
    """Cross-products of a design, and their factorisation at given variance ratios.

    Parameters
    ----------
    design : MixedDesign

    Raises
    ------
    ModelError
        If the fixed effects already determine every level of a factor.

    Examples
    --------
    >>> import pandas as pd
    >>> from swaystride.stats.mixed_design import design_from_terms
    >>> table = pd.DataFrame({"a": list("uuvvww"), "b": list("xyxyxy")})
    >>> structure = CrossedStructure(design_from_terms(table, [], ["a", "b"]))
    >>> structure.layout.n_blocks, structure.layout.n_border
    (3, 2)
    """

    def __init__(self, design: MixedDesign) -> None:
        self.design = design
        for factor in design.factors:
            left = factor.counts.sum() - float((factor.sum_rows(design.Q) ** 2).sum())
            if left <= _NULL * design.n:
                raise ModelError(
                    f"the fixed effects already determine every level of {factor.name}"
                )
        self.layout = block_layout(design)
        self.batches, self.corner = block_batches(design, self.layout)
        # Levels of all factors: those of the interior, then those of the border.
        self.places = dict(self.layout.columns)
        for i in self.layout.border:
            at = self.layout.columns[i]
            first = self.layout.n_interior
            self.places[i] = slice(first + at.start, first + at.stop)
        codes = [self.places[i].start + factor.codes for i, factor in enumerate(design.factors)]
        n, k = design.n, len(design.factors)
        self.indicator = csr_array(
            (np.ones(n * k), np.column_stack(codes).ravel(), np.arange(0, n * k + 1, k)),
            shape=(n, self.layout.n_interior + self.layout.n_border),
        )
        self.indicator_transposed = csr_array(self.indicator.T)
        self._last: BlockFactorisation | None = None
        self._kept: BlockFactorisation | None = None

    def bind(self, residual: FloatArray) -> CrossedResponse:
        """Attach the residual of ordinary least squares, shape (n,)."""
        return CrossedResponse(self, residual)

    def at(self, gamma: FloatArray) -> BlockFactorisation:
        """Factorise at the ratios, shape (k,); the last one is remembered."""
        for remembered in (self._last, self._kept):
            if remembered is not None and np.array_equal(remembered.gamma, gamma):
                return remembered
        self._last = BlockFactorisation(self.layout, self.batches, self.corner, gamma.copy())
        return self._last

    def keep(self, gamma: FloatArray) -> None:
        """Remember the factorisation at the ratios, from which many fits start."""
        self._kept = self.at(gamma)

    def precision_slopes(self, gamma: FloatArray) -> FloatArray:
        """Derivatives of ``-Q.T @ inv(H) @ Q`` with respect to each ratio, shape (k, p, p)."""
        across = np.vstack(self.at(gamma).fixed_in_random)
        parts = [across[self.places[i]] for i in range(len(gamma))]
        return np.array([part.T @ part for part in parts])


class CrossedResponse:
    """One response on the blocks of its design.

    Parameters
    ----------
    structure : CrossedStructure
    residual : array, shape (n,)
        Response with the fixed effects projected out.
    """

    def __init__(self, structure: CrossedStructure, residual: FloatArray) -> None:
        self.structure, self.residual = structure, residual

    def value(self, gamma: FloatArray, *, reml: bool) -> tuple[float, float]:
        """Log-determinant and generalised residual sum of squares alone."""
        at = self.structure.at(gamma)
        rest, scores, _ = self._project(at, self.residual[:, None])
        s = float((rest * rest).sum() + gamma @ self._sums_of_squares(scores))
        return at.logdet_reml if reml else at.logdet_ml, s

    def parts(self, gamma: FloatArray, *, reml: bool) -> DevianceParts:
        """Parts of the deviance at the ratios, shape (k,)."""
        hessian = self.structure.at(gamma).logdet_hessian(reml=reml)
        return replace(self.sketch(gamma, reml=reml), logdet_hessian=hessian)

    def sketch(self, gamma: FloatArray, *, reml: bool) -> DevianceParts:
        """Parts of the deviance with zeros for the costly Hessian of the log-determinant."""
        at, k = self.structure.at(gamma), len(gamma)
        rest, scores, _ = self._project(at, self.residual[:, None])
        sums = self._sums_of_squares(scores)
        by_factor = np.zeros((len(scores), k))
        for i, place in self.structure.places.items():
            by_factor[place, i] = scores[place, 0]
        spread = self.structure.indicator @ by_factor
        curvature = spread.T @ self._project(at, spread)[0]
        return DevianceParts(
            at.logdet_reml if reml else at.logdet_ml,
            at.logdet_gradient(reml=reml),
            np.zeros((k, k)),
            float((rest * rest).sum() + gamma @ sums),
            -sums,
            curvature + curvature.T,
        )

    def _sums_of_squares(self, scores: FloatArray) -> FloatArray:
        """Sum of squares of ``Z.T @ P @ y`` by factor, shape (k,)."""
        squares = {i: float((scores[at] ** 2).sum()) for i, at in self.structure.places.items()}
        return np.array([squares[i] for i in range(len(squares))])

    def solution(self, gamma: FloatArray) -> Solution:
        """Effects at the ratios, shape (k,)."""
        at = self.structure.at(gamma)
        rest, scores, shift = self._project(at, self.residual[:, None])
        random = tuple(ratio * scores[self.structure.places[i], 0] for i, ratio in enumerate(gamma))
        return Solution(shift[:, 0], at.precision, random, rest[:, 0])

    def _project(
        self, at: BlockFactorisation, values: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Apply P: the projected columns, Z'P of them by level, and the fixed effects."""
        structure, design = self.structure, self.structure.design
        first = structure.layout.n_interior
        sums = structure.indicator_transposed @ values
        border = np.vstack([sums[first:], design.Q.T @ values])
        *scores, shift = at.solve(sums[:first], border)
        effects = np.vstack(scores)
        ratios = np.concatenate([at.ratio_inner[:-1], at.ratio_border[: at.b]])
        rest = values - design.Q @ shift - structure.indicator @ (ratios[:, None] * effects)
        return rest, effects, shift
