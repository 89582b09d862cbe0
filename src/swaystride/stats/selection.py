"""Choose the exponent of a learning curve and the terms of a mixed model.

Both work by maximum likelihood on explicit columns: a term is a column name of a numeric table or
a product such as ``"block:trial_number"``, and an intercept is always part of the model.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from swaystride.errors import ModelError
from swaystride.stats.grouping_factor import FloatArray, GroupingFactor
from swaystride.stats.mixed_design import (
    MixedDesign,
    check_columns,
    check_finite,
    factors_from_frame,
    model_matrix,
)
from swaystride.stats.mixed_fit import fit_design


@dataclass(frozen=True, eq=False)
class ExponentSearch:
    """Result of :func:`search_exponent`.

    Attributes
    ----------
    best : float
        The exponent with the highest log-likelihood (the smallest such, if several tie).
    loglik : pandas.Series
        Maximised ML log-likelihood by exponent.
    """

    best: float
    loglik: pd.Series[float]


@dataclass(frozen=True, eq=False)
class Elimination:
    """Result of :func:`eliminate_terms`.

    Attributes
    ----------
    terms : tuple of str
        The terms that remain, in their original order, without the intercept.
    aic : float
        ML AIC of the model with these terms.
    path : pandas.DataFrame
        One row per step: ``step``, ``dropped``, ``aic_before``, ``aic_after``.
    """

    terms: tuple[str, ...]
    aic: float
    path: pd.DataFrame


def raise_to_exponent(frame: pd.DataFrame, base: str, exponent: float) -> pd.DataFrame:
    """Copy a table with one column raised to a power, for a fit at the chosen exponent.

    Parameters
    ----------
    frame : pandas.DataFrame
    base : str
        A column without negative values.
    exponent : float

    Returns
    -------
    pandas.DataFrame

    Raises
    ------
    ModelError
        If the column is absent, incomplete or negative somewhere.

    Examples
    --------
    >>> raise_to_exponent(pd.DataFrame({"N": [0, 4, 9]}), "N", 0.5)["N"].tolist()
    [0.0, 2.0, 3.0]
    """
    return frame.assign(**{base: _base_values(frame, base) ** exponent})


def search_exponent(
    frame: pd.DataFrame,
    response: str,
    terms: Sequence[str],
    groups: Sequence[str],
    *,
    base: str,
    exponents: Sequence[float],
) -> ExponentSearch:
    """Find the exponent of one column by maximum ML log-likelihood of the given model.

    Every occurrence of `base` in the terms, also within products, is raised to the exponent.

    Parameters
    ----------
    frame : pandas.DataFrame
        Numeric columns for outcome and terms, any columns for the groups.
    response : str
        Outcome column.
    terms : sequence of str
        Terms of the maximal model, without the intercept.
    groups : sequence of str
        Grouping factors of the random intercepts.
    base : str
        The column to raise, without negative values.
    exponents : sequence of float
        Grid to choose from.

    Returns
    -------
    ExponentSearch

    Raises
    ------
    ModelError
        If no term holds `base`, the grid is empty, or the model cannot be fitted.

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> table = pd.DataFrame({"who": np.repeat(np.arange(8), 15), "N": np.tile(np.arange(15), 8)})
    >>> table["y"] = table["N"] ** 0.5 + rng.normal(size=8)[table["who"]]
    >>> table["y"] += 0.05 * rng.normal(size=len(table))
    >>> search = search_exponent(
    ...     table, "y", ["N"], ["who"], base="N", exponents=[0.3, 0.4, 0.5, 0.6, 0.7]
    ... )
    >>> search.best, len(search.loglik)
    (0.5, 5)
    """
    powers = np.array([term.split(":").count(base) for term in terms])
    if not powers.any():
        raise ModelError(f"no term holds the column {base}", found=", ".join(terms))
    if len(exponents) == 0:
        raise ModelError("there is no exponent to choose from")
    values = _base_values(frame, base)
    rest = model_matrix(frame.assign(**{base: 1.0}), terms)
    factors = factors_from_frame(frame, groups)
    y = _outcome(frame, response)
    names = ("Intercept", *terms)
    loglik = []
    for exponent in exponents:
        X = rest.copy()
        with np.errstate(divide="ignore"):
            X[:, 1:] *= np.where(powers == 0, 1.0, (values**exponent)[:, None] ** powers)
        loglik.append(fit_design(MixedDesign(X, names, factors), y, reml=False).loglik)
    series = pd.Series(loglik, index=pd.Index(exponents, name="exponent"), name="loglik")
    return ExponentSearch(best=float(exponents[int(np.argmax(loglik))]), loglik=series)


def eliminate_terms(
    frame: pd.DataFrame,
    response: str,
    terms: Sequence[str],
    groups: Sequence[str],
    *,
    protected: Sequence[str] = (),
) -> Elimination:
    """Backward elimination of single terms by ML AIC.

    At every step the unprotected term whose removal lowers AIC most is dropped; the search ends
    when no removal lowers it. Marginality is ignored on purpose: a main effect may go while its
    product stays, because the printed models that this reproduces do so (methods, section 8.3).

    Parameters
    ----------
    frame : pandas.DataFrame
        Numeric columns for outcome and terms, any columns for the groups.
    response : str
        Outcome column.
    terms : sequence of str
        Terms of the maximal model, without the intercept.
    groups : sequence of str
        Grouping factors of the random intercepts.
    protected : sequence of str, optional
        Terms that are never dropped. The intercept never is.

    Returns
    -------
    Elimination

    Raises
    ------
    ModelError
        If a protected term is not among the terms, or the model cannot be fitted.

    Examples
    --------
    >>> rng = np.random.default_rng(2)
    >>> table = pd.DataFrame(rng.normal(size=(60, 3)), columns=["x", "z", "w"])
    >>> table["who"] = np.repeat(np.arange(6), 10)
    >>> table["y"] = 2 * table["x"] + rng.normal(size=6)[table["who"]] + rng.normal(size=60)
    >>> result = eliminate_terms(table, "y", ["x", "z", "w"], ["who"], protected=["w"])
    >>> result.terms, result.path["dropped"].tolist()
    (('x', 'w'), ['z'])
    """
    absent = [term for term in protected if term not in terms]
    if absent:
        raise ModelError(
            f"the protected term {absent[0]} is not in the model", expected=", ".join(terms)
        )
    X, y = model_matrix(frame, terms), _outcome(frame, response)
    factors, names = factors_from_frame(frame, groups), ("Intercept", *terms)
    kept = list(range(len(names)))
    aic = _ml_aic(X, y, names, factors, kept)
    path: list[tuple[int, str, float, float]] = []
    while True:
        shorter = [
            [other for other in kept if other != at]
            for at in kept
            if at > 0 and names[at] not in protected
        ]
        candidates = [_ml_aic(X, y, names, factors, columns) for columns in shorter]
        if not candidates or min(candidates) >= aic:
            break
        best = int(np.argmin(candidates))
        (dropped,) = set(kept) - set(shorter[best])
        path.append((len(path) + 1, names[dropped], aic, candidates[best]))
        kept, aic = shorter[best], candidates[best]
    return Elimination(
        terms=tuple(names[at] for at in kept if at > 0),
        aic=aic,
        path=pd.DataFrame(path, columns=["step", "dropped", "aic_before", "aic_after"]),
    )


def _ml_aic(
    X: FloatArray,
    y: FloatArray,
    names: Sequence[str],
    factors: tuple[GroupingFactor, ...],
    columns: list[int],
) -> float:
    design = MixedDesign(X[:, columns], tuple(names[at] for at in columns), factors)
    return fit_design(design, y, reml=False).aic


def _outcome(frame: pd.DataFrame, response: str) -> FloatArray:
    check_columns(frame, [response])
    if not pd.api.types.is_numeric_dtype(frame[response]):
        raise ModelError(f"the column {response} is not numeric")
    y = frame[response].to_numpy(dtype=float)
    check_finite(y[:, None], [response])
    return y


def _base_values(frame: pd.DataFrame, base: str) -> FloatArray:
    values = _outcome(frame, base)
    if (values < 0.0).any():
        raise ModelError(
            f"the column {base} has no real powers",
            expected="no negative value",
            found=f"{int((values < 0.0).sum())} of {len(values)} rows",
        )
    return values
