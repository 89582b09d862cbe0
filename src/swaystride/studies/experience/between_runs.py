"""Associations between runs: one measure, one scale, all runs or the aerial ones (D§5.3.4.2).

Runs count as independent, as in the dissertation; beside them stands an interval over runners, who
bring one run or several.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
import numpy.typing as npt
import pandas as pd
from numpy.typing import NDArray

from swaystride.errors import ModelError
from swaystride.stats.cluster_bootstrap import bootstrap_interval, cluster_codes, cluster_weights
from swaystride.stats.correlation import pearson
from swaystride.stats.multiple_tests import benjamini_hochberg
from swaystride.studies.experience.plan import MEASURE_KEYS, SCALES

Array = NDArray[np.float64]

#: Groups of runs, and the pattern that their runs have; Tables 5.3 and 5.4.
GROUPS: Final = {"all": "", "aerial": "aerial"}
ASSOCIATION_COLUMNS: Final = (
    "group",
    "measure",
    "scale",
    "n",
    "r",
    "ci_low",
    "ci_high",
    "p",
    "q",
    "beta",
    "rating_sd",
    "ci_low_cluster",
    "ci_high_cluster",
    "n_participants",
    "reason",
    "reason_cluster",
)

_NUMBERS: Final = (
    "r",
    "ci_low",
    "ci_high",
    "p",
    "beta",
    "rating_sd",
    "ci_low_cluster",
    "ci_high_cluster",
)
#: A correlation needs four runs, in a resample too: from fewer it is close to ±1 by chance.
_FEWEST_RUNS = 4
#: Resamples that may have too few before there is no interval.
_UNDEFINED_SHARE = 0.05
#: Of the variance; below it a resample is constant up to rounding.
_CONSTANT = 1e-12


@dataclass(frozen=True)
class ClusterRule:
    """Resampling of runners.

    Parameters
    ----------
    enabled : bool
        Whether intervals over runners are computed.
    n_draws : int
    seed : int
    """

    enabled: bool
    n_draws: int
    seed: int


@dataclass(frozen=True)
class BetweenRules:
    """How associations between runs are estimated.

    Parameters
    ----------
    level : float
        Confidence level.
    cluster : ClusterRule
    """

    level: float
    cluster: ClusterRule


def associations(observations: pd.DataFrame, rules: BetweenRules) -> pd.DataFrame:
    """Every measure against every scale, in both groups of runs.

    Parameters
    ----------
    observations : DataFrame
        A row per run: ``participant``, ``pattern``, the measures and the scales.
    rules : BetweenRules

    Returns
    -------
    DataFrame
        :data:`ASSOCIATION_COLUMNS`. ``beta`` is the change of the rating per standard deviation of
        the measure over the runs of the row, ``rating_sd`` the standard deviation of the rating
        over them, ``q`` the p-value adjusted within the group (Benjamini and Hochberg). What cannot
        be estimated is missing, with its ``reason``.
    """
    tables = []
    for group, pattern in GROUPS.items():
        own = observations[observations["pattern"] == pattern] if pattern else observations
        people = own["participant"].to_numpy(dtype=object)
        values = {name: own[name].to_numpy(dtype=float) for name in (*MEASURE_KEYS, *SCALES)}
        rows = [
            {
                "group": group,
                "measure": measure,
                "scale": scale,
                **association(values[measure], values[scale], people, rules),
            }
            for measure in MEASURE_KEYS
            for scale in SCALES
        ]
        table = pd.DataFrame(rows)
        tables.append(table.assign(q=benjamini_hochberg(table["p"].to_numpy(dtype=float))))
    return pd.concat(tables, ignore_index=True)[list(ASSOCIATION_COLUMNS)]


def association(
    measure: npt.ArrayLike, rating: npt.ArrayLike, participants: npt.ArrayLike, rules: BetweenRules
) -> dict[str, object]:
    """One measure against one scale.

    Parameters
    ----------
    measure, rating : array_like, shape (n_runs,)
        NaN where missing.
    participants : array_like, shape (n_runs,)
        Who ran.
    rules : BetweenRules

    Returns
    -------
    dict
        :data:`ASSOCIATION_COLUMNS` but ``group``, ``measure``, ``scale`` and ``q``.
    """
    pairs = np.stack([np.asarray(measure, dtype=float), np.asarray(rating, dtype=float)])
    complete = np.isfinite(pairs).all(axis=0)
    x, y = pairs[:, complete]
    people = np.asarray(participants, dtype=object)[complete]
    row = dict.fromkeys(_NUMBERS, float("nan")) | {
        "n": len(x),
        "n_participants": len(set(people)),
        "reason": "",
        "reason_cluster": "",
    }
    try:
        found = pearson(x, y, level=rules.level)
    except ModelError as error:
        return row | {"reason": str(error)}
    scaled = (x - x.mean()) / np.std(x, ddof=1)
    row |= {
        "r": found.r,
        "ci_low": found.ci_low,
        "ci_high": found.ci_high,
        "p": found.p,
        "beta": float(scaled @ (y - y.mean()) / (scaled @ scaled)),
        "rating_sd": float(np.std(y, ddof=1)),
    }
    if not rules.cluster.enabled:
        return row
    try:
        low, high = _over_runners(x, y, people, found.r, rules)
    except ModelError as error:
        return row | {"reason_cluster": str(error)}
    return row | {"ci_low_cluster": low, "ci_high_cluster": high}


def resampled_correlations(x: Array, y: Array, codes: NDArray[np.intp], weights: Array) -> Array:
    """Correlation in resamples of clusters; missing where fewer than four rows differ.

    Parameters
    ----------
    x, y : ndarray, shape (n,)
    codes : ndarray of int, shape (n,)
        Cluster of each row.
    weights : ndarray, shape (n_draws, n_clusters)
        How often each cluster occurs.

    Returns
    -------
    ndarray, shape (n_draws,)

    Examples
    --------
    >>> x, y = np.arange(4.0), np.array([1.0, 0.0, 3.0, 2.0])
    >>> resampled_correlations(x, y, np.arange(4), np.array([[1.0, 1, 1, 1], [2, 2, 0, 0]]))
    array([0.6, nan])
    """
    a, b = ((values - values.mean()) / np.std(values) for values in (x, y))
    terms = np.column_stack([np.ones(len(a)), a, b, a * a, b * b, a * b])
    members = (codes[None, :] == np.arange(weights.shape[1])[:, None]).astype(float)
    n, sa, sb, saa, sbb, sab = (weights @ (members @ terms)).T
    distinct = (weights > 0) @ members.sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        va, vb = saa / n - (sa / n) ** 2, sbb / n - (sb / n) ** 2
        r = (sab / n - sa * sb / n**2) / np.sqrt(va * vb)
    defined = (distinct >= _FEWEST_RUNS) & (va > _CONSTANT) & (vb > _CONSTANT)
    return np.where(defined, np.clip(r, -1.0, 1.0), np.nan)


def _over_runners(
    x: Array, y: Array, people: npt.NDArray[np.object_], r: float, rules: BetweenRules
) -> tuple[float, float]:
    """Interval over runners, on the scale of Fisher's z."""
    codes, labels = cluster_codes(people)
    rule = rules.cluster
    weights = _weights(len(labels), rule.n_draws, rule.seed)
    draws = resampled_correlations(x, y, codes, weights)
    defined = draws[np.isfinite(draws)]
    undefined = 1.0 - len(defined) / len(draws)
    if undefined > _UNDEFINED_SHARE:
        raise ModelError(
            "too few participants for an interval over them",
            expected=f"{_FEWEST_RUNS} different runs in {1 - _UNDEFINED_SHARE:.0%} of resamples",
            found=f"{1 - undefined:.0%} with {len(labels)} participants",
        )
    interval = bootstrap_interval(
        r, defined, n_clusters=len(labels), level=rules.level, scale="fisher_z"
    )
    return interval.low, interval.high


@lru_cache(maxsize=32)
def _weights(n_clusters: int, n_draws: int, seed: int) -> Array:
    """How often each cluster is drawn; the rows of a table differ in little but missing values."""
    return cluster_weights(n_clusters, n_draws, seed).astype(float)
