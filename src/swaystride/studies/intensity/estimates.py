"""All printed quantities of the chapter from one cohort, without files."""

from __future__ import annotations

import pandas as pd

from swaystride.studies.intensity.difficulty import difficulty
from swaystride.studies.intensity.kinematics import correlations, predictions
from swaystride.studies.intensity.plan import IntensityPlan
from swaystride.studies.intensity.reliability import quick_icc
from swaystride.studies.intensity.self_ratings import self_ratings


def cohort_estimates(
    ratings: pd.DataFrame, sway: pd.DataFrame, plan: IntensityPlan
) -> pd.DataFrame:
    """Estimates and participant-level intervals; the ICC without intervals, which take long.

    Parameters
    ----------
    ratings : DataFrame
        As from :func:`swaystride.studies.intensity.observations.analysed_ratings`.
    sway : DataFrame
        ``participant``, ``exercise``, ``trial`` and the features.
    plan : IntensityPlan

    Returns
    -------
    DataFrame
        Results of Tables 3.2 and 3.3 and of the text.
    """
    parts = [
        difficulty(ratings, plan),
        correlations(ratings, sway, plan, quick=True),
        quick_icc(ratings, plan),
        self_ratings(ratings, plan),
        predictions(ratings, sway, plan, quick=True)["results"],
    ]
    return pd.concat(parts, ignore_index=True)
