"""Patients' own ratings against those of the therapists (§3.3.4.2; spec §8.5)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from scipy import stats

from swaystride.stats.agreement import exact_agreement, rounded_rating
from swaystride.stats.cluster_bootstrap import Scale
from swaystride.stats.correlation import spearman
from swaystride.stats.grouping_factor import CodeArray, FloatArray
from swaystride.stats.linear_prediction import least_squares_prediction, leave_one_cluster_out
from swaystride.stats.mixed_model import fit_mixed_model
from swaystride.studies.intensity.plan import RATING_LEVELS, IntensityPlan, RatingLevel
from swaystride.studies.intensity.results import (
    participant_intervals,
    result_row,
    results,
    share_given,
    tested_effect,
)

_DIFFERENCE = "pt_minus_self_mean_difference"
_SD = "difference_sd"
_VARIANCE = "pt_minus_self_between_trial_variance_difference"

#: Scale on which the participant-level interval of each statistic is computed.
_SCALES: Mapping[str, Scale] = {
    "spearman_self_vs_pt": "fisher_z",
    _DIFFERENCE: "identity",
    _SD: "identity",
    "self_predicts_pt_accuracy": "logit",
    "self_5_agrees_with_pt": "logit",
    "self_4_is_pt_5": "logit",
}
#: Shares, printed as percentages.
_PERCENT = ("self_predicts_pt_accuracy", "self_5_agrees_with_pt", "self_4_is_pt_5")


def paired_ratings(ratings: pd.DataFrame, level: RatingLevel) -> pd.DataFrame:
    """Ratings of one kind that have a self-rating beside them.

    Parameters
    ----------
    ratings : DataFrame
        As from :func:`swaystride.studies.intensity.observations.analysed_ratings`.
    level : {"per_trial", "per_exercise"}
    """
    own = ratings[(ratings["rating_level"] == level) & ratings["self_rating"].notna()]
    return own.reset_index(drop=True)


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
        Results; shares in percent.
    """
    rows = []
    for level in RATING_LEVELS:
        pairs = paired_ratings(ratings, level)
        both = pairs[["rating", "self_rating"]].to_numpy(dtype=float)
        estimates = _statistics(both)

        def resampled(rows: CodeArray, both: FloatArray = both) -> dict[str, float]:
            return _statistics(both[rows])

        intervals = participant_intervals(
            resampled,
            pairs["participant"],
            estimates,
            _SCALES,
            plan,
        )
        models = _model_results(pairs, estimates, plan)
        for name, estimate in estimates.items():
            percent = name in _PERCENT
            low, high = intervals[name]
            factor = 100.0 if percent else 1.0
            rows.append(
                result_row(
                    f"study3_text/{name}_{level}" + ("_percent" if percent else ""),
                    factor * estimate,
                    n=len(pairs),
                    participant_ci=(factor * low, factor * high),
                    **models.get(name, {}),
                )
            )
    rows.append(_variance_difference(ratings, plan))
    return results(rows)


def left_out_accuracy(ratings: pd.DataFrame, level: RatingLevel) -> float:
    """Accuracy of the prediction from self-ratings for patients that the model has not seen.

    Parameters
    ----------
    ratings : DataFrame
        As from :func:`swaystride.studies.intensity.observations.analysed_ratings`.
    level : {"per_trial", "per_exercise"}
    """
    pairs = paired_ratings(ratings, level)
    predicted = leave_one_cluster_out(pairs[["self_rating"]], pairs["rating"], pairs["participant"])
    return exact_agreement(rounded_rating(predicted), pairs["rating"])


def _statistics(pairs: FloatArray) -> dict[str, float]:
    """Everything that is computed from pairs (therapist, patient) alone."""
    rating, own = pairs.T
    difference = rating - own
    predicted = least_squares_prediction(own[:, None], rating).predicted
    return {
        "spearman_self_vs_pt": spearman(own, rating).r,
        _DIFFERENCE: float(difference.mean()),
        _SD: float(difference.std(ddof=1)),
        "self_predicts_pt_accuracy": exact_agreement(rounded_rating(predicted), rating),
        "self_5_agrees_with_pt": share_given(own, rating, 5, 5),
        "self_4_is_pt_5": share_given(own, rating, 4, 5),
    }


def _model_results(
    pairs: pd.DataFrame, estimates: Mapping[str, float], plan: IntensityPlan
) -> dict[str, dict[str, Any]]:
    """Printed kinds of intervals: Fisher's z, a mixed model, and chi-squared."""
    n, level = len(pairs), plan.confidence_level
    rank = spearman(pairs["self_rating"], pairs["rating"], level=level)
    frame = pairs.assign(difference=pairs["rating"] - pairs["self_rating"])
    random = " + ".join(f"(1|{term})" for term in plan.random_terms(rater=True))
    fit = fit_mixed_model(f"difference ~ 1 + {random}", frame, reml=plan.reml)
    mean = tested_effect(fit, "Intercept", plan)
    tails = [0.5 + level / 2.0, 0.5 - level / 2.0]
    spread = estimates[_SD] * np.sqrt((n - 1) / stats.chi2.ppf(tails, n - 1))
    return {
        "spearman_self_vs_pt": {"ci": (rank.ci_low, rank.ci_high), "p": rank.p},
        _DIFFERENCE: {
            "se": mean["se"],
            "df": mean["df"],
            "p": mean["p"],
            "ci": (mean["ci_low"], mean["ci_high"]),
        },
        _SD: {"ci": (float(spread[0]), float(spread[1]))},
    }


def _variance_difference(ratings: pd.DataFrame, plan: IntensityPlan) -> dict[str, object]:
    """Variance between the trials of an exercise: therapist minus patient, paired t-test."""
    pairs = paired_ratings(ratings, "per_trial")
    grouped = pairs.groupby(["participant", "exercise", "rater"], sort=False)
    variances = grouped[["rating", "self_rating"]].var()
    variances = variances[grouped.size() == int(grouped.size().max())].reset_index()
    difference = (variances["rating"] - variances["self_rating"]).to_numpy()
    n, mean = len(difference), float(difference.mean())
    se = float(difference.std(ddof=1) / np.sqrt(n))
    half = float(stats.t.ppf(0.5 + plan.confidence_level / 2.0, n - 1)) * se
    interval = participant_intervals(
        lambda at: {_VARIANCE: float(difference[at].mean())},
        variances["participant"],
        {_VARIANCE: mean},
        {_VARIANCE: "identity"},
        plan,
    )[_VARIANCE]
    return result_row(
        f"study3_text/{_VARIANCE}",
        mean,
        n=n,
        se=se,
        df=n - 1,
        p=float(2.0 * stats.t.sf(abs(mean) / se, n - 1)) if se > 0 else float("nan"),
        ci=(mean - half, mean + half),
        participant_ci=interval,
    )
