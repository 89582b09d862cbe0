"""Patients' own ratings against those of the therapists (§3.3.4.2; spec §8.5)."""

from __future__ import annotations

import numpy as np
import pandas as pd
from scipy.special import chdtri, stdtr, stdtrit

from swaystride.errors import DesignError
from swaystride.stats.cluster_bootstrap import cluster_codes
from swaystride.stats.correlation import spearman
from swaystride.stats.grouping_factor import CodeArray, FloatArray
from swaystride.stats.mixed_model import fit_mixed_model
from swaystride.studies.intensity.design import TRIALS_PER_EXERCISE
from swaystride.studies.intensity.plan import RATING_LEVELS, IntensityPlan, RatingLevel
from swaystride.studies.intensity.prediction import judge_prediction
from swaystride.studies.intensity.rated_units import RatedUnits, rated_units
from swaystride.studies.intensity.results import (
    mean_draws,
    participant_interval,
    patient_weights,
    result_row,
    results,
    tested_effect,
)


def paired_ratings(ratings: pd.DataFrame, level: RatingLevel) -> pd.DataFrame:
    """Ratings of one kind that have a self-rating beside them.

    Parameters
    ----------
    ratings : DataFrame
        As from :func:`swaystride.studies.intensity.observations.analysed_ratings`.
    level : {"per_trial", "per_exercise"}

    Raises
    ------
    DesignError
        If there is none.
    """
    own = ratings[(ratings["rating_level"] == level) & ratings["self_rating"].notna()]
    if own.empty:
        raise DesignError(
            "no rating has a self-rating beside it",
            place=RATING_LEVELS[level],
            expected="rows of ratings.tsv with rater self",
        )
    return own.assign(difference=own["rating"] - own["self_rating"]).reset_index(drop=True)


def self_ratings(ratings: pd.DataFrame, plan: IntensityPlan) -> pd.DataFrame:
    """All numbers that compare self-ratings with the therapists' ratings.

    Parameters
    ----------
    ratings : DataFrame
        As from :func:`swaystride.studies.intensity.observations.analysed_ratings`.
    plan : IntensityPlan

    Returns
    -------
    DataFrame
        Results; shares in percent. Intervals are those that the chapter prints where it prints
        one of that kind: Fisher's z, a mixed model of the differences, χ² of their variance.
    """
    rows = []
    for level in RATING_LEVELS:
        pairs = paired_ratings(ratings, level)
        codes, labels = cluster_codes(pairs["participant"])
        weights = patient_weights(len(labels), plan)
        units = _units(pairs)
        rows += [
            _rank_correlation(pairs, units, weights, level, plan),
            _mean_difference(pairs, codes, weights, level, plan),
            _difference_sd(pairs, codes, weights, level, plan),
            *_agreement(units, weights, level, plan),
        ]
    rows.append(_variance_difference(ratings, plan))
    return results(rows)


def self_predictions(ratings: pd.DataFrame, plan: IntensityPlan) -> pd.DataFrame:
    """Therapists' ratings predicted from self-ratings, in sample and for patients left out.

    Parameters
    ----------
    ratings : DataFrame
        As from :func:`swaystride.studies.intensity.observations.analysed_ratings`.
    plan : IntensityPlan

    Returns
    -------
    DataFrame
        As from :func:`swaystride.studies.intensity.prediction.judge_prediction`.
    """
    tables = [
        judge_prediction(
            _units(paired_ratings(ratings, level)),
            predictor="self_rating",
            rating=level,
            plan=plan,
        )
        for level in RATING_LEVELS
    ]
    return pd.concat(tables, ignore_index=True)


def _units(pairs: pd.DataFrame) -> RatedUnits:
    """Therapists' ratings by patient and level of the self-rating."""
    return rated_units(pairs["participant"], pairs[["self_rating"]], pairs["rating"])


def _rank_correlation(
    pairs: pd.DataFrame, units: RatedUnits, weights: FloatArray, level: str, plan: IntensityPlan
) -> dict[str, object]:
    """Spearman's correlation; Fisher's z with every pair counted, as printed."""
    rank = spearman(pairs["self_rating"], pairs["rating"], level=plan.confidence_level)
    own = np.broadcast_to(units.predictors[:, 0], (len(weights), len(units.predictors)))
    draws = units.spearman(own, weights)
    return result_row(
        f"study3_text/spearman_self_vs_pt_{level}",
        rank.r,
        n=rank.n,
        p=rank.p,
        ci=(rank.ci_low, rank.ci_high),
        participant_ci=participant_interval(draws, rank.r, "fisher_z", units.n_patients, plan),
    )


def _mean_difference(
    pairs: pd.DataFrame, codes: CodeArray, weights: FloatArray, level: str, plan: IntensityPlan
) -> dict[str, object]:
    """Mean over all pairs; test and interval of the intercept of a mixed model."""
    random = " + ".join(f"(1|{term})" for term in plan.random_terms(rater=True))
    fit = fit_mixed_model(f"difference ~ 1 + {random}", pairs, reml=plan.reml)
    model = tested_effect(fit, "Intercept", plan)
    values = pairs["difference"].to_numpy(dtype=float)
    mean = float(values.mean())
    draws = mean_draws(values, codes, weights)
    return result_row(
        f"study3_text/pt_minus_self_mean_difference_{level}",
        mean,
        n=len(values),
        se=model["se"],
        df=model["df"],
        p=model["p"],
        ci=(model["ci_low"], model["ci_high"]),
        participant_ci=participant_interval(draws, mean, "identity", weights.shape[1], plan),
    )


def _difference_sd(
    pairs: pd.DataFrame, codes: CodeArray, weights: FloatArray, level: str, plan: IntensityPlan
) -> dict[str, object]:
    """Standard deviation of the differences, with the χ² interval of independent values."""
    values = pairs["difference"].to_numpy(dtype=float)
    n, sd = len(values), float(values.std(ddof=1))
    beyond = np.array([0.5 - plan.confidence_level / 2.0, 0.5 + plan.confidence_level / 2.0])
    low, high = (sd * np.sqrt((n - 1) / chdtri(n - 1, beyond))).tolist()
    size = weights @ np.bincount(codes)
    centred = values - values.mean()
    around = mean_draws(centred**2, codes, weights) - mean_draws(centred, codes, weights) ** 2
    draws = np.sqrt(np.maximum(around, 0.0) * size / (size - 1.0))
    return result_row(
        f"study3_text/difference_sd_{level}",
        sd,
        n=n,
        ci=(low, high),
        participant_ci=participant_interval(draws, sd, "identity", weights.shape[1], plan),
    )


def _agreement(
    units: RatedUnits, weights: FloatArray, level: str, plan: IntensityPlan
) -> list[dict[str, object]]:
    """Accuracy of the linear prediction, and rows of the contingency table, in percent."""

    def statistics(w: FloatArray) -> dict[str, FloatArray]:
        own = np.broadcast_to(units.predictors[:, 0], (len(w), len(units.predictors)))
        return {
            "self_predicts_pt_accuracy": units.accuracy(units.predict(w), w),
            "self_5_agrees_with_pt": units.share_given(own, w, given=5, then=5),
            "self_4_is_pt_5": units.share_given(own, w, given=4, then=5),
        }

    estimates, drawn = statistics(np.ones((1, units.n_patients))), statistics(weights)
    rows = []
    for name, values in estimates.items():
        estimate = float(values[0])
        low, high = participant_interval(drawn[name], estimate, "logit", units.n_patients, plan)
        rows.append(
            result_row(
                f"study3_text/{name}_{level}_percent",
                100.0 * estimate,
                n=int(units.counts.sum()),
                participant_ci=(100.0 * low, 100.0 * high),
            )
        )
    return rows


def variance_pairs(ratings: pd.DataFrame) -> pd.DataFrame:
    """Variance between the trials of each exercise, of the therapist and of the patient.

    Parameters
    ----------
    ratings : DataFrame
        As from :func:`swaystride.studies.intensity.observations.analysed_ratings`.

    Returns
    -------
    DataFrame
        ``participant``, ``exercise``, ``rater``, ``rating``, ``self_rating`` (sample variances);
        exercises of which a rating or self-rating is missing are left out.

    Raises
    ------
    DesignError
        If no exercise remains.
    """
    pairs = paired_ratings(ratings, "per_trial")
    keys = ["participant", "exercise", "rater"]
    complete = pairs[pairs.groupby(keys)["rating"].transform("size") == TRIALS_PER_EXERCISE]
    if complete.empty:
        raise DesignError(
            "no exercise has all ratings and self-ratings of its trials",
            expected=f"{TRIALS_PER_EXERCISE} trials rated by therapist and patient",
        )
    variances: pd.DataFrame = (
        complete.groupby(keys, sort=False)[["rating", "self_rating"]].var().reset_index()
    )
    return variances


def _variance_difference(ratings: pd.DataFrame, plan: IntensityPlan) -> dict[str, object]:
    """Variance between the trials of an exercise: therapist minus patient, paired t-test."""
    variances = variance_pairs(ratings)
    difference = (variances["rating"] - variances["self_rating"]).to_numpy(dtype=float)
    n, mean = len(difference), float(difference.mean())
    se = float(difference.std(ddof=1) / np.sqrt(n))
    half = float(stdtrit(n - 1, 0.5 + plan.confidence_level / 2.0)) * se
    codes, labels = cluster_codes(variances["participant"])
    draws = mean_draws(difference, codes, patient_weights(len(labels), plan))
    return result_row(
        "study3_text/pt_minus_self_between_trial_variance_difference",
        mean,
        n=n,
        se=se,
        df=n - 1,
        p=float(2.0 * stdtr(n - 1, -abs(mean) / se)) if se > 0.0 else float("nan"),
        ci=(mean - half, mean + half),
        participant_ci=participant_interval(draws, mean, "identity", len(labels), plan),
    )
