"""Design of the study: the lab's tables of people and recordings, read, checked, named.

``participants.tsv`` lists the people, ``trials.tsv`` the recordings: one row per trial, foot and
IMU. ``imu_1`` is the one of large range, ``imu_2`` the one of high rate.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final, Literal

import pandas as pd

from swaystride.errors import DesignError
from swaystride.findings import FINDING_COLUMNS, Finding
from swaystride.io.study_tables import Column, check_participants, read_study_table

Foot = Literal["left", "right"]
Imu = Literal["imu_1", "imu_2"]

FEET: Final[tuple[Foot, ...]] = ("left", "right")
IMUS: Final[tuple[Imu, ...]] = ("imu_1", "imu_2")

_NAME: Final = Column("text", pattern=r"[^/\\\s]+")

PARTICIPANT_COLUMNS: Final = {
    "participant": _NAME,
    "sex": Column("text", levels=("F", "M")),
    "age_years": Column("number", minimum=0, maximum=120),
    "height_m": Column("number", minimum=0.5, maximum=2.5),
    "mass_kg": Column("number", minimum=10, maximum=300),
}
#: ``exclude`` is the lab's own reason to leave a recording out; its file is not read.
TRIAL_COLUMNS: Final = {
    "participant": _NAME,
    "trial": _NAME,
    "foot": Column("text", levels=FEET),
    "imu": Column("text", levels=IMUS),
    "file": Column("text"),
    "distance_m": Column("number", minimum=1, maximum=100_000),
    "exclude": Column("text", may_be_empty=True, required=False),
}

#: What names a recording.
KEYS: Final = ("participant", "trial", "foot", "imu")


@dataclass(frozen=True, eq=False)
class ImuDesign:
    """The tables of one cohort, checked; made by :func:`read_design`.

    Parameters
    ----------
    participants, trials : DataFrame
        In the order of the files. ``trials`` gains ``recording``, the name of each recording
        within its participant.
    """

    participants: pd.DataFrame
    trials: pd.DataFrame


def read_design(folder: Path) -> ImuDesign:
    """Read and check the two tables of the study.

    Parameters
    ----------
    folder : Path
        ``data/raw/<cohort>/imu_design``.

    Raises
    ------
    DesignError
        If a table is malformed, a participant is unknown or has no trials, the distance of a trial
        is given twice and differs, or two recordings name one file. What is merely incomplete is
        listed by :func:`design_findings`.
    """
    people_file, trials_file = folder / "participants.tsv", folder / "trials.tsv"
    participants = read_study_table(people_file, PARTICIPANT_COLUMNS, unique=["participant"])
    trials = read_study_table(trials_file, TRIAL_COLUMNS, unique=KEYS)
    check_participants(participants, trials, people_file, trials_file)
    _check_distances(trials, trials_file)
    _check_files(trials, trials_file)
    return ImuDesign(participants, with_recording_names(trials))


def with_recording_names(trials: pd.DataFrame) -> pd.DataFrame:
    """Add the column ``recording``, the name of each recording within its participant.

    Parameters
    ----------
    trials : DataFrame
        With ``trial``, ``foot`` and ``imu``.

    Examples
    --------
    >>> trials = pd.DataFrame({"trial": ["04"], "foot": ["left"], "imu": ["imu_2"]})
    >>> with_recording_names(trials)["recording"].tolist()
    ['trial_04_left_imu_2']
    """
    parts = zip(trials["trial"], trials["foot"], trials["imu"], strict=True)
    return trials.assign(recording=[f"trial_{trial}_{foot}_{imu}" for trial, foot, imu in parts])


def usable_trials(trials: pd.DataFrame, recordings: list[str]) -> pd.DataFrame:
    """Rows of one participant whose recording was imported.

    Parameters
    ----------
    trials : DataFrame
        Rows of one participant, as in :class:`ImuDesign`.
    recordings : list of str
        Names of the recordings that the import kept.
    """
    return trials[trials["recording"].isin(recordings)].reset_index(drop=True)


def design_findings(design: ImuDesign) -> pd.DataFrame:
    """What is missing from the plan of two IMUs on both feet: no error, but to be known.

    Parameters
    ----------
    design : ImuDesign

    Returns
    -------
    DataFrame
        ``participant``, ``trial`` and the columns of a finding. A foot without any recording of a
        trial is one finding, a foot without one of its IMUs another.
    """
    rows = []
    kept = design.trials[design.trials["exclude"] == ""]
    there = set(kept[list(KEYS)].itertuples(index=False, name=None))
    trials = design.trials[["participant", "trial"]].drop_duplicates()
    for participant, trial in trials.itertuples(index=False, name=None):
        for foot in FEET:
            missing = [imu for imu in IMUS if (participant, trial, foot, imu) not in there]
            if not missing:
                continue
            whole = len(missing) == len(IMUS)
            finding = Finding(
                "missing_foot" if whole else "missing_imu",
                "warning",
                "trials.tsv",
                f"trial {trial}, {foot} foot",
                "both feet" if whole else "imu_1 and imu_2",
                "the other foot alone" if whole else f"no {missing[0]}",
            )
            rows.append({"participant": participant, "trial": trial, **asdict(finding)})
    return pd.DataFrame(rows, columns=["participant", "trial", *FINDING_COLUMNS])


def _check_distances(trials: pd.DataFrame, file: Path) -> None:
    """All recordings of one trial cover one known distance."""
    for (participant, trial), rows in trials.groupby(["participant", "trial"], sort=False):
        distances = rows["distance_m"].unique()
        if len(distances) > 1:
            raise DesignError(
                "one trial has two distances",
                file=file,
                place=f"participant {participant}, trial {trial}",
                expected="the same distance_m for both feet and both IMUs",
                found=", ".join(f"{value:g}" for value in distances),
            )


def _check_files(trials: pd.DataFrame, file: Path) -> None:
    """A recording belongs to one foot and one IMU."""
    used = trials[trials["exclude"] == ""]
    shared = used["file"].duplicated(keep=False)
    if shared.any():
        name = used.loc[shared, "file"].iloc[0]
        raise DesignError(
            "two recordings name the same file",
            file=file,
            place=f"lines {', '.join(str(i + 2) for i in used.index[used['file'] == name])}",
            found=name,
        )
