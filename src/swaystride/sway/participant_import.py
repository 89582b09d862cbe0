"""Import of all standing trials of one participant from a study's table of trials."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from swaystride.recording import save_recordings
from swaystride.sway.trial_import import ImportedTrials, RecordingRules, import_trials


@dataclass(frozen=True)
class ImportFiles:
    """Where the import of one participant is written.

    Parameters
    ----------
    recordings : Path
        netCDF, one group per usable trial.
    findings, exclusions : Path
        CSV, with the participant in front.
    """

    recordings: Path
    findings: Path
    exclusions: Path


def import_participant(
    participant: str,
    trials: pd.DataFrame,
    folder: Path,
    rules: RecordingRules,
    files: ImportFiles,
) -> ImportedTrials:
    """Import the trials of one participant and write recordings, findings and exclusions.

    Parameters
    ----------
    participant : str
        Name in `trials`.
    trials : DataFrame
        Of all participants, in the order of the session: ``participant``, ``trial`` (name of the
        recording), ``file`` (relative to `folder`) and ``exclude`` (the lab's own reason to leave
        the trial out, or empty).
    folder : Path
        Where the study's recordings lie.
    rules : RecordingRules
        When a trial can be used.
    files : ImportFiles
        What is written.

    Returns
    -------
    ImportedTrials
        ``findings`` and ``exclusions`` have the participant in front.

    Raises
    ------
    RecordingError
        If a file is missing or is not a usable recording; nothing is written then.
    """
    own = trials[trials["participant"] == participant].set_index("trial")
    imported = import_trials(
        {str(trial): Path(file) for trial, file in own["file"].items()},
        folder,
        rules,
        {str(t): str(why) for t, why in own["exclude"].items() if why != ""},
    )
    save_recordings(files.recordings, imported.recordings)
    for table, path in (
        (imported.findings, files.findings),
        (imported.exclusions, files.exclusions),
    ):
        table.insert(0, "participant", participant)
        table.to_csv(path, index=False, lineterminator="\n")
    return imported


def read_quality_tables(folder: Path, participants: Sequence[str]) -> pd.DataFrame:
    """Join the findings, or the exclusions, of several participants.

    Parameters
    ----------
    folder : Path
        Holds ``<participant>.csv`` as from :func:`import_participant`.
    participants : sequence of str
        Whose tables are joined, in this order.

    Returns
    -------
    DataFrame
        All cells as text.
    """
    files = [folder / f"{name}.csv" for name in participants]
    tables = [pd.read_csv(file, dtype=str, keep_default_na=False) for file in files]
    return pd.concat(tables, ignore_index=True)
