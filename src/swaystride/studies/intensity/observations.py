"""What is analysed: the therapists' ratings with the patient's own beside, and the sway."""

from __future__ import annotations

from collections.abc import Hashable, Mapping

import pandas as pd

from swaystride.findings import FINDING_COLUMNS
from swaystride.studies.intensity.design import (
    SELF,
    TRIALS_PER_EXERCISE,
    IntensityDesign,
    difficulty_codes,
)
from swaystride.studies.intensity.plan import FEATURES, IntensityPlan


def analysed_ratings(design: IntensityDesign) -> pd.DataFrame:
    """Ratings of the therapists with the patient's own beside; missing ratings are left out.

    Parameters
    ----------
    design : IntensityDesign

    Returns
    -------
    DataFrame
        ``participant``, ``exercise``, ``trial`` (NA for an exercise as a whole),
        ``rating_level``, ``rater``, ``rating``, ``self_rating`` (NaN if missing) and the codes of
        the four dimensions, in the order of ratings.tsv.
    """
    ratings = design.ratings.assign(
        trial=design.ratings["trial"].astype("Int64"),
        rating=design.ratings["rating"].astype("float64"),
    )
    key = ["participant", "exercise", "trial"]
    own = ratings[ratings["rater"] == SELF].rename(columns={"rating": "self_rating"})
    given = ratings[(ratings["rater"] != SELF) & ratings["rating"].notna()]
    joined = given[[*key, "rater", "rating"]].merge(
        own[[*key, "self_rating"]], on=key, how="left", validate="many_to_one"
    )
    level = joined["trial"].isna().map({True: "per_exercise", False: "per_trial"})
    joined.insert(3, "rating_level", level)
    return joined.merge(difficulty_codes(design.trials), on="exercise", validate="many_to_one")


def analysed_sway(
    design: IntensityDesign, measures: pd.DataFrame, plan: IntensityPlan
) -> pd.DataFrame:
    """Sway features of every measured trial.

    Parameters
    ----------
    design : IntensityDesign
    measures : DataFrame
        ``participant``, ``trial`` (name of the recording) and the sway measures.
    plan : IntensityPlan
        Which measure stands for the elliptical area.

    Returns
    -------
    DataFrame
        ``participant``, ``exercise``, ``trial`` (number), ``duration_s`` and the features.
    """
    key = ["participant", "recording"]
    measured = measures.rename(columns={"trial": "recording"})
    trials = design.trials[["participant", "exercise", "trial", "recording"]]
    frame = trials.merge(measured, on=key, validate="one_to_one")
    frame = frame.assign(ellipse_area=frame[plan.ellipse_measure])
    return frame[["participant", "exercise", "trial", "duration_s", *FEATURES]]


def rating_findings(design: IntensityDesign) -> pd.DataFrame:
    """What is incomplete about ratings and trials without being wrong.

    Parameters
    ----------
    design : IntensityDesign

    Returns
    -------
    DataFrame
        ``participant``, ``trial`` and the finding columns: a therapist who rated nobody, a
        patient with fewer than two therapists, a missing rating, a rated trial or exercise
        without a self-rating, an exercise without all its trials.
    """
    ratings, trials = design.ratings, design.trials
    therapists = ratings[ratings["rater"] != SELF]
    idle = sorted(set(design.raters["rater"]) - set(therapists["rater"]))
    rows = [("", "", "idle_rater", "ratings by every rater", f"{name}: none") for name in idle]
    per_participant = therapists.groupby("participant")["rater"].nunique()
    n_raters = per_participant.reindex(design.participants["participant"], fill_value=0)
    rows += [
        (str(name), "", "few_raters", "2 or more raters", f"{n}")
        for name, n in n_raters[n_raters < 2].items()
    ]
    missing = therapists[therapists["rating"].isna()]
    rows += [
        (row["participant"], _rated_thing(row), "missing_rating", "a rating", row["rater"])
        for row in missing.to_dict("records")
    ]
    key = ["participant", "exercise", "trial"]
    own = ratings.loc[(ratings["rater"] == SELF) & ratings["rating"].notna(), key]
    rated = therapists[key].drop_duplicates().merge(own, how="left", indicator=True)
    rows += [
        (row["participant"], _rated_thing(row), "missing_self_rating", "a self-rating", "none")
        for row in rated[rated["_merge"] == "left_only"].to_dict("records")
    ]
    counts = trials.groupby(["participant", "exercise"], sort=False, as_index=False).size()
    expected = f"{TRIALS_PER_EXERCISE} trials"
    rows += [
        (row["participant"], row["exercise"], "missing_trial", expected, str(row["size"]))
        for row in counts[counts["size"] < TRIALS_PER_EXERCISE].to_dict("records")
    ]
    return pd.DataFrame(
        [(a, b, check, "warning", "ratings.tsv", "", c, d) for a, b, check, c, d in rows],
        columns=["participant", "trial", *FINDING_COLUMNS],
    )


def _rated_thing(row: Mapping[Hashable, object]) -> str:
    """Exercise and, if there is one, trial of a row of ratings.tsv."""
    trial = str(row["trial"])
    return f"{row['exercise']}" + (f" trial {trial[0]}" if trial[:1].isdigit() else "")
