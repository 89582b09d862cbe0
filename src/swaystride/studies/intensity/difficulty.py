"""Do ratings rise with the difficulty of the exercise? (§3.3.4.1, Table 3.2).

One dimension of difficulty at a time, as a number, with random intercepts of patient and therapist.
The printed model takes all ratings of a patient as alike but for the therapist; that the ratings
of one exercise belong together is not in it, and its intervals are too narrow (spec §8.4).
"""

from __future__ import annotations

import pandas as pd

from swaystride.stats.clustered_mixed_model import resampled_fixed_effects
from swaystride.stats.mixed_model import MixedModelFit, fit_mixed_model
from swaystride.studies.intensity.plan import DIMENSIONS, RATING_LEVELS, IntensityPlan, RatingLevel
from swaystride.studies.intensity.results import (
    participant_interval,
    patient_weights,
    result_row,
    results,
    tested_effect,
)


def fit_difficulty(
    ratings: pd.DataFrame, dimension: str, level: RatingLevel, plan: IntensityPlan
) -> MixedModelFit:
    """Regress ratings on one dimension of difficulty.

    Parameters
    ----------
    ratings : DataFrame
        As from :func:`swaystride.studies.intensity.observations.analysed_ratings`.
    dimension : str
        One of the four dimensions.
    level : {"per_trial", "per_exercise"}
    plan : IntensityPlan
    """
    own = ratings[ratings["rating_level"] == level]
    random = " + ".join(f"(1|{term})" for term in plan.random_terms(rater=True))
    return fit_mixed_model(f"rating ~ {dimension} + {random}", own, reml=plan.reml)


def difficulty(ratings: pd.DataFrame, plan: IntensityPlan) -> pd.DataFrame:
    """Effects of the four dimensions on both kinds of ratings, with both intervals.

    Parameters
    ----------
    ratings : DataFrame
        As from :func:`swaystride.studies.intensity.observations.analysed_ratings`.
    plan : IntensityPlan

    Returns
    -------
    DataFrame
        Results in the order of Table 3.2.
    """
    rows = []
    for level in RATING_LEVELS:
        patients = ratings.loc[ratings["rating_level"] == level, "participant"]
        weights = patient_weights(patients.nunique(), plan)
        for dimension in DIMENSIONS:
            fit = fit_difficulty(ratings, dimension, level, plan)
            row = tested_effect(fit, dimension, plan)
            draws = resampled_fixed_effects(fit, patients, weights)
            interval = participant_interval(
                draws[:, 1], row["estimate"], "identity", weights.shape[1], plan
            )
            rows.append(
                result_row(
                    f"table_3_2/{dimension}/{level}",
                    row["estimate"],
                    n=fit.n_observations,
                    se=row["se"],
                    df=row["df"],
                    p=row["p"],
                    ci=(row["ci_low"], row["ci_high"]),
                    participant_ci=interval,
                )
            )
    return results(rows)


def residuals(ratings: pd.DataFrame, plan: IntensityPlan) -> pd.DataFrame:
    """Residuals of the models of difficulty, for the check of their assumptions.

    Parameters
    ----------
    ratings : DataFrame
        As from :func:`swaystride.studies.intensity.observations.analysed_ratings`.
    plan : IntensityPlan

    Returns
    -------
    DataFrame
        ``rating``, ``dimension``, ``fitted``, ``residual``.
    """
    parts = []
    for level in RATING_LEVELS:
        for dimension in DIMENSIONS:
            fit = fit_difficulty(ratings, dimension, level, plan)
            values = {"fitted": fit.fitted, "residual": fit.residuals}
            parts.append(pd.DataFrame({"rating": level, "dimension": dimension, **values}))
    return pd.concat(parts, ignore_index=True)
