"""Correlations of one row over many sets of ratings, against the population that they are drawn from."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.gait.rating_windows import RatingMean
from swaystride.simulate.experience_population import population_correlations
from swaystride.simulate.experience_rating_parameters import RatingModel
from swaystride.simulate.experience_rating_truth import RatingTruth
from swaystride.simulate.experience_ratings import draw_ratings, run_scores
from swaystride.stats.correlation import pearson
from swaystride.studies.experience.plan import SCALES
from swaystride.studies.experience.recovery_coverage import cluster_coverage, expected_coverage

Array = NDArray[np.float64]

#: Largest accepted difference between the median correlation and that of the population.
LARGEST_DIFFERENCE: Final = 0.10
#: Largest accepted difference between β/R and the standard deviation of the rating.
IDENTITY: Final = 1e-9
#: Level of all intervals.
LEVEL: Final = 0.95


@dataclass(frozen=True)
class RecoveryPlan:
    """How recovery is done.

    Parameters
    ----------
    seeds : sequence of int
        One set of ratings each.
    n_resamples : int
        Of the runners, for the interval of the cluster bootstrap.
    bootstrap_seed : int
        Seed of these.
    start_s : float
        From here on ratings of affect count.
    mean : {"time_weighted", "simple"}
        Mean rating over a run.
    """

    seeds: Sequence[int]
    n_resamples: int
    bootstrap_seed: int
    start_s: float
    mean: RatingMean


@dataclass(frozen=True)
class RowRuns:
    """One row of a table of correlations: measured and true values of its runs.

    Parameters
    ----------
    name : str
        Quantity, as ``all/peak_head_g/flow``.
    scale : int
        Number of the scale.
    printed : float
        Printed correlation.
    used : ndarray of bool, shape (n_runs,)
        Runs of the row.
    measured, true : ndarray, shape (n_used,)
        Measure of these runs.
    """

    name: str
    scale: int
    printed: float
    used: NDArray[np.bool_]
    measured: Array
    true: Array


def significant_rows(
    group: str,
    table: pd.DataFrame,
    names: pd.Series[str],
    measured: pd.DataFrame,
    true: pd.DataFrame,
    every_run: pd.Index,
) -> list[RowRuns]:
    """Starred rows of a printed table.

    Parameters
    ----------
    group : str
        Word for the runs of the table.
    table : DataFrame
        Table 5.3 or 5.4 as in data/published.
    names : Series
        Key of each measure by its printed name.
    measured, true : DataFrame
        One row per run of the group, one column per measure.
    every_run : Index
        Names of all runs, of which the group is a part.

    Returns
    -------
    list of RowRuns
    """
    starred = table[table["significant"].astype(int) == 1]
    rows = []
    for row in starred.to_dict("records"):
        key = names[row["measure"]]
        known = measured[key].dropna().index
        rows.append(
            RowRuns(
                name=f"{group}/{key}/{row['scale']}",
                scale=SCALES.index(row["scale"]),
                printed=float(row["r"]),
                used=np.asarray(every_run.isin(known)),
                measured=measured.loc[known, key].to_numpy(dtype=np.float64),
                true=true.loc[known, key].to_numpy(dtype=np.float64),
            )
        )
    return rows


def rated_again(
    truth: RatingTruth,
    model: RatingModel,
    plan: RecoveryPlan,
    *,
    associated: bool,
) -> Array:
    """Scores of all runs in many sets of ratings, through the study's own mean of affect.

    Parameters
    ----------
    truth : RatingTruth
        Population.
    model : RatingModel
        Margins and course of affect.
    plan : RecoveryPlan
        Seeds, and how affect is averaged.
    associated : bool
        Whether ratings go with the runs, or not at all.

    Returns
    -------
    ndarray, shape (n_seeds, n_runs, 3)
    """
    population = truth.population
    signal = population.signal if associated else np.zeros_like(population.signal)
    residual = population.residual if associated else truth.between_scales
    word = "recovery" if associated else "recovery null"
    drawn = (
        draw_ratings(model, truth.runs, signal, residual, seed=seed, cohort=word)
        for seed in plan.seeds
    )
    scores = [run_scores(one, truth.runs, start_s=plan.start_s, mean=plan.mean) for one in drawn]
    return np.stack([table[list(SCALES)].to_numpy(dtype=np.float64) for table in scores])


def recovery_rows(
    rows: Iterable[RowRuns],
    scores: Array,
    truth: RatingTruth,
    model: RatingModel,
    plan: RecoveryPlan,
) -> pd.DataFrame:
    """Bias and coverage of every row.

    Parameters
    ----------
    rows : iterable of RowRuns
        From :func:`significant_rows`.
    scores : ndarray, shape (n_seeds, n_runs, 3)
        From :func:`rated_again`.
    truth : RatingTruth
        Population.
    model : RatingModel
        Says what runs of a runner share.
    plan : RecoveryPlan
        Resamples.

    Returns
    -------
    DataFrame
        A row each; ``within`` is yes if the median lies within
        :data:`LARGEST_DIFFERENCE` of the population and β/R is the SD of the rating.
    """
    runners = np.asarray(truth.runs.runners)
    return pd.DataFrame(
        [
            _recovered(row, scores[:, row.used, row.scale], runners, truth, model, plan)
            for row in rows
        ]
    )


def _recovered(
    row: RowRuns,
    scores: Array,
    runners: NDArray[np.str_],
    truth: RatingTruth,
    model: RatingModel,
    plan: RecoveryPlan,
) -> dict[str, object]:
    """One row of the table."""
    population = truth.population
    signal = population.signal[row.used][:, [row.scale]]
    residual = population.residual[row.scale, row.scale]
    target = float(population_correlations(signal, [residual], row.true[:, None])[0, 0])
    found = [pearson(row.measured, one, LEVEL) for one in scores]
    r, low, high = (
        np.array([getattr(one, name) for one in found]) for name in ("r", "ci_low", "ci_high")
    )
    coverage = float(np.mean((low <= target) & (target <= high)))
    standard = (row.measured - row.measured.mean()) / row.measured.std(ddof=1)
    beta = np.linalg.lstsq(
        np.stack([np.ones_like(standard), standard], axis=1), scores.T, rcond=None
    )[0][1]
    identity = float(np.max(np.abs(beta / r - scores.std(axis=1, ddof=1))))
    median = float(np.median(r))
    good = abs(median - target) <= LARGEST_DIFFERENCE and identity <= IDENTITY
    return {
        "quantity": row.name,
        "truth": target,
        "mean": r.mean(),
        "bias": r.mean() - target,
        "empirical_sd": r.std(ddof=1),
        "model_se": float(np.mean(1.0 - r**2) / np.sqrt(len(row.true) - 3.0)),
        "coverage": coverage,
        "n_cohorts": len(scores),
        "within": "yes" if good else "no",
        "median": median,
        "printed": row.printed,
        "n_runs": len(row.true),
        "coverage_expected": expected_coverage(
            signal[:, 0],
            residual,
            row.true,
            runners[row.used],
            runner_share=model.association.runner_share,
            level=LEVEL,
        ),
        "coverage_se": float(np.sqrt(coverage * (1.0 - coverage) / len(scores))),
        "coverage_cluster": cluster_coverage(
            row.measured,
            scores,
            r,
            target,
            runners[row.used],
            level=LEVEL,
            n_resamples=plan.n_resamples,
            seed=plan.bootstrap_seed,
        ),
        "identity_error": identity,
    }
