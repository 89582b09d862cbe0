"""Sway against the therapists' ratings (§3.3.4.3; spec §8.4)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import pandas as pd

from swaystride.errors import ModelError
from swaystride.findings import FINDING_COLUMNS
from swaystride.stats.clustered_mixed_model import resampled_random_intercepts
from swaystride.stats.correlation import spearman
from swaystride.stats.grouping_factor import FloatArray
from swaystride.stats.linear_prediction import least_squares_prediction
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
from swaystride.studies.intensity.prediction import judge_prediction
from swaystride.studies.intensity.rated_units import rated_units
from swaystride.studies.intensity.results import (
    participant_interval,
    patient_weights,
    result_row,
    results,
)

_NONE = (float("nan"), float("nan"))

#: Statistic of a prediction -> its name in study3_text, and the ratings for which it is printed.
_PRINTED: Final[dict[str, tuple[str, tuple[RatingLevel, ...]]]] = {
    "spearman": ("spearman_kinematics_vs_pt_{}", ("per_trial", "per_exercise")),
    "accuracy_percent": (
        "kinematics_predicts_pt_accuracy_{}_percent",
        ("per_trial", "per_exercise"),
    ),
    "predicted_5_is_pt_5_percent": ("kinematics_5_agrees_with_pt_{}_percent", ("per_exercise",)),
    "predicted_4_is_pt_5_percent": ("kinematics_4_is_pt_5_{}_percent", ("per_exercise",)),
    "predicted_4_is_pt_4_percent": ("kinematics_4_is_pt_4_{}_percent", ("per_exercise",)),
}


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
    patients = table["participant"]
    weights = patient_weights(patients.nunique(), plan)
    fits = resampled_random_intercepts(table["rating"], x, patients, weights, reml=plan.reml)
    other = fits.cluster_variance + fits.residual_variance
    draws = np.sign(fits.fixed_effects[:, 1]) * np.sqrt(
        fits.fixed_variance / (fits.fixed_variance + other)
    )
    return participant_interval(draws, r, "fisher_z", weights.shape[1], plan)


def predictions(
    ratings: pd.DataFrame, sway: pd.DataFrame, plan: IntensityPlan, *, quick: bool = False
) -> dict[str, pd.DataFrame]:
    """Predict ratings from all features together, rounded to the scale (Figure 3.4).

    Parameters
    ----------
    ratings, sway : DataFrame
        See :func:`rated_sway`.
    plan : IntensityPlan
    quick : bool, optional
        Judge the prediction in sample only.

    Returns
    -------
    dict of str to DataFrame
        ``results``: what the text prints, in sample. ``left_out``: every statistic in sample and
        for patients left out (:func:`swaystride.studies.intensity.prediction.judge_prediction`).
        ``predicted``: ``rating_level``, ``participant``, ``exercise``, ``rater``, ``rating``,
        ``predicted`` and ``left_out``, not rounded. ``dropped``: ``rating``, ``feature``, features
        that the others determine. ``findings``: these, and ratings without features, with
        ``participant``, ``trial`` and the finding columns.

    Raises
    ------
    ModelError
        If there is nothing to predict from.
    """
    judged, printed, predicted, dropped, findings = [], [], [], [], []
    for level in RATING_LEVELS:
        table = rated_sway(ratings, sway, level)
        if table.empty:
            raise ModelError(f"no rating {RATING_LEVELS[level]} has the features of its trials")
        covariates = _covariates(table, plan)
        fit = least_squares_prediction(covariates, table["rating"])
        used = covariates[list(fit.kept)].to_numpy()
        units = rated_units(table["participant"], used, table["rating"])
        left_out = units.predict_left_out(np.ones((1, units.n_patients)))[0, units.unit_of_row]
        kept = table[["participant", "exercise", "rater", "rating"]]
        kept.insert(0, "rating_level", level)
        predicted.append(kept.assign(predicted=fit.predictions, left_out=left_out))
        judgement = judge_prediction(
            units, predictor="kinematics", rating=level, plan=plan, left_out=not quick
        )
        judged.append(judgement)
        printed += _printed_rows(judgement, predicted[-1], level, plan)
        dropped += [(level, name) for name in fit.dropped]
        findings += _findings(ratings, table, level, fit.dropped)
    return {
        "results": results(printed),
        "left_out": pd.concat(judged, ignore_index=True),
        "predicted": pd.concat(predicted, ignore_index=True),
        "dropped": pd.DataFrame(dropped, columns=["rating", "feature"]),
        "findings": pd.DataFrame(findings, columns=["participant", "trial", *FINDING_COLUMNS]),
    }


def _covariates(table: pd.DataFrame, plan: IntensityPlan) -> pd.DataFrame:
    """Features as they enter the prediction."""
    values = table[[name for name in table.columns if name.rstrip("_123") in FEATURES]]
    return values.transform(np.log) if plan.prediction_transform == "log" else values


def _printed_rows(
    judgement: pd.DataFrame, predicted: pd.DataFrame, level: RatingLevel, plan: IntensityPlan
) -> list[dict[str, object]]:
    """What the text prints about a prediction, under the names of study3_text."""
    rank = spearman(predicted["predicted"], predicted["rating"], level=plan.confidence_level)
    rows = []
    for statistic, (name, levels) in _PRINTED.items():
        if level not in levels:
            continue
        row = judgement.loc[judgement["statistic"] == statistic].to_dict("records")[0]
        ranked = statistic == "spearman"
        rows.append(
            result_row(
                f"study3_text/{name.format(level)}",
                row["in_sample"],
                n=len(predicted),
                p=rank.p if ranked else float("nan"),
                ci=(rank.ci_low, rank.ci_high) if ranked else _NONE,
                participant_ci=(
                    row["in_sample_participant_ci_low"],
                    row["in_sample_participant_ci_high"],
                ),
            )
        )
    return rows


def _findings(
    ratings: pd.DataFrame, table: pd.DataFrame, level: RatingLevel, dropped: Sequence[str]
) -> list[tuple[str, ...]]:
    """Features that a prediction does without, and ratings that it cannot use."""
    label = RATING_LEVELS[level]
    rows: list[tuple[str, ...]] = [
        ("", "", "collinear_feature", "info", "", f"prediction {label}",
         "a feature that the others do not determine", name)
        for name in dropped
    ]  # fmt: skip
    given = ratings.loc[ratings["rating_level"] == level, "participant"].value_counts(sort=False)
    used = table["participant"].value_counts(sort=False).reindex(given.index, fill_value=0)
    wanted = "the sway of the trial" if level == "per_trial" else "the sway of all its trials"
    rows += [
        (str(patient), "", "rating_without_sway", "warning", "ratings.tsv", f"prediction {label}",
         wanted, f"{n} ratings without it, left out")
        for patient, n in (given - used).items()
        if n > 0
    ]  # fmt: skip
    return rows
