"""Agreement of two ratings on the same ordered scale."""

from __future__ import annotations

from collections.abc import Hashable, Sequence

import numpy as np
import numpy.typing as npt
import pandas as pd

from swaystride.errors import DesignError


def rounded_rating(prediction: npt.ArrayLike, low: int = 1, high: int = 5) -> npt.NDArray[np.int64]:
    """Nearest rating of a scale of whole numbers.

    Parameters
    ----------
    prediction : array, shape (n,)
        Predicted ratings, any real numbers. A half is rounded up.
    low, high : int, optional
        Ends of the scale; what lies beyond is set to them.

    Returns
    -------
    array of int, shape (n,)

    Raises
    ------
    DesignError
        If a prediction is not finite, or the scale is empty.

    Examples
    --------
    >>> rounded_rating([-3.0, 1.49, 2.5, 4.51, 9.0]).tolist()
    [1, 1, 3, 5, 5]
    """
    values = np.asarray(prediction, dtype=float)
    if low >= high:
        raise DesignError("the scale is empty", expected="low < high", found=f"{low} and {high}")
    _check_finite(values, "prediction")
    return np.clip(np.floor(values + 0.5), low, high).astype(np.int64)


def contingency(
    rows: npt.ArrayLike, columns: npt.ArrayLike, levels: Sequence[Hashable]
) -> pd.DataFrame:
    """Counts of every pair of ratings, those that never occur included.

    Parameters
    ----------
    rows, columns : array, shape (n,)
        Two ratings of the same things.
    levels : sequence
        Levels of the scale in their order.

    Returns
    -------
    DataFrame
        Counts, first rating down, second across, both over `levels`.

    Raises
    ------
    DesignError
        If the lengths differ, a rating is missing or not one of the levels, or a level is named
        twice.

    Examples
    --------
    >>> contingency([1, 2, 2, 3], [1, 2, 3, 3], levels=[1, 2, 3]).to_numpy().tolist()
    [[1, 0, 0], [0, 1, 1], [0, 0, 1]]
    """
    index = pd.Index(list(levels))
    if not index.is_unique:
        raise DesignError("a level of the scale is named twice", found=str(list(levels)))
    first, second = _paired(rows, columns)
    codes = []
    for values in (first, second):
        code = index.get_indexer(pd.Index(values))
        if (code < 0).any():
            raise DesignError(
                "a rating is not on the scale",
                expected="one of " + ", ".join(map(str, levels)),
                found=str(values[int(np.argmin(code))]),
            )
        codes.append(code)
    counts = np.zeros((len(index), len(index)), dtype=np.int64)
    np.add.at(counts, (codes[0], codes[1]), 1)
    return pd.DataFrame(counts, index=index, columns=index)


def exact_agreement(a: npt.ArrayLike, b: npt.ArrayLike) -> float:
    """Share of things that two ratings rate alike.

    Parameters
    ----------
    a, b : array, shape (n,)
        Two ratings of the same things.

    Returns
    -------
    float
        Between 0 and 1.

    Raises
    ------
    DesignError
        If the lengths differ, nothing is rated, or a rating is missing.

    Examples
    --------
    >>> exact_agreement([1, 2, 3, 5], [1, 2, 4, 5])
    0.75
    """
    first, second = _paired(a, b)
    return float(np.mean(first == second))


def conditional_share(table: pd.DataFrame, row: Hashable, column: Hashable) -> float:
    """Share of one second rating among the things that got one first rating.

    Parameters
    ----------
    table : DataFrame
        As from :func:`contingency`.
    row : hashable
        Level of the first rating.
    column : hashable
        Level of the second rating.

    Returns
    -------
    float
        Between 0 and 1; NaN if nothing got this first rating.

    Raises
    ------
    DesignError
        If the table has no such row or column.

    Examples
    --------
    >>> conditional_share(contingency([5, 5, 5, 4], [5, 5, 4, 4], levels=[4, 5]), row=5, column=4)
    0.3333333333333333
    """
    for level, labels in ((row, table.index), (column, table.columns)):
        if level not in labels:
            raise DesignError(
                "the table has no such rating",
                expected="one of " + ", ".join(map(str, labels)),
                found=str(level),
            )
    counts = table.to_numpy()[table.index.get_loc(row)]
    total = int(counts.sum())
    return float(counts[table.columns.get_loc(column)] / total) if total else float("nan")


def _paired(
    a: npt.ArrayLike, b: npt.ArrayLike
) -> tuple[npt.NDArray[np.generic], npt.NDArray[np.generic]]:
    """Two ratings of equal length without gaps."""
    first, second = np.asarray(a), np.asarray(b)
    if first.shape != second.shape or first.ndim != 1:
        raise DesignError(
            "two ratings must be of the same things",
            expected="two lists of one length",
            found=f"shapes {first.shape} and {second.shape}",
        )
    if len(first) == 0:
        raise DesignError("nothing is rated", expected="one pair of ratings or more")
    for values in (first, second):
        missing = int(pd.isna(values).sum())
        if missing:
            raise DesignError(f"a rating is missing in {missing} of {len(values)} places")
    return first, second


def _check_finite(values: npt.NDArray[np.floating], name: str) -> None:
    bad = int((~np.isfinite(values)).sum())
    if bad:
        raise DesignError(f"a {name} is not finite in {bad} of {values.size} places")
