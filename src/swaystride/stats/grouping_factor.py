"""Grouping factors: which level of a random intercept each row belongs to."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
import pandas as pd

from swaystride.errors import ModelError

FloatArray = npt.NDArray[np.floating]
CodeArray = npt.NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class GroupingFactor:
    """A partition of the rows into the levels of one random intercept.

    Attributes
    ----------
    name : str
        As written in the formula, ``"a"`` or ``"a:b"``.
    codes : array of int, shape (n,)
        Level of each row, 0 to ``n_levels - 1``; every level occurs.
    levels : pandas.Index
        Names of the levels; those of ``a:b`` are joined by a colon.
    """

    name: str
    codes: CodeArray
    levels: pd.Index[str]

    @property
    def n_levels(self) -> int:
        """Number of levels."""
        return len(self.levels)

    @cached_property
    def counts(self) -> FloatArray:
        """Rows per level, shape (n_levels,)."""
        return np.bincount(self.codes, minlength=self.n_levels).astype(float)

    @cached_property
    def _order_and_starts(self) -> tuple[CodeArray, CodeArray]:
        order = np.argsort(self.codes, kind="stable")
        return order, np.searchsorted(self.codes[order], np.arange(self.n_levels))

    def sum_rows(self, values: FloatArray) -> FloatArray:
        """Sum rows within levels, ``Z.T @ values``.

        Parameters
        ----------
        values : array, shape (n, m)

        Returns
        -------
        array, shape (n_levels, m)
        """
        order, starts = self._order_and_starts
        sums: FloatArray = np.add.reduceat(values[order], starts, axis=0)
        return sums

    def is_nested_in(self, other: GroupingFactor) -> bool:
        """Whether every level lies within a single level of the other factor."""
        of_level = np.empty(self.n_levels, dtype=np.intp)
        of_level[self.codes] = other.codes
        return bool((of_level[self.codes] == other.codes).all())


def grouping_factor(frame: pd.DataFrame, name: str) -> GroupingFactor:
    """Build the grouping factor ``"a"`` or ``"a:b"`` from columns of a table.

    Parameters
    ----------
    frame : pandas.DataFrame
        Rows with the columns that the name mentions, free of missing values.
    name : str
        One column, or several joined by colons for their observed combinations.

    Returns
    -------
    GroupingFactor

    Raises
    ------
    ModelError
        If there are fewer than two levels, or as many levels as rows.

    Examples
    --------
    >>> table = pd.DataFrame({"a": ["x", "x", "y", "y", "y"], "b": [1, 2, 1, 1, 2]})
    >>> factor = grouping_factor(table, "a:b")
    >>> list(factor.levels), factor.counts.tolist()
    (['x:1', 'x:2', 'y:1', 'y:2'], [1.0, 1.0, 2.0, 1.0])
    """
    codes = np.zeros(len(frame), dtype=np.intp)
    levels: list[str] = [""]
    for column in name.split(":"):
        column_codes, column_levels = pd.factorize(frame[column], sort=True)
        joint, codes = np.unique(codes * len(column_levels) + column_codes, return_inverse=True)
        levels = [
            f"{levels[at // len(column_levels)]}:{column_levels[at % len(column_levels)]}"
            for at in joint.tolist()
        ]
    factor = GroupingFactor(
        name, codes.astype(np.intp), pd.Index([level[1:] for level in levels], name=name)
    )
    if factor.n_levels < 2:
        raise ModelError(
            f"the grouping factor {name} has {factor.n_levels} level", expected="2 or more"
        )
    if factor.n_levels == len(frame):
        raise ModelError(
            f"the random intercept of {name} cannot be told from the residual",
            expected="fewer levels than rows",
            found=f"{factor.n_levels} levels in {len(frame)} rows",
        )
    return factor


def check_distinct(factors: tuple[GroupingFactor, ...]) -> None:
    """Refuse two grouping factors that divide the rows in the same way.

    Parameters
    ----------
    factors : tuple of GroupingFactor

    Raises
    ------
    ModelError
        Naming the two factors.

    Examples
    --------
    >>> table = pd.DataFrame({"a": [1, 1, 2], "b": ["u", "u", "v"]})
    >>> check_distinct((grouping_factor(table, "a"), grouping_factor(table, "b")))
    Traceback (most recent call last):
        ...
    swaystride.errors.ModelError: the grouping factors a and b divide the rows in the same way
    """
    for at, factor in enumerate(factors):
        for other in factors[:at]:
            if factor.n_levels == other.n_levels and factor.is_nested_in(other):
                raise ModelError(
                    f"the grouping factors {other.name} and {factor.name} "
                    "divide the rows in the same way"
                )
