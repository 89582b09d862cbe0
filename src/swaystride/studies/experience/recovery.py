"""Many sets of ratings of the same runs: does the study find the correlations of the population.

The runs and their measured kinematics stay, only the ratings are drawn anew. An interval of Fisher's z,
made for pairs drawn anew, is then too long by a known amount
(:mod:`swaystride.simulate.experience_population`), and too short where runs of one runner have more
in common than their measures; ``coverage_expected`` says what is to be expected of both.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.simulate.experience_rating_parameters import RatingModel
from swaystride.simulate.experience_rating_truth import RatingTruth
from swaystride.stats.correlation import pearson
from swaystride.studies.experience.plan import MEASURES
from swaystride.studies.experience.recovery_rows import (
    LEVEL,
    RecoveryPlan,
    rated_again,
    recovery_rows,
    significant_rows,
)

Array = NDArray[np.float64]

#: Share of the sets of ratings in which the interval must cover the correlation of the population.
COVERAGE: Final = (0.93, 0.97)

_APART: Final = "runs of a runner alike in nothing else"

RECOVERY_COLUMNS: Final = (
    "variant",
    "quantity",
    "truth",
    "mean",
    "bias",
    "empirical_sd",
    "model_se",
    "coverage",
    "n_cohorts",
    "median",
    "printed",
    "n_runs",
    "coverage_expected",
    "coverage_se",
    "coverage_cluster",
    "identity_error",
    # the last one: `make recovery` looks for a "no" at the end of a line
    "within",
)


def recovery_table(
    runs: pd.DataFrame,
    true: pd.DataFrame,
    tables: Mapping[str, pd.DataFrame],
    truth: RatingTruth,
    model: RatingModel,
    plan: RecoveryPlan,
) -> pd.DataFrame:
    """Recovery of all starred rows, and what chance finds.

    Parameters
    ----------
    runs : DataFrame
        ``observations/runs.parquet``: ``run``, ``pattern`` and the measures.
    true : DataFrame
        True measures, by run.
    tables : mapping of str to DataFrame
        Printed Table 5.3 as ``all`` and 5.4 as ``aerial``.
    truth : RatingTruth
        Population of the ratings.
    model : RatingModel
        Margins, course of affect, share of a runner.
    plan : RecoveryPlan
        Seeds and resamples.

    Returns
    -------
    DataFrame
        :data:`RECOVERY_COLUMNS` but ``variant``: a row ``<group>/<measure>/<scale>`` for each
        starred correlation; pooled coverage, judged for all runs; and for ratings that go with
        nothing the number of significant correlations and the share of such cohorts that have as
        many as Table 5.3. Coverage and chance stand also for residuals of which the runs of a
        runner share nothing, for comparison.
    """
    keys = [measure.key for measure in MEASURES]
    names = pd.Series({measure.name: measure.key for measure in MEASURES})
    # A run that the study left out has no measures.
    ordered = runs.set_index("run").reindex(pd.Index(truth.runs.names))
    measured, real = ordered[keys], true.loc[list(truth.runs.names), keys]
    aerial = (ordered["pattern"] == "aerial").to_numpy()
    groups = {"all": np.ones(len(ordered), dtype=bool), "aerial": aerial}
    rows = {
        group: significant_rows(
            group, table, names, measured[groups[group]], real[groups[group]], ordered.index
        )
        for group, table in tables.items()
    }
    scores = rated_again(truth, model, plan, associated=True)
    parts = []
    for group, own in rows.items():
        found = recovery_rows(own, scores, truth, model, plan)
        parts += [found, pooled_coverage(found, f"{group}/pooled coverage", judged=group == "all")]
    apart = replace(model, association=replace(model.association, runner_share=0.0))
    found = recovery_rows(
        rows["all"], rated_again(truth, apart, plan, associated=True), truth, apart, plan
    )
    parts.append(pooled_coverage(found, f"all/pooled coverage, {_APART}", judged=False))
    n_starred = int(tables["all"]["significant"].astype(int).sum())
    for chosen, words in ((model, ""), (apart, f", {_APART}")):
        nothing = rated_again(truth, chosen, plan, associated=False)
        parts.append(_chance(measured, nothing, n_starred, words))
    return pd.concat(parts, ignore_index=True).reindex(columns=list(RECOVERY_COLUMNS[1:]))


def pooled_coverage(rows: pd.DataFrame, quantity: str, *, judged: bool) -> pd.DataFrame:
    """Coverage over all rows together.

    Parameters
    ----------
    rows : DataFrame
        From :func:`recovery_rows`.
    quantity : str
        Name of the result.
    judged : bool
        Whether it must lie within :data:`COVERAGE`; else it is reported.

    Returns
    -------
    DataFrame
        One row.
    """
    share = float(rows["coverage"].mean())
    inside = "yes" if COVERAGE[0] <= share <= COVERAGE[1] else "no"
    return pd.DataFrame(
        [
            {
                "quantity": quantity,
                "truth": LEVEL,
                "coverage": share,
                "n_cohorts": rows["n_cohorts"].iloc[0],
                "within": inside if judged else "reported",
                "coverage_expected": rows["coverage_expected"].mean(),
                "coverage_cluster": rows["coverage_cluster"].mean(),
            }
        ]
    )


def chance_findings(measured: pd.DataFrame, scores: Array) -> Array:
    """How many correlations of measures and scales are significant in each set of ratings.

    Parameters
    ----------
    measured : DataFrame
        One row per run, one column per measure.
    scores : ndarray, shape (n_seeds, n_runs, 3)
        Ratings that go with nothing.

    Returns
    -------
    ndarray, shape (n_seeds,)
    """
    counts = np.zeros(len(scores))
    for column in measured.columns:
        values = measured[column].to_numpy(dtype=np.float64)
        used = np.isfinite(values)
        for scale in range(scores.shape[2]):
            drawn = scores[:, used, scale]
            counts += [pearson(values[used], one).p <= 1.0 - LEVEL for one in drawn]
    return counts


def _chance(measured: pd.DataFrame, scores: Array, n_starred: int, words: str) -> pd.DataFrame:
    """What is found where nothing is, and how often it is as much as in print."""
    counts = chance_findings(measured, scores)
    expected = (1.0 - LEVEL) * measured.shape[1] * scores.shape[2]
    common = {"n_cohorts": len(counts), "within": "reported", "printed": n_starred}
    number = {
        "quantity": f"null/significant correlations{words}",
        "truth": expected,
        "mean": counts.mean(),
        "bias": counts.mean() - expected,
        "empirical_sd": counts.std(ddof=1),
        "median": float(np.median(counts)),
    }
    share = {
        "quantity": f"null/share with as many as printed{words}",
        "mean": float(np.mean(counts >= n_starred)),
    }
    return pd.DataFrame([number | common, share | common])
