"""Stride lengths by gaitmap on the public foot recordings; runs in an environment of its own.

That environment is ``.venv-peers-gait`` (``requirements-peers-gait.txt``, ``make peers``). The
method is gaitmap's error-state Kalman filter with RTS smoothing (``RtsKalman``) and its default
zero-velocity detector, every parameter at its default, the same for all trials. Only the initial
orientation has to be given: gravity as measured in the first 0.25 s. The half turn about x that
makes the sensor's z point up in ``foot_imu_vicon`` changes nothing but the sense of the path.

The table has one row per given stride: trial, stride (from 1), start and stop in seconds, and the
horizontal displacement in metres.
"""

import argparse
import csv
import warnings
from collections.abc import Iterator
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pandas as pd
from gaitmap.trajectory_reconstruction import RtsKalman
from gaitmap.utils.rotations import get_gravity_rotation
from scipy.io import loadmat

COLUMNS = ["acc_x", "acc_y", "acc_z", "gyr_x", "gyr_y", "gyr_z"]
REST_S = 0.25
Trial = tuple[str, pd.DataFrame, float, np.ndarray]


def vicon(folder: Path) -> Iterator[Trial]:
    """Trials of foot_imu_vicon: name, signals in m/s² and deg/s, rate, samples of the instants."""
    for path in sorted((folder / "data").glob("*_LLIO.mat")):
        content = loadmat(path)
        signals = content["imu_data"] * np.array([1.0, -1.0, -1.0] * 2)
        signals[:, 3:] = np.rad2deg(signals[:, 3:])
        stamps_s = content["timestamps_all"].ravel()
        rate_hz = (len(stamps_s) - 1) / (stamps_s[-1] - stamps_s[0])
        name = path.stem.removesuffix("_LLIO")
        yield name, pd.DataFrame(signals, columns=COLUMNS), rate_hz, content["strideIndex"].ravel()


def mocap_walk(folder: Path) -> Iterator[Trial]:
    """Both feet of foot_imu_mocap_walk."""
    table = pd.read_csv(folder / "imu_sample.csv", header=[0, 1], index_col=0)
    events = pd.read_csv(folder / "stride_events_sample.csv")
    for foot in ("left", "right"):
        own = events[events["foot"] == foot]
        instants = np.append(own["start"], own["end"].iloc[-1]).astype(int)
        yield foot, table[f"{foot}_sensor"][COLUMNS].reset_index(drop=True), 204.8, instants


def smoothed_position(signals: pd.DataFrame, rate_hz: float) -> np.ndarray:
    """Position by RtsKalman, shape (n, 3); its first row is the start, before the first sample."""
    rest = signals[COLUMNS[:3]].to_numpy()[: int(REST_S * rate_hz)].mean(axis=0)
    start = get_gravity_rotation(rest / np.linalg.norm(rest))
    found = RtsKalman(initial_orientation=start).estimate(signals, sampling_rate_hz=rate_hz)
    return found.position_.to_numpy()


def main() -> None:
    """Compute every trial, write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("dataset", choices=["foot_imu_vicon", "foot_imu_mocap_walk"])
    parser.add_argument("--real-data", type=Path, required=True)
    parser.add_argument("--table", type=Path, required=True)
    arguments = parser.parse_args()
    warnings.simplefilter("ignore")
    trials = vicon if arguments.dataset == "foot_imu_vicon" else mocap_walk
    rows = []
    for name, signals, rate_hz, instants in trials(arguments.real_data / arguments.dataset):
        at = smoothed_position(signals, rate_hz)[instants, :2]
        lengths = np.linalg.norm(np.diff(at, axis=0), axis=1)
        for number, length in enumerate(lengths, start=1):
            start, stop = instants[number - 1] / rate_hz, instants[number] / rate_hz
            rows.append([name, number, f"{start:.6f}", f"{stop:.6f}", f"{length:.6f}"])
    arguments.table.parent.mkdir(parents=True, exist_ok=True)
    with arguments.table.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["trial", "stride", "start_s", "stop_s", "length_m"])
        writer.writerows(rows)
    print(f"{arguments.dataset}: {len(rows)} strides by gaitmap {version('gaitmap')}")


if __name__ == "__main__":
    main()
