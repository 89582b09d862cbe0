"""Import of one participant: every trial read, checked and put on one clock; what fails is listed."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

import pandas as pd
import xarray as xr

from swaystride.findings import FINDING_COLUMNS
from swaystride.recording import save_recordings
from swaystride.studies.kinematics.design import KinematicsDesign
from swaystride.studies.kinematics.equipment import measured_lengths
from swaystride.studies.kinematics.trial_checks import UnusableTrialError
from swaystride.studies.kinematics.trial_import import ImportedTrial, ImportRules, import_trial

EXCLUSION_COLUMNS: Final = ("participant", "trial", "file", "reason", "expected", "found")


@dataclass(frozen=True, eq=False)
class ImportTables:
    """What the import of one participant leaves beside the recordings.

    Parameters
    ----------
    findings, exclusions : DataFrame
        What the checks saw; which trials are left out and why.
    n_usable : int
        Trials that remain.
    """

    findings: pd.DataFrame
    exclusions: pd.DataFrame
    n_usable: int

    @property
    def summary(self) -> str:
        """How many trials, usable and excluded, and findings."""
        return (
            f"{self.n_usable} trials usable, {len(self.exclusions)} excluded, "
            f"{len(self.findings)} findings"
        )


def import_participant(
    participant: str, design: KinematicsDesign, folder: Path, rules: ImportRules, output: Path
) -> ImportTables:
    """Import the trials of one participant and write them as netCDF.

    Parameters
    ----------
    participant : str
    design : KinematicsDesign
    folder : Path
        Where the study's recordings lie.
    rules : ImportRules
    output : Path
        netCDF; of every usable trial the groups ``<trial>/running``, ``/markers``, ``/standing`` and
        ``/standing_markers``.

    Returns
    -------
    ImportTables

    Raises
    ------
    DesignError
        If nobody has this name.
    RecordingError
        If a trial contradicts its labels or the measures of the person; nothing is written then.
    """
    person = measured_lengths(design.person(participant), rules.markers)
    person.check(f"participants.tsv: {participant}")
    groups: dict[str, xr.Dataset] = {}
    findings: list[dict[str, str]] = []
    exclusions: list[dict[str, str]] = []
    n_usable = 0
    for trial in design.trial_names(participant):
        key = {"participant": participant, "trial": trial}
        files = design.files(participant, trial)
        if reason := design.exclusion(participant, trial):
            row = {"file": files.get("running_imu", ""), "reason": reason}
            exclusions.append({**key, **row, "expected": "", "found": ""})
            continue
        try:
            imported = import_trial(files, folder, person, rules)
        except UnusableTrialError as error:
            exclusions.append({**key, **_exclusion(error)})
            continue
        n_usable += 1
        groups |= trial_groups(trial, imported)
        findings += [{**key, **asdict(finding)} for finding in imported.findings]
    save_recordings(output, groups)
    return ImportTables(
        pd.DataFrame(findings, columns=["participant", "trial", *FINDING_COLUMNS]),
        pd.DataFrame(exclusions, columns=list(EXCLUSION_COLUMNS)),
        n_usable,
    )


def trial_groups(trial: str, imported: ImportedTrial) -> dict[str, xr.Dataset]:
    """Groups of the file of one trial.

    Parameters
    ----------
    trial : str
    imported : ImportedTrial
    """
    return {
        f"{trial}/running": imported.running,
        f"{trial}/markers": imported.markers,
        f"{trial}/standing": imported.standing,
        f"{trial}/standing_markers": imported.standing_markers,
    }


def _exclusion(error: UnusableTrialError) -> dict[str, str]:
    """Row of the exclusions."""
    found = ": ".join(filter(None, (error.place, error.found)))
    return {
        "file": str(error.file or ""),
        "reason": error.problem,
        "expected": error.expected or "",
        "found": found,
    }
