"""Inter-rater reliability: ICC(2,1) from variance components, and from closed formulas.

With ratings of trials of exercises by patients and raters, the intraclass correlation is the share
of the variance that does not involve the rater: every component whose grouping factor does not
contain the rater, over the sum of all. The residual counts as containing the rater. (The text of
the dissertation, §3.3.4.1, prints the complement; register I-08.)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, Final, Literal, overload

import numpy as np
import numpy.typing as npt
import pandas as pd
from scipy.special import fdtrc, fdtri

from swaystride.errors import ModelError
from swaystride.stats.grouping_factor import FloatArray

if TYPE_CHECKING:  # a fit is only passed in; the models take long to import
    from swaystride.stats.mixed_model import MixedModelFit
    from swaystride.stats.mixed_refits import Seed

ReliabilityForm = Literal["printed", "recommended"]

#: Lower bounds of the classes above poor (Koo & Li 2016, as in the dissertation §3.3.4.1).
RELIABILITY_CLASSES: Final = ((0.5, "moderate"), (0.75, "good"))
_EXCELLENT_ABOVE: Final = 0.9
# Share of the ratings below which a residual is rounding.
_ROUNDING: Final = 1e-13


def reliability_formula(
    form: ReliabilityForm,
    *,
    outcome: str,
    patient: str,
    exercise: str,
    rater: str,
    trial: str | None = None,
) -> str:
    """Formula of the variance decomposition (spec §8.4).

    Parameters
    ----------
    form : {"printed", "recommended"}
        ``printed``: every interaction of trial, exercise, patient and rater that is neither the
        fixed trial nor the residual, 13 components (6 without trial). ``recommended``: the
        exercise is nested in the patient, 9 components (4 without trial).
    outcome, patient, exercise, rater : str
        Columns.
    trial : str, optional
        Column of the trial number, a fixed factor; without it the ratings are of exercises.

    Returns
    -------
    str

    Examples
    --------
    >>> reliability_formula("recommended", outcome="rating", patient="p", exercise="e", rater="r")
    'rating ~ 1 + (1|p) + (1|p:e) + (1|r) + (1|p:r)'
    """
    if form == "printed":
        factors = [exercise, patient, rater, *([trial] if trial else [])]
        groups = [
            ":".join(group)
            for size in range(1, len(factors))
            for group in combinations(factors, size)
            if group != (trial,)
        ]
    elif form == "recommended":
        nested = f"{patient}:{exercise}"
        groups = [patient, nested, rater, f"{patient}:{rater}"]
        if trial:
            groups += [
                f"{nested}:{rater}",
                f"{patient}:{trial}",
                f"{nested}:{trial}",
                f"{rater}:{trial}",
                f"{patient}:{rater}:{trial}",
            ]
    else:
        raise ModelError(
            "unknown form of the reliability", expected="printed or recommended", found=str(form)
        )
    fixed = f"C({trial})" if trial else "1"
    return f"{outcome} ~ {fixed} + " + " + ".join(f"(1|{group})" for group in groups)


@overload
def intraclass_correlation(variance_components: pd.Series[float], rater: str) -> float: ...
@overload
def intraclass_correlation(variance_components: pd.DataFrame, rater: str) -> FloatArray: ...
def intraclass_correlation(
    variance_components: pd.Series[float] | pd.DataFrame, rater: str
) -> float | FloatArray:
    """ICC(2,1): variance without the rater over all variance.

    Parameters
    ----------
    variance_components : Series or DataFrame
        By grouping factor, with ``Residual``; a table has one row per fit.
    rater : str
        Name of the rater's column.

    Returns
    -------
    float, or array of shape (n_fits,)

    Raises
    ------
    ModelError
        If no component contains the rater, the residual is absent, or there is no variance.

    Examples
    --------
    >>> components = pd.Series({"target": 3.0, "rater": 0.5, "Residual": 0.5})
    >>> intraclass_correlation(components, "rater")
    0.75
    """
    table = (
        variance_components.to_frame().T
        if isinstance(variance_components, pd.Series)
        else variance_components
    )
    with_rater = [name == "Residual" or rater in str(name).split(":") for name in table.columns]
    if sum(with_rater) < 2:
        raise ModelError(
            f"no variance component contains {rater!r}", found=", ".join(map(str, table.columns))
        )
    if "Residual" not in table.columns:
        raise ModelError(
            "the residual variance is absent", found=", ".join(map(str, table.columns))
        )
    variances = table.to_numpy(dtype=float)
    total = variances.sum(axis=1)
    if not (total > 0.0).all():
        raise ModelError("there is no variance to share", found=f"a total of {np.min(total)}")
    values: FloatArray = variances[:, ~np.array(with_rater)].sum(axis=1) / total
    return float(values[0]) if isinstance(variance_components, pd.Series) else values


def reliability_class(icc: float) -> str:
    """Word for an ICC: poor below .5, moderate below .75, good up to .9, excellent above.

    Parameters
    ----------
    icc : float
        Intraclass correlation.

    Examples
    --------
    >>> [reliability_class(icc) for icc in (0.3, 0.5, 0.868, 0.9, 0.95)]
    ['poor', 'moderate', 'good', 'good', 'excellent']
    """
    if icc > _EXCELLENT_ABOVE:
        return "excellent"
    return next((word for low, word in reversed(RELIABILITY_CLASSES) if icc >= low), "poor")


@dataclass(frozen=True)
class BootstrappedICC:
    """An ICC with percentile limits of a parametric bootstrap.

    Parameters
    ----------
    icc, ci_low, ci_high : float
        Estimate and limits.
    n_refits, n_not_converged : int
        Simulated responses, and fits among them that did not converge (they are left out).
    """

    icc: float
    ci_low: float
    ci_high: float
    n_refits: int
    n_not_converged: int


def bootstrap_icc(
    fit: MixedModelFit, rater: str, *, n: int, seed: Seed, level: float, processes: int = 1
) -> BootstrappedICC:
    """ICC of a fitted decomposition with a parametric bootstrap interval.

    Parameters
    ----------
    fit : MixedModelFit
        A decomposition such as :func:`reliability_formula` writes.
    rater : str
        Name of the rater's column.
    n : int
        Number of simulated responses.
    seed : int, sequence of int or numpy.random.SeedSequence
    level : float
        Confidence level.
    processes : int, optional
        Processes that share the refits; the result does not depend on it.

    Returns
    -------
    BootstrappedICC

    Raises
    ------
    ModelError
        If `n` is less than two, the level is no probability, no component contains the rater, or
        fewer than two refits converge.

    Notes
    -----
    Percentiles need no scale: Fisher's z or the logit would give the same limits.
    """
    _check_level(level)
    if n < 2:
        raise ModelError("too few draws for an interval", expected="2 or more", found=str(n))
    estimate = intraclass_correlation(fit.variance_components, rater)
    refits = fit.refit_many(fit.simulate(n, seed), processes=processes)
    converged = np.asarray(refits.converged)
    if converged.sum() < 2:
        raise ModelError("the refits do not converge", found=f"{(~converged).sum()} of {n} failed")
    draws = intraclass_correlation(refits.variance_components[converged], rater)
    tails = [(1.0 - level) / 2.0, (1.0 + level) / 2.0]
    low, high = np.quantile(draws, tails).tolist()
    return BootstrappedICC(estimate, low, high, n, int((~converged).sum()))


def two_way_icc(table: npt.ArrayLike, *, level: float = 0.95) -> pd.DataFrame:
    """Closed formulas for complete ratings of targets by raters (Shrout & Fleiss 1979).

    Parameters
    ----------
    table : array, shape (n_targets, n_raters)
        One rating per cell.
    level : float, optional
        Confidence level.

    Returns
    -------
    DataFrame
        ``icc, f, df1, df2, p, ci_low, ci_high`` by ``ICC(1,1)``, ``ICC(2,1)``, ``ICC(3,1)``,
        ``ICC(1,k)``, ``ICC(2,k)``, ``ICC(3,k)``. The limits of ICC(2,·) follow McGraw & Wong
        (1996); its F test is that of ICC(3,·). Limits of ICC(·,k) are those of
        ICC(·,1) after the Spearman-Brown formula.

    Raises
    ------
    ModelError
        If a rating is missing, there are fewer than two targets or raters, all ratings are equal,
        or raters differ by a constant only.

    Examples
    --------
    >>> judges = [[9, 2, 5, 8], [6, 1, 3, 2], [8, 4, 6, 8], [7, 1, 2, 6], [10, 5, 6, 9],
    ...           [6, 2, 4, 7]]
    >>> two_way_icc(judges)["icc"].round(2).tolist()
    [0.17, 0.29, 0.71, 0.44, 0.62, 0.91]
    """
    y = np.asarray(table, dtype=float)
    if y.ndim != 2 or min(y.shape) < 2:
        raise ModelError(
            "no table of targets by raters", expected="at least 2 × 2", found=str(y.shape)
        )
    if not np.isfinite(y).all():
        raise ModelError("a rating is missing", expected="complete ratings, or a mixed model")
    _check_level(level)
    n, k = y.shape
    if np.ptp(y) == 0.0:
        raise ModelError("all ratings are equal", found=str(y[0, 0]))
    between = k * y.mean(axis=1).var(ddof=1)
    raters = n * y.mean(axis=0).var(ddof=1)
    within = float(y.var(axis=1, ddof=1).mean())
    rest = y - y.mean(axis=1, keepdims=True) - y.mean(axis=0) + y.mean()
    error = float((rest**2).sum()) / ((n - 1) * (k - 1))
    if np.sqrt(error) <= _ROUNDING * np.abs(y).max():
        raise ModelError(
            "the ratings leave no residual variance", found="raters that differ by a constant only"
        )
    one = _one_way(between / within, n, k, level)
    three = _consistency(between / error, n, k, level)
    two = _agreement(between, raters, error, n, k, level)
    rows = [one[0], two[0], three[0], one[1], two[1], three[1]]
    names = ["ICC(1,1)", "ICC(2,1)", "ICC(3,1)", "ICC(1,k)", "ICC(2,k)", "ICC(3,k)"]
    columns = ["icc", "f", "df1", "df2", "p", "ci_low", "ci_high"]
    return pd.DataFrame(rows, index=pd.Index(names, name="form"), columns=columns)


def _check_level(level: float) -> None:
    if not 0.0 < level < 1.0:
        raise ModelError("the confidence level is no probability", found=str(level))


_Rows = tuple[Sequence[float], Sequence[float]]


def _one_way(f: float, n: int, k: int, level: float) -> _Rows:
    """ICC(1,1) and ICC(1,k) from the F of targets."""
    return _ratio_rows(f, n - 1, n * (k - 1), k, level)


def _consistency(f: float, n: int, k: int, level: float) -> _Rows:
    """ICC(3,1) and ICC(3,k) from the F of targets."""
    return _ratio_rows(f, n - 1, (n - 1) * (k - 1), k, level)


def _ratio_rows(f: float, df1: int, df2: int, k: int, level: float) -> _Rows:
    """Single and average ICC of the form (F − 1)/(F + k − 1) and 1 − 1/F."""
    upper = 0.5 + level / 2.0
    low = f / float(fdtri(df1, df2, upper))
    high = f * float(fdtri(df2, df1, upper))
    p = float(fdtrc(df1, df2, f))
    single = [(x - 1.0) / (x + k - 1.0) for x in (f, low, high)]
    average = [1.0 - 1.0 / x for x in (f, low, high)]
    return (
        [single[0], f, df1, df2, p, *single[1:]],
        [average[0], f, df1, df2, p, *average[1:]],
    )


def _agreement(between: float, raters: float, error: float, n: int, k: int, level: float) -> _Rows:
    """ICC(2,1) and ICC(2,k), with limits by Satterthwaite's approximation."""
    df1, df_error, upper = n - 1, (n - 1) * (k - 1), 0.5 + level / 2.0
    icc = (between - error) / (between + (k - 1) * error + k * (raters - error) / n)
    # The degrees of freedom are a mean of positive parts only if the share is not negative.
    share, ratio = max(icc, 0.0), raters / error
    top = df_error * (k * share * ratio + n * (1.0 + (k - 1) * share) - k * share) ** 2
    bottom = df1 * (k * share * ratio) ** 2 + (n * (1.0 + (k - 1) * share) - k * share) ** 2
    df2 = top / bottom
    high_f = float(fdtri(df1, df2, upper))
    low_f = float(fdtri(df2, df1, upper))
    spread = k * raters + (k * n - k - n) * error
    low = n * (between - high_f * error) / (high_f * spread + n * between)
    high = n * (low_f * between - error) / (spread + n * low_f * between)
    f = between / error
    p = float(fdtrc(df1, df_error, f))
    averages = [_of_average(x, k) for x in (icc, low, high)]
    return (
        [icc, f, df1, df_error, p, low, high],
        [averages[0], f, df1, df_error, p, *averages[1:]],
    )


def _of_average(icc: float, k: int) -> float:
    """Reliability of the mean of k raters, Spearman-Brown; no bound beyond its pole."""
    below = 1.0 + (k - 1) * icc
    return k * icc / below if below > 0.0 else -float("inf")
