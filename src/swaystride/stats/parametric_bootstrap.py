r"""Correlation within a series, alone and given time, with intervals by parametric bootstrap.

Rows of a series are not independent, and both variables may drift. The model is
``outcome ~ 1 + predictor + time``; new outcomes are its prediction plus errors, and the correlation
of each with the predictor, alone and given time, spans the interval. Errors are drawn

- ``independent``: normal;
- ``ar1``: normal, each correlated with its neighbour (:mod:`.residual_autocorrelation`);
- ``block``: residuals themselves, in blocks of neighbours from random places.

In an orthonormal basis of the terms (level, time, predictor without time) an outcome is three
coordinates and a rest. Both correlations follow from these, so a draw costs three scalar products.
Random numbers are drawn once for all predictors of a series.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal, NamedTuple

import numpy as np

from swaystride.errors import ModelError
from swaystride.stats.cluster_bootstrap import ClusterInterval
from swaystride.stats.grouping_factor import FloatArray
from swaystride.stats.mixed_refits import Seed
from swaystride.stats.trend_fit import N_TERMS, TrendFit

ErrorKind = Literal["independent", "ar1", "block"]
ERROR_KINDS: Final[tuple[ErrorKind, ...]] = ("independent", "ar1", "block")


@dataclass(frozen=True)
class SeriesDraws:
    """Random numbers of one series, a column per draw.

    Attributes
    ----------
    normal : array, shape (n_rows, n_draws)
        Standard normal.
    uniform : array, shape (n_blocks, n_draws)
        From 0 to 1: where each block of residuals begins.
    block_length : int
        Rows of a block.
    """

    normal: FloatArray
    uniform: FloatArray
    block_length: int


def series_draws(n_rows: int, *, n_draws: int, block_length: int, seed: Seed) -> SeriesDraws:
    """Draw the random numbers of one series.

    Parameters
    ----------
    n_rows : int
    n_draws : int
    block_length : int
        Rows of a block of residuals.
    seed : int, sequence of int or numpy.random.SeedSequence

    Returns
    -------
    SeriesDraws

    Examples
    --------
    >>> draws = series_draws(20, n_draws=5, block_length=9, seed=1)
    >>> draws.normal.shape, draws.uniform.shape
    ((20, 5), (3, 5))
    """
    rng = np.random.default_rng(seed)
    normal = rng.standard_normal((n_rows, n_draws))
    return SeriesDraws(normal, rng.random((-(-n_rows // block_length), n_draws)), block_length)


@dataclass(frozen=True, eq=False)
class DrawnErrors:
    """What the correlations need of the errors of new outcomes.

    Attributes
    ----------
    along : array, shape (3, n_draws)
        Coordinates in the basis of the fit.
    squares : array, shape (n_draws,)
        Sum of the squares of all errors of a draw.
    """

    along: FloatArray
    squares: FloatArray


def drawn_errors(
    fits: Sequence[TrendFit], draws: SeriesDraws, kind: ErrorKind
) -> list[DrawnErrors]:
    """Draw the errors of new outcomes.

    Parameters
    ----------
    fits : sequence of TrendFit
        Of one series.
    draws : SeriesDraws
        For all rows of the series, the incomplete ones included.
    kind : {"independent", "ar1", "block"}

    Returns
    -------
    list of DrawnErrors
        One per fit.

    Raises
    ------
    ModelError
        If the kind is unknown, or a series is no longer than a block.
    """
    if kind not in ERROR_KINDS:
        raise ModelError("unknown kind of errors", expected=" or ".join(ERROR_KINDS), found=kind)
    if kind == "block":
        return [_blocks(fit, draws) for fit in fits]
    drawn: dict[int, DrawnErrors] = {}
    for rows in {fit.rows.tobytes(): fit.rows for fit in fits}.values():
        alike = [at for at, fit in enumerate(fits) if np.array_equal(fit.rows, rows)]
        normal = draws.normal if rows.all() else draws.normal[rows]
        made = _normal_errors([fits[at] for at in alike], normal, correlated=kind == "ar1")
        drawn.update(zip(alike, made, strict=True))
    return [drawn[at] for at in range(len(fits))]


def drawn_correlations(fit: TrendFit, errors: DrawnErrors) -> FloatArray:
    """Correlations of predictor and new outcomes.

    Parameters
    ----------
    fit : TrendFit
    errors : DrawnErrors

    Returns
    -------
    array, shape (2, n_draws)
        Alone, and given time.
    """
    beyond = errors.squares - (errors.along**2).sum(axis=0)
    time, own = fit.coordinates[:, None] + errors.along[1:]
    left = own**2 + np.maximum(beyond, 0.0)
    with np.errstate(invalid="ignore", divide="ignore"):
        alone = (fit.share[0] * time + fit.share[1] * own) / np.sqrt(time**2 + left)
        return np.stack([alone, own / np.sqrt(left)])


class CorrelationLimits(NamedTuple):
    """Confidence limits of a correlation within a series.

    Attributes
    ----------
    alone : ClusterInterval
        Of the correlation.
    given_time : ClusterInterval
        Of the partial correlation.
    """

    alone: ClusterInterval
    given_time: ClusterInterval


def bootstrap_trends(
    fits: Sequence[TrendFit], draws: SeriesDraws, *, kind: ErrorKind, level: float
) -> list[CorrelationLimits]:
    """Percentile limits of correlations and partial correlations.

    Parameters
    ----------
    fits : sequence of TrendFit
        Of one series.
    draws : SeriesDraws
        For all rows of the series.
    kind : {"independent", "ar1", "block"}
    level : float
        Confidence level between 0 and 1.

    Returns
    -------
    list of CorrelationLimits
        One per fit. NaN where nothing is left of the outcome, or the correlation of neighbouring
        errors is asked for and unknown.

    Raises
    ------
    ModelError
        As :func:`drawn_errors`; or if the level is no probability.

    Examples
    --------
    >>> x = np.array([1.0, 3, 2, 5, 4, 6, 5, 8, 7, 9, 8, 6])
    >>> y = np.array([1.0, 2, 2, 3, 3, 3, 4, 4, 4, 4, 3, 3])
    >>> from swaystride.stats.trend_fit import fit_trend
    >>> fit = fit_trend(x, y, range(12), range(12))
    >>> draws = series_draws(12, n_draws=500, block_length=4, seed=1)
    >>> (limits,) = bootstrap_trends([fit], draws, kind="independent", level=0.95)
    >>> round(fit.r, 2), round(limits.alone.low, 1), round(limits.alone.high, 1)
    (0.84, 0.6, 0.9)
    """
    if not 0.0 < level < 1.0:
        raise ModelError("the confidence level is no probability", found=str(level))
    if not fits:
        return []
    errors = drawn_errors(fits, draws, kind)
    values = np.stack([drawn_correlations(fit, own) for fit, own in zip(fits, errors, strict=True)])
    tail = 0.5 * (1.0 - level)
    limits = np.quantile(values, [tail, 1.0 - tail], axis=2)
    return [
        CorrelationLimits(*(ClusterInterval(float(low), float(high)) for low, high in pair.T))
        for pair in np.moveaxis(limits, 1, 0)
    ]


def _normal_errors(
    fits: Sequence[TrendFit], normal: FloatArray, *, correlated: bool
) -> list[DrawnErrors]:
    """Normal errors of fits to the same rows; all coordinates by one matrix product."""
    n = len(normal)
    sds, factors = [], []
    for fit in fits:
        if correlated:
            rho, sd = fit.autoregressive
            lag = np.abs(fit.place[:, None] - fit.place[None, :])
            # an unknown ρ has an unknown sd, which makes everything unknown
            factors.append(np.linalg.cholesky((0.0 if np.isnan(rho) else rho) ** lag))
        else:
            sd = float(np.linalg.norm(fit.residuals)) / np.sqrt(n - N_TERMS)
        sds.append(sd)
    bases = [fit.basis for fit in fits]
    if correlated:
        bases = [factor.T @ basis for factor, basis in zip(factors, bases, strict=True)]
    along = (np.concatenate(bases, axis=1).T @ normal).reshape(len(fits), N_TERMS, -1)
    if correlated:
        squares = [_column_squares(factor @ normal) for factor in factors]
    else:
        squares = [_column_squares(normal)] * len(fits)
    return [
        DrawnErrors(sd * own, sd**2 * total)
        for sd, own, total in zip(sds, along, squares, strict=True)
    ]


def _column_squares(values: FloatArray) -> FloatArray:
    """Sum of squares of each column."""
    return np.asarray(np.einsum("nb,nb->b", values, values))


def _blocks(fit: TrendFit, draws: SeriesDraws) -> DrawnErrors:
    """Residuals in blocks from random places, each place of a block with mean zero.

    What a block adds depends on where it came from and where it goes; a table holds all pairs.
    """
    n, length = fit.n, draws.block_length
    n_starts, n_blocks = n - length + 1, -(-n // length)
    if n_starts < 2:
        raise ModelError(
            "the series is no longer than a block", expected=f"over {length} rows", found=str(n)
        )
    blocks = np.lib.stride_tricks.sliding_window_view(fit.residuals, length)
    # Residuals of a fit are smaller than its errors.
    blocks = (blocks - blocks.mean(axis=0)) * np.sqrt(n / (n - N_TERMS))
    # The last block is cut at the end of the series.
    padded = np.zeros((n_blocks * length, N_TERMS + 1))
    padded[:n] = np.column_stack([fit.basis, np.ones(n)])
    terms = padded.reshape(n_blocks, length, -1)
    table = np.concatenate([blocks @ terms[..., :-1], blocks**2 @ terms[..., -1:]], axis=2)
    starts = (draws.uniform[:n_blocks] * n_starts).astype(np.intp)
    sums = np.zeros((starts.shape[1], N_TERMS + 1))
    for added, begin in zip(table, starts, strict=True):
        sums += added.take(begin, axis=0)
    along, squares = np.split(sums.T, [N_TERMS])
    return DrawnErrors(along, squares[0])
