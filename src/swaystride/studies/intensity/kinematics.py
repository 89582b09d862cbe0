"""Sway against the therapists' ratings (§3.3.4.3; spec §8.4)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from swaystride.errors import ModelError
from swaystride.stats.agreement import exact_agreement, rounded_rating
from swaystride.stats.cluster_bootstrap import (
    Scale,
    bootstrap_interval,
    cluster_codes,
    cluster_weights,
)
from swaystride.stats.clustered_mixed_model import resampled_random_intercepts
from swaystride.stats.correlation import spearman
from swaystride.stats.grouping_factor import CodeArray, FloatArray
from swaystride.stats.linear_prediction import (
    dropped_names,
    least_squares_prediction,
    leave_one_cluster_out,
)
from swaystride.stats.marginal_correlation import (
    MarginalCorrelation,
    bootstrap_marginal_correlation,
    marginal_correlation,
)
from swaystride.studies.intensity.plan import (
    FEATURES,
    RATING_LEVELS,
    TRANSFORMS,
    IntensityPlan,
    RatingLevel,
)
from swaystride.studies.intensity.results import (
    participant_intervals,
    result_row,
    results,
    share_given,
)

_SCALES: Mapping[str, Scale] = {
    "spearman_kinematics_vs_pt": "fisher_z",
    "kinematics_predicts_pt_accuracy": "logit",
    "kinematics_5_agrees": "logit",
    "kinematics_4_is_pt_5": "logit",
    "kinematics_4_is_pt_4": "logit",
}
_NONE = (float("nan"), float("nan"))
_PER_EXERCISE_ONLY = ("kinematics_5_agrees", "kinematics_4_is_pt_5", "kinematics_4_is_pt_4")


def rated_sway(ratings: pd.DataFrame, sway: pd.DataFrame, level: RatingLevel) -> pd.DataFrame:
    """Ratings with the features of the rated trial, or of all trials of the rated exercise.

    Parameters
    ----------
    ratings : DataFrame
        As from :func:`swaystride.studies.intensity.observations.analysed_ratings`.
    sway : DataFrame
        ``participant``, ``exercise``, ``trial`` and the features.
    level : {"per_trial", "per_exercise"}
        For exercises the features have the number of the trial behind their name; exercises
        that lack a trial are left out.

    Returns
    -------
    DataFrame
        ``participant``, ``exercise``, ``rater``, ``rating`` and the features.
    """
    own = ratings[ratings["rating_level"] == level]
    if level == "per_trial":
        key = ["participant", "exercise", "trial"]
        own = own.assign(trial=own["trial"].astype("int64"))
        features = sway[[*key, *FEATURES]]
    else:
        key = ["participant", "exercise"]
        parts = [
            own_trial.set_index(key)[list(FEATURES)].add_suffix(f"_{trial}")
            for trial, own_trial in sway.groupby("trial")
        ]
        features = pd.concat(parts, axis=1, join="inner").reset_index()
    joined = own[[*key, "rater", "rating"]].merge(features, on=key, validate="many_to_one")
    return joined.reset_index(drop=True)


def correlations(
    ratings: pd.DataFrame, sway: pd.DataFrame, plan: IntensityPlan, *, quick: bool = False
) -> pd.DataFrame:
    """Marginal correlation of every feature with the ratings of trials (Table 3.3).

    The model has a random intercept of the patient only, as printed. Its interval is a parametric
    bootstrap; the participant-level one resamples patients and estimates the variances anew.

    Parameters
    ----------
    ratings, sway : DataFrame
        See :func:`rated_sway`.
    plan : IntensityPlan
    quick : bool, optional
        Leave out the model's interval.

    Returns
    -------
    DataFrame
        Results in the order of Table 3.3.
    """
    table = rated_sway(ratings, sway, "per_trial")
    rows = []
    for transform in TRANSFORMS:
        for feature in FEATURES:
            x = table[feature].to_numpy(dtype=float)
            values = np.log(x) if transform == "log" else x
            found = _marginal(table, values, plan, quick=quick)
            rows.append(
                result_row(
                    f"table_3_3/{feature}/{transform}",
                    found.r,
                    n=len(table),
                    p=found.p,
                    ci=_NONE if quick else (found.ci_low, found.ci_high),
                    participant_ci=_participant_interval(table, values, found.r, plan),
                )
            )
    return results(rows)


def _marginal(
    table: pd.DataFrame, x: FloatArray, plan: IntensityPlan, *, quick: bool
) -> MarginalCorrelation:
    """Marginal correlation of one feature; the bootstrap of its limits takes time."""
    y, patients = table["rating"].to_numpy(dtype=float), table["participant"].to_numpy()
    level, reml, df = plan.confidence_level, plan.reml, plan.degrees_of_freedom
    if quick:
        return marginal_correlation(y, x, patients, level=level, reml=reml, df=df)
    return bootstrap_marginal_correlation(
        y,
        x,
        patients,
        n=plan.cluster_bootstrap_n,
        seed=plan.icc_bootstrap_seed,
        level=level,
        reml=reml,
        df=df,
    )


def _participant_interval(
    table: pd.DataFrame, x: FloatArray, r: float, plan: IntensityPlan
) -> tuple[float, float]:
    """Interval over patients of one marginal correlation."""
    patients, level = table["participant"], plan.confidence_level
    codes, labels = cluster_codes(patients)
    weights = cluster_weights(len(labels), plan.cluster_bootstrap_n, plan.cluster_bootstrap_seed)
    fits = resampled_random_intercepts(table["rating"], x, patients, weights, reml=plan.reml)
    sums = [weights @ np.bincount(codes, weights=power) for power in (np.ones_like(x), x, x * x)]
    spread = (sums[2] - sums[1] ** 2 / sums[0]) / (sums[0] - 1.0)
    slope = fits.estimates[:, 1]
    explained = slope**2 * spread
    other = fits.cluster_variance + fits.residual_variance
    draws = np.sign(slope) * np.sqrt(explained / (explained + other))
    return bootstrap_interval(r, draws, n_clusters=len(labels), level=level, scale="fisher_z")


@dataclass(frozen=True, eq=False)
class Prediction:
    """Ratings predicted from the sway.

    Parameters
    ----------
    table : DataFrame
        ``participant``, ``exercise``, ``rater``, ``rating``, ``predicted``, ``left_out`` (predicted
        without the patient), both not rounded.
    dropped : list of str
        Features that the others determine.
    """

    table: pd.DataFrame
    dropped: list[str]


def predict_ratings(
    ratings: pd.DataFrame, sway: pd.DataFrame, level: RatingLevel, plan: IntensityPlan
) -> Prediction:
    """Predict ratings from all features, in sample and with the patient left out.

    Parameters
    ----------
    ratings, sway : DataFrame
        See :func:`rated_sway`.
    level : {"per_trial", "per_exercise"}
    plan : IntensityPlan

    Returns
    -------
    Prediction

    Raises
    ------
    ModelError
        If there is nothing to predict from.
    """
    table = rated_sway(ratings, sway, level)
    if table.empty:
        raise ModelError(f"no rating {level} has the features of its trials")
    covariates, names = _covariates(table, plan)
    fit = least_squares_prediction(covariates, table["rating"])
    left_out = leave_one_cluster_out(covariates, table["rating"], table["participant"])
    kept = table[["participant", "exercise", "rater", "rating"]]
    return Prediction(
        kept.assign(predicted=fit.predicted, left_out=left_out), dropped_names(fit, names)
    )


def predictions(
    ratings: pd.DataFrame, sway: pd.DataFrame, plan: IntensityPlan
) -> dict[str, pd.DataFrame]:
    """Everything that the text says about predictions from the sway.

    Parameters
    ----------
    ratings, sway : DataFrame
        See :func:`rated_sway`.
    plan : IntensityPlan

    Returns
    -------
    dict of str to DataFrame
        ``results`` (in sample, as printed); ``left_out`` (``rating``, statistic, in sample, left
        out); ``predicted`` (every rating with its predictions); ``dropped`` (``rating``,
        ``feature``).
    """
    rows, compared, predicted, dropped = [], [], [], []
    for level in RATING_LEVELS:
        found = predict_ratings(ratings, sway, level, plan)
        table = found.table
        rating = table["rating"].to_numpy(dtype=float)
        estimates = _statistics(rating, table["predicted"].to_numpy())
        covariates, _ = _covariates(rated_sway(ratings, sway, level), plan)

        def resampled(
            rows: CodeArray, x: FloatArray = covariates, y: FloatArray = rating
        ) -> dict[str, float]:
            return _statistics(y[rows], least_squares_prediction(x[rows], y[rows]).predicted)

        intervals = participant_intervals(
            resampled,
            table["participant"],
            estimates,
            _SCALES,
            plan,
        )
        rank = spearman(table["predicted"], rating, level=plan.confidence_level)
        others = _statistics(rating, table["left_out"].to_numpy())
        for name, estimate in estimates.items():
            if name in _PER_EXERCISE_ONLY and level == "per_trial":
                continue
            percent = name != "spearman_kinematics_vs_pt"
            factor = 100.0 if percent else 1.0
            low, high = intervals[name]
            quantity = f"study3_text/{name}_{level}" + ("_percent" if percent else "")
            rows.append(
                result_row(
                    quantity,
                    factor * estimate,
                    n=len(table),
                    p=float("nan") if percent else rank.p,
                    ci=_NONE if percent else (rank.ci_low, rank.ci_high),
                    participant_ci=(factor * low, factor * high),
                )
            )
            compared.append((level, name, factor * estimate, factor * others[name], len(table)))
        predicted.append(table.assign(rating_level=level))
        dropped += [(level, name) for name in found.dropped]
    return {
        "results": results(rows),
        "left_out": pd.DataFrame(
            compared, columns=["rating", "statistic", "in_sample", "left_out", "n"]
        ),
        "predicted": pd.concat(predicted, ignore_index=True),
        "dropped": pd.DataFrame(dropped, columns=["rating", "feature"]),
    }


def _covariates(table: pd.DataFrame, plan: IntensityPlan) -> tuple[FloatArray, list[str]]:
    """Features as they enter the prediction, with their names."""
    names = [name for name in table.columns if name.rstrip("_123") in FEATURES]
    values = table[names].to_numpy(dtype=float)
    return (np.log(values) if plan.prediction_transform == "log" else values), names


def _statistics(rating: FloatArray, predicted: FloatArray) -> dict[str, float]:
    """What is said about a prediction."""
    rounded = rounded_rating(predicted).astype(float)
    return {
        "spearman_kinematics_vs_pt": spearman(predicted, rating).r,
        "kinematics_predicts_pt_accuracy": exact_agreement(rounded, rating),
        "kinematics_5_agrees": share_given(rounded, rating, 5, 5),
        "kinematics_4_is_pt_5": share_given(rounded, rating, 4, 5),
        "kinematics_4_is_pt_4": share_given(rounded, rating, 4, 4),
    }
