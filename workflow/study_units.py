"""Units of work of a study: participants, or the runs of each."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from swaystride.errors import ConfigurationError

#: Studies whose unit is a run of a participant; of all others it is the participant.
RUN_STUDIES = ("experience",)

#: Columns of ``runs.tsv`` that name files.
RUN_FILES = ("imu", "standing", "walking", "ecg", "affect", "events")

#: Studies whose imported recordings are deleted after use.
PASSING_RECORDINGS = ("experience",)


def simulated_units(study: str, protocol: Mapping[str, Any]) -> list[str]:
    """Units of a simulated cohort.

    Parameters
    ----------
    study : str
        Name of the study.
    protocol : mapping
        Plain values of ``simulation.cohort.protocol``.
    """
    if study in RUN_STUDIES:
        return [
            f"P{person:02d}_{run:02d}"
            for person, n_runs in enumerate(protocol["runs_per_participant"], start=1)
            for run in range(1, n_runs + 1)
        ]
    return [f"P{number:02d}" for number in range(1, protocol["n_participants"] + 1)]


def unit_of(study: str, row: Mapping[str, str]) -> str:
    """Unit to which a row of the lab's table belongs."""
    return f"{row['participant']}_{row['run']}" if study in RUN_STUDIES else row["participant"]


def files_of(study: str, row: Mapping[str, str]) -> list[str]:
    """Files that a row of the lab's table names."""
    columns = RUN_FILES if study in RUN_STUDIES else ("file",)
    return [row[column] for column in columns if row.get(column)]


def lab_rows(folder: Path, study: str) -> list[dict[str, str]]:
    """Rows of the lab's table of recordings, as text.

    Parameters
    ----------
    folder : Path
        Raw files of the study.
    study : str
        Name of the study.

    Raises
    ------
    ConfigurationError
        If the table is missing, cannot be read, or lacks a column.
    """
    name, needed = (
        ("runs.tsv", ("participant", "run", "imu"))
        if study in RUN_STUDIES
        else ("trials.tsv", ("participant", "file"))
    )
    path = folder / name
    if not path.is_file():
        raise ConfigurationError(
            f"the cohort has no {name}",
            file=path,
            expected="the table that docs/your-data.md describes",
        )
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows = [
                {key: value or "" for key, value in row.items() if key}
                for row in csv.DictReader(file, delimiter="\t")
            ]
    except UnicodeDecodeError:
        raise ConfigurationError("not readable as text", file=path, expected="UTF-8") from None
    if not rows or not set(needed) <= set(rows[0]):
        raise ConfigurationError(
            f"{name} cannot be used",
            file=path,
            expected=f"tab-separated columns {' and '.join(needed)}, and at least one row",
        )
    return rows
