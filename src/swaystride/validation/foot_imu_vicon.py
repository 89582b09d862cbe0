"""Foot IMU against Vicon: 22 trials of walking and running, stride by stride.

Wagstaff, Peretroukhin and Kelly (2017), University of Toronto foot-mounted inertial navigation
data; one MATLAB file per trial as redistributed with a path of the redistributor's own. One
person, sensor on the right shoe, 200 Hz.

Frames. In every file the acceleration at rest is about (-2.7, 0.4, -9.4) m/s²: it points along -z.
The file's own navigation-frame acceleration is ``acc_n = R(euler) acc + (0, 0, 9.8)`` and zero at
rest, so that this is proper acceleration, pointing up, in a frame whose z points down. Nothing has
to be negated: half a turn about x makes z point up. Negating the acceleration alone would give
plausible strides too, but a mirror image of the path, because (-acc, gyr) are the signals of a
mirrored movement. The optical path and the stored one are given in a plane with z down as well and
are turned alike, and then a path from the signals fits by a rotation and not by a reflection.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import numpy as np
import pandas as pd
from scipy.io import loadmat

from swaystride.errors import RecordingError
from swaystride.validation.foot_recording import (
    FloatArray,
    FootRecording,
    check_foot_signals,
    displacements,
    from_z_down,
)
from swaystride.validation.manifest import verified_files

DATASET: Final = "foot_imu_vicon"

#: Shapes of what is read, n samples and k instants.
_SHAPES: Final = {
    "imu_data": ("n", 6),
    "timestamps_all": (1, "n"),
    "gt": ("n", 2),
    "strideIndex": (1, "k"),
    "pyshoeTrajectory": ("n", 2),
}

#: The files name no gait. Median stride times are 0.72-0.80 s in one cluster and 1.0-1.7 s in the
#: other; two trials of the slow cluster have strides of 0.5 and 0.7 m, all others 1.1 m or more.
_LONGEST_RUNNING_STRIDE_S: Final = 0.9
_SHORTEST_WALKING_STRIDE_M: Final = 0.9


def vicon_recordings(folder: Path) -> list[FootRecording]:
    """All trials, in the order of their names.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.
    """
    paths = verified_files(folder, DATASET)
    return [read_vicon_trial(path) for path in sorted(paths) if path.suffix == ".mat"]


def read_vicon_trial(path: Path) -> FootRecording:
    """One trial.

    Parameters
    ----------
    path : Path
        MATLAB file with ``imu_data`` (acceleration in m/s², angular rate in rad/s),
        ``timestamps_all``, ``gt``, ``strideIndex`` and ``pyshoeTrajectory``.

    Raises
    ------
    RecordingError
        If the file cannot be read, lacks something, or holds something else.
    """
    content = _content(path)
    signals = from_z_down(content["imu_data"][:, :3].T), from_z_down(content["imu_data"][:, 3:].T)
    index = content["strideIndex"].ravel()
    n_samples = len(content["imu_data"])
    if not (np.all(index >= 0) and np.all(index < n_samples)):
        raise RecordingError(
            "a stride index lies outside of the trial",
            file=path,
            place="strideIndex",
            expected=f"0 to {n_samples - 1}",
            found=f"{index.min():g} to {index.max():g}",
        )
    rate_hz = _rate_hz(content["timestamps_all"].ravel(), path)
    time_s, instants_s = np.arange(n_samples) / rate_hz, index / rate_hz
    path_m = from_z_down(content["gt"].T)
    reference_m = displacements(path_m, time_s, instants_s)
    recording = FootRecording(
        dataset=DATASET,
        trial=path.stem.removesuffix("_LLIO"),
        gait=gait_label(instants_s, reference_m),
        rate_hz=rate_hz,
        acc_m_s2=signals[0],
        gyr_rad_s=signals[1],
        instants_s=instants_s,
        reference_m=reference_m,
        path_s=time_s,
        path_m=path_m,
        stored_path_m=from_z_down(content["pyshoeTrajectory"].T),
    )
    check_foot_signals(recording, file=path.name)
    return recording


def gait_label(instants_s: FloatArray, lengths_m: FloatArray) -> str:
    """``run``, ``walk``, or ``other`` for short and irregular strides.

    Parameters
    ----------
    instants_s : array, shape (n_strides + 1,)
    lengths_m : array, shape (n_strides,)

    Examples
    --------
    >>> gait_label(np.array([0.0, 0.75, 1.5]), np.array([1.3, 1.4]))
    'run'
    """
    if np.median(np.diff(instants_s)) < _LONGEST_RUNNING_STRIDE_S:
        return "run"
    return "walk" if np.median(lengths_m) >= _SHORTEST_WALKING_STRIDE_M else "other"


def _content(path: Path) -> dict[str, FloatArray]:
    """Arrays of the file as float64, after a check of their shapes."""
    try:
        raw: dict[str, Any] = loadmat(path)
    # the reader of MATLAB files raises whatever the damaged bytes lead it into
    except Exception as error:
        raise RecordingError(
            "not readable as a MATLAB file", file=path, found=type(error).__name__
        ) from error
    sizes: dict[str, int] = {}
    content = {}
    for name, shape in _SHAPES.items():
        if name not in raw:
            raise RecordingError(
                "an array is missing", file=path, expected=", ".join(_SHAPES), found=f"no {name}"
            )
        values = np.asarray(raw[name], dtype=np.float64)
        wanted = tuple(
            sizes.setdefault(size, found) if isinstance(size, str) else size
            for size, found in zip(shape, values.shape, strict=False)
        )
        if values.ndim != 2 or values.shape != wanted:
            raise RecordingError(
                "wrong shape",
                file=path,
                place=name,
                expected=" × ".join(map(str, wanted)),
                found=" × ".join(map(str, values.shape)),
            )
        content[name] = values
    return content


def _rate_hz(stamps_s: FloatArray, path: Path) -> float:
    """Rate of time stamps that jitter by less than a sample and skip none."""
    rate_hz = (len(stamps_s) - 1) / (stamps_s[-1] - stamps_s[0])
    apart = float(np.max(np.abs(stamps_s - stamps_s[0] - np.arange(len(stamps_s)) / rate_hz)))
    if not apart < 2.0 / rate_hz:
        raise RecordingError(
            "time stamps are not regular",
            file=path,
            place="timestamps_all",
            expected="no sample lost or doubled",
            found=f"{apart * rate_hz:.1f} samples from a regular clock",
        )
    return float(rate_hz)


def sensor_frame_residual(path: Path) -> pd.Series:
    """How well ``acc_n = R(euler) acc + (0, 0, 9.8)`` holds in a file, and acceleration at rest.

    Parameters
    ----------
    path : Path
        MATLAB file that also has ``acc_n`` and ``euler_angles`` (roll, pitch, yaw in rad).

    Returns
    -------
    Series
        ``difference_m_s2``, 99th percentile over samples of the largest difference of any
        component, and ``rest_z_m_s2``, the median of the z component of the first 50 samples as
        they stand in the file.
    """
    raw = loadmat(path)
    acc = raw["imu_data"][:, :3]
    roll, pitch, yaw = raw["euler_angles"].T
    x, y, z = acc.T
    # rotate about x (roll), then y (pitch), then z (yaw)
    y, z = y * np.cos(roll) - z * np.sin(roll), y * np.sin(roll) + z * np.cos(roll)
    x, z = x * np.cos(pitch) + z * np.sin(pitch), z * np.cos(pitch) - x * np.sin(pitch)
    x, y = x * np.cos(yaw) - y * np.sin(yaw), x * np.sin(yaw) + y * np.cos(yaw)
    difference = raw["acc_n"].T - np.stack([x, y, z + 9.8])
    return pd.Series(
        {
            "difference_m_s2": float(np.percentile(np.max(np.abs(difference), axis=0), 99)),
            "rest_z_m_s2": float(np.median(acc[:50, 2])),
        }
    )
