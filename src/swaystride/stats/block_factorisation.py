r"""The covariance of crossed or nested random effects at given variance ratios, block by block.

:mod:`~swaystride.stats.block_layout` splits the random effects into interior blocks (c) and a
border (b) that the fixed effects (x) join. With :math:`H_0` the covariance of the blocks alone,

.. math::

    T_0 = (I + G_c\Gamma_c)^{-1} G_c, \qquad K = (I + G_c\Gamma_c)^{-1} G_{c,bx}, \qquad
    S_0 = G_{bx,bx} - G_{c,bx}^T \Gamma_c K

are :math:`Z_c^T H_0^{-1} Z_c`, :math:`Z_c^T H_0^{-1} [Z_b, Q]` and the same within the border.
Nothing is ever divided by a variance ratio, so that components at zero are handled exactly.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from scipy.linalg import lapack

from swaystride.stats.block_layout import BlockBatch, BlockLayout
from swaystride.stats.grouping_factor import CodeArray, FloatArray

# Width from which blocks are factorised one by one; smaller ones are solved side by side.
_WIDE = 16


class BlockFactorisation:
    """Everything about the covariance that does not depend on the response.

    Parameters
    ----------
    layout : BlockLayout
    batches : sequence of BlockBatch
    corner : array, shape (n_border + p, n_border + p)
        Cross-products within the border.
    gamma : array, shape (k,)
    """

    def __init__(
        self,
        layout: BlockLayout,
        batches: Sequence[BlockBatch],
        corner: FloatArray,
        gamma: FloatArray,
    ) -> None:
        self.layout, self.batches, self.gamma = layout, batches, gamma
        b, end = layout.n_border, len(corner)
        self.b, self.end = b, end
        # One more entry each, for the empty slots and columns of the batches.
        self.ratio_inner = np.zeros(layout.n_interior + 1)
        for i in layout.interior:
            self.ratio_inner[layout.columns[i]] = gamma[i]
        self.ratio_border = np.ones(end)
        for i in layout.border:
            self.ratio_border[layout.columns[i]] = gamma[i]
        padded = np.zeros((end + 1) * (end + 1))
        self._solvers: list[_BlockSolver] = []
        self.T0: list[FloatArray] = []
        self.K: list[FloatArray] = []
        for batch in batches:
            k, ratio = batch.width, self.ratio_inner[batch.levels]
            inner, outer = batch.products[:, :k], batch.products[:, k:]
            solver = _BlockSolver(np.eye(k) + ratio[:, :, None] * inner)
            # Solving keeps digits at large ratios that an inverse of the blocks would lose.
            solved = solver.solve(batch.products).transpose(0, 2, 1)
            self._solvers.append(solver)
            self.T0.append(solved[:, :, :k])
            self.K.append(solved[:, :, k:])
            local = (outer * ratio[:, None, :]) @ self.K[-1]
            padded += np.bincount(batch.scatter, local.ravel(), minlength=len(padded))
        S0 = corner - padded.reshape(end + 1, end + 1)[:end, :end]
        self.S0 = 0.5 * (S0 + S0.T)
        root = np.sqrt(self.ratio_border)
        scaled = self.S0 * np.outer(root, root)
        scaled[np.arange(b), np.arange(b)] += 1.0
        self.lower = np.linalg.cholesky(scaled)
        diagonal = 2.0 * np.log(np.diag(self.lower))
        logdet = sum(solver.logdet() for solver in self._solvers)
        self.logdet_ml = logdet + float(diagonal[:b].sum())
        self.logdet_reml = self.logdet_ml + float(diagonal[b:].sum())

    @cached_property
    def border_inverse(self) -> FloatArray:
        """Inverse of the border equations, fixed effects included, free of divisions by ratios."""
        equations = self.S0 * self.ratio_border
        equations[np.arange(self.b), np.arange(self.b)] += 1.0
        inverse: FloatArray = np.linalg.inv(equations)
        return inverse

    @cached_property
    def _border_inverse_without_fixed(self) -> FloatArray:
        equations = self.S0[: self.b, : self.b] * self.ratio_border[: self.b]
        inverse: FloatArray = np.linalg.inv(equations + np.eye(self.b))
        return inverse

    @cached_property
    def precision(self) -> FloatArray:
        """``Q.T @ inv(H) @ Q``, shape (p, p)."""
        corner = self.lower[self.b :, self.b :]
        precision: FloatArray = corner @ corner.T
        return precision

    @cached_property
    def fixed_in_random(self) -> tuple[FloatArray, FloatArray]:
        """``Z.T @ inv(H) @ Q`` for the interior levels and for the border."""
        b, p = self.b, self.end - self.b
        border = self._border_inverse_without_fixed @ self.S0[:b, b:]
        weight = np.zeros((self.end + 1, p))
        weight[:b] = -self.ratio_border[:b, None] * border
        weight[b : self.end] = np.eye(p)
        return self._spread(weight), border

    def _spread(self, border: FloatArray) -> FloatArray:
        """Multiply K with values by (padded) border column, shape (n_interior, m)."""
        values = np.zeros((self.layout.n_interior + 1, border.shape[1]))
        for batch, K in zip(self.batches, self.K, strict=True):
            values[batch.levels] = K @ border[batch.columns]
        return values[:-1]

    def solve(
        self, inner: FloatArray, border: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Random effects over their ratios (interior, border) and fixed effects of right sides.

        Parameters
        ----------
        inner : array, shape (n_interior, m)
        border : array, shape (n_border + p, m)
        """
        m = inner.shape[1]
        given = np.vstack([inner, np.zeros((1, m))])
        weighted = self.ratio_inner[:, None] * given
        reduced = np.vstack([border, np.zeros((1, m))])
        for batch, K in zip(self.batches, self.K, strict=True):
            local = K.transpose(0, 2, 1) @ weighted[batch.levels]
            for at in range(m):
                reduced[:, at] -= np.bincount(
                    batch.columns.ravel(), local[:, :, at].ravel(), minlength=self.end + 1
                )
        solved = self.border_inverse @ reduced[:-1]
        onward = np.vstack([self.ratio_border[:, None] * solved, np.zeros((1, m))])
        effects = np.zeros((self.layout.n_interior + 1, m))
        for batch, K, solver in zip(self.batches, self.K, self._solvers, strict=True):
            alone = solver.solve(given[batch.levels].transpose(0, 2, 1)).transpose(0, 2, 1)
            effects[batch.levels] = alone - K @ onward[batch.columns]
        return effects[:-1], solved[: self.b], solved[self.b :]

    def logdet_gradient(self, *, reml: bool) -> FloatArray:
        """Gradient of the log-determinant: the traces of ``Z.T @ P @ Z``, shape (k,)."""
        return self._gradient_reml if reml else self._gradient_ml

    def logdet_hessian(self, *, reml: bool) -> FloatArray:
        """Hessian of the log-determinant: minus squared norms of ``Z.T @ P @ Z``, shape (k, k)."""
        return self._hessian_reml if reml else self._hessian_ml

    @cached_property
    def _gradient_reml(self) -> FloatArray:
        return self._gradient(self.border_inverse)

    @cached_property
    def _gradient_ml(self) -> FloatArray:
        return self._gradient(self._border_inverse_without_fixed)

    @cached_property
    def _hessian_reml(self) -> FloatArray:
        return self._hessian(self.border_inverse)

    @cached_property
    def _hessian_ml(self) -> FloatArray:
        return self._hessian(self._border_inverse_without_fixed)

    def _weight(self, inverse: FloatArray) -> FloatArray:
        """Symmetric weight W, padded, with ``Z.T @ P @ Z = T0 - K @ W @ K.T`` in the blocks."""
        size = len(inverse)
        weight = np.zeros((self.end + 1, self.end + 1))
        weight[:size, :size] = self.ratio_border[:size, None] * inverse
        return weight

    def _gradient(self, inverse: FloatArray) -> FloatArray:
        weight = self._weight(inverse)
        levels = np.zeros(self.layout.n_interior + 1)
        for batch, T0, K in zip(self.batches, self.T0, self.K, strict=True):
            c = K.shape[2]
            part = K @ weight.take(batch.scatter).reshape(len(K), c, c)
            taken = np.einsum("mkc,mkc->mk", part, K)
            levels[batch.levels] = np.diagonal(T0, axis1=1, axis2=2) - taken
        border = np.einsum("ij,ji->i", inverse[: self.b], self.S0[: len(inverse), : self.b])
        gradient = np.zeros(len(self.gamma))
        for places, values in ((self.layout.interior, levels), (self.layout.border, border)):
            for i in places:
                gradient[i] = values[self.layout.columns[i]].sum()
        return gradient

    def _hessian(self, inverse: FloatArray) -> FloatArray:
        layout, size = self.layout, len(inverse)
        hessian = np.zeros((len(self.gamma), len(self.gamma)))
        root = np.zeros((self.end + 1, size + self.b))
        root[:size, :size] = self._border_root[:size, :size]
        root[:size, size:] = inverse[: self.b].T
        spread = np.zeros((layout.n_interior + 1, size + self.b))
        inside = np.zeros((len(layout.interior), len(layout.interior)))
        for batch, T0, K in zip(self.batches, self.T0, self.K, strict=True):
            local = K @ root[batch.columns]
            spread[batch.levels] = local
            cross = local[:, :, :size] @ local[:, :, :size].transpose(0, 2, 1)
            # |T0 - cross|^2 within blocks, |cross|^2 between blocks
            within = T0 * (T0 - 2.0 * cross)
            owner = self._owners(batch.levels)
            inside += (owner.transpose(0, 2, 1) @ within @ owner).sum(axis=0)
        grams = [spread[layout.columns[i], :size] for i in layout.interior]
        grams = [part.T @ part for part in grams]
        for at, i in enumerate(layout.interior):
            for there, j in enumerate(layout.interior[: at + 1]):
                between = float(np.vdot(grams[at], grams[there]))
                hessian[i, j] = hessian[j, i] = -(inside[at, there] + between)
            across = (spread[layout.columns[i], size:] ** 2).sum(axis=0)
            for j in layout.border:
                hessian[i, j] = hessian[j, i] = -across[layout.columns[j]].sum()
        squared = (inverse[: self.b] @ self.S0[:size, : self.b]) ** 2
        for i in layout.border:
            for j in layout.border:
                hessian[i, j] = -squared[layout.columns[i], layout.columns[j]].sum()
        return hessian

    def _owners(self, levels: CodeArray) -> FloatArray:
        """Which slot belongs to which interior factor, shape (m, width, number of factors)."""
        ends = [self.layout.columns[i].stop for i in self.layout.interior]
        owner = np.searchsorted(ends, levels, side="right")
        indicator: FloatArray = np.eye(len(ends) + 1, len(ends))[owner]
        return indicator

    @cached_property
    def _border_root(self) -> FloatArray:
        """Upper triangle E with ``W = E @ E.T``; the first n_border columns serve ML."""
        if not self.lower.size:  # no border and no fixed effects
            return self.lower
        inverse: FloatArray = lapack.dtrtri(self.lower, lower=1)[0]
        return np.sqrt(self.ratio_border)[:, None] * np.tril(inverse).T


class _BlockSolver:
    """Solutions of the equations of each block, with one factorisation of wide blocks.

    `transposed` holds the transposes of the blocks, shape (m, width, width); wide ones are
    overwritten. In column order, the order of LAPACK, these are the blocks themselves.
    """

    def __init__(self, transposed: FloatArray) -> None:
        self.transposed = transposed
        self.pivots: list[CodeArray] = []
        if transposed.shape[1] >= _WIDE:
            for block in transposed:
                self.pivots.append(lapack.dgetrf(block.T, overwrite_a=1)[1])

    def logdet(self) -> float:
        """Sum of the log-determinants."""
        if not self.pivots:
            return float(np.linalg.slogdet(self.transposed)[1].sum())
        diagonal = np.diagonal(self.transposed, axis1=1, axis2=2)
        return float(np.log(np.abs(diagonal)).sum())

    def solve(self, right: FloatArray) -> FloatArray:
        """Solve for the rows of right sides, shape (m, q, width)."""
        if not self.pivots:
            solved = np.linalg.solve(self.transposed.transpose(0, 2, 1), right.transpose(0, 2, 1))
            return solved.transpose(0, 2, 1)
        given = np.array(right, order="C")
        for block, pivots, values in zip(self.transposed, self.pivots, given, strict=True):
            lapack.dgetrs(block.T, pivots, values.T, overwrite_b=1)
        return given
