"""Fit one design to many responses: simulation, bootstrap, permutation."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context

import numpy as np
import pandas as pd

from swaystride.errors import ModelError
from swaystride.stats.grouping_factor import FloatArray
from swaystride.stats.mixed_design import MixedDesign
from swaystride.stats.mixed_fit import DesignFit, fit_design, ols_residual, structure_of
from swaystride.stats.one_factor import OneFactorStructure

Seed = int | Sequence[int] | np.random.SeedSequence
_CHUNK = 2000
_ROUNDING = 1e-11


@dataclass(frozen=True, eq=False)
class Refits:
    """Estimates for N responses of the same design.

    Attributes
    ----------
    estimates, se : pandas.DataFrame
        Fixed effects and their standard errors, one row per response.
    variance_components : pandas.DataFrame
        One column per grouping factor, and ``Residual``.
    loglik : array, shape (N,)
    converged : array of bool, shape (N,)
    """

    estimates: pd.DataFrame
    se: pd.DataFrame
    variance_components: pd.DataFrame
    loglik: FloatArray
    converged: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]


def simulate_responses(fit: DesignFit, n: int, seed: Seed) -> FloatArray:
    """Draw responses from a fitted model, random effects included.

    Parameters
    ----------
    fit : DesignFit
    n : int
        Number of responses.
    seed : int, sequence of int or numpy.random.SeedSequence

    Returns
    -------
    array, shape (n, number of rows)

    Examples
    --------
    >>> from swaystride.stats.mixed_design import design_from_terms
    >>> table = pd.DataFrame({"who": list("aabbcc")})
    >>> fit = fit_design(design_from_terms(table, [], ["who"]), np.array([1.0, 2, 4, 5, 8, 9]))
    >>> simulate_responses(fit, 3, seed=1).shape
    (3, 6)
    """
    rng = np.random.default_rng(seed)
    design, variances = fit.design, fit.variances
    noise = np.sqrt(fit.sigma2) * rng.standard_normal((n, design.n))
    responses: FloatArray = design.X @ fit.beta + noise
    for variance, factor in zip(variances[:-1], design.factors, strict=True):
        effects = np.sqrt(variance) * rng.standard_normal((n, factor.n_levels))
        responses += effects[:, factor.codes]
    return responses


def refit_responses(
    design: MixedDesign,
    responses: FloatArray,
    *,
    reml: bool,
    start: FloatArray | None = None,
    processes: int = 1,
) -> Refits:
    """Fit the same design to many responses.

    For a single grouping factor all responses are fitted side by side; otherwise one after the
    other, with everything that depends on the design alone computed once.

    Parameters
    ----------
    design : MixedDesign
    responses : array, shape (N, n)
        One response per row.
    reml : bool
    start : array, shape (k,), optional
        Variance ratios near which the answers are expected, to save steps with several factors.
    processes : int, optional
        Processes that share the responses of a design with several factors. Every response is
        fitted alone, so that the result does not depend on their number. The processes start
        afresh: a script that asks for more than one protects its own start by
        ``if __name__ == "__main__":``.

    Returns
    -------
    Refits

    Raises
    ------
    ModelError
        If the shape is wrong, a value is not finite, a response has no residual variance, or
        there is not at least one process.

    Examples
    --------
    >>> from swaystride.stats.mixed_design import design_from_terms
    >>> design = design_from_terms(pd.DataFrame({"who": list("aabbcc")}), [], ["who"])
    >>> refits = refit_responses(design, np.array([[1.0, 2, 4, 5, 8, 9], [0, 2, 0, 2, 0, 2]]),
    ...                          reml=True)
    >>> refits.variance_components.round(6).to_numpy().tolist()
    [[12.083333, 0.5], [0.0, 1.2]]
    """
    responses = np.asarray(responses, dtype=float)
    if responses.ndim != 2 or responses.shape[1] != design.n:
        raise ModelError(
            "the responses do not fit the design",
            expected=f"an array of shape (N, {design.n})",
            found=str(responses.shape),
        )
    if not np.isfinite(responses).all():
        at = int(np.argmin(np.isfinite(responses).all(axis=1)))
        raise ModelError(f"response {at} is not finite")
    if processes < 1:
        raise ModelError("no process to work with", expected="1 or more", found=str(processes))
    structure = structure_of(design)
    if isinstance(structure, OneFactorStructure):
        chunks = [
            _one_factor(structure, responses[start : start + _CHUNK], start, reml=reml)
            for start in range(0, len(responses), _CHUNK)
        ] or [_one_factor_empty(design)]
    else:
        chunks = _in_processes(design, responses, start, reml=reml, processes=processes)
    estimates, se, variances, loglik, converged = (
        np.concatenate(parts) for parts in zip(*chunks, strict=True)
    )
    components = [*(factor.name for factor in design.factors), "Residual"]
    return Refits(
        estimates=pd.DataFrame(estimates, columns=list(design.names)),
        se=pd.DataFrame(se, columns=list(design.names)),
        variance_components=pd.DataFrame(variances, columns=components),
        loglik=loglik,
        converged=converged.astype(bool),
    )


_Arrays = tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]


def _one_factor_empty(design: MixedDesign) -> _Arrays:
    empty = np.empty((0, design.p))
    return empty, empty, np.empty((0, len(design.factors) + 1)), np.empty(0), np.empty(0)


def _one_factor(
    structure: OneFactorStructure, responses: FloatArray, first: int, *, reml: bool
) -> _Arrays:
    """Estimates, standard errors, variances, log-likelihoods and convergence, side by side."""
    design = structure.design
    Y = responses.T
    residual = ols_residual(design, Y)
    bound = structure.bind(residual)
    flat = np.sqrt(bound.s0) <= _ROUNDING * np.abs(Y).max(axis=0)
    if flat.any():
        raise ModelError(f"response {first + int(np.argmax(flat))} is reproduced by the groups")
    best = bound.best_ratios(reml=reml)
    nu = design.n - (design.p if reml else 0)
    sigma2 = best.s / nu
    precision = structure.precision(best.gamma)
    on_basis = (design.Q.T @ Y).T + bound.shifts(best.gamma, precision)
    r_inverse = np.linalg.inv(design.R)
    inverse = r_inverse @ np.linalg.inv(precision) @ r_inverse.T
    variance = sigma2[:, None] * np.diagonal(inverse, axis1=1, axis2=2)
    deviance = best.logdet + nu * (1.0 + np.log(2.0 * np.pi * sigma2))
    return (
        on_basis @ r_inverse.T,
        np.sqrt(variance),
        np.column_stack([best.gamma * sigma2, sigma2]),
        -0.5 * (deviance + (design.log_det_xtx if reml else 0.0)),
        best.converged.astype(float),
    )


def _in_processes(
    design: MixedDesign,
    responses: FloatArray,
    start: FloatArray | None,
    *,
    reml: bool,
    processes: int,
) -> list[_Arrays]:
    """Share the responses among processes; one process stays in this one."""
    if processes == 1 or len(responses) < 2 * processes:
        return [_one_by_one(design, (0, responses), start=start, reml=reml)]
    parts = np.array_split(np.arange(len(responses)), processes)
    given = [(int(rows[0]), responses[rows]) for rows in parts]
    # A copy leaves behind what the design has computed for itself.
    copy = MixedDesign(design.X, design.names, design.factors)
    fit_part = partial(_one_by_one, copy, start=start, reml=reml)
    # Fresh processes: a fork of one with threads of a linear algebra library may hang.
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
        return list(pool.map(fit_part, given))


def _one_by_one(
    design: MixedDesign,
    numbered: tuple[int, FloatArray],
    *,
    start: FloatArray | None,
    reml: bool,
) -> _Arrays:
    """Fit one response after the other; `numbered` holds the number of the first and all."""
    estimates, se, variances, loglik, converged = [], [], [], [], []
    first, responses = numbered
    for at, y in enumerate(responses, start=first):
        try:
            fit = fit_design(design, y, reml=reml, start=start)
        except ModelError as error:
            raise ModelError(str(error), place=f"response {at}") from None
        estimates.append(fit.beta)
        se.append(np.sqrt(np.diag(fit.covariance)))
        variances.append(fit.variances)
        loglik.append(fit.loglik)
        converged.append(fit.converged)
    shape = (len(responses), -1) if len(responses) else (0, design.p)
    return (
        np.reshape(estimates, shape),
        np.reshape(se, shape),
        np.reshape(variances, (len(responses), len(design.factors) + 1)),
        np.array(loglik, dtype=float),
        np.array(converged, dtype=float),
    )
