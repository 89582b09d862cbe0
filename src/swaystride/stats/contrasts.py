"""Linear combinations of fixed effects: weights, labels and t tests."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

import numpy as np
import numpy.typing as npt
import pandas as pd
from scipy.special import stdtr, stdtrit

from swaystride.errors import ModelError
from swaystride.stats.grouping_factor import FloatArray
from swaystride.stats.mixed_design import MixedDesign
from swaystride.stats.mixed_fit import DesignFit
from swaystride.stats.satterthwaite import satterthwaite_df

DegreesOfFreedom = Literal["satterthwaite", "residual"]
Weights = Mapping[str, float] | Sequence[float] | npt.NDArray[np.float64]


def contrast_rows(design: MixedDesign, weights: Weights) -> FloatArray:
    """Weights as a matrix with one combination per row.

    Parameters
    ----------
    design : MixedDesign
    weights : mapping of str to float, or array of shape (p,) or (m, p)

    Returns
    -------
    array, shape (m, p)

    Raises
    ------
    ModelError
        If a term is unknown, a row is zero, or the shape does not fit.

    Examples
    --------
    >>> from swaystride.stats.mixed_design import design_from_terms
    >>> table = pd.DataFrame({"x": [0.0, 1, 2, 3], "who": list("aabb")})
    >>> contrast_rows(design_from_terms(table, ["x"], ["who"]), {"x": 2}).tolist()
    [[0.0, 2.0]]
    """
    names = design.names
    if isinstance(weights, Mapping):
        unknown = [term for term in weights if term not in names]
        if unknown:
            raise ModelError(
                f"there is no fixed effect {unknown[0]}", expected="one of " + ", ".join(names)
            )
        rows = np.array([[float(weights.get(name, 0.0)) for name in names]])
    else:
        rows = np.atleast_2d(np.asarray(weights, dtype=float))
    if rows.ndim != 2 or rows.shape[1] != len(names):
        raise ModelError(
            "the contrast does not fit the model",
            expected=f"{len(names)} weights, for {', '.join(names)}",
            found=f"shape {rows.shape}",
        )
    if not rows.any(axis=1).all():
        raise ModelError("the contrast has no weight")
    return rows


def contrast_label(design: MixedDesign, row: FloatArray) -> str:
    """Write a combination as a sum of terms.

    Parameters
    ----------
    design : MixedDesign
    row : array, shape (p,)

    Returns
    -------
    str

    Examples
    --------
    >>> from swaystride.stats.mixed_design import design_from_terms
    >>> table = pd.DataFrame({"x": [0.0, 1, 2, 3], "who": list("aabb")})
    >>> contrast_label(design_from_terms(table, ["x"], ["who"]), np.array([1.0, -0.5]))
    'Intercept - 0.5*x'
    """
    text = ""
    for weight, name in zip(row, design.names, strict=True):
        if weight != 0.0:
            sign = (" - " if weight < 0 else " + ") if text else ("-" if weight < 0 else "")
            factor = "" if abs(weight) == 1.0 else f"{abs(weight):g}*"
            text += f"{sign}{factor}{name}"
    return text


def contrast_tests(
    fit: DesignFit, rows: FloatArray, labels: list[str], *, df: DegreesOfFreedom, level: float
) -> pd.DataFrame:
    """Estimate combinations, test them against zero and give confidence limits.

    Parameters
    ----------
    fit : DesignFit
    rows : array, shape (m, p)
    labels : list of str
        Row labels of the result.
    df : {"satterthwaite", "residual"}
        Degrees of freedom of the t distribution; "residual" is rows minus fixed effects.
    level : float
        Confidence level.

    Returns
    -------
    pandas.DataFrame
        ``estimate, se, df, t, p, ci_low, ci_high``.

    Raises
    ------
    ModelError
        If the degrees of freedom are of an unknown kind.

    Examples
    --------
    >>> from swaystride.stats.mixed_design import design_from_terms
    >>> from swaystride.stats.mixed_fit import fit_design
    >>> table = pd.DataFrame({"who": list("aabbcc")})
    >>> fit = fit_design(design_from_terms(table, [], ["who"]), np.array([1.0, 2, 4, 5, 8, 9]))
    >>> tests = contrast_tests(fit, np.array([[1.0]]), ["mean"], df="satterthwaite", level=0.95)
    >>> tests[["estimate", "df"]].round(6).to_numpy().tolist()
    [[4.833333, 2.0]]
    """
    if df == "satterthwaite":
        freedom = satterthwaite_df(fit, rows)
    elif df == "residual":
        freedom = np.full(len(rows), float(fit.design.n - fit.design.p))
    else:
        raise ModelError(
            "unknown degrees of freedom",
            expected="satterthwaite or residual (Kenward-Roger is out of scope)",
            found=str(df),
        )
    estimate = rows @ fit.beta
    se = np.sqrt(np.einsum("ij,jk,ik->i", rows, fit.covariance, rows))
    t = estimate / se
    half = stdtrit(freedom, 0.5 + level / 2.0) * se
    return pd.DataFrame(
        {
            "estimate": estimate,
            "se": se,
            "df": freedom,
            "t": t,
            "p": 2.0 * stdtr(freedom, -np.abs(t)),
            "ci_low": estimate - half,
            "ci_high": estimate + half,
        },
        index=labels,
    )
