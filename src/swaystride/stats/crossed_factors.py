r"""Any number of crossed or nested grouping factors, block by block.

:mod:`~swaystride.stats.block_layout` splits the random effects into interior blocks (c) and a
border (b) that the fixed effects (x) join. With :math:`H_0` the covariance of the blocks alone,

.. math::

    T_0 = (I + G_c\Gamma_c)^{-1} G_c, \qquad K = (I + G_c\Gamma_c)^{-1} G_{c,bx}, \qquad
    S_0 = G_{bx,bx} - G_{c,bx}^T \Gamma_c K

are :math:`Z_c^T H_0^{-1} Z_c`, :math:`Z_c^T H_0^{-1} [Z_b, Q]` and the same within the border.
Nothing is ever divided by a variance ratio, so that components at zero are handled exactly.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from scipy.linalg import lapack

from swaystride.errors import ModelError
from swaystride.stats.block_layout import block_layout, block_products
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
        self.layout = block_layout(design)
        self.products = block_products(design, self.layout)
        for factor in design.factors:
            left = factor.counts.sum() - float((factor.sum_rows(design.Q) ** 2).sum())
            if left <= _NULL * design.n:
                raise ModelError(
                    f"the fixed effects already determine every level of {factor.name}"
                )
        self._last: BlockFactorisation | None = None

    def bind(self, residual: FloatArray) -> CrossedResponse:
        """Attach the residual of ordinary least squares, shape (n,)."""
        return CrossedResponse(self, residual)

    def at(self, gamma: FloatArray) -> BlockFactorisation:
        """Factorise at the ratios, shape (k,); the last one is kept."""
        if self._last is None or not np.array_equal(self._last.gamma, gamma):
            self._last = BlockFactorisation(self, gamma.copy())
        return self._last

    def precision_slopes(self, gamma: FloatArray) -> FloatArray:
        """Derivatives of ``-Q.T @ inv(H) @ Q`` with respect to each ratio, shape (k, p, p)."""
        inner, border = self.at(gamma).fixed_in_random
        slopes = np.empty((len(gamma), self.design.p, self.design.p))
        for i in self.layout.interior:
            part = np.concatenate(inner[:, self.layout.slots[i]])
            slopes[i] = part.T @ part
        for i in self.layout.border:
            part = border[self.layout.columns[i]]
            slopes[i] = part.T @ part
        return slopes


class BlockFactorisation:
    """Everything about the covariance that does not depend on the response.

    Parameters
    ----------
    structure : CrossedStructure
    gamma : array, shape (k,)
    """

    def __init__(self, structure: CrossedStructure, gamma: FloatArray) -> None:
        self.structure, self.gamma = structure, gamma
        layout, products = structure.layout, structure.products
        b = self.b = layout.n_border
        self.ratio_inner = np.zeros(layout.width)
        for i in layout.interior:
            self.ratio_inner[layout.slots[i]] = gamma[i]
        self.ratio_border = np.ones(b + structure.design.p)
        for i in layout.border:
            self.ratio_border[layout.columns[i]] = gamma[i]
        blocks = np.eye(layout.width) + products.inner * self.ratio_inner
        # Solving keeps digits at large ratios that an explicit inverse of the blocks would lose.
        self._blocks = blocks
        solved = np.linalg.solve(blocks, np.concatenate([products.inner, products.outer], axis=2))
        self.T0 = solved[:, :, : layout.width]
        self.K = solved[:, :, layout.width :]
        flat_K = np.concatenate(self.K)
        weighted = (products.outer * self.ratio_inner[:, None]).reshape(flat_K.shape)
        S0 = products.corner - weighted.T @ flat_K
        self.S0 = 0.5 * (S0 + S0.T)
        root = np.sqrt(self.ratio_border)
        scaled = self.S0 * np.outer(root, root)
        scaled[np.arange(b), np.arange(b)] += 1.0
        self.lower = np.linalg.cholesky(scaled)
        diagonal = 2.0 * np.log(np.diag(self.lower))
        self.logdet_ml = float(np.linalg.slogdet(blocks)[1].sum() + diagonal[:b].sum())
        self.logdet_reml = self.logdet_ml + float(diagonal[b:].sum())

    @cached_property
    def border_inverse(self) -> FloatArray:
        """Inverse of the border equations, fixed effects included, free of divisions by ratios."""
        weight = self.ratio_border.copy()
        equations = self.S0 * weight
        equations[np.arange(self.b), np.arange(self.b)] += 1.0
        inverse: FloatArray = np.linalg.inv(equations)
        return inverse

    @cached_property
    def _border_inverse_without_fixed(self) -> FloatArray:
        equations = self.S0[: self.b, : self.b] * self.ratio_border[: self.b]
        inverse: FloatArray = np.linalg.inv(equations + np.eye(self.b))
        return inverse

    @cached_property
    def _border_root(self) -> FloatArray:
        """Upper triangle E; E[:, :b] serves ML, all columns REML."""
        if not self.lower.size:  # no border and no fixed effects
            return self.lower
        inverse: FloatArray = lapack.dtrtri(self.lower, lower=1)[0]
        return np.sqrt(self.ratio_border)[:, None] * np.tril(inverse).T

    @cached_property
    def precision(self) -> FloatArray:
        """``Q.T @ inv(H) @ Q``, shape (p, p)."""
        corner = self.lower[self.b :, self.b :]
        precision: FloatArray = corner @ corner.T
        return precision

    @cached_property
    def fixed_in_random(self) -> tuple[FloatArray, FloatArray]:
        """``Z.T @ inv(H) @ Q`` for the blocks and for the border."""
        b = self.b
        border = self._border_inverse_without_fixed @ self.S0[:b, b:]
        inner = self.K[:, :, b:] - self.K[:, :, :b] @ (self.ratio_border[:b, None] * border)
        return inner, border

    def solve(
        self, inner: FloatArray, border: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Random effects over their ratios (blocks, border) and fixed effects of right sides.

        Parameters
        ----------
        inner : array, shape (n_blocks, width, m)
        border : array, shape (n_border + p, m)
        """
        alone = np.linalg.solve(self._blocks, inner)
        outer = self.structure.products.outer * self.ratio_inner[:, None]
        reduced = border - np.einsum("ckb,ckm->bm", outer, alone, optimize=True)
        solved = self.border_inverse @ reduced
        return (
            alone - self.K @ (self.ratio_border[:, None] * solved),
            solved[: self.b],
            solved[self.b :],
        )

    @cached_property
    def _traces_reml(self) -> tuple[FloatArray, FloatArray]:
        return self._traces(self.b + self.structure.design.p, self.border_inverse)

    @cached_property
    def _traces_ml(self) -> tuple[FloatArray, FloatArray]:
        return self._traces(self.b, self._border_inverse_without_fixed)

    def logdet_derivatives(self, *, reml: bool) -> tuple[FloatArray, FloatArray]:
        """Gradient and Hessian of the log-determinant: traces and squared norms of Z'PZ."""
        return self._traces_reml if reml else self._traces_ml

    def _traces(self, columns: int, inverse: FloatArray) -> tuple[FloatArray, FloatArray]:
        layout, b = self.structure.layout, self.b
        k = len(self.gamma)
        gradient, hessian = np.zeros(k), np.zeros((k, k))
        U = self.K @ self._border_root[:, :columns]
        cross = U @ U.transpose(0, 2, 1)
        own = self.T0 - cross
        border_rows = inverse[:b, :columns]
        T_border = border_rows @ self.S0[:columns, :b]
        T_across = border_rows @ np.concatenate(self.K)[:, :columns].T
        squared = T_across.reshape(b, layout.n_blocks, layout.width) ** 2
        squared = squared.sum(axis=1)
        grams: dict[int, FloatArray] = {}
        for i in layout.interior:
            at = layout.slots[i]
            gradient[i] = np.trace(own[:, at, at], axis1=1, axis2=2).sum()
            part = U[:, at].reshape(layout.n_blocks * (at.stop - at.start), columns)
            grams[i] = part.T @ part
            for j in grams:
                # |T0 - cross|^2 within blocks, |cross|^2 between blocks
                there = layout.slots[j]
                within = (own[:, at, there] ** 2).sum() - (cross[:, at, there] ** 2).sum()
                hessian[i, j] = hessian[j, i] = -(within + (grams[i] * grams[j]).sum())
        for i in layout.border:
            at = layout.columns[i]
            gradient[i] = np.trace(T_border[at, at])
            for j in layout.interior:
                hessian[i, j] = hessian[j, i] = -squared[at, layout.slots[j]].sum()
            for j in layout.border:
                hessian[i, j] = -(T_border[at, layout.columns[j]] ** 2).sum()
        return gradient, hessian


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

    def parts(self, gamma: FloatArray, *, reml: bool) -> DevianceParts:
        """Parts of the deviance at the ratios, shape (k,)."""
        at = self.structure.at(gamma)
        rest, scores, _ = self._project(at, self.residual[:, None])
        codes = [factor.codes for factor in self.structure.design.factors]
        spread = np.column_stack([u[c, 0] for u, c in zip(scores, codes, strict=True)])
        sums = np.array([float((u * u).sum()) for u in scores])
        projected = self._project(at, spread)[0]
        gradient, hessian = at.logdet_derivatives(reml=reml)
        curvature = spread.T @ projected
        return DevianceParts(
            at.logdet_reml if reml else at.logdet_ml,
            gradient,
            hessian,
            float((rest * rest).sum() + gamma @ sums),
            -sums,
            curvature + curvature.T,
        )

    def solution(self, gamma: FloatArray) -> Solution:
        """Effects at the ratios, shape (k,)."""
        at = self.structure.at(gamma)
        rest, scores, shift = self._project(at, self.residual[:, None])
        random = tuple(ratio * u[:, 0] for ratio, u in zip(gamma, scores, strict=True))
        return Solution(shift[:, 0], at.precision, random, rest[:, 0])

    def _project(
        self, at: BlockFactorisation, values: FloatArray
    ) -> tuple[FloatArray, list[FloatArray], FloatArray]:
        """Apply P: the projected columns, Z'P of them by factor, and the fixed effects."""
        layout, design = self.structure.layout, self.structure.design
        m = values.shape[1]
        inner = np.zeros((layout.n_blocks, layout.width, m))
        border = np.empty((layout.n_border + design.p, m))
        for i in layout.interior:
            inner[layout.home[i]] = design.factors[i].sum_rows(values)
        for i in layout.border:
            border[layout.columns[i]] = design.factors[i].sum_rows(values)
        border[layout.n_border :] = design.Q.T @ values
        in_blocks, in_border, shift = at.solve(inner, border)
        scores = [
            in_blocks[layout.home[i]] if i in layout.home else in_border[layout.columns[i]]
            for i in range(len(design.factors))
        ]
        rest = values - design.Q @ shift
        for ratio, u, factor in zip(at.gamma, scores, design.factors, strict=True):
            rest -= ratio * u[factor.codes]
        return rest, scores, shift
