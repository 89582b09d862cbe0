"""Markers of the real runners of ``running_markers_grf`` as marker recordings in world axes.

Fukuchi, Fukuchi and Duarte (2017), PeerJ 5:e3298, CC BY 4.0: treadmill, 150 Hz, X forward, Y up, Z
right, mm. Times in the files are rounded; the rate is known. Thighs, shanks and feet carry clusters
of four or five markers; medial landmarks are in the static trials only.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.io.c3d import read_c3d
from swaystride.marker_recording import MarkerRecording, make_marker_recording
from swaystride.mocap.anthropometrics import Anthropometrics
from swaystride.mocap.marker_set import LegMarkers, MarkerSet, in_world_axes, points
from swaystride.units import GRAVITY_M_S2
from swaystride.validation.manifest import verified_files

Array = NDArray[np.float64]

MARKERS: Final = "running_markers_grf"
RATE_HZ: Final = 150.0
FORCE_RATE_HZ: Final = 300.0
#: Forward, left and up in axes of the laboratory.
_LABORATORY: Final = ("x", "-z", "y")
#: Marker radius and base plate are not published; [N], used for the hip centre only.
MARKER_RADIUS_M: Final = 0.007
BASE_PLATE_M: Final = 0.002


def _leg(letter: str) -> LegMarkers:
    def plate(segment: str) -> tuple[str, ...]:
        corners = ("Top.Lateral", "Bottom.Lateral", "Top.Medial", "Bottom.Medial")
        return tuple(f"{letter}.{segment}.{corner}" for corner in corners)

    return LegMarkers(
        knee=f"{letter}.Knee",
        ankle=f"{letter}.Ankle",
        heel=f"{letter}.Heel.Bottom",
        toe=f"{letter}.MT2",
        thigh=plate("Thigh"),
        shank=plate("Shank"),
        foot=(
            f"{letter}.Heel.Top",
            f"{letter}.Heel.Bottom",
            f"{letter}.Heel.Lateral",
            f"{letter}.MT1",
            f"{letter}.MT5",
        ),
        knee_medial=f"{letter}.Knee.Medial",
        ankle_medial=f"{letter}.Ankle.Medial",
    )


#: Mass by the force plates at 2.5 m/s.
_MASS_KG: Final = {"RBDS001": 60.9}
#: Clusters on all segments of the legs.
CLUSTERS: Final = MarkerSet(
    front=("R.ASIS", "L.ASIS"),
    back=("R.PSIS", "L.PSIS"),
    right=_leg("R"),
    left=_leg("L"),
    tracking="cluster",
)
#: Markers from which the events of a foot are found.
FOOT_MARKERS: Final = {
    side: {
        "heel": (f"{letter}.Heel.Bottom", f"{letter}.Heel.Lateral"),
        "toe": (f"{letter}.MT1", f"{letter}.MT5"),
    }
    for side, letter in (("right", "R"), ("left", "L"))
}


@dataclass(frozen=True)
class RealRun:
    """One treadmill trial of a real runner.

    Parameters
    ----------
    runner : str
        Whose.
    speed_m_s : float
        Of the belt.
    static, markers : str
        Files.
    forces : str or None
        File of the force plates, if there is one.
    exchanged : tuple of (str, str)
        Labels that are exchanged in the file, as the shape of the foot shows.
    processed : str
        Files of the authors' mean curves, the tag of this speed being ten times the speed.
    """

    runner: str
    speed_m_s: float
    static: str
    markers: str
    forces: str | None
    exchanged: tuple[tuple[str, str], ...]
    processed: str

    @property
    def label(self) -> str:
        """Runner and speed."""
        return f"{self.runner} at {self.speed_m_s:g} m/s"


#: On the right foot of RBDS001 the markers of both running trials carry each other's names.
_EXCHANGED: Final = (("R.MT1", "R.MT5"),)
RUNS: Final = (
    RealRun("RBDS001", 2.5, "RBDS001static.txt", "RBDS001runT25markers.txt",
            "RBDS001runT25forces.txt", _EXCHANGED, "RBDS001processed.txt"),
    RealRun("RBDS001", 3.5, "RBDS001static.txt", "RBDS001runT35.c3d",
            "RBDS001runT35.c3d", _EXCHANGED,
            "RBDS001processed.txt"),
    RealRun("RBDS0041", 2.5, "RBDS0041static.txt", "RBDS0041runT252.txt",
            "RBDS0041runT252forces.txt", (), "RBDS0041processed.txt"),
    RealRun("RBDS0041", 3.5, "RBDS0041static.txt", "RBDS0041runT352.txt", None, (),
            "RBDS0041processed.txt"),
)  # fmt: skip


def runner_file(folder: Path, name: str) -> Path:
    """Verified path of one file of the data set.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.
    name : str

    Raises
    ------
    RecordingError
        If the manifest does not list it.
    """
    paths = _verified(folder)
    if name not in paths:
        raise RecordingError("not in the manifest", file=name, expected=", ".join(paths))
    return paths[name]


@cache
def _verified(folder: Path) -> dict[str, Path]:
    """Files by their names; every byte is checked once."""
    return {path.name: path for path in verified_files(folder, MARKERS)}


def read_markers(path: Path) -> MarkerRecording:
    """Read a table of markers.

    Parameters
    ----------
    path : Path
        Tab-separated with three columns per marker, or C3D.

    Returns
    -------
    MarkerRecording
        World axes: x forward, y left, z up.
    """
    if path.suffix == ".c3d":
        return in_world_axes(read_c3d(path), _LABORATORY)
    table = pd.read_csv(path, sep="\t")
    names = [name[:-1] for name in table.columns if name.endswith("X")]
    position = np.stack(
        [table[[f"{name}{axis}" for axis in "XYZ"]].to_numpy(np.float64).T for name in names]
    )
    recording = make_marker_recording(
        position / 1e3,
        markers=names,
        rate_hz=RATE_HZ,
        rate_source="description of the data set",
        file_unit="mm",
        source_file=path.name,
    )
    return in_world_axes(recording, _LABORATORY)


def measured(static: MarkerRecording) -> Anthropometrics:
    """Measures of a runner from the markers of the static trial, between the markers' inner sides.

    Parameters
    ----------
    static : MarkerRecording
        With medial landmarks.

    Returns
    -------
    Anthropometrics
    """
    legs, knees, ankles = [], [], []
    off_m = 2.0 * (MARKER_RADIUS_M + BASE_PLATE_M)
    for row, leg in enumerate((CLUSTERS.right, CLUSTERS.left)):
        names = (CLUSTERS.front[row], leg.knee, str(leg.knee_medial), leg.ankle,
                 str(leg.ankle_medial))  # fmt: skip
        spine, knee, knee_medial, ankle, ankle_medial = np.nanmedian(points(static, names), axis=1)
        legs.append(float(np.linalg.norm(spine - ankle_medial)))
        knees.append(float(np.linalg.norm(knee - knee_medial)) - off_m)
        ankles.append(float(np.linalg.norm(ankle - ankle_medial)) - off_m)
    return Anthropometrics(
        (legs[0], legs[1]),
        (knees[0], knees[1]),
        (ankles[0], ankles[1]),
        MARKER_RADIUS_M,
        BASE_PLATE_M,
    )


def vertical_force(folder: Path, run: RealRun) -> Array:
    """Vertical force of a trial without its offset, N at 300 Hz.

    The C3D file holds raw voltages; over whole strides the mean vertical force is body weight, which
    gives the scale.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.
    run : RealRun
        With force plates.
    """
    path = runner_file(folder, str(run.forces))
    if path.suffix == ".c3d":
        volts = -read_c3d(path)["analog"].sel(channel="F1Z").to_numpy()
        volts = volts - np.percentile(volts, 5)
        return np.asarray(volts * _MASS_KG[run.runner] * GRAVITY_M_S2 / volts.mean())
    force = pd.read_csv(path, sep="\t")["Fy"].to_numpy(dtype=np.float64)
    return np.asarray(force - np.percentile(force, 5))


def relabelled(
    recording: MarkerRecording, exchanged: tuple[tuple[str, str], ...]
) -> MarkerRecording:
    """Give pairs of markers each other's names.

    Parameters
    ----------
    recording : MarkerRecording
    exchanged : tuple of (str, str)

    Returns
    -------
    MarkerRecording
        A copy.
    """
    new = {a: b for pair in exchanged for a, b in (pair, pair[::-1])}
    names = [new.get(str(name), str(name)) for name in recording["marker"].to_numpy()]
    return recording.assign_coords(marker=names)
