"""Reader of the walking trial with seven Xsens sensors and Vicon (Sy et al., UNSW).

One trial of 9.5 s at 100 Hz with a U-turn; the raw sensor files hold 11 s before it as well, with
quiet standing. The optical segments are those of the Helen-Hayes marker set; the foot has no
inversion of its own.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from swaystride.errors import RecordingError
from swaystride.rotations import matrix_from_quaternion
from swaystride.signals.filters import butterworth_lowpass

Array = NDArray[np.float64]

DATASET: Final = "lower_limb_imu_vicon_walk"
RATE_HZ: Final = 100.0
#: Serial numbers in the order of swaystride.erkf.body.SEGMENTS; the shank sensors are those in the
#: middle of the shank ("LowLeg2").
_SERIALS: Final = (
    "00B40B91",
    "00B40C3C",
    "00B40C45",
    "00B40C35",
    "00B40BA5",
    "00B40C48",
    "00B40C55",
)
_SEGMENTS: Final = ("RPV", "RTH", "LTH", "RSK", "LSK", "RFT", "LFT")
_CENTRES: Final = {
    "right_hip": "RFEP",
    "left_hip": "LFEP",
    "right_knee": "RFEO",
    "left_knee": "LFEO",
    "right_ankle": "RTIO",
    "left_ankle": "LTIO",
}
#: Columns: anatomical x (forward), y (up), z (right) in the optical segment (x forward, y left, z up).
_LEG: Final = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
#: As above for the foot, whose optical z points forward and x down.
_FOOT: Final = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])
#: Largest lag of the sensors behind the optical system that is looked for.
_LONGEST_LAG: Final = 10


@dataclass(frozen=True, eq=False)
class LimbWalk:
    """Signals of seven sensors, and what the optical system saw of a part of them.

    Parameters
    ----------
    acc_m_s2, gyr_rad_s : ndarray, shape (7, 3, n_all)
        Whole recording.
    rotation : ndarray, shape (n, 7, 3, 3)
        Optical ``r_world_from_anatomical`` (x forward, y up, z right).
    centres_m : dict of str to ndarray, shape (n, 3)
        Optical joint centres.
    first : int
        Sample of the sensors that belongs to the first optical one.
    lag : int
        By how many samples the sensors lag behind the synchronisation of the file; `first` has it.
    """

    acc_m_s2: Array
    gyr_rad_s: Array
    rotation: Array
    centres_m: dict[str, Array]
    first: int
    lag: int

    @property
    def walking(self) -> slice:
        """Samples of the sensors that the optical system saw."""
        return slice(self.first, self.first + len(self.rotation))


def read_walk(folder: Path) -> LimbWalk:
    """Read the trial.

    Parameters
    ----------
    folder : Path
        Folder of the data set, with ``rawimu`` and ``vicon``.

    Raises
    ------
    RecordingError
        If a file or column is missing, packets are lost, or sensors and optics do not fit.
    """
    sensors = [_sensor(_only(folder / "rawimu", f"*_{serial}.txt")) for serial in _SERIALS]
    starts = {int(frame["PacketCounter"].iloc[0]) for frame in sensors}
    if len(starts) > 1 or len({len(frame) for frame in sensors}) > 1:
        raise RecordingError("sensors do not start and end together", file=folder / "rawimu")
    acc, gyr = (
        np.stack([frame[[f"{kind}_{a}" for a in "XYZ"]].to_numpy().T for frame in sensors])
        for kind in ("Acc", "Gyr")
    )
    path = _only(folder / "vicon", "*.csv")
    optical = pd.read_csv(path, comment="/")
    rotation = np.stack([_rotation(optical, name, path) for name in _SEGMENTS], axis=1)
    first = _first_frame(path)
    lag = lag_samples(rotation, gyr[:, :, first:])
    n = min(len(rotation), acc.shape[2] - first - lag)
    centres = {name: _columns(optical, code, 3, path)[:n] for name, code in _CENTRES.items()}
    return LimbWalk(acc, gyr, rotation[:n], centres, first + lag, lag)


def lag_samples(rotation: Array, gyr_rad_s: Array) -> int:
    """By how many samples the sensors lag behind the optical system: best match of rates.

    Parameters
    ----------
    rotation : ndarray, shape (n, 7, 3, 3)
        Optical orientations.
    gyr_rad_s : ndarray, shape (7, 3, m)
        From the sample on that the files say is simultaneous.

    Returns
    -------
    int
        Median over the sensors but for the left thigh, whose markers are bad.
    """
    n = min(len(rotation), gyr_rad_s.shape[2])
    lags = np.arange(-_LONGEST_LAG, _LONGEST_LAG + 1)
    inner = np.arange(_LONGEST_LAG + 1, n - _LONGEST_LAG - 1)
    found = []
    for j in (0, 1, 3, 4, 5, 6):
        turns = Rotation.from_matrix(rotation[:-1, j]).inv() * Rotation.from_matrix(rotation[1:, j])
        optical = low_passed(np.asarray(turns.magnitude()) * RATE_HZ, 8.0)
        own = low_passed(np.linalg.norm(gyr_rad_s[j], axis=0), 8.0)
        # a turn between samples k and k + 1 belongs to the time between them
        own = 0.5 * (own[:-1] + own[1:])
        match = [np.corrcoef(optical[inner], own[inner + lag])[0, 1] for lag in lags]
        found.append(lags[int(np.argmax(match))])
    return int(np.median(found))


def low_passed(signal: Array, cutoff_hz: float) -> Array:
    """Low-pass without lag along the last axis.

    Parameters
    ----------
    signal : ndarray, shape (..., n)
    cutoff_hz : float
    """
    return butterworth_lowpass(
        signal, cutoff_hz=cutoff_hz, rate_hz=RATE_HZ, order=2, direction="zero_lag", pad_s=0.5
    )


def _only(folder: Path, pattern: str) -> Path:
    """The one file of a pattern."""
    found = sorted(folder.glob(pattern))
    if len(found) != 1:
        raise RecordingError(
            "file not found", file=folder, expected=f"one {pattern}", found=str(len(found))
        )
    return found[0]


def _sensor(path: Path) -> pd.DataFrame:
    """Table of one sensor, with every packet."""
    frame = pd.read_csv(path, comment="/")
    steps = np.diff(frame["PacketCounter"])
    if not (steps == 1).all():
        raise RecordingError(
            "lost packets",
            file=path,
            place=f"row {int(np.flatnonzero(steps != 1)[0]) + 2}",
            expected="consecutive packet counters",
        )
    return frame


def _columns(frame: pd.DataFrame, code: str, count: int, path: Path) -> Array:
    """Columns ``code_1`` … of the optical file."""
    names = [f"{code}_{i + 1}" for i in range(count)]
    missing = [name for name in names if name not in frame]
    if missing:
        raise RecordingError("missing columns", file=path, expected=", ".join(missing))
    return np.asarray(frame[names].to_numpy(dtype=np.float64))


def _rotation(frame: pd.DataFrame, code: str, path: Path) -> Array:
    """Anatomical orientation of a segment."""
    r_world_from_optical = matrix_from_quaternion(_columns(frame, f"q{code}", 4, path))
    return np.asarray(r_world_from_optical @ (_FOOT if code.endswith("FT") else _LEG))


def _first_frame(path: Path) -> int:
    """First sample of the sensors, from the line ``// idx=first,last`` (counted from one)."""
    with path.open(encoding="utf-8") as lines:
        for line in lines:
            if match := re.match(r"//\s*idx=(\d+),", line):
                return int(match[1]) - 1
            if not line.startswith("//"):
                break
    raise RecordingError("no synchronisation", file=path, expected="a line '// idx=first,last'")
