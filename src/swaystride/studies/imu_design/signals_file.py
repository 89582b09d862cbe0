"""Signals of an imported recording, ready for a trajectory."""

from __future__ import annotations

from pathlib import Path

from swaystride.recording import load_recording, six_axis_signals
from swaystride.signals.gaps import fill_short_gaps
from swaystride.studies.imu_design.conditions import Signals


def load_signals(file: Path, recording: str) -> tuple[Signals, str]:
    """Signals of an imported recording, short gaps filled, and the name of its file.

    Parameters
    ----------
    file : Path
        Recordings of one participant.
    recording : str
        Name of the group.
    """
    stored = load_recording(file, recording)
    six = six_axis_signals(stored)
    # the import has excluded what may not be filled
    filled = fill_short_gaps(six, longest_gap=six.shape[1])
    signals = Signals(filled[:3], filled[3:], float(stored.attrs["rate_hz"]))
    return signals, str(stored.attrs["source_file"])
