"""Time gaitmap's RtsKalman; runs in the environment of ``requirements-peers-gait.txt``.

Prints one line of JSON: version, samples, seconds of each run, peak memory of the process.
"""

import argparse
import json
import resource
import time
import warnings
from importlib.metadata import version

import numpy as np
import pandas as pd
from gaitmap.trajectory_reconstruction import RtsKalman
from gaitmap.utils.rotations import get_gravity_rotation

COLUMNS = ["acc_x", "acc_y", "acc_z", "gyr_x", "gyr_y", "gyr_z"]


def main() -> None:
    """Compile on a short piece, run, print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("recording", help="array (6, n) of m/s² and rad/s (.npy)")
    parser.add_argument("--rate-hz", type=float, required=True)
    parser.add_argument("--repeats", type=int, required=True)
    arguments = parser.parse_args()
    warnings.simplefilter("ignore")
    values = np.load(arguments.recording).T.copy()
    values[:, 3:] = np.rad2deg(values[:, 3:])
    signals = pd.DataFrame(values, columns=COLUMNS)
    rest = values[: int(0.25 * arguments.rate_hz), :3].mean(axis=0)
    start = get_gravity_rotation(rest / np.linalg.norm(rest))
    seconds = []
    for piece in [signals.iloc[:5000], *[signals] * arguments.repeats]:
        begin = time.perf_counter()
        RtsKalman(initial_orientation=start).estimate(piece, sampling_rate_hz=arguments.rate_hz)
        seconds.append(time.perf_counter() - begin)
    peak_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    answer = {"version": version("gaitmap"), "seconds": seconds[1:], "peak_mb": peak_mb}
    print(json.dumps(answer))


if __name__ == "__main__":
    main()
