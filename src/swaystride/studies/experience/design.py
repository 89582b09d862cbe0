"""Design of the study: the lab's tables of people and runs, read, checked, named.

``participants.tsv`` lists the people, ``runs.tsv`` their runs, each with the files that belong to it:
the sensors in the run, in quiet standing and in walking before it, the chest strap, the ratings of
affect, and what happened when.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import pandas as pd

from swaystride.errors import DesignError
from swaystride.io.study_tables import Column, check_participants, read_study_table

_NAME: Final = Column("text", pattern=r"[^/\\\s]+")
_FILE: Final = Column("text")
_OPTIONAL_FILE: Final = Column("text", may_be_empty=True, required=False)

PARTICIPANT_COLUMNS: Final = {
    "participant": _NAME,
    "sex": Column("text", levels=("F", "M")),
    "age_years": Column("number", minimum=0, maximum=120),
    "height_m": Column("number", minimum=0.5, maximum=2.5),
    "mass_kg": Column("number", minimum=10, maximum=300),
    "highest_level": Column("text", may_be_empty=True, required=False),
    "current_level": Column("text", may_be_empty=True, required=False),
}
#: ``exclude`` is the lab's own reason to leave a run out; its files are not read.
RUN_COLUMNS: Final = {
    "participant": _NAME,
    "run": _NAME,
    "imu": _FILE,
    "standing": _OPTIONAL_FILE,
    "walking": _OPTIONAL_FILE,
    "ecg": _OPTIONAL_FILE,
    "affect": _OPTIONAL_FILE,
    "events": _OPTIONAL_FILE,
    "exclude": Column("text", may_be_empty=True, required=False),
}
EVENT_COLUMNS: Final = {
    "start_s": Column("number", minimum=0),
    "stop_s": Column("number", minimum=0, may_be_empty=True),
    "event": Column("text"),
    "sensor": Column("text", may_be_empty=True, required=False),
}
#: Files of a run besides those of the sensors.
FILE_KINDS: Final = ("imu", "standing", "walking", "ecg", "affect", "events")

#: Events after which signals or ratings are not used, and events that are no steady running.
LOSSES: Final = ("data_loss", "poor_attachment")
UNSTEADY: Final = ("turn", "stop")
#: What an event may name besides the label of a sensor.
LOST_RATINGS: Final = "ratings"
LOST_HEART_RATE: Final = "heart rate"


@dataclass(frozen=True)
class RunFiles:
    """One run: whose it is, its files, and why it is left out, if it is.

    Parameters
    ----------
    name : str
        ``<participant>_<run>``.
    participant : str
    files : dict of str to str
        By kind (:data:`FILE_KINDS`), relative to the study's folder; only those that are named.
    exclude : str
        The lab's reason, or nothing.
    """

    name: str
    participant: str
    files: dict[str, str]
    exclude: str


@dataclass(frozen=True, eq=False)
class ExperienceDesign:
    """The tables of one cohort, checked; made by :func:`read_design`.

    Parameters
    ----------
    participants, runs : DataFrame
        In the order of the files.
    """

    participants: pd.DataFrame
    runs: pd.DataFrame

    @property
    def run_names(self) -> list[str]:
        """Names of all runs, in the order of the table."""
        return [f"{p}_{r}" for p, r in zip(self.runs["participant"], self.runs["run"], strict=True)]

    def run(self, name: str) -> RunFiles:
        """One run.

        Parameters
        ----------
        name : str
            ``<participant>_<run>``.

        Raises
        ------
        DesignError
            If there is no such run.
        """
        if name not in self.run_names:
            raise DesignError(
                "no such run",
                file="runs.tsv",
                expected=", ".join(self.run_names),
                found=repr(name),
            )
        row = self.runs.iloc[self.run_names.index(name)]
        files = {kind: str(row[kind]) for kind in FILE_KINDS if row[kind]}
        return RunFiles(name, str(row["participant"]), files, str(row["exclude"]))

    def person(self, participant: str) -> pd.Series[Any]:
        """Row of one participant.

        Parameters
        ----------
        participant : str
        """
        own = self.participants[self.participants["participant"] == participant]
        return own.iloc[0]


def read_design(folder: Path) -> ExperienceDesign:
    """Read and check the two tables of the study.

    Parameters
    ----------
    folder : Path
        ``data/raw/<cohort>/experience``.

    Returns
    -------
    ExperienceDesign

    Raises
    ------
    DesignError
        If a table is malformed, a run stands twice, a participant is unknown or has no runs, two
        runs have one name or name the same recording.
    """
    people_file, runs_file = folder / "participants.tsv", folder / "runs.tsv"
    participants = read_study_table(people_file, PARTICIPANT_COLUMNS, unique=["participant"])
    runs = read_study_table(runs_file, RUN_COLUMNS, unique=["participant", "run"])
    check_participants(participants, runs, people_file, runs_file)
    design = ExperienceDesign(participants, runs)
    used = runs[runs["exclude"] == ""]
    _refuse_repeated(pd.Series(design.run_names), runs.index, "two runs have one name", runs_file)
    for kind in ("imu", "ecg", "affect", "events"):
        named = used.loc[used[kind] != "", kind]
        _refuse_repeated(named, named.index, f"two runs name the same file ({kind})", runs_file)
    return design


def _refuse_repeated(values: pd.Series, lines: pd.Index, problem: str, file: Path) -> None:
    """Refuse a value that stands twice."""
    twice = values.duplicated(keep=False).to_numpy()
    if twice.any():
        first = str(values[twice].iloc[0])
        where = [str(line + 2) for line, value in zip(lines, values, strict=True) if value == first]
        raise DesignError(problem, file=file, place=f"lines {', '.join(where)}", found=first)


def read_events(path: Path, *, name: str) -> pd.DataFrame:
    """Read what happened in a run.

    Parameters
    ----------
    path : Path
        Table with the columns of :data:`EVENT_COLUMNS`.
    name : str
        Of the file, for errors.

    Returns
    -------
    DataFrame
        ``start_s``, ``stop_s`` (missing for an instant, or for a loss until the end), ``event``,
        ``sensor`` (empty: all).

    Raises
    ------
    DesignError
        If the table is malformed or an event stops before it starts.
    """
    events = read_study_table(path, EVENT_COLUMNS, unique=["start_s", "event", "sensor"])
    early = (events["stop_s"] < events["start_s"]).to_numpy()
    if early.any():
        row = int(early.argmax())
        raise DesignError(
            "an event stops before it starts",
            file=name,
            place=f"line {row + 2}",
            expected=f"stop_s of {events['start_s'].iloc[row]:g} or later",
            found=f"{events['stop_s'].iloc[row]:g}",
        )
    return events[list(EVENT_COLUMNS)]
