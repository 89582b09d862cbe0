"""Order the random effects so that the equations are many small blocks and one border.

One grouping factor is the *carrier*. Every factor nested in it (itself included) is *interior*:
its levels split into independent blocks, one per level of the carrier. All other factors are the
*border*, together with the fixed effects. A block meets only some columns of the border, and only
these are kept with it. The carrier is chosen by the arithmetic it saves.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from swaystride.stats.grouping_factor import CodeArray, FloatArray, GroupingFactor
from swaystride.stats.mixed_design import MixedDesign

# Blocks are padded to a common size with others at most this much smaller.
_PADDING = 1.25
# Largest number of elements of one batch of blocks.
_BATCH = 2_000_000


@dataclass(frozen=True, eq=False)
class BlockLayout:
    """Which level of which factor stands where.

    Attributes
    ----------
    interior, border : tuple of int
        Indices of the grouping factors.
    columns : dict of int to slice
        Where the levels of each factor stand in its list: the interior levels or the border.
    n_interior, n_border : int
        Levels of all interior and of all border factors.
    block : array of int, shape (n_interior,)
        Block of each interior level.
    n_blocks : int
    touched : array of int, shape (m, 2)
        Pairs of a block and a border column that share rows, in ascending order.
    """

    interior: tuple[int, ...]
    border: tuple[int, ...]
    columns: dict[int, slice]
    n_interior: int
    n_border: int
    block: CodeArray
    n_blocks: int
    touched: CodeArray


@dataclass(frozen=True, eq=False)
class BlockBatch:
    """Blocks of about the same size, padded with empty slots and columns to the same size.

    Attributes
    ----------
    levels : array of int, shape (m, width)
        Interior level in each slot; empty slots hold ``n_interior``.
    columns : array of int, shape (m, n_columns)
        Border column (those of the fixed effects follow the border factors) in each column;
        empty ones hold ``n_border + p``.
    products : array, shape (m, width + n_columns, width)
        Cross-products of the slots, then of the border columns, with the slots.
    scatter : array of int
        For each pair of columns of each block its place in the flattened padded border.
    """

    levels: CodeArray
    columns: CodeArray
    products: FloatArray
    scatter: CodeArray

    @property
    def width(self) -> int:
        """Slots per block."""
        return int(self.levels.shape[1])


def block_layout(design: MixedDesign) -> BlockLayout:
    """Choose the carrier and lay out the levels.

    Parameters
    ----------
    design : MixedDesign

    Returns
    -------
    BlockLayout

    Examples
    --------
    >>> import pandas as pd
    >>> from swaystride.stats.mixed_design import design_from_terms
    >>> table = pd.DataFrame({"plate": list("aabbccdd"), "sample": list("uvuvuvuv")})
    >>> layout = block_layout(design_from_terms(table, [], ["plate", "sample"]))
    >>> layout.interior, layout.border, layout.n_blocks, layout.n_border
    ((0,), (1,), 4, 2)
    """
    layouts = [_layout(design.factors, carrier) for carrier in range(len(design.factors))]
    return min(layouts, key=lambda layout: _cost(layout, design.p))


def _cost(layout: BlockLayout, p: int) -> float:
    """Multiplications of one evaluation, roughly."""
    k = np.bincount(layout.block, minlength=layout.n_blocks).astype(float)
    c = np.bincount(layout.touched[:, 0], minlength=layout.n_blocks) + float(p)
    b = layout.n_border + p
    inside = 2.0 * k**3 + 3.0 * k * k * c + 2.0 * k * c * c + 0.2 * k * b * b
    return float(inside.sum() + 4 * b**3)


def _layout(factors: Sequence[GroupingFactor], carrier: int) -> BlockLayout:
    interior = tuple(i for i, f in enumerate(factors) if f.is_nested_in(factors[carrier]))
    border = tuple(i for i in range(len(factors)) if i not in interior)
    columns: dict[int, slice] = {}
    counts = []
    for part in (interior, border):
        count = 0
        for i in part:
            columns[i] = slice(count, count + factors[i].n_levels)
            count = columns[i].stop
        counts.append(count)
    n_interior, n_border = counts
    of_row = factors[carrier].codes
    block = np.zeros(n_interior, dtype=np.intp)
    for i in interior:
        block[columns[i].start + factors[i].codes] = of_row
    met = np.zeros((factors[carrier].n_levels, n_border), dtype=bool)
    for i in border:
        met[of_row, columns[i].start + factors[i].codes] = True
    return BlockLayout(
        interior=interior,
        border=border,
        columns=columns,
        n_interior=n_interior,
        n_border=n_border,
        block=block,
        n_blocks=factors[carrier].n_levels,
        touched=np.argwhere(met),
    )


def block_batches(
    design: MixedDesign, layout: BlockLayout
) -> tuple[tuple[BlockBatch, ...], FloatArray]:
    """Count and sum the cross-products of all factors and the fixed effects.

    Parameters
    ----------
    design : MixedDesign
    layout : BlockLayout

    Returns
    -------
    tuple of BlockBatch
    array, shape (n_border + p, n_border + p)
        Cross-products within the border; the fixed effects enter through their orthonormal basis.
    """
    widths = np.bincount(layout.block, minlength=layout.n_blocks)
    met = np.bincount(layout.touched[:, 0], minlength=layout.n_blocks)
    size_class = [np.ceil(np.log(v + 1) / np.log(_PADDING)) for v in (widths, met)]
    classes = np.unique(np.column_stack(size_class), axis=0, return_inverse=True)[1].ravel()
    batches = []
    for which in range(int(classes.max()) + 1):
        members = np.flatnonzero(classes == which)
        k, c = int(widths[members].max()), int(met[members].max()) + design.p
        most = max(1, _BATCH // (k + c) ** 2)
        parts = np.array_split(members, -(-len(members) // most))
        batches += [_batch(design, layout, part, k, c) for part in parts]
    return tuple(batches), _corner(design, layout)


def _batch(
    design: MixedDesign, layout: BlockLayout, members: CodeArray, k: int, c: int
) -> BlockBatch:
    """Slots, columns and cross-products of some blocks."""
    m, p = len(members), design.p
    end = layout.n_border + p
    position = np.full(layout.n_blocks, -1)
    position[members] = np.arange(m)
    mine = np.flatnonzero(position[layout.block] >= 0)
    at, slot = _ranks(position[layout.block[mine]])
    levels = np.full((m, k), layout.n_interior)
    levels[at, slot] = mine[np.argsort(position[layout.block[mine]], kind="stable")]
    slot_of = np.zeros(layout.n_interior + 1, dtype=np.intp)
    slot_of[levels] = np.arange(k)
    touched = layout.touched[position[layout.touched[:, 0]] >= 0]
    at, rank = _ranks(position[touched[:, 0]])
    columns = np.full((m, c), end)
    columns[:, :p] = layout.n_border + np.arange(p)
    columns[at, p + rank] = touched[np.argsort(position[touched[:, 0]], kind="stable"), 1]
    # from a block and a border column to the column's place among those of the block
    place = np.zeros((m, end + 1), dtype=np.intp)
    place[np.arange(m)[:, None], columns] = np.arange(c)

    first = design.factors[layout.interior[0]]
    of_row = position[layout.block[layout.columns[layout.interior[0]].start + first.codes]]
    rows = np.flatnonzero(of_row >= 0)
    of_row = of_row[rows]

    def stacked(indices: tuple[int, ...]) -> CodeArray:
        codes = [layout.columns[i].start + design.factors[i].codes[rows] for i in indices]
        return np.array(codes, dtype=np.intp).reshape(len(indices), len(rows))

    inside = slot_of[stacked(layout.interior)]
    outside = k + place[of_row, stacked(layout.border)]
    here = of_row * (k + c) + np.concatenate([inside, outside])
    flat = (here[:, None] * k + inside).ravel()
    products = np.bincount(flat, minlength=m * k * (k + c)).astype(float).reshape(m, k + c, k)
    sums = np.zeros((layout.n_interior + 1, p))
    for i in layout.interior:
        sums[layout.columns[i]] = design.factors[i].sum_rows(design.Q)
    products[:, k : k + p] = sums[levels].transpose(0, 2, 1)
    scatter = (columns[:, :, None] * (end + 1) + columns[:, None, :]).ravel()
    return BlockBatch(levels, columns, products, scatter)


def _ranks(groups: CodeArray) -> tuple[CodeArray, CodeArray]:
    """Groups in ascending order, and the rank of each member within its group."""
    ordered = np.sort(groups, kind="stable")
    first = np.searchsorted(ordered, ordered)
    return ordered, np.arange(len(ordered)) - first


def _corner(design: MixedDesign, layout: BlockLayout) -> FloatArray:
    """Cross-products within the border."""
    b, p = layout.n_border, design.p
    corner = np.zeros((b + p, b + p))
    codes = [layout.columns[i].start + design.factors[i].codes for i in layout.border]
    at = np.array(codes, dtype=np.intp).reshape(len(codes), design.n)
    corner[:b, :b] = np.bincount((at[:, None] * b + at).ravel(), minlength=b * b).reshape(b, b)
    for i in layout.border:
        corner[layout.columns[i], b:] = design.factors[i].sum_rows(design.Q)
    corner[b:, :b] = corner[:b, b:].T
    corner[b:, b:] = np.eye(p)
    return corner
