"""Design of the study: the lab's four tables, read, checked and held against each other.

``participants.tsv`` lists the patients, ``raters.tsv`` the therapists, ``trials.tsv`` the
recordings, ``ratings.tsv`` every rating in long form. A self-rating has the rater ``self``; a
rating of an exercise as a whole has no trial.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import pandas as pd

from swaystride.errors import DesignError
from swaystride.io.study_tables import Column, read_study_table

#: Name that stands for the patient's own rating.
SELF: Final = "self"

#: Trials of an exercise (dissertation §3.3.3.1).
TRIALS_PER_EXERCISE: Final = 3

#: Levels of the rating scale (dissertation Table 3.1).
RATINGS: Final = (1, 2, 3, 4, 5)

#: Codes of the four dimensions of difficulty (dissertation §3.3.4.1).
DIFFICULTY_CODES: Final[dict[str, tuple[str, dict[str, float]]]] = {
    "surface": ("surface", {"firm": 1.0, "foam": 2.0}),
    "stance": (
        "stance",
        {
            "feet_apart": 1.0,
            "feet_together": 2.0,
            "partial_tandem": 3.0,
            "tandem": 4.0,
            "single_leg": 5.0,
        },
    ),
    "visual_input": ("vision", {"eyes_open": 1.0, "eyes_closed": 2.0}),
    "head_movements": ("head", {"none": 1.0, "pitch": 2.0, "yaw": 2.0}),
}

_NAME: Final = Column("text", pattern=r"[^/\\\s]+")

PARTICIPANT_COLUMNS: Final = {
    "participant": _NAME,
    "group": Column("text", levels=("older_adult", "vestibular")),
    "age_years": Column("number", minimum=0, maximum=120),
    "sex": Column("text", levels=("F", "M")),
    "height_m": Column("number", minimum=0.5, maximum=2.5),
    "mass_kg": Column("number", minimum=10, maximum=300),
}
RATER_COLUMNS: Final = {
    "rater": _NAME,
    "experience_years": Column("number", minimum=0, maximum=80),
}
#: ``exclude`` is the lab's own reason to leave a recording out; its ratings still count.
TRIAL_COLUMNS: Final = {
    "participant": _NAME,
    "exercise": _NAME,
    "exercise_order": Column("integer", minimum=1),
    "trial": Column("integer", minimum=1, maximum=TRIALS_PER_EXERCISE),
    **{column: Column("text", levels=tuple(codes)) for column, codes in DIFFICULTY_CODES.values()},
    "file": Column("text"),
    "exclude": Column("text", may_be_empty=True, required=False),
}
RATING_COLUMNS: Final = {
    "participant": Column("text"),
    "exercise": Column("text"),
    "trial": Column("integer", minimum=1, maximum=TRIALS_PER_EXERCISE, may_be_empty=True),
    "rater": Column("text"),
    "rating": Column("integer", minimum=RATINGS[0], maximum=RATINGS[-1], may_be_empty=True),
}

_LONG_FORM: Final = "one row per rating: participant, exercise, trial, rater, rating"
_COMBINATION: Final = [column for column, _ in DIFFICULTY_CODES.values()]


@dataclass(frozen=True, eq=False)
class IntensityDesign:
    """The tables of one cohort, checked; made by :func:`read_design`.

    Parameters
    ----------
    participants, raters, trials, ratings : DataFrame
        In the order of the files. ``trials`` gains ``recording``, the name of each recording
        within its participant. In ``ratings``, ``trial`` is Int64 (missing: the exercise as a
        whole) and ``rating`` is NaN where the cell is empty.
    """

    participants: pd.DataFrame
    raters: pd.DataFrame
    trials: pd.DataFrame
    ratings: pd.DataFrame


def read_design(folder: Path) -> IntensityDesign:
    """Read and check the four tables of the study.

    Parameters
    ----------
    folder : Path
        ``data/raw/<cohort>/intensity``.

    Raises
    ------
    DesignError
        If a table is malformed, the tables contradict each other, the ratings are in wide form, or
        all ratings are by one therapist. What is merely incomplete is listed by
        :func:`swaystride.studies.intensity.observations.rating_findings`.
    """
    files = {
        name: folder / f"{name}.tsv" for name in ("participants", "raters", "trials", "ratings")
    }
    participants = read_study_table(
        files["participants"], PARTICIPANT_COLUMNS, unique=["participant"]
    )
    raters = read_study_table(files["raters"], RATER_COLUMNS, unique=["rater"])
    trials = read_study_table(
        files["trials"], TRIAL_COLUMNS, unique=["participant", "exercise", "trial"]
    )
    _check_raters(raters, files["raters"])
    _check_trials(participants, trials, files)
    ratings = _read_ratings(files["ratings"], [*raters["rater"], SELF])
    _check_ratings(raters, trials, ratings, files)
    return IntensityDesign(participants, raters, with_recording_names(trials), ratings)


def with_recording_names(trials: pd.DataFrame) -> pd.DataFrame:
    """Add the column ``recording``, the name of each recording within its participant.

    Parameters
    ----------
    trials : DataFrame
        With ``exercise_order`` and ``trial``.

    Examples
    --------
    >>> trials = pd.DataFrame({"exercise_order": [4], "trial": [2]})
    >>> with_recording_names(trials)["recording"].tolist()
    ['exercise_04_trial_2']
    """
    numbers = zip(trials["exercise_order"], trials["trial"], strict=True)
    return trials.assign(
        recording=[f"exercise_{order:02d}_trial_{trial}" for order, trial in numbers]
    )


def difficulty_codes(trials: pd.DataFrame) -> pd.DataFrame:
    """Numeric codes of the four dimensions of difficulty, by exercise.

    Parameters
    ----------
    trials : DataFrame
        As in :class:`IntensityDesign`.

    Returns
    -------
    DataFrame
        ``exercise``, ``surface``, ``stance``, ``visual_input``, ``head_movements``.

    Examples
    --------
    >>> trials = pd.DataFrame({"exercise": ["a", "a"], "surface": "foam", "stance": "tandem",
    ...                        "vision": "eyes_open", "head": "yaw"})
    >>> difficulty_codes(trials).values.tolist()
    [['a', 2.0, 4.0, 1.0, 2.0]]
    """
    exercises = trials.drop_duplicates("exercise")
    coded = {
        dimension: exercises[column].map(codes).astype("float64")
        for dimension, (column, codes) in DIFFICULTY_CODES.items()
    }
    return pd.DataFrame({"exercise": exercises["exercise"], **coded}).reset_index(drop=True)


def _read_ratings(file: Path, rater_names: list[str]) -> pd.DataFrame:
    """Ratings in long form; raters as columns are recognised and named."""
    if file.is_file():
        with file.open(encoding="utf-8-sig", errors="replace") as lines:
            header = lines.readline().rstrip("\r\n").split("\t")
        wide = [name for name in header if name in rater_names]
        if wide:
            raise DesignError(
                "ratings are in wide form",
                file=file,
                place="line 1",
                expected=f"{_LONG_FORM} (pandas: table.melt(id_vars=['participant', 'exercise', "
                "'trial'], var_name='rater', value_name='rating'))",
                found="columns that are raters: " + ", ".join(wide),
            )
    ratings = read_study_table(
        file, RATING_COLUMNS, unique=["participant", "exercise", "trial", "rater"]
    )
    return ratings.assign(trial=ratings["trial"].astype("Int64"))


def _check_raters(raters: pd.DataFrame, file: Path) -> None:
    """``self`` is the patient, not a therapist."""
    if SELF in set(raters["rater"]):
        raise DesignError(
            "a therapist cannot be called self", file=file, expected="self only in ratings.tsv"
        )


def _check_trials(participants: pd.DataFrame, trials: pd.DataFrame, files: dict[str, Path]) -> None:
    """Hold participants against trials, exercises against combinations, files against rows."""
    file = files["trials"]
    _check_known(trials, "participant", participants["participant"], file, files["participants"])
    idle = sorted(set(participants["participant"]) - set(trials["participant"]))
    if idle:
        raise DesignError(
            "participant has no trials", file=files["participants"], found=", ".join(idle)
        )
    for exercise, rows in trials.groupby("exercise", sort=False):
        combinations = rows[_COMBINATION].drop_duplicates()
        if len(combinations) > 1:
            raise DesignError(
                "exercise stands for two combinations",
                file=file,
                place=f"exercise {exercise}",
                expected="one combination of surface, stance, vision and head everywhere",
                found="; ".join(" ".join(row) for row in combinations.to_numpy().tolist()),
            )
    for keys, other in ((["exercise"], "exercise_order"), (["exercise_order"], "exercise")):
        several = trials.groupby(["participant", *keys])[other].nunique().gt(1)
        if several.any():
            participant, value = several.index[int(several.to_numpy().argmax())]
            raise DesignError(
                "exercises and their order do not match one to one",
                file=file,
                place=f"participant {participant}, {keys[0]} {value}",
            )
    used = trials[trials["exclude"] == ""]
    shared = used["file"].duplicated(keep=False)
    if shared.any():
        name = used.loc[shared, "file"].iloc[0]
        raise DesignError(
            "two trials name the same file",
            file=file,
            place=f"lines {', '.join(str(i + 2) for i in used.index[used['file'] == name])}",
            found=name,
        )


def _check_ratings(
    raters: pd.DataFrame, trials: pd.DataFrame, ratings: pd.DataFrame, files: dict[str, Path]
) -> None:
    """Every rating is by a known rater, of a known trial or exercise, and not all are by one."""
    file = files["ratings"]
    _check_known(ratings, "rater", [*raters["rater"], SELF], file, files["raters"])
    done = set(zip(trials["participant"], trials["exercise"], trials["trial"], strict=True))
    exercises = {(participant, exercise) for participant, exercise, _ in done}
    for row, (participant, exercise, trial) in enumerate(
        zip(ratings["participant"], ratings["exercise"], ratings["trial"], strict=True)
    ):
        whole = pd.isna(trial)
        known = exercises if whole else done
        key = (participant, exercise) if whole else (participant, exercise, trial)
        if key not in known:
            raise DesignError(
                f"rating of {'an exercise' if whole else 'a trial'} that is not in trials.tsv",
                file=file,
                place=f"line {row + 2}",
                found=", ".join(str(part) for part in key),
            )
    given = ratings.dropna(subset="rating").query("rater != @SELF")
    names = sorted(set(given["rater"]))
    if len(names) < 2:
        raise DesignError(
            "no two therapists rated: raters and patients cannot be told apart",
            file=file,
            expected="ratings by two therapists or more",
            found=", ".join(names) or "none",
        )


def _check_known(
    table: pd.DataFrame, column: str, known: pd.Series | list[str], file: Path, list_file: Path
) -> None:
    """Names of a column must stand in the table that lists them."""
    unknown = ~table[column].isin(known)
    if unknown.any():
        row = int(unknown.to_numpy().argmax())
        raise DesignError(
            f"{column} is not in {list_file.name}",
            file=file,
            place=f"line {row + 2}, column {column}",
            found=repr(table.loc[row, column]),
        )
