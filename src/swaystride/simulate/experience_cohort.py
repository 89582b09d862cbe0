"""The simulated cohort of the experience study: participants, runs, and their patterns."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import pandas as pd

from swaystride.errors import ConfigurationError
from swaystride.simulate.experience_parameters import ExperienceCohort

Pattern = Literal["aerial", "terrestrial"]

#: Files of a run and the ends of their names, in the order of the table.
FILES: Final = {
    "imu": ".h5",
    "standing": "_standing.h5",
    "walking": "_walking.h5",
    "ecg": "_ecg.csv",
    "affect": "_affect.tsv",
    "events": "_events.tsv",
}


@dataclass(frozen=True)
class ExperienceTables:
    """The tables that a lab would keep; ratings and questionnaires are written by others.

    Parameters
    ----------
    participants, runs : DataFrame
        As docs/your-data.md describes them.
    """

    participants: pd.DataFrame
    runs: pd.DataFrame


def participant_names(cohort: ExperienceCohort) -> list[str]:
    """Names of the participants, ``P01`` onwards.

    Parameters
    ----------
    cohort : ExperienceCohort
        Parameters.
    """
    return [f"P{number + 1:02d}" for number in range(len(cohort.protocol.runs_per_participant))]


def run_names(cohort: ExperienceCohort) -> list[str]:
    """Names of all runs, ``P01_01`` onwards.

    Parameters
    ----------
    cohort : ExperienceCohort
        Parameters.
    """
    counts = cohort.protocol.runs_per_participant
    return [
        f"{name}_{number:02d}"
        for name, n in zip(participant_names(cohort), counts, strict=True)
        for number in range(1, n + 1)
    ]


def experience_tables(
    cohort: ExperienceCohort, people: pd.DataFrame, seed: int
) -> ExperienceTables:
    """Participants and runs, as a lab would keep them.

    Parameters
    ----------
    cohort : ExperienceCohort
        Parameters.
    people : DataFrame
        The printed participants, with the columns of ``table_5_1.csv``; the first are taken.
    seed : int
        Seed of the cohort; bodies are printed, so nothing here depends on it.

    Returns
    -------
    ExperienceTables
        One row per person, and one per run.

    Raises
    ------
    ConfigurationError
        If more people are wanted than were printed.
    """
    names = participant_names(cohort)
    if len(names) > len(people):
        raise ConfigurationError(
            "more participants than were printed",
            place="cohort.protocol.runs_per_participant",
            expected=f"at most {len(people)}",
            found=str(len(names)),
        )
    printed = people.iloc[: len(names)].reset_index(drop=True)
    participants = pd.DataFrame(
        {
            "participant": names,
            "sex": printed["sex"],
            "age_years": printed["age"],
            "height_m": printed["height_cm"] / 100.0,
            "mass_kg": printed["mass_kg"],
            "highest_level": printed["highest_level"],
            "current_level": printed["current_level"],
        }
    )
    rows = []
    for name in run_names(cohort):
        participant, run = name.split("_")
        row = {"participant": participant, "run": run}
        row |= {kind: f"{participant}/{name}{end}" for kind, end in FILES.items()}
        if name in cohort.losses.heart_rate_runs:
            row["ecg"] = ""
        rows.append(row | {"exclude": ""})
    return ExperienceTables(participants, pd.DataFrame(rows))


def pattern_of(run: str, cohort: ExperienceCohort) -> Pattern:
    """Global running pattern of a run.

    Parameters
    ----------
    run : str
        Name, as ``P01_01``.
    cohort : ExperienceCohort
        Parameters.
    """
    return "terrestrial" if run in cohort.protocol.terrestrial_runs else "aerial"
