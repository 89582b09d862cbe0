"""How well ratings can be predicted, in sample as printed and for patients left out (§3.3.4)."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt
import pandas as pd

from swaystride.stats.cluster_bootstrap import Scale
from swaystride.stats.grouping_factor import FloatArray
from swaystride.studies.intensity.plan import IntensityPlan
from swaystride.studies.intensity.rated_units import RatedUnits
from swaystride.studies.intensity.results import participant_interval, patient_weights

#: What is said about a prediction, and the scale of its participant-level interval.
STATISTICS: Final[dict[str, Scale]] = {
    "spearman": "fisher_z",
    "accuracy_percent": "logit",
    "predicted_5_is_pt_5_percent": "logit",
    "predicted_4_is_pt_5_percent": "logit",
    "predicted_4_is_pt_4_percent": "logit",
}

#: Columns of :func:`judge_prediction`.
PREDICTION_COLUMNS: Final = (
    "predictor",
    "rating",
    "statistic",
    "in_sample",
    "in_sample_participant_ci_low",
    "in_sample_participant_ci_high",
    "left_out",
    "left_out_participant_ci_low",
    "left_out_participant_ci_high",
    "n",
)


def prediction_statistics(
    units: RatedUnits, predicted: FloatArray, weights: npt.ArrayLike
) -> dict[str, FloatArray]:
    """Rank correlation, accuracy and shares of a prediction in each resample; no percentages yet.

    Parameters
    ----------
    units : RatedUnits
    predicted : array, shape (n, n_units)
        Not rounded.
    weights : array, shape (n, m)

    Returns
    -------
    dict of str to array of shape (n,)
        By the names of :data:`STATISTICS`.
    """
    return {
        "spearman": units.spearman(predicted, weights),
        "accuracy_percent": units.accuracy(predicted, weights),
        "predicted_5_is_pt_5_percent": units.share_given(predicted, weights, given=5, then=5),
        "predicted_4_is_pt_5_percent": units.share_given(predicted, weights, given=4, then=5),
        "predicted_4_is_pt_4_percent": units.share_given(predicted, weights, given=4, then=4),
    }


def judge_prediction(
    units: RatedUnits, *, predictor: str, rating: str, plan: IntensityPlan, left_out: bool = True
) -> pd.DataFrame:
    """Judge least-squares predictions of ratings, in sample and with the patient left out.

    The prediction is fitted anew in every resample of patients.

    Parameters
    ----------
    units : RatedUnits
        Ratings by predictors.
    predictor, rating : str
        What predicts which ratings; repeated in the table.
    plan : IntensityPlan
    left_out : bool, optional
        Whether patients are left out at all; otherwise these columns are empty.

    Returns
    -------
    DataFrame
        One row per statistic: its value in sample, for patients left out, and the
        participant-level interval of each; shares in percent.
    """
    weights = patient_weights(units.n_patients, plan)
    whole = np.ones((1, units.n_patients))
    rows: dict[str, dict[str, object]] = {
        name: {"predictor": predictor, "rating": rating, "statistic": name} for name in STATISTICS
    }
    kinds = [("in_sample", units.predict), ("left_out", units.predict_left_out)]
    for kind, predict in kinds if left_out else kinds[:1]:
        estimates = prediction_statistics(units, predict(whole), whole)
        drawn = prediction_statistics(units, predict(weights), weights)
        for name, scale in STATISTICS.items():
            factor = 100.0 if name.endswith("percent") else 1.0
            estimate = float(estimates[name][0])
            low, high = participant_interval(drawn[name], estimate, scale, units.n_patients, plan)
            rows[name][kind] = factor * estimate
            rows[name][f"{kind}_participant_ci_low"] = factor * low
            rows[name][f"{kind}_participant_ci_high"] = factor * high
    n = int(units.counts.sum())
    return pd.DataFrame(list(rows.values())).assign(n=n).reindex(columns=list(PREDICTION_COLUMNS))
