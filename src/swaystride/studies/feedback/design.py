"""Design of the study: the lab's tables, and the model variables derived from them (spec §8.3)."""

from __future__ import annotations

from pathlib import Path
from typing import Final, Literal

import numpy as np
import pandas as pd

from swaystride.errors import DesignError
from swaystride.io.study_tables import Column, check_participants, read_study_table

TrialNumberCoding = Literal["continue", "reset"]

#: What participants.tsv must hold.
PARTICIPANT_COLUMNS: Final = {
    "participant": Column("text", pattern=r"[^/\\\s]+"),
    "order": Column("text", levels=("concurrent_first", "terminal_first")),
    "age_years": Column("number", minimum=0, maximum=120),
    "sex": Column("text", levels=("F", "M")),
    "height_m": Column("number", minimum=0.5, maximum=2.5),
    "mass_kg": Column("number", minimum=10, maximum=300),
}

#: What trials.tsv must hold; ``exclude`` is the lab's own reason to leave a trial out.
TRIAL_COLUMNS: Final = {
    "participant": Column("text"),
    "session_trial": Column("integer", minimum=1),
    "block": Column("integer", minimum=1, maximum=2),
    "feedback": Column("text", levels=("concurrent", "terminal")),
    "phase": Column("text", levels=("baseline", "training")),
    "set": Column("integer", minimum=1, may_be_empty=True),
    "trial_in_set": Column("integer", minimum=1),
    "feedback_shown": Column("text", levels=("concurrent", "terminal", "none")),
    "file": Column("text"),
    "exclude": Column("text", may_be_empty=True, required=False),
}

#: The numeric 0/1 and count variables that the models are written in.
MODEL_VARIABLES: Final = (
    "order",
    "block",
    "trial_number",
    "concurrent_feedback_removed",
    "terminal_feedback_removed",
    "age",
    "sex",
)


def read_design(folder: Path) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Read and check participants.tsv and trials.tsv.

    Parameters
    ----------
    folder : Path
        ``data/raw/<cohort>/feedback``.

    Returns
    -------
    participants, trials : DataFrame
        ``trials`` gains the column ``trial``, the name of the recording.

    Raises
    ------
    DesignError
        If a table is malformed, or the two contradict each other.
    """
    participants_file, trials_file = folder / "participants.tsv", folder / "trials.tsv"
    participants = read_study_table(participants_file, PARTICIPANT_COLUMNS, unique=["participant"])
    trials = read_study_table(trials_file, TRIAL_COLUMNS, unique=["participant", "session_trial"])
    check_participants(participants, trials, participants_file, trials_file)
    contradiction = (trials["feedback_shown"] != "none") & (
        (trials["feedback_shown"] != trials["feedback"]) | (trials["phase"] == "baseline")
    )
    if contradiction.any():
        row = int(contradiction.to_numpy().argmax())
        raise DesignError(
            "feedback shown contradicts block and phase",
            file=trials_file,
            place=f"line {row + 2}, column feedback_shown",
            expected="none in a baseline, else none or the feedback of the block",
            found=str(trials.loc[row, "feedback_shown"]),
        )
    _check_session_structure(participants, trials, trials_file)
    return participants, with_trial_names(trials)


def with_trial_names(trials: pd.DataFrame) -> pd.DataFrame:
    """Add the column ``trial``, the name of each recording within its participant.

    Parameters
    ----------
    trials : DataFrame
        With ``session_trial``.

    Examples
    --------
    >>> with_trial_names(pd.DataFrame({"session_trial": [3]}))["trial"].tolist()
    ['trial_03']
    """
    return trials.assign(trial=[f"trial_{number:02d}" for number in trials["session_trial"]])


def _check_session_structure(participants: pd.DataFrame, trials: pd.DataFrame, file: Path) -> None:
    """Hold the sequence of blocks against the order of each participant, and files against rows."""
    first_feedback = participants.set_index("participant")["order"].str.removesuffix("_first")
    for participant, session in trials.sort_values("session_trial").groupby("participant"):
        place = f"participant {participant}"
        if not session["block"].is_monotonic_increasing:
            raise DesignError(
                "blocks are mixed within the session", file=file, place=place,
                expected="all trials of block 1 before those of block 2",
            )  # fmt: skip
        for block, rows in session.groupby("block"):
            first = str(first_feedback[participant])
            other = "terminal" if first == "concurrent" else "concurrent"
            expected = first if block == 1 else other
            if (rows["feedback"] != expected).any():
                raise DesignError(
                    "feedback of a block contradicts the order of the participant",
                    file=file,
                    place=f"{place}, block {block}",
                    expected=f"{expected} ({first}_first in participants.tsv)",
                    found=", ".join(sorted(set(rows["feedback"]))),
                )
            if not (rows["phase"] == "training").is_monotonic_increasing:
                raise DesignError(
                    "a baseline trial follows a training trial of its block",
                    file=file,
                    place=f"{place}, block {block}",
                    expected="baseline first",
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


def model_variables(
    participants: pd.DataFrame, trials: pd.DataFrame, *, trial_number_coding: TrialNumberCoding
) -> pd.DataFrame:
    """Derive the variables of the models from the lab's tables.

    The document does not print its coding; the spec infers this one from the printed widths of
    the confidence intervals (spec §8.3, "Coding"):

    * ``order`` 1: terminal feedback first; ``block`` 1: trial in the concurrent block;
    * ``trial_number`` counts the training trials so far, this one included. It is 0 in the first
      baseline, keeps its value in the second (``continue``), or starts anew there (``reset``);
    * ``…_feedback_removed`` 1: training trial of that block without feedback;
    * ``age`` in years; ``sex`` 1: male.

    Parameters
    ----------
    participants, trials : DataFrame
        As from :func:`read_design`.
    trial_number_coding : {"continue", "reset"}

    Returns
    -------
    DataFrame
        One row per trial, sorted by participant and session: ``participant``, ``trial``,
        ``session_trial``, the model variables, and ``block_index``, ``feedback``, ``phase``,
        ``feedback_shown``.
    """
    frame = trials.merge(participants, on="participant", validate="many_to_one")
    frame = frame.sort_values(["participant", "session_trial"], kind="stable", ignore_index=True)
    training = frame["phase"] == "training"
    counted_within = ["participant", "block"] if trial_number_coding == "reset" else ["participant"]
    removed = training & (frame["feedback_shown"] == "none")
    concurrent = frame["feedback"] == "concurrent"
    return pd.DataFrame(
        {
            "participant": frame["participant"],
            "trial": frame["trial"],
            "session_trial": frame["session_trial"],
            "order": (frame["order"] == "terminal_first").astype(np.float64),
            "block": concurrent.astype(np.float64),
            "trial_number": training.groupby([frame[name] for name in counted_within])
            .cumsum()
            .astype(np.float64),
            "concurrent_feedback_removed": (removed & concurrent).astype(np.float64),
            "terminal_feedback_removed": (removed & ~concurrent).astype(np.float64),
            "age": frame["age_years"],
            "sex": (frame["sex"] == "M").astype(np.float64),
            "block_index": frame["block"],
            "feedback": frame["feedback"],
            "phase": frame["phase"],
            "feedback_shown": frame["feedback_shown"],
        }
    )
