"""Both feet of one walk of 2 × 20 m against optical markers.

Example recording of gaitmap (Küderle et al. 2024): two foot sensors at 204.8 Hz, markers on each
foot at 100 Hz, started together. Sensor z points up, as it must for gaitmap; the angular rate is in
degrees per second.

Which marker. Nobody says where on the shoe the sensor sat, and the displacement of a sensor differs
from that of a marker wherever the foot turns between two instants. The reference is the heel marker
(FCC, on the calcaneus): it sits on a stiff part of the shoe and is the slowest of the three at the
given instants (0.008 m/s; toe 0.02 m/s). The marker at the fifth metatarsal (FM5) and the toe
marker are reported beside it. They agree within a few millimetres except in the turns: where the
left foot turns by 166° in one stride they differ by 0.19 m.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from swaystride.errors import RecordingError
from swaystride.units import to_si
from swaystride.validation.foot_recording import (
    FloatArray,
    FootRecording,
    check_foot_signals,
    displacements,
)
from swaystride.validation.manifest import verified_files

DATASET: Final = "foot_imu_mocap_walk"

#: Rates as the authors state them; the files hold no time.
RATE_HZ: Final = 204.8
MARKER_RATE_HZ: Final = 100.0

#: Marker whose displacement is the reference, and the others.
HEEL_MARKER: Final = "FCC"
OTHER_MARKERS: Final = ("TOE", "FM5")

FEET: Final = ("left", "right")


def mocap_recordings(folder: Path) -> list[FootRecording]:
    """Left and right foot.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.
    """
    paths = {path.name: path for path in verified_files(folder, DATASET)}
    return read_mocap_walk(
        paths["imu_sample.csv"], paths["mocap_sample.csv"], paths["stride_events_sample.csv"]
    )


def read_mocap_walk(imu: Path, markers: Path, events: Path) -> list[FootRecording]:
    """Left and right foot from three files.

    Parameters
    ----------
    imu : Path
        Two header rows (sensor, axis), then m/s² and °/s.
    markers : Path
        Two header rows (marker, axis), then mm.
    events : Path
        ``foot``, and ``start`` and ``end`` of each stride in samples of the sensor.

    Raises
    ------
    RecordingError
        If a column is missing, or strides do not follow each other without a gap.
    """
    signals, positions = (pd.read_csv(path, header=[0, 1], index_col=0) for path in (imu, markers))
    strides = pd.read_csv(events)
    return [_foot(foot, (imu, signals), (markers, positions), (events, strides)) for foot in FEET]


def _foot(
    foot: str,
    signals: tuple[Path, pd.DataFrame],
    positions: tuple[Path, pd.DataFrame],
    strides: tuple[Path, pd.DataFrame],
) -> FootRecording:
    """One foot; each table comes with its path."""
    sensor, side = f"{foot}_sensor", foot[0].upper()
    acc = _columns(signals, sensor, "acc_")
    gyr = to_si(_columns(signals, sensor, "gyr_"), "deg/s", "angular_rate")
    instants_s = _instants(foot, strides) / RATE_HZ
    paths_m = {
        name: _columns(positions, f"{side}_{name}")[:2] / 1000.0
        for name in (HEEL_MARKER, *OTHER_MARKERS)
    }
    path_s = np.arange(paths_m[HEEL_MARKER].shape[1]) / MARKER_RATE_HZ
    if path_s[-1] < instants_s[-1]:
        raise RecordingError(
            "markers end before the last stride",
            file=positions[0],
            expected=f"at least {instants_s[-1]:.2f} s",
            found=f"{path_s[-1]:.2f} s",
        )
    moved_m = {name: displacements(path, path_s, instants_s) for name, path in paths_m.items()}
    recording = FootRecording(
        dataset=DATASET,
        trial=foot,
        gait="walk",
        rate_hz=RATE_HZ,
        acc_m_s2=acc,
        gyr_rad_s=gyr,
        instants_s=instants_s,
        reference_m=moved_m.pop(HEEL_MARKER),
        path_s=path_s,
        path_m=paths_m[HEEL_MARKER],
        other_references_m=moved_m,
    )
    check_foot_signals(recording, file=f"{signals[0].name}, {foot} foot")
    return recording


def _columns(table: tuple[Path, pd.DataFrame], name: str, prefix: str = "") -> FloatArray:
    """The three axes of one sensor or marker, shape (3, n)."""
    path, frame = table
    wanted = [(name, f"{prefix}{axis}") for axis in "xyz"]
    missing = [" ".join(column) for column in wanted if column not in frame.columns]
    if missing:
        raise RecordingError(
            "columns are missing", file=path, expected=", ".join(map(" ".join, wanted)),
            found="no " + ", ".join(missing),
        )  # fmt: skip
    return np.ascontiguousarray(frame[wanted].to_numpy(dtype=np.float64).T)


def _instants(foot: str, table: tuple[Path, pd.DataFrame]) -> FloatArray:
    """Starts of all strides of a foot and the end of the last, in samples."""
    path, frame = table
    missing = {"foot", "start", "end"} - set(frame.columns)
    if missing:
        raise RecordingError(
            "columns are missing", file=path, expected="foot, start, end",
            found="no " + ", ".join(sorted(missing)),
        )  # fmt: skip
    start, end = frame.loc[frame["foot"] == foot, ["start", "end"]].to_numpy(dtype=float).T
    if len(start) == 0:
        raise RecordingError("no strides", file=path, expected=f"rows of the {foot} foot")
    broken = np.flatnonzero(start[1:] != end[:-1])
    if len(broken):
        raise RecordingError(
            "strides do not follow each other",
            file=path,
            place=f"{foot} foot, stride {broken[0] + 2}",
            expected=f"start at {end[broken[0]]:g}, where the one before ends",
            found=f"{start[broken[0] + 1]:g}",
        )
    return np.append(start, end[-1])
