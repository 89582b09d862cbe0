"""Public recordings of real runners: joint curves, timing, foot pitch and bobbing of the pelvis.

``running_markers_grf``: Fukuchi, Fukuchi and Duarte (2017), PeerJ 5:e3298; treadmill, markers at
150 Hz (X forward, Y up, Z right, mm), forces at 300 Hz, and angles that the authors computed. In
their files hip flexion and, in the newest per-stride files, ankle dorsiflexion are negative.
``running_full_body_ik``: subject02 of Hamner, Seth and Delp (2010) at 3.96 m/s from the test files
of OpenSim; 60 Hz, degrees, knee flexion negative.
"""

from __future__ import annotations

from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.signal import butter, find_peaks, sosfiltfilt

from swaystride.errors import RecordingError
from swaystride.validation.manifest import verified_files

FloatArray = NDArray[np.float64]

MARKERS: Final = "running_markers_grf"
FULL_BODY: Final = "running_full_body_ik"
FULL_BODY_RUNNER: Final = "subject02"
JOINTS: Final = ("hip", "knee", "ankle")
#: Samples over a stride, both ends included.
N_PHASES: Final = 101
#: Hip flexion beyond this range is a jump of the authors' Euler angles, not a runner.
_WIDEST_HIP_DEG: Final = 90.0
_LEAST_FORCE: Final = 0.05
_MARKER_RATE_HZ: Final = 150.0
_FORCE_RATE_HZ: Final = 300.0
_FULL_BODY_RATE_HZ: Final = 60.0


@dataclass(frozen=True)
class RealCurves:
    """Sagittal curves of real strides over the phase of the stride from first touch.

    Parameters
    ----------
    label : str
        Who, and how fast.
    speed_m_s : float
        Speed.
    runner : ndarray of str, shape (n_strides,)
        Who ran each stride.
    angle_deg : dict of str to ndarray, shape (n_strides, N_PHASES)
        Flexion (dorsiflexion) of hip, knee and ankle.
    duty_factor, stride_time_s : ndarray
        Of those who ran; empty if the files do not say.
    """

    label: str
    speed_m_s: float
    runner: NDArray[np.str_]
    angle_deg: dict[str, FloatArray]
    duty_factor: FloatArray
    stride_time_s: FloatArray

    @property
    def dataset(self) -> str:
        """Name of the data set."""
        return FULL_BODY if FULL_BODY_RUNNER in self.runner else MARKERS


@dataclass(frozen=True)
class RealTrial:
    """Strides of one treadmill trial.

    Parameters
    ----------
    label : str
        Who, and how fast.
    speed_m_s : float
        Speed.
    stride_time_s, duty_factor : ndarray, shape (n_strides,)
        Timing by the force plates; duty factor NaN where there are none.
    oscillation_m : ndarray, shape (n_strides,)
        Vertical range of the pelvis.
    foot_pitch_deg : ndarray, shape (n_strides, N_PHASES)
        Toes up positive, 0 in the middle of the stance.
    """

    label: str
    speed_m_s: float
    stride_time_s: FloatArray
    duty_factor: FloatArray
    oscillation_m: FloatArray
    foot_pitch_deg: FloatArray


def stride_curves(folder: Path) -> RealCurves:
    """Strides of the eight runners at 2.5 m/s, one row per stride.

    Strides with a jump of the hip angle are left out.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.
    """
    angles: dict[str, list[FloatArray]] = {joint: [] for joint in JOINTS}
    runner = []
    for path in verified_files(folder, MARKERS):
        if not path.name.endswith("angs.txt"):
            continue
        table = pd.read_csv(path, sep="\t")
        strides = [name.split("_")[-1] for name in table.columns if name.startswith("Knee_Z_")]
        for stride in strides:
            hip = -table[f"Hip_Z_{stride}"].to_numpy(dtype=np.float64)
            if np.abs(hip).max() > _WIDEST_HIP_DEG or np.ptp(hip) > _WIDEST_HIP_DEG:
                continue
            knee = table[f"Knee_Z_{stride}"].to_numpy(dtype=np.float64)
            ankle = -table[f"Ankle_Z_{stride}"].to_numpy(dtype=np.float64)
            for joint, curve in zip(JOINTS, (hip, knee, ankle), strict=True):
                angles[joint].append(curve)
            runner.append(path.name.removesuffix("angs.txt"))
    return RealCurves(
        "eight runners at 2.5 m/s",
        2.5,
        np.array(runner),
        {joint: np.array(rows) for joint, rows in angles.items()},
        duty_factor=np.array([]),
        stride_time_s=np.array([]),
    )


def mean_curves(folder: Path) -> list[RealCurves]:
    """Mean curves of two runners at 2.5, 3.5 and 4.5 m/s, right and left.

    The duty factor is the share of the stride with more than 5 % of the largest vertical force.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.
    """
    found = []
    paths = [p for p in verified_files(folder, MARKERS) if p.name.endswith("processed.txt")]
    tables = {
        path.name.removesuffix("processed.txt"): pd.read_csv(path, sep="\t") for path in paths
    }
    for speed in (2.5, 3.5, 4.5):
        angles: dict[str, list[FloatArray]] = {joint: [] for joint in JOINTS}
        runner, duty = [], []
        for name, table in tables.items():
            for side in ("R", "L"):
                runner.append(name)
                force = np.nan_to_num(table[f"{side}grfY{round(10 * speed)}"].to_numpy(np.float64))
                duty.append(np.mean(force[:-1] > _LEAST_FORCE * force.max()))
                for joint in JOINTS:
                    column = table[f"{side}{joint}AngZ{round(10 * speed)}"]
                    angles[joint].append(column.to_numpy(dtype=np.float64))
        stacked = {joint: np.array(rows) for joint, rows in angles.items()}
        label = f"means of two runners at {speed:g} m/s"
        found.append(
            RealCurves(label, speed, np.array(runner), stacked, np.array(duty), np.array([]))
        )
    return found


def marker_trials(folder: Path) -> list[RealTrial]:
    """Trials with markers and force plates, both at 2.5 m/s.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.
    """
    paths = {path.name: path for path in verified_files(folder, MARKERS)}
    return [
        _marker_trial(paths["RBDS001runT25markers.txt"], paths["RBDS001runT25forces.txt"], 2.5),
        _marker_trial(paths["RBDS0041runT252.txt"], paths["RBDS0041runT252forces.txt"], 2.5),
    ]


def _marker_trial(markers: Path, forces: Path, speed_m_s: float) -> RealTrial:
    table = pd.read_csv(markers, sep="\t")
    time = np.arange(len(table)) / _MARKER_RATE_HZ

    def place(name: str) -> FloatArray:
        return np.stack([table[f"{name}{axis}"].to_numpy(np.float64) for axis in "XYZ"]) / 1e3

    toe = (place("R.MT1") + place("R.MT5")) / 2
    way = toe - (place("R.Heel.Top") + place("R.Heel.Bottom")) / 2
    pitch = np.degrees(np.arctan2(way[1], way[0]))
    spines = ("R.ASIS", "L.ASIS", "R.PSIS", "L.PSIS")
    pelvis = np.mean([place(name)[1] for name in spines], axis=0)
    seen = np.isfinite(pelvis)
    pelvis = np.interp(time, time[seen], pelvis[seen])
    contact, toe_off = _touches(forces)
    middle = np.interp((contact + toe_off) / 2, time, toe[1] - place("L.MT1")[1])
    contact, toe_off = contact[middle < 0.0], toe_off[middle < 0.0]
    inside = contact < time[-1]
    contact, toe_off = contact[inside], toe_off[inside]
    stride = np.diff(contact)
    whole = stride < 1.3 * np.median(stride)
    begin, end, off = contact[:-1][whole], contact[1:][whole], toe_off[:-1][whole]
    pitches, heights = _by_phase(time, pitch, begin, end), _by_phase(time, pelvis, begin, end)
    duty = (off - begin) / (end - begin)
    return RealTrial(
        markers.name.split("run")[0],
        speed_m_s,
        end - begin,
        duty,
        np.ptp(heights, axis=1),
        level_in_stance(pitches, float(np.median(duty))),
    )


def _touches(forces: Path) -> tuple[FloatArray, FloatArray]:
    """Begins and ends of contact of both feet: 50 N after a 30 Hz low-pass (spec §9.1 data)."""
    vertical = pd.read_csv(forces, sep="\t")["Fy"].to_numpy(dtype=np.float64)
    vertical = vertical - np.percentile(vertical, 5)
    low = sosfiltfilt(butter(2, 30.0, fs=_FORCE_RATE_HZ, output="sos"), vertical)
    on = low > 50.0
    begin = np.flatnonzero(on[1:] & ~on[:-1]) / _FORCE_RATE_HZ
    end = np.flatnonzero(~on[1:] & on[:-1]) / _FORCE_RATE_HZ
    end = end[end > begin[0]]
    n = min(len(begin), len(end))
    return begin[:n], end[:n]


def _by_phase(
    time: FloatArray, signal: FloatArray, begin: FloatArray, end: FloatArray
) -> FloatArray:
    phase = np.linspace(0.0, 1.0, N_PHASES)
    return np.array(
        [np.interp(a + phase * (b - a), time, signal) for a, b in zip(begin, end, strict=True)]
    )


def level_in_stance(pitch_deg: FloatArray, duty_factor: float) -> FloatArray:
    """Pitch from its median in the middle of the stance, stride by stride.

    Parameters
    ----------
    pitch_deg : ndarray, shape (n_strides, N_PHASES)
        Pitch of anything that is fixed to the foot.
    duty_factor : float
        Share of the stance.
    """
    share = np.linspace(0.0, 1.0, N_PHASES) / duty_factor
    flat = (share > 0.35) & (share < 0.55)
    return np.asarray(pitch_deg - np.median(pitch_deg[:, flat], axis=1, keepdims=True))


def full_body(folder: Path, knee_peak_phase: float) -> tuple[RealCurves, RealTrial]:
    """Right strides of a runner at 3.96 m/s, cut so that the knee peaks in swing at a phase.

    The file has no forces: first touch is not known, only the period and the curves are.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.
    knee_peak_phase : float
        Phase to which the greatest flexion of the knee is put.
    """
    (path,) = verified_files(folder, FULL_BODY)
    text = path.read_text(encoding="utf-8").split("endheader\n", 1)
    if len(text) != 2:
        raise RecordingError(
            "not a motion file", file=path, expected="a line endheader", found="none"
        )
    table = pd.read_csv(StringIO(text[1]), sep="\t")
    column = {name: table[name].to_numpy(dtype=np.float64) for name in table.columns}
    # Times are printed in whole milliseconds.
    time, knee = np.arange(len(table)) / _FULL_BODY_RATE_HZ, -column["knee_angle_r"]
    peaks, _ = find_peaks(knee, height=90.0, distance=30)
    # A parabola through three samples: frames are 17 ms apart, strides differ by less.
    before, top, after = knee[peaks - 1], knee[peaks], knee[peaks + 1]
    turn = time[peaks] + (before - after) / (before - 2 * top + after) / 2.0 / _FULL_BODY_RATE_HZ
    period = np.diff(turn)
    begin = turn[1:] - knee_peak_phase * period
    begin, end = begin[:-1], begin[:-1] + period[1:]
    angles = {
        "hip": _by_phase(time, column["hip_flexion_r"], begin, end),
        "knee": _by_phase(time, knee, begin, end),
        "ankle": _by_phase(time, column["ankle_angle_r"], begin, end),
    }
    pitch = column["pelvis_tilt"] + column["hip_flexion_r"] - knee + column["ankle_angle_r"]
    label = "one runner at 3.96 m/s"
    runner = np.full(len(begin), FULL_BODY_RUNNER)
    trial = RealTrial(
        FULL_BODY_RUNNER,
        3.96,
        period,
        np.full(len(period), np.nan),
        np.ptp(_by_phase(time, column["pelvis_ty"], begin, end), axis=1),
        level_in_stance(_by_phase(time, pitch, begin, end), 0.3),
    )
    return RealCurves(label, 3.96, runner, angles, np.array([]), period), trial
