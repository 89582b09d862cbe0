"""Time the running body: a run of 30 minutes with 13 sensors, and a treadmill trial of 6 minutes.

The long run is simulated at 2 kHz, recorded at 500 Hz and written as an Opal file; the treadmill
trial has 7 sensors and 45 markers at 200 Hz. Every case runs in a process of its own with one
thread, compiles on a short piece first, and reports wall time, processor time and peak memory.
"""

import json
import os
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from swaystride.command_line import run_script, script_parser
from swaystride.io.c3d_writer import write_c3d
from swaystride.io.opal_hdf5_writer import OpalRun, OpalWriter
from swaystride.marker_recording import make_marker_recording
from swaystride.simulate.running_body import runner_body, usual_shares, usual_shoe
from swaystride.simulate.running_manner import USUAL_VARIABILITY, RunnerManner, steady_run
from swaystride.simulate.running_markers import USUAL_CAMERAS, filmed, wear_markers
from swaystride.simulate.running_motion import RunningMotion
from swaystride.simulate.running_recording import recorded
from swaystride.simulate.running_run import Treadmill, run_motion
from swaystride.simulate.running_sensors import (
    USUAL_MOUNTING,
    WornSensors,
    sensor_places,
    wear_sensors,
)
from swaystride.simulate.running_tissue import common_tissue, usual_tissue

#: Seconds and mebibytes that the library must reach.
TARGETS = {"run": (40.0, 1536.0), "treadmill": (8.0, 1536.0)}
LOWER_BODY = (
    "lumbar",
    "thigh_right",
    "thigh_left",
    "shank_right",
    "shank_left",
    "foot_right",
    "foot_left",
)


def simulated(
    names: tuple[str, ...], duration_s: float, speed_m_s: float, treadmill: Treadmill | None
) -> tuple[RunningMotion, WornSensors, np.ndarray, np.random.Generator]:
    """A motion and the sensors of the person."""
    rng = np.random.default_rng(1)
    body = runner_body(1.72, 70.0, shares=usual_shares(), shoe=usual_shoe())
    common = common_tissue(rng)
    sensors = wear_sensors(
        body, names, mounting=USUAL_MOUNTING, tissue=usual_tissue(), common=common, rng=rng
    )
    motion = run_motion(
        body,
        RunnerManner(),
        steady_run(duration_s, speed_m_s),
        duration_s=duration_s,
        variability=USUAL_VARIABILITY,
        rng=rng,
        treadmill=treadmill,
    )
    return motion, sensors, common, rng


def write_run(motion: RunningMotion, sensors: WornSensors, path: Path, rate_hz: float) -> None:
    """Record a motion and write the file, chunk by chunk."""
    ids = tuple(f"SI-{k:06d}" for k in range(len(sensors.names)))
    run = OpalRun(ids, sensors.names, rate_hz, 1_600_000_000_000_000, note="simulated")
    with OpalWriter(path, run) as writer:
        for chunk in recorded(motion, sensors, rate_hz=rate_hz, rng=np.random.default_rng(2)):
            writer.append(acc_m_s2=chunk.acc_m_s2, gyr_rad_s=chunk.gyr_rad_s)


def long_run(folder: Path, duration_s: float) -> None:
    """13 sensors at 500 Hz."""
    motion, sensors, *_ = simulated(tuple(sensor_places()), duration_s, 3.0, None)
    write_run(motion, sensors, folder / "run.h5", 500.0)


def treadmill_trial(folder: Path, duration_s: float) -> None:
    """7 sensors and 45 markers at 200 Hz."""
    motion, sensors, common, rng = simulated(LOWER_BODY, duration_s, 14.0 / 3.6, Treadmill(0.02))
    write_run(motion, sensors, folder / "trial.h5", 200.0)
    markers = wear_markers(
        motion.body, sensors, place_sd_m=0.004, tissue=usual_tissue(), common=common, rng=rng
    )
    film = np.concatenate(
        [
            chunk.position_m
            for chunk in filmed(motion, markers, rate_hz=200.0, errors=USUAL_CAMERAS, rng=rng)
        ]
    )
    recording = make_marker_recording(
        np.moveaxis(film, 0, -1),
        markers=markers.names,
        rate_hz=200.0,
        rate_source="simulation",
        subject="P01",
    )
    write_c3d(folder / "trial.c3d", recording, unit="mm", description="simulated")


CASES: dict[str, tuple[Callable[[Path, float], None], float]] = {
    "run": (long_run, 1800.0),
    "treadmill": (treadmill_trial, 360.0),
}


def measure_case(name: str) -> dict[str, float]:
    """Compile on three seconds, then time the case."""
    case, duration_s = CASES[name]
    with TemporaryDirectory() as folder:
        case(Path(folder), 3.0)
        wall, processor = time.perf_counter(), time.process_time()
        case(Path(folder), duration_s)
        wall, processor = time.perf_counter() - wall, time.process_time() - processor
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    return {"wall_s": wall, "processor_s": processor, "peak_mib": peak}


def main() -> None:
    """Run every case in a process of its own, or one case in this process."""
    parser = script_parser(__doc__)
    parser.add_argument("--case", choices=sorted(CASES))
    arguments = parser.parse_args()
    if arguments.case is not None:
        print(json.dumps(measure_case(arguments.case)))
        return
    environment = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    missed = []
    for name in CASES:
        command = [sys.executable, __file__, "--case", name]
        done = subprocess.run(command, capture_output=True, text=True, check=True, env=environment)
        found = json.loads(done.stdout)
        seconds, mebibytes = TARGETS[name]
        print(
            f"{name}: {found['wall_s']:.1f} s (processor {found['processor_s']:.1f} s, "
            f"at most {seconds:g} s), {found['peak_mib']:.0f} MiB (at most {mebibytes:g} MiB)"
        )
        if found["processor_s"] > seconds or found["peak_mib"] > mebibytes:
            missed.append(name)
    if missed:
        sys.exit("missed: " + ", ".join(missed))


if __name__ == "__main__":
    run_script(main)
