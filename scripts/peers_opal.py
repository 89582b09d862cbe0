"""An Opal file of ours, read by scikit-digital-health in an environment of its own.

Run by ``make peers``. A run of three sensors with gaps is written in pieces and read by both: times
must be equal to the µs, signals to the last digit that single precision holds.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from swaystride.io.opal_hdf5_writer import OpalRun, OpalWriter
from swaystride.io.reading import read_recording

REPOSITORY = Path(__file__).resolve().parents[1]
PEER = REPOSITORY / ".venv-peers-opal/bin/python"
LABELS = ("Lumbar", "Left Foot", "Right Lower Leg")
RATE_HZ, START_US, TIMEZONE_H = 500.0, 1_700_000_000_123_456, -7.0
PIECE, N_PIECES = 4000, 5
#: Runs there: reads each sensor, without shifting the time to the local one, and stores the arrays.
PROGRAM = """
import sys, warnings
import numpy as np
from skdh.io import ReadApdmH5
warnings.simplefilter("ignore")
path, target, *labels = sys.argv[1:]
found = {}
for label in labels:
    reader = ReadApdmH5(label, localize_timestamps=False, gravity_acceleration=1.0)
    result = reader.predict(file=path)
    for name in ("time", "accel", "gyro"):
        found[f"{label}/{name}"] = result[name]
np.savez(target, **found)
"""


def write_run(path: Path) -> None:
    """Write 40 s of three sensors in pieces, with one gap."""
    rng = np.random.default_rng(5)
    run = OpalRun(
        ids=tuple(f"XI-{number:06d}" for number in range(len(LABELS))),
        labels=LABELS,
        rate_hz=RATE_HZ,
        start_unix_us=START_US,
        timezone_offset_h=TIMEZONE_H,
        note="simulated",
    )
    shape = (len(LABELS), 3, PIECE)
    with OpalWriter(path, run) as writer:
        for piece in range(N_PIECES):
            acc, gyr = rng.normal(6.0, 5.0, shape), rng.normal(0.0, 3.0, shape)
            if piece == 2:
                acc[:, :, 100:140] = gyr[:, :, 100:140] = np.nan
            writer.append(acc_m_s2=acc, gyr_rad_s=gyr)


def main() -> None:
    """Write, read twice, compare."""
    if not PEER.exists():
        sys.exit("peers_opal: not installed; run `make peers`")
    with tempfile.TemporaryDirectory() as folder:
        path, target = Path(folder, "run.h5"), Path(folder, "peer.npz")
        write_run(path)
        subprocess.run([PEER, "-c", PROGRAM, path, target, *LABELS], check=True)
        ours, peer = read_recording(path), dict(np.load(target))
    there = np.isfinite(ours["acc"].values).all(axis=(0, 1))
    time_s = START_US * 1e-6 + ours["time"].values[there]
    worst = dict.fromkeys(("time", "accel", "gyro"), 0.0)
    for label in LABELS:
        one = ours.sel(sensor=label)
        expected = {
            "time": time_s,
            "accel": one["acc"].values[:, there].T,
            "gyro": one["gyr"].values[:, there].T,
        }
        for name, values in expected.items():
            apart = float(np.abs(values - peer[f"{label}/{name}"]).max())
            worst[name] = max(worst[name], apart)
    print(
        f"scikit-digital-health reads our Opal file: {len(LABELS)} sensors, {there.sum()} rows; "
        f"largest differences: time {worst['time']:.1e} s, acceleration {worst['accel']:.1e} m/s², "
        f"angular rate {worst['gyro']:.1e} rad/s"
    )
    if worst["time"] > 1e-6 or max(worst["accel"], worst["gyro"]) > 0:
        sys.exit("peers_opal: the two readings differ")


if __name__ == "__main__":
    main()
