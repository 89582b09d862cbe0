"""Correlation of two variables, with the interval of Fisher's z."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import pandas as pd
from scipy.special import ndtri, stdtr

from swaystride.errors import ModelError
from swaystride.stats.grouping_factor import FloatArray

_FEWEST = 4


@dataclass(frozen=True)
class Correlation:
    """A correlation coefficient.

    Attributes
    ----------
    r : float
        The coefficient.
    ci_low, ci_high : float
        Confidence limits by Fisher's z.
    p : float
        Two-sided p-value of the hypothesis that there is none.
    n : int
        Number of pairs.
    """

    r: float
    ci_low: float
    ci_high: float
    p: float
    n: int


def pearson(x: npt.ArrayLike, y: npt.ArrayLike, level: float = 0.95) -> Correlation:
    """Pearson's correlation.

    The limits are ``tanh(atanh(r) ± z/sqrt(n - 3))``, the p-value is that of
    ``t = r*sqrt((n - 2)/(1 - r²))`` with n - 2 degrees of freedom.

    Parameters
    ----------
    x, y : array, shape (n,)
        Pairs of values.
    level : float, optional
        Confidence level.

    Returns
    -------
    Correlation

    Raises
    ------
    ModelError
        If the lengths differ, there are fewer than four pairs, a value is not finite, a variable
        is constant, or the level is no probability.

    Examples
    --------
    >>> found = pearson([1, 2, 3, 4, 5], [2, 1, 4, 3, 5])
    >>> round(found.r, 6), round(found.ci_low, 3), round(found.ci_high, 3), round(found.p, 3)
    (0.8, -0.28, 0.986, 0.104)
    """
    first, second = _checked(x, y)
    return _correlation(first, second, level)


def spearman(x: npt.ArrayLike, y: npt.ArrayLike, level: float = 0.95) -> Correlation:
    """Spearman's rank correlation: Pearson's of the ranks, ties at their mean rank.

    Limits and p-value are computed from it as for :func:`pearson`.

    Parameters
    ----------
    x, y : array, shape (n,)
        Pairs of values.
    level : float, optional
        Confidence level.

    Returns
    -------
    Correlation

    Raises
    ------
    ModelError
        As for :func:`pearson`.

    Examples
    --------
    >>> round(spearman([1, 2, 3, 4], [1, 8, 27, 26]).r, 6)
    0.8
    """
    first, second = _checked(x, y)
    return _correlation(_ranks(first), _ranks(second), level)


def _correlation(x: FloatArray, y: FloatArray, level: float) -> Correlation:
    """Coefficient, limits and p-value of checked pairs."""
    if not 0.0 < level < 1.0:
        raise ModelError("the confidence level is no probability", found=str(level))
    n = len(x)
    a, b = (_unit(values) for values in (x, y))
    r = float(np.clip(a @ b, -1.0, 1.0))
    # A perfect correlation has z and t at infinity; its limits are itself.
    with np.errstate(divide="ignore"):
        z = np.arctanh(r)
        t = r * np.sqrt((n - 2) / np.float64((1.0 - r) * (1.0 + r)))
    half = ndtri(0.5 + level / 2.0) / np.sqrt(n - 3.0)
    return Correlation(
        r=r,
        ci_low=float(np.tanh(z - half)),
        ci_high=float(np.tanh(z + half)),
        p=float(2.0 * stdtr(n - 2, -abs(t))),
        n=n,
    )


def _ranks(values: FloatArray) -> FloatArray:
    """Ranks from 1, ties at their mean rank."""
    ranks: FloatArray = pd.Series(values).rank().to_numpy()
    return ranks


def _unit(values: FloatArray) -> FloatArray:
    """Centred values of length one; scaled first, so that squares stay in range."""
    centred = values - values.mean()
    centred = centred / np.abs(centred).max()
    unit: FloatArray = centred / np.linalg.norm(centred)
    return unit


def _checked(x: npt.ArrayLike, y: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Pairs of finite numbers that vary."""
    first, second = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if first.shape != second.shape or first.ndim != 1:
        raise ModelError(
            "a correlation needs pairs",
            expected="two lists of one length",
            found=f"shapes {first.shape} and {second.shape}",
        )
    if len(first) < _FEWEST:
        raise ModelError(
            "too few pairs for a correlation with an interval",
            expected=f"{_FEWEST} or more",
            found=str(len(first)),
        )
    for name, values in (("first", first), ("second", second)):
        bad = int((~np.isfinite(values)).sum())
        if bad:
            raise ModelError(f"the {name} variable is not finite in {bad} of {len(values)} pairs")
        # Values whose spread is rounding of their size carry no information.
        if np.ptp(values) <= 1e-14 * np.abs(values).max():
            raise ModelError(f"the {name} variable is constant", found=str(values[0]))
    return first, second
