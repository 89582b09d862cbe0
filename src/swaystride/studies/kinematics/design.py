"""Design of the study: the lab's tables of people and recordings, read, checked, named.

``participants.tsv`` lists the people with what was measured on them, ``trials.tsv`` the recordings:
one row per trial and kind. A trial has inertial sensors and markers, in running and in the quiet
standing before it.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import pandas as pd

from swaystride.errors import DesignError
from swaystride.io.study_tables import Column, check_participants, read_study_table

#: Kinds of recordings of a trial.
KINDS: Final = ("running_imu", "running_markers", "standing_imu", "standing_markers")

_NAME: Final = Column("text", pattern=r"[^/\\\s]+")
_LENGTH: Final = Column("number", minimum=0.001, maximum=5.0)

PARTICIPANT_COLUMNS: Final = {
    "participant": _NAME,
    "sex": Column("text", levels=("F", "M")),
    "age_years": Column("number", minimum=0, maximum=120),
    "height_m": Column("number", minimum=0.5, maximum=2.5),
    "mass_kg": Column("number", minimum=10, maximum=300),
    "leg_length_right_m": _LENGTH,
    "leg_length_left_m": _LENGTH,
    "knee_width_right_m": _LENGTH,
    "knee_width_left_m": _LENGTH,
    "ankle_width_right_m": _LENGTH,
    "ankle_width_left_m": _LENGTH,
    "years_running": Column("text", may_be_empty=True),
    "typical_pace_min_per_km": Column("text", may_be_empty=True),
    "race_5km_min": Column("text", may_be_empty=True),
}
#: ``belt_speed_m_s`` is nil in standing. ``exclude`` is the lab's own reason to leave a trial out; it
#: may stand in any of its rows, and its files are not read.
TRIAL_COLUMNS: Final = {
    "participant": _NAME,
    "trial": _NAME,
    "kind": Column("text", levels=KINDS),
    "file": Column("text"),
    "belt_speed_m_s": Column("number", minimum=0, maximum=20),
    "exclude": Column("text", may_be_empty=True, required=False),
}


@dataclass(frozen=True, eq=False)
class KinematicsDesign:
    """The tables of one cohort, checked; made by :func:`read_design`.

    Parameters
    ----------
    participants, trials : DataFrame
        In the order of the files.
    """

    participants: pd.DataFrame
    trials: pd.DataFrame

    def person(self, participant: str) -> pd.Series[Any]:
        """Row of one participant.

        Parameters
        ----------
        participant : str

        Raises
        ------
        DesignError
            If nobody has this name.
        """
        own = self.participants[self.participants["participant"] == participant]
        if own.empty:
            raise DesignError(
                "no such participant",
                file="participants.tsv",
                expected=", ".join(map(str, self.participants["participant"])),
                found=repr(participant),
            )
        return own.iloc[0]

    def trial_names(self, participant: str) -> list[str]:
        """Trials of a participant, in the order of the file.

        Parameters
        ----------
        participant : str
        """
        own = self.trials[self.trials["participant"] == participant]
        return [str(name) for name in own["trial"].drop_duplicates()]

    def files(self, participant: str, trial: str) -> dict[str, str]:
        """Files of a trial by kind; a kind without a row is not in it.

        Parameters
        ----------
        participant, trial : str
        """
        own = self._rows(participant, trial)
        return {str(k): str(f) for k, f in zip(own["kind"], own["file"], strict=True)}

    def belt_speed_m_s(self, participant: str, trial: str) -> float:
        """Speed of the belt in a trial.

        Parameters
        ----------
        participant, trial : str
        """
        own = self._rows(participant, trial)
        running = own[own["kind"] == "running_imu"]
        return float(running["belt_speed_m_s"].iloc[0]) if len(running) else 0.0

    def exclusion(self, participant: str, trial: str) -> str:
        """The lab's reason to leave a trial out, or nothing.

        Parameters
        ----------
        participant, trial : str
        """
        reasons = [str(why) for why in self._rows(participant, trial)["exclude"] if why]
        return reasons[0] if reasons else ""

    def _rows(self, participant: str, trial: str) -> pd.DataFrame:
        """Rows of a trial."""
        table = self.trials
        return table[(table["participant"] == participant) & (table["trial"] == trial)]


def read_design(folder: Path) -> KinematicsDesign:
    """Read and check the two tables of the study.

    Parameters
    ----------
    folder : Path
        ``data/raw/<cohort>/kinematics``.

    Returns
    -------
    KinematicsDesign

    Raises
    ------
    DesignError
        If a table is malformed, a participant is unknown or has no trials, a file is named twice, or both
        recordings of a run tell another speed of the belt.
    """
    people_file, trials_file = folder / "participants.tsv", folder / "trials.tsv"
    participants = read_study_table(people_file, PARTICIPANT_COLUMNS, unique=["participant"])
    trials = read_study_table(trials_file, TRIAL_COLUMNS, unique=["participant", "trial", "kind"])
    check_participants(participants, trials, people_file, trials_file)
    running = trials[trials["kind"].str.startswith("running")]
    speeds = running.groupby(["participant", "trial"], sort=False)["belt_speed_m_s"]
    differs = running[speeds.transform("nunique") > 1]
    if len(differs):
        raise DesignError(
            "one run has two speeds of the belt",
            file=trials_file,
            place=f"lines {differs.index[0] + 2} and {differs.index[1] + 2}, column belt_speed_m_s",
            found=" and ".join(f"{speed:g}" for speed in differs["belt_speed_m_s"].iloc[:2]),
        )
    # one standing recording may serve several trials
    used = trials[(trials["exclude"] == "") & trials["kind"].str.startswith("running")]
    shared = used["file"].duplicated(keep=False)
    if shared.any():
        name = used.loc[shared, "file"].iloc[0]
        raise DesignError(
            "two trials name the same file",
            file=trials_file,
            place=f"lines {', '.join(str(i + 2) for i in used.index[used['file'] == name])}",
            found=name,
        )
    return KinematicsDesign(participants, trials)
