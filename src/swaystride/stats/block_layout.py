"""Order the random effects so that the equations are many small blocks and one border.

One grouping factor is the *carrier*. Every factor nested in it (itself included) is *interior*:
its levels split into independent blocks, one per level of the carrier. All other factors are the
*border*, together with the fixed effects. The carrier is chosen by the arithmetic it saves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from swaystride.stats.grouping_factor import CodeArray, FloatArray
from swaystride.stats.mixed_design import MixedDesign


@dataclass(frozen=True, eq=False)
class BlockLayout:
    """Which level of which factor stands where.

    Attributes
    ----------
    interior, border : tuple of int
        Indices of the grouping factors.
    block : array of int, shape (n,)
        Block of each row.
    n_blocks, width : int
        Number of blocks and slots per block; a block with fewer levels has empty slots.
    slots : dict of int to slice
        Slots of each interior factor within a block.
    columns : dict of int to slice
        Columns of each border factor.
    n_border : int
        Columns of all border factors; those of the fixed effects follow.
    place : dict of int to array of int, shape (n,)
        For each row its slot (interior) or column (border).
    home : dict of int to tuple of array
        For each level of an interior factor its block and its slot.
    """

    interior: tuple[int, ...]
    border: tuple[int, ...]
    block: CodeArray
    n_blocks: int
    width: int
    slots: dict[int, slice]
    columns: dict[int, slice]
    n_border: int
    place: dict[int, CodeArray]
    home: dict[int, tuple[CodeArray, CodeArray]]


@dataclass(frozen=True, eq=False)
class BlockProducts:
    """Cross-products of the design in the block layout.

    Attributes
    ----------
    inner : array, shape (n_blocks, width, width)
        Within blocks.
    outer : array, shape (n_blocks, width, n_border + p)
        Between blocks and border.
    corner : array, shape (n_border + p, n_border + p)
        Within the border; the fixed effects enter through their orthonormal basis.
    """

    inner: FloatArray
    outer: FloatArray
    corner: FloatArray


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
    layouts = [_layout(design, carrier) for carrier in range(len(design.factors))]
    return min(layouts, key=lambda layout: _cost(layout, design.p))


def _cost(layout: BlockLayout, p: int) -> float:
    """Multiplications of one evaluation, roughly."""
    k, b = layout.width, layout.n_border + p
    return float(layout.n_blocks * (k**3 + k * k * b + k * b * b) + 4 * b**3)


def _layout(design: MixedDesign, carrier: int) -> BlockLayout:
    factors = design.factors
    block = factors[carrier].codes
    interior = tuple(i for i, f in enumerate(factors) if f.is_nested_in(factors[carrier]))
    border = tuple(i for i in range(len(factors)) if i not in interior)
    slots, columns, place, home = {}, {}, {}, {}
    width = 0
    for i in interior:
        level_block = np.zeros(factors[i].n_levels, dtype=np.intp)
        level_block[factors[i].codes] = block
        order = np.argsort(level_block, kind="stable")
        per_block = np.bincount(level_block, minlength=factors[carrier].n_levels)
        first = np.concatenate([[0], np.cumsum(per_block)[:-1]])
        level_slot = np.empty_like(level_block)
        level_slot[order] = np.arange(len(order)) - first[level_block[order]] + width
        slots[i] = slice(width, width + int(per_block.max()))
        place[i], home[i] = level_slot[factors[i].codes], (level_block, level_slot)
        width = slots[i].stop
    n_border = 0
    for i in border:
        columns[i] = slice(n_border, n_border + factors[i].n_levels)
        place[i] = factors[i].codes + n_border
        n_border = columns[i].stop
    return BlockLayout(
        interior=interior,
        border=border,
        block=block,
        n_blocks=factors[carrier].n_levels,
        width=width,
        slots=slots,
        columns=columns,
        n_border=n_border,
        place=place,
        home=home,
    )


def block_products(design: MixedDesign, layout: BlockLayout) -> BlockProducts:
    """Count and sum the cross-products of all factors and the fixed effects.

    Parameters
    ----------
    design : MixedDesign
    layout : BlockLayout

    Returns
    -------
    BlockProducts
    """
    m, k, b, p = layout.n_blocks, layout.width, layout.n_border, design.p
    inner, outer, corner = np.zeros((m, k, k)), np.zeros((m, k, b + p)), np.zeros((b + p, b + p))
    flat = layout.block * k
    for i in layout.interior:
        row = flat + layout.place[i]
        for j in layout.interior:
            inner += _counts(row * k + layout.place[j], (m, k, k))
        for j in layout.border:
            outer[:, :, :b] += _counts(row * b + layout.place[j], (m, k, b))
        level_block, level_slot = layout.home[i]
        outer[level_block, level_slot, b:] = design.factors[i].sum_rows(design.Q)
    for i in layout.border:
        for j in layout.border:
            corner[:b, :b] += _counts(layout.place[i] * b + layout.place[j], (b, b))
        corner[layout.columns[i], b:] = design.factors[i].sum_rows(design.Q)
    corner[b:, :b] = corner[:b, b:].T
    corner[b:, b:] = np.eye(p)
    return BlockProducts(inner, outer, corner)


def _counts(index: CodeArray, shape: tuple[int, ...]) -> FloatArray:
    counts: FloatArray = np.bincount(index, minlength=int(np.prod(shape))).astype(float)
    return counts.reshape(shape)
