"""Many tests at once: the share of false discoveries, or the chance of any (Holm 1979)."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from swaystride.errors import ModelError
from swaystride.stats.grouping_factor import FloatArray


def benjamini_hochberg(p: npt.ArrayLike) -> FloatArray:
    """Adjusted p-values q: rejecting all tests with q ≤ α keeps the false discovery rate at α.

    Benjamini and Hochberg (1995).

    Parameters
    ----------
    p : array, shape (n,)
        p-values; NaN where there was no test, which then does not count.

    Returns
    -------
    array, shape (n,)
        NaN where p is.

    Raises
    ------
    ModelError
        If a value is no probability.

    Examples
    --------
    >>> benjamini_hochberg([0.01, 0.04, np.nan, 0.03]).round(3).tolist()
    [0.03, 0.04, nan, 0.04]
    """
    values, tested = _tested(p)
    ordered = np.sort(values[tested])
    n = ordered.size
    least = np.minimum.accumulate((ordered * n / np.arange(1, n + 1))[::-1])[::-1]
    return _in_place(values, tested, least)


def holm(p: npt.ArrayLike) -> FloatArray:
    """Adjusted p-values: rejecting all tests with one ≤ α keeps the chance of any false one at α.

    Holm (1979).

    Parameters
    ----------
    p : array, shape (n,)
        p-values; NaN where there was no test, which then does not count.

    Returns
    -------
    array, shape (n,)
        NaN where p is.

    Raises
    ------
    ModelError
        If a value is no probability.

    Examples
    --------
    >>> holm([0.01, np.nan, 0.04]).tolist()
    [0.02, nan, 0.04]
    """
    values, tested = _tested(p)
    ordered = np.sort(values[tested])
    largest = np.maximum.accumulate(ordered * np.arange(ordered.size, 0, -1))
    return _in_place(values, tested, largest)


def _tested(p: npt.ArrayLike) -> tuple[FloatArray, npt.NDArray[np.bool_]]:
    """p-values, and which of them are of tests."""
    values = np.asarray(p, dtype=float)
    tested = ~np.isnan(values)
    bad = tested & ~((values >= 0.0) & (values <= 1.0))
    if bad.any():
        raise ModelError(
            "a p-value is no probability", expected="0 to 1", found=f"{values[bad][0]:g}"
        )
    return values, tested


def _in_place(
    values: FloatArray, tested: npt.NDArray[np.bool_], of_ordered: FloatArray
) -> FloatArray:
    """Adjusted values of the ordered tests, back in the order of the tests and at most 1."""
    adjusted = np.full(values.shape, np.nan)
    at = np.flatnonzero(tested)[np.argsort(values[tested], kind="stable")]
    adjusted[at] = np.minimum(of_ordered, 1.0)
    return adjusted
