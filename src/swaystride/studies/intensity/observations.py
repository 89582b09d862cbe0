"""What is analysed: the therapists' ratings with the patient's own beside, and the sway."""

from __future__ import annotations

from typing import Final

import pandas as pd

from swaystride.findings import FINDING_COLUMNS
from swaystride.studies.intensity.design import (
    SELF,
    TRIALS_PER_EXERCISE,
    IntensityDesign,
    difficulty_codes,
)
from swaystride.studies.intensity.plan import FEATURES, IntensityPlan

#: Missing ratings that one finding names.
_NAMED: Final = 3


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


def expected_ratings(design: IntensityDesign) -> pd.DataFrame:
    """Every rating that was to be given, and what became of it.

    Whoever rated a patient at all was to rate every trial and every exercise of this patient, and
    so was the patient.

    Parameters
    ----------
    design : IntensityDesign

    Returns
    -------
    DataFrame
        ``participant``, ``exercise``, ``trial`` (NA: the exercise as a whole), ``rater``,
        ``rating`` and ``status``: ``given``, ``empty`` (a row without a rating) or ``no row``.
    """
    key = ["participant", "exercise", "trial"]
    done = design.trials[key].astype({"trial": "Int64"})
    whole = done.drop_duplicates(key[:2])
    whole = whole.assign(trial=whole["trial"].where(whole["trial"].isna()))
    judged = design.ratings.loc[design.ratings["rater"] != SELF, ["participant", "rater"]]
    own = design.participants[["participant"]].assign(rater=SELF)
    pairs = pd.concat([judged.drop_duplicates(), own], ignore_index=True)
    planned = pairs.merge(pd.concat([done, whole], ignore_index=True), on="participant")
    found = planned.merge(
        design.ratings[[*key, "rater", "rating"]], on=[*key, "rater"], how="left", indicator=True
    )
    status = found["rating"].notna().map({True: "given", False: "empty"})
    found["status"] = status.mask(found["_merge"] == "left_only", "no row")
    return found[[*key, "rater", "rating", "status"]]


def rating_findings(design: IntensityDesign) -> pd.DataFrame:
    """What is incomplete about trials and ratings without being wrong.

    Parameters
    ----------
    design : IntensityDesign

    Returns
    -------
    DataFrame
        ``participant``, ``trial`` and the finding columns: a therapist who rated nobody; a
        patient with one therapist, whose ratings stay but say nothing about how raters differ, or
        with none; an exercise without all its trials; missing ratings and self-ratings.
    """
    given = expected_ratings(design).query("rater != @SELF and status == 'given'")
    idle = [str(name) for name in design.raters["rater"] if name not in set(given["rater"])]
    rows = [
        (
            "",
            "rater_without_ratings",
            "raters.tsv",
            f"rater {name}",
            "ratings by every rater",
            "none",
        )
        for name in idle
    ]
    for patient in design.participants["participant"].astype(str):
        n_raters = given.loc[given["participant"] == patient, "rater"].nunique()
        found = "one: no comparison between raters" if n_raters else "none: patient is not analysed"
        if n_raters < 2:
            rows.append((patient, "few_raters", "ratings.tsv", "", "two therapists or more", found))
    return pd.DataFrame(
        [
            (row[0], "", row[1], "warning", *row[2:])
            for row in [*rows, *_missing_trials(design), *_missing_ratings(design)]
        ],
        columns=["participant", "trial", *FINDING_COLUMNS],
    )


def _missing_trials(design: IntensityDesign) -> list[tuple[str, ...]]:
    """Exercises with fewer trials than the design asks for."""
    expected = "trials " + ", ".join(str(number) for number in range(1, TRIALS_PER_EXERCISE + 1))
    rows: list[tuple[str, ...]] = []
    for _, own in design.trials.groupby(["participant", "exercise"], sort=False):
        numbers = sorted(own["trial"])
        if len(numbers) < TRIALS_PER_EXERCISE:
            patient, exercise = own["participant"].iloc[0], own["exercise"].iloc[0]
            found = ", ".join(str(number) for number in numbers)
            place = f"exercise {exercise}"
            rows.append((patient, "missing_trial", "trials.tsv", place, expected, found))
    return rows


def _missing_ratings(design: IntensityDesign) -> list[tuple[str, ...]]:
    """Missing ratings, those of one rater of one patient together."""
    expected = expected_ratings(design)
    rows: list[tuple[str, ...]] = []
    for _, own in expected.groupby(["participant", "rater"], sort=False):
        patient, rater = own["participant"].iloc[0], own["rater"].iloc[0]
        lost = own[own["status"] != "given"]
        if lost.empty:
            continue
        check = "missing_self_rating" if rater == SELF else "missing_rating"
        things = [
            exercise + ("" if pd.isna(trial) else f" trial {trial}")
            for exercise, trial in zip(lost["exercise"], lost["trial"], strict=True)
        ]
        named = ", ".join(things[:_NAMED]) + (", …" if len(things) > _NAMED else "")
        rows.append(
            (patient, check, "ratings.tsv", f"rater {rater}", f"{len(own)} ratings",
             f"{len(own) - len(lost)}; missing: {named}")
        )  # fmt: skip
    return rows
