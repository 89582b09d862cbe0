"""Stride lengths that another package found on the same recordings, read from its table.

``scripts/peers_gaitmap.py`` writes the table in an environment of its own (``make peers``).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from swaystride.errors import RecordingError
from swaystride.validation.foot_recording import FloatArray, FootRecording

COLUMNS: Final = ("trial", "stride", "start_s", "stop_s", "length_m")
#: Instants of both tables must be the same samples.
_SAME_INSTANT_S: Final = 0.006


def peer_lengths(
    path: Path | None, recordings: Sequence[FootRecording]
) -> Mapping[str, FloatArray]:
    """Stride lengths of the peer by trial; empty if there is no table.

    Parameters
    ----------
    path : Path or None
        CSV with the columns :data:`COLUMNS`, strides of a trial counted from 1.
    recordings : sequence of FootRecording
        What the table must cover.

    Raises
    ------
    RecordingError
        If the table lacks a column or a trial, or was computed at other instants.
    """
    if path is None or not path.is_file():
        return {}
    table = pd.read_csv(path, dtype={"trial": str})
    missing = set(COLUMNS) - set(table.columns)
    if missing:
        raise RecordingError(
            "columns are missing", file=path, expected=", ".join(COLUMNS),
            found="no " + ", ".join(sorted(missing)),
        )  # fmt: skip
    by_trial = {str(name): rows.sort_values("stride") for name, rows in table.groupby("trial")}
    return {
        recording.trial: _lengths(by_trial.get(recording.trial), recording, path)
        for recording in recordings
    }


def _lengths(rows: pd.DataFrame | None, recording: FootRecording, path: Path) -> FloatArray:
    """Lengths of one trial, after a check of its instants."""
    n_strides = len(recording.reference_m)
    if rows is None or len(rows) != n_strides:
        raise RecordingError(
            "strides are missing",
            file=path,
            place=f"trial {recording.trial}",
            expected=str(n_strides),
            found=str(0 if rows is None else len(rows)),
        )
    given = np.stack([recording.instants_s[:-1], recording.instants_s[1:]], axis=1)
    apart = np.abs(rows[["start_s", "stop_s"]].to_numpy(dtype=float) - given).max(axis=1)
    if np.any(apart > _SAME_INSTANT_S):
        worst = int(np.argmax(apart))
        raise RecordingError(
            "computed between other instants",
            file=path,
            place=f"trial {recording.trial}, stride {worst + 1}",
            expected=f"start at {given[worst, 0]:.3f} s",
            found=f"{rows['start_s'].iloc[worst]:.3f} s",
        )
    return rows["length_m"].to_numpy(dtype=np.float64)
