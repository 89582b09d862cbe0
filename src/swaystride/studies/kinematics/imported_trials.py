"""Imported recordings of one trial, as the stages after the import take them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from swaystride.marker_recording import MarkerRecording
from swaystride.recording import Recording, load_recording


@dataclass(frozen=True, eq=False)
class TrialRecordings:
    """Imported recordings of one trial (:mod:`swaystride.studies.kinematics.importing`)."""

    running: Recording
    markers: MarkerRecording
    standing: Recording
    standing_markers: MarkerRecording


def load_trial(path: Path, trial: str) -> TrialRecordings:
    """Imported recordings of one trial.

    Parameters
    ----------
    path : Path
        From :func:`swaystride.studies.kinematics.importing.import_participant`.
    trial : str
        Its name.

    Returns
    -------
    TrialRecordings
    """
    return TrialRecordings(
        running=load_recording(path, f"{trial}/running"),
        markers=load_recording(path, f"{trial}/markers"),
        standing=load_recording(path, f"{trial}/standing"),
        standing_markers=load_recording(path, f"{trial}/standing_markers"),
    )
