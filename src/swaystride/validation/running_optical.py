"""Real runners through the optical side: joint angles, contacts by markers and by force plates."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray
from scipy.signal import butter, sosfiltfilt

from swaystride.lower_limb_joints import ANGLES, Side
from swaystride.marker_recording import MarkerRecording
from swaystride.mocap.foot_events import RUNNING_CONTACT, ContactRule, foot_contacts
from swaystride.mocap.joint_axes import public_joint_axes
from swaystride.mocap.marker_cleaning import PRINTED_CLEANING, clean_markers
from swaystride.mocap.marker_gaps import PRINTED_LIMITS, fill_gaps
from swaystride.mocap.marker_set import SIDES, points
from swaystride.mocap.optical_angles import optical_joint_angles
from swaystride.mocap.static_calibration import OpticalOptions
from swaystride.units import DEG_PER_RAD
from swaystride.validation.running_optical_recording import (
    CLUSTERS,
    FOOT_MARKERS,
    FORCE_RATE_HZ,
    RUNS,
    RealRun,
    measured,
    read_markers,
    relabelled,
    runner_file,
    vertical_force,
)

Array = NDArray[np.float64]

#: Samples over a stride, both ends included.
N_PHASES: Final = 101
#: A foot is on the plate above this force, after a low-pass.
CONTACT_N: Final = 50.0
CONTACT_HZ: Final = 30.0
#: A time between contacts of one foot that spans two strides is longer than this share of one.
ONE_STRIDE: Final = 1.3
_AXES: Final = dict(zip(ANGLES, "ZXY", strict=True))
#: Knee and ankle centres midway between the landmarks, as the authors had them.
MEDIAL: Final = OpticalOptions("medial_markers", "least_squares", True, "malleoli")
#: Recipe of the knee axis frame that the document uses.
RECIPE: Final = "spine_plane"
AVERAGE: Final = OpticalOptions("average_axes", "least_squares", True, "malleoli")


@dataclass(frozen=True, eq=False)
class OpticalRun:
    """A trial with everything found in it.

    Parameters
    ----------
    run : RealRun
    recording : MarkerRecording
        As it is in the file, with labels exchanged back.
    angles : dict of str to xarray.Dataset
        By the way to the joint centres.
    contacts : dict of str to DataFrame
        By side, from the markers.
    plates : dict of str to DataFrame
        By side, from the force plates; empty without them.
    """

    run: RealRun
    recording: MarkerRecording
    angles: dict[str, xr.Dataset]
    contacts: dict[str, pd.DataFrame]
    plates: dict[str, pd.DataFrame]

    @property
    def rate_hz(self) -> float:
        """Frames per second."""
        return float(self.recording.attrs["rate_hz"])


@cache
def optical_runs(folder: Path) -> tuple[OpticalRun, ...]:
    """All trials of the real runners.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.
    """
    return tuple(_optical_run(folder, run) for run in RUNS)


def _optical_run(folder: Path, run: RealRun) -> OpticalRun:
    static = read_markers(runner_file(folder, run.static))
    raw = relabelled(read_markers(runner_file(folder, run.markers)), run.exchanged)
    clean = clean_markers(raw, CLUSTERS, PRINTED_CLEANING)
    body = measured(static)
    angles: dict[str, xr.Dataset] = {
        options.centres: optical_joint_angles(
            clean, static, body, markers=CLUSTERS, options=options, axes=public_joint_axes(RECIPE)
        )
        for options in (MEDIAL, AVERAGE)
    }
    contacts: dict[str, pd.DataFrame] = {
        side: marker_contacts(raw, run, side, RUNNING_CONTACT) for side in SIDES
    }
    plates = {} if run.forces is None else _plate_contacts(folder, run, raw)
    return OpticalRun(run, raw, angles, contacts, plates)


def marker_contacts(
    recording: MarkerRecording, run: RealRun, side: Side, rule: ContactRule
) -> pd.DataFrame:
    """Contacts of one foot from its markers.

    Parameters
    ----------
    recording : MarkerRecording
    run : RealRun
    side : {"right", "left"}
    rule : ContactRule
    """
    names = {part: FOOT_MARKERS[side][part] for part in ("heel", "toe")}
    both = (*names["heel"], *names["toe"])
    filled, _ = fill_gaps(
        points(recording, both), both, limits=PRINTED_LIMITS, rigid=(both,), patterns=(both,)
    )
    n_heel = len(names["heel"])
    return foot_contacts(
        filled[:n_heel],
        filled[n_heel:],
        rate_hz=float(recording.attrs["rate_hz"]),
        running_speed_m_s=run.speed_m_s,
        belt_speed_m_s=run.speed_m_s,
        rule=rule,
        file=run.markers,
    )


def _plate_contacts(folder: Path, run: RealRun, raw: MarkerRecording) -> dict[str, pd.DataFrame]:
    """Contacts by the force plates, to a fraction of a sample; the lower foot is on the plate."""
    force = sosfiltfilt(
        butter(2, CONTACT_HZ, fs=FORCE_RATE_HZ, output="sos"), vertical_force(folder, run)
    )
    above = force > CONTACT_N
    edges = np.diff(above.astype(np.int8))
    begin, end = (
        (rows + (CONTACT_N - force[rows]) / (force[rows + 1] - force[rows])) / FORCE_RATE_HZ
        for rows in (np.flatnonzero(edges == 1), np.flatnonzero(edges == -1))
    )
    end = end[end > begin[0]]
    begin = begin[: len(end)]
    right, left = (points(raw, (FOOT_MARKERS[side]["toe"]))[..., 2].mean(axis=0) for side in SIDES)
    inside = end < raw["time"].to_numpy()[-1]
    lower = np.interp((begin + end) / 2.0, raw["time"].to_numpy(), right - left)
    frame = pd.DataFrame({"initial_contact_s": begin, "toe_off_s": end})
    return {"right": frame[inside & (lower < 0)], "left": frame[inside & (lower > 0)]}


def mean_curves(found: OpticalRun, centres: str, side: Side) -> Array:
    """Mean joint angles over the strides of a side, from first touch to first touch.

    Parameters
    ----------
    found : OpticalRun
    centres : str
        Which of ``found.angles``.
    side : {"right", "left"}

    Returns
    -------
    ndarray, shape (6, 3, N_PHASES)
        Degrees.
    """
    contacts = found.plates.get(side, found.contacts[side])["initial_contact_s"].to_numpy()
    length = np.diff(contacts)
    whole = length < ONE_STRIDE * np.median(length)
    angles = found.angles[centres]
    time = angles["time"].to_numpy()
    phase = np.linspace(0.0, 1.0, N_PHASES)
    at = contacts[:-1][whole, None] + phase * length[whole, None]
    values = angles["joint_angle"].to_numpy() * DEG_PER_RAD
    return np.array(
        [[np.interp(at, time, angle).mean(axis=0) for angle in joint] for joint in values]
    )


def authors_curve(folder: Path, run: RealRun, side: Side, joint: str, angle: str) -> Array:
    """Mean curve that the authors publish, degrees.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.
    run : RealRun
    side : {"right", "left"}
    joint : {"hip", "knee", "ankle"}
    angle : str
        One of ``ANGLES``.
    """
    table = processed_table(runner_file(folder, run.processed))
    column = f"{side[0].upper()}{joint}Ang{_AXES[angle]}{round(10 * run.speed_m_s)}"
    return np.asarray(table[column].to_numpy(dtype=np.float64))


@cache
def processed_table(path: Path) -> pd.DataFrame:
    """Mean curves of a runner as the authors publish them.

    Parameters
    ----------
    path : Path
        Tab-separated.
    """
    return pd.read_csv(path, sep="\t")
