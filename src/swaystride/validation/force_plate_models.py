"""Statistics of the force-plate table against R: mixed models, repeated trials, correlations.

All 1930 trials of Santos & Duarte (2016). Each condition has three trials per person; people
without all three are left out of its reliability, as in the reference.
"""

from __future__ import annotations

from typing import Final

import pandas as pd

from swaystride.errors import DesignError
from swaystride.stats.correlation import pearson, spearman
from swaystride.stats.mixed_model import fit_mixed_model
from swaystride.validation.reliability_and_mixed_models import (
    Values,
    compared,
    model_values,
    rating_values,
)

DATASET: Final = "standing_force_plate"
_REPETITIONS: Final = 3
_FIRST_TRIALS: Final = 200

_TERMS: Final = ("(Intercept)", "VisionClosed", "SurfaceFoam")
_M1: Final = "logA ~ Vision*Surface + AgeGroup + (1|Subject)"
_M2: Final = "logV ~ Vision*Surface*AgeGroup + (1|Subject:Vision:Surface) + (1|Subject)"
_M4: Final = "logA ~ Vision*Surface + (1|Subject)"
_M1_TERMS: Final = (*_TERMS, "AgeGroupOld", "VisionClosed:SurfaceFoam")
_M2_TERMS: Final = (
    *_M1_TERMS,
    "VisionClosed:AgeGroupOld",
    "SurfaceFoam:AgeGroupOld",
    "VisionClosed:SurfaceFoam:AgeGroupOld",
)
_M4_TERMS: Final = (*_TERMS, "VisionClosed:SurfaceFoam")
#: Measures that are correlated with age, one value per person.
_WITH_AGE: Final = {
    "area": "COParea",
    "velocity": "COPvelo",
    "Mini-BESTest": "Best_T",
    "FES": "FES_T",
}


def force_plate_comparison(table: pd.DataFrame) -> pd.DataFrame:
    """Our statistics of the table beside those of R.

    Parameters
    ----------
    table : DataFrame
        As from :func:`swaystride.validation.standing_force_plate.force_plate_table`.

    Returns
    -------
    DataFrame
        As from :func:`swaystride.validation.reliability_and_mixed_models.compared`.
    """
    return compared(DATASET, {**_models(table), **_reliability(table), **_correlations(table)})


def repeated_trials(table: pd.DataFrame, measure: str, vision: str, surface: str) -> pd.DataFrame:
    """One measure of the repeated trials of one condition, people down and repetitions across.

    Parameters
    ----------
    table : DataFrame
        ``Subject``, ``Vision``, ``Surface`` and the measure, trials of a person in their order.
    measure : str
        Column of the measure.
    vision, surface : str
        The condition.

    Returns
    -------
    DataFrame, shape (n_people, 3)
        Only people with all three trials.

    Raises
    ------
    DesignError
        If a person has more trials of the condition than three, or the condition none.
    """
    chosen = table[(table["Vision"] == vision) & (table["Surface"] == surface)]
    if chosen.empty:
        raise DesignError(
            "no trial of this condition", place="force-plate table", found=f"{vision}, {surface}"
        )
    repetition = chosen.groupby("Subject").cumcount()
    if int(repetition.max()) >= _REPETITIONS:
        raise DesignError(
            "too many trials of a condition",
            place=f"force-plate table, {vision}, {surface}",
            expected=str(_REPETITIONS),
            found=str(int(repetition.max()) + 1),
        )
    wide = chosen.assign(repetition=repetition).pivot_table(
        index="Subject", columns="repetition", values=measure
    )
    return wide.dropna()


def _models(table: pd.DataFrame) -> Values:
    """M1 and M2 on all trials, M4 on those of the first 17 people."""
    first = table.iloc[:_FIRST_TRIALS]
    m2 = model_values(fit_mixed_model(_M2, table), _M2_TERMS, ["cell", "subject"])
    by_ml = fit_mixed_model(_M2, table, reml=False)
    m2 |= {"ML log-likelihood": by_ml.loglik, "ML AIC": by_ml.aic}
    return {
        "M1": model_values(fit_mixed_model(_M1, table), _M1_TERMS, ["subject"]),
        "M2": m2,
        "M4": model_values(fit_mixed_model(_M4, first), _M4_TERMS, ["subject"]),
    }


def _reliability(table: pd.DataFrame) -> Values:
    """Reliability of the mean velocity over the three trials of each condition."""
    return {
        f"velocity {vision.lower()} {surface.lower()}": rating_values(
            repeated_trials(table, "COPvelo", vision, surface).to_numpy(dtype=float)
        )
        for vision in ("Open", "Closed")
        for surface in ("Firm", "Foam")
    }


def _correlations(table: pd.DataFrame) -> Values:
    """Correlation with age, on the means of each person's trials with open eyes on foam."""
    chosen = table[(table["Vision"] == "Open") & (table["Surface"] == "Foam")]
    people = chosen.groupby("Subject")[["Age", *_WITH_AGE.values()]].mean()
    values = {}
    for name, column in _WITH_AGE.items():
        linear, ranks = (method(people[column], people["Age"]) for method in (pearson, spearman))
        values[f"age and {name}"] = {
            "Pearson r": linear.r,
            "Pearson r: p": linear.p,
            "Pearson r: lower limit": linear.ci_low,
            "Pearson r: upper limit": linear.ci_high,
            "Spearman r": ranks.r,
            "Spearman r: p": ranks.p,
        }
    return values
