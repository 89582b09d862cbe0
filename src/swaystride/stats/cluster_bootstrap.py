"""Resampling of clusters: whole participants are drawn, with everything measured on them.

With few clusters, plain percentile limits are too narrow twice over: the draws vary by (m-1)/m of
what they should, and the normal quantile ignores that the spread itself comes from m values. The
interval here widens the standard deviation of the draws by sqrt(m/(m-1)) and takes the quantile
of t with m-1 degrees of freedom, on a scale on which the estimate is roughly symmetric. For a mean
of m equal clusters this is the t interval of the cluster means.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Literal, NamedTuple

import numpy as np
import numpy.typing as npt
import pandas as pd
from scipy.special import expit, logit, stdtrit

from swaystride.errors import ModelError
from swaystride.stats.grouping_factor import CodeArray, FloatArray
from swaystride.stats.mixed_refits import Seed

Scale = Literal["identity", "fisher_z", "logit"]
Statistic = Callable[[CodeArray], npt.ArrayLike]

# Ends of the range of a scale.
_RANGES = {"identity": (-np.inf, np.inf), "fisher_z": (-1.0, 1.0), "logit": (0.0, 1.0)}
# How far rounding may carry a share or a correlation past the end of its range.
_ROUNDING = 1e-9


class ClusterInterval(NamedTuple):
    """Confidence limits, both NaN where resampling cannot tell them.

    Attributes
    ----------
    low, high : float
    """

    low: float
    high: float


def cluster_codes(clusters: npt.ArrayLike) -> tuple[CodeArray, pd.Index]:
    """Number the clusters in sorted order; all functions of this module count them so.

    Parameters
    ----------
    clusters : array or pandas.Series, shape (n_rows,)
        Cluster of each row.

    Returns
    -------
    codes : array of int, shape (n_rows,)
    labels : pandas.Index, shape (n_clusters,)

    Raises
    ------
    ModelError
        If there are fewer than two clusters, or a row has none.

    Examples
    --------
    >>> codes, labels = cluster_codes(["P2", "P1", "P2"])
    >>> codes.tolist(), list(labels)
    ([1, 0, 1], ['P1', 'P2'])
    """
    values = np.asarray(clusters, dtype=object)  # NaN among words stays missing
    if values.ndim != 1:
        raise ModelError(
            "the clusters are no column", expected="one per row", found=str(values.shape)
        )
    missing = int(pd.isna(values).sum())
    if missing:
        raise ModelError(f"the cluster is missing in {missing} of {len(values)} rows")
    codes, labels = pd.factorize(values, sort=True)
    _check_clusters(len(labels))
    return codes.astype(np.intp), pd.Index(labels).infer_objects()


def cluster_weights(n_clusters: int, n: int, seed: Seed) -> npt.NDArray[np.intp]:
    """Draw how often each cluster occurs in each of n resamples of as many clusters.

    Parameters
    ----------
    n_clusters : int
    n : int
        Number of resamples.
    seed : int, sequence of int or numpy.random.SeedSequence

    Returns
    -------
    array of int, shape (n, n_clusters)
        Every row sums to `n_clusters`.

    Raises
    ------
    ModelError
        If there are fewer than two clusters.

    Examples
    --------
    >>> cluster_weights(5, 1000, seed=1).sum(axis=1).tolist() == [5] * 1000
    True
    """
    _check_clusters(n_clusters)
    rng = np.random.default_rng(seed)
    weights = rng.multinomial(n_clusters, np.full(n_clusters, 1.0 / n_clusters), size=n)
    return weights.astype(np.intp)


def cluster_resamples(clusters: npt.ArrayLike, n: int, seed: Seed) -> Iterator[CodeArray]:
    """Iterate over the rows of resamples; the draws are those of :func:`cluster_weights`.

    Parameters
    ----------
    clusters : array or pandas.Series, shape (n_rows,)
        Cluster of each row.
    n : int
        Number of resamples.
    seed : int, sequence of int or numpy.random.SeedSequence

    Yields
    ------
    array of int
        Row numbers; the rows of a cluster that is drawn twice occur twice.

    Examples
    --------
    >>> for rows in cluster_resamples(["a", "b", "a"], 3, seed=1):
    ...     print(rows)
    [0 2 1]
    [0 2 0 2]
    [1 1]
    """
    rows = _rows_of_clusters(clusters)
    for weight in cluster_weights(len(rows), n, seed):
        yield np.concatenate([np.tile(rows[at], weight[at]) for at in np.flatnonzero(weight)])


def cluster_bootstrap(
    statistic: Statistic, clusters: npt.ArrayLike, *, n: int, seed: Seed
) -> FloatArray:
    """Compute a statistic on resamples of whole clusters.

    Parameters
    ----------
    statistic : callable
        Takes row numbers, returns a number or an array of fixed shape. It must not depend on the
        cluster labels, because a cluster that is drawn twice counts as two.
    clusters : array or pandas.Series, shape (n_rows,)
        Cluster of each row.
    n : int
        Number of resamples.
    seed : int, sequence of int or numpy.random.SeedSequence

    Returns
    -------
    array, shape (n, ...)

    Examples
    --------
    >>> y = np.array([1.0, 2.0, 6.0])
    >>> cluster_bootstrap(lambda rows: y[rows].mean(), ["a", "a", "b"], n=3, seed=3).tolist()
    [6.0, 6.0, 1.5]
    """
    draws = [statistic(rows) for rows in cluster_resamples(clusters, n, seed)]
    return np.array(draws, dtype=float)


def jackknife_clusters(statistic: Statistic, clusters: npt.ArrayLike) -> FloatArray:
    """Compute a statistic with each cluster left out in turn.

    Parameters
    ----------
    statistic : callable
        As for :func:`cluster_bootstrap`.
    clusters : array or pandas.Series, shape (n_rows,)
        Cluster of each row.

    Returns
    -------
    array, shape (n_clusters, ...)
        In the order of the sorted labels.

    Examples
    --------
    >>> y = np.array([1.0, 2.0, 6.0])
    >>> jackknife_clusters(lambda rows: y[rows].mean(), ["a", "a", "b"]).tolist()
    [6.0, 1.5]
    """
    codes, labels = cluster_codes(clusters)
    left_out = [statistic(np.flatnonzero(codes != at)) for at in range(len(labels))]
    return np.array(left_out, dtype=float)


def bootstrap_interval(
    estimate: float, draws: npt.ArrayLike, *, n_clusters: int, level: float, scale: Scale
) -> ClusterInterval:
    """Interval of t with m-1 degrees of freedom from the spread of cluster resamples.

    Computed on the scale and transformed back. A draw of exactly 0, 1 or -1, infinitely far on its
    scale, counts as the most extreme draw that is finite there. If the estimate itself lies at
    the end (a share of 0 in every cluster is 0 in every resample), both limits are NaN.

    Parameters
    ----------
    estimate : float
    draws : array, shape (n,)
        The statistic on resamples.
    n_clusters : int
        Number of clusters m.
    level : float
        Confidence level between 0 and 1.
    scale : {"identity", "fisher_z", "logit"}
        The last two keep a correlation within (-1, 1), a share within (0, 1).

    Returns
    -------
    ClusterInterval

    Raises
    ------
    ModelError
        If the draws are not finite numbers in the range of the scale, there are fewer than two
        draws or clusters, or the scale or the level is unknown.

    Examples
    --------
    >>> low, high = bootstrap_interval(0.9, [0.85, 0.9, 0.97], n_clusters=10, level=0.95,
    ...                                scale="fisher_z")
    >>> round(low, 3), round(high, 3)
    (0.411, 0.987)
    """
    _check_clusters(n_clusters)
    center, values = _on_scale(estimate, _checked_draws(draws), scale)
    spread = float(np.std(values, ddof=1)) * np.sqrt(n_clusters / (n_clusters - 1))
    return _t_interval(center, spread, n_clusters - 1, level, scale)


def jackknife_interval(
    estimate: float, leave_one_out: npt.ArrayLike, *, level: float, scale: Scale
) -> ClusterInterval:
    """Interval of t with m-1 degrees of freedom from the jackknife over m clusters.

    Needs no random numbers and suits smooth statistics; ends of the range are handled as by
    :func:`bootstrap_interval`.

    Parameters
    ----------
    estimate : float
    leave_one_out : array, shape (n_clusters,)
        The statistic without each cluster, from :func:`jackknife_clusters`.
    level : float
        Confidence level between 0 and 1.
    scale : {"identity", "fisher_z", "logit"}

    Returns
    -------
    ClusterInterval

    Raises
    ------
    ModelError
        As :func:`bootstrap_interval`.

    Examples
    --------
    >>> low, high = jackknife_interval(2.0, [2.5, 2.0, 1.5], level=0.95, scale="identity")
    >>> round(high - 2.0, 4), round(4.302653 / 3**0.5, 4)  # means of 1, 2 and 3: s is 1
    (2.4841, 2.4841)
    """
    center, values = _on_scale(estimate, _checked_draws(leave_one_out), scale)
    m = len(values)
    spread = (m - 1) / np.sqrt(m) * float(np.std(values, ddof=1))
    return _t_interval(center, spread, m - 1, level, scale)


def percentile_interval(draws: npt.ArrayLike, level: float) -> ClusterInterval:
    """Plain percentile limits; too narrow for few clusters.

    Parameters
    ----------
    draws : array, shape (n,)
    level : float
        Confidence level between 0 and 1.

    Returns
    -------
    ClusterInterval

    Examples
    --------
    >>> [round(limit, 9) for limit in percentile_interval(range(101), 0.9)]
    [5.0, 95.0]
    """
    _check_level(level)
    tail = 0.5 * (1.0 - level)
    low, high = np.quantile(_checked_draws(draws), [tail, 1.0 - tail])
    return ClusterInterval(float(low), float(high))


def _rows_of_clusters(clusters: npt.ArrayLike) -> list[CodeArray]:
    codes, labels = cluster_codes(clusters)
    order = np.argsort(codes, kind="stable")
    return np.split(order, np.searchsorted(codes[order], np.arange(1, len(labels))))


def _check_clusters(n_clusters: int) -> None:
    if n_clusters < 2:
        raise ModelError(
            "too few clusters to resample", expected="2 or more", found=f"{n_clusters}"
        )


def _check_level(level: float) -> None:
    if not 0.0 < level < 1.0:
        raise ModelError("the confidence level is no probability", found=str(level))


def _checked_draws(draws: npt.ArrayLike) -> FloatArray:
    values = np.asarray(draws, dtype=float)
    if values.ndim != 1 or len(values) < 2:
        raise ModelError(
            "the draws make no interval", expected="2 or more in one row", found=str(values.shape)
        )
    bad = int((~np.isfinite(values)).sum())
    if bad:
        raise ModelError(f"{bad} of {len(values)} draws are not finite")
    return values


def _on_scale(estimate: float, draws: FloatArray, scale: Scale) -> tuple[float, FloatArray]:
    """Estimate and draws on the scale; draws at an end moved to the most extreme finite one."""
    if scale not in _RANGES:
        raise ModelError("unknown scale", expected=" or ".join(_RANGES), found=str(scale))
    low, high = _RANGES[scale]
    everything = np.append(draws, estimate)
    if not np.isfinite(estimate):
        raise ModelError("the estimate is not finite")
    if everything.min() < low - _ROUNDING or everything.max() > high + _ROUNDING:
        raise ModelError(
            f"the scale {scale} does not suit the draws",
            expected=f"values from {low:g} to {high:g}",
            found=f"{everything.min():g} to {everything.max():g}",
        )
    if scale == "identity":
        return float(estimate), draws
    # Fisher's z is half the logit of (r + 1) / 2: the factor cancels.
    values = logit(np.clip((everything - low) / (high - low), 0.0, 1.0))
    finite = values[:-1][np.isfinite(values[:-1])]
    if len(finite) == 0 or not np.isfinite(values[-1]):
        return np.nan, values[:-1] * np.nan
    return float(values[-1]), np.clip(values[:-1], finite.min(), finite.max())


def _t_interval(
    center: float, spread: float, df: int, level: float, scale: Scale
) -> ClusterInterval:
    _check_level(level)
    half = float(stdtrit(df, 0.5 + 0.5 * level)) * spread
    limits = np.array([center - half, center + half])
    if scale != "identity":
        low, high = _RANGES[scale]
        limits = low + (high - low) * expit(limits)
    return ClusterInterval(float(limits[0]), float(limits[1]))
