"""Time foot trajectories of this library beside vqf and gaitmap's RTS filter, on one recording.

Run by ``make benchmark-feet``, after ``make peers`` also with gaitmap. The recording has 900,000
samples: a real trial of ``foot_imu_vicon`` (SWAYSTRIDE_REAL_DATA, or ``real_data_dir``) repeated
from rest to rest, else a simple simulated walk. Every program runs in a process of its own with one
thread, compiles on a short piece first, and reports the peak memory of its process.
"""

import json
import os
import resource
import subprocess
import sys
import time
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

import numpy as np
import yaml

from swaystride.command_line import run_script, script_parser
from swaystride.errors import RecordingError
from swaystride.units import GRAVITY_M_S2
from swaystride.validation.foot_imu_vicon import DATASET, read_vicon_trial

REPOSITORY = Path(__file__).resolve().parents[1]
GAITMAP = REPOSITORY / ".venv-peers-gait/bin/python"
N_SAMPLES = 900_000
COMPILE_SAMPLES = 5_000
#: A walk with turns, from rest to rest, 8979 samples.
TRIAL = "2017-11-22-11-30-14_LLIO.mat"
SIMULATED_RATE_HZ = 200.0
METHODS = ("printed", "recommended", "vqf")
#: Samples per second and megabytes that the library must reach.
TARGETS = {"printed": 3e6, "recommended": 1e6}
TARGET_MB = 600.0


def real_trial() -> tuple[np.ndarray, float] | None:
    """Signals (6, n) and rate of the real trial, if it is at hand."""
    config = yaml.safe_load((REPOSITORY / "config/config.yaml").read_text(encoding="utf-8"))
    folder = os.environ.get("SWAYSTRIDE_REAL_DATA") or config["real_data_dir"]
    path = Path(folder or ".") / DATASET / "data" / TRIAL
    if not path.is_file():
        return None
    recording = read_vicon_trial(path)
    return np.concatenate([recording.acc_m_s2, recording.gyr_rad_s]), recording.rate_hz


def simulated_walk() -> tuple[np.ndarray, float]:
    """Signals (6, n) of 30 strides between two rests of 3 s: a foot that swings and pitches."""
    stride_s, swing_s, n_strides, rest_s = 1.1, 0.7, 30, 3.0
    time_s = np.arange(0.0, 2 * rest_s + n_strides * stride_s, 1.0 / SIMULATED_RATE_HZ)
    within = np.mod(time_s - rest_s, stride_s) / swing_s
    walking = (time_s >= rest_s) & (time_s < rest_s + n_strides * stride_s) & (within < 1.0)
    phase = 2.0 * np.pi * np.where(walking, within, 0.0)
    rate = 2.0 * np.pi / swing_s
    # speed, height and pitch are raised cosines of the swing, so that all begin and end still
    acc_x = np.where(walking, 1.5 * rate * np.sin(phase), 0.0)
    acc_z = np.where(walking, 0.04 * rate**2 * np.cos(phase), 0.0) + GRAVITY_M_S2
    pitch = 0.3 * (1.0 - np.cos(phase))
    zero = np.zeros_like(pitch)
    along_x = acc_x * np.cos(pitch) - acc_z * np.sin(pitch)
    along_z = acc_x * np.sin(pitch) + acc_z * np.cos(pitch)
    gyr_y = np.where(walking, 0.3 * rate * np.sin(phase), 0.0)
    clean = np.stack([along_x, zero, along_z, zero, gyr_y, zero])
    noise = np.random.default_rng(1).normal(size=clean.shape)
    return clean + np.repeat([[0.03], [0.003]], 3, axis=0) * noise, SIMULATED_RATE_HZ


def repeated(signals: np.ndarray) -> np.ndarray:
    """Copies one after the other, cut at the wanted number of samples."""
    copies = -(-N_SAMPLES // signals.shape[1])
    return np.ascontiguousarray(np.tile(signals, copies)[:, :N_SAMPLES])


def measure(method: str, path: Path, rate_hz: float, repeats: int) -> None:
    """Run one method of this environment and print a line of JSON."""
    signals = np.load(path)
    if method == "vqf":
        from vqf import VQF

        def run(acc: np.ndarray, gyr: np.ndarray) -> None:
            VQF(1.0 / rate_hz).updateBatch(np.ascontiguousarray(gyr.T), np.ascontiguousarray(acc.T))
    else:
        from swaystride.gait.foot_methods import PRINTED, RECOMMENDED
        from swaystride.gait.trajectory import foot_trajectory

        chosen = {"printed": PRINTED, "recommended": RECOMMENDED}[method]

        def run(acc: np.ndarray, gyr: np.ndarray) -> None:
            foot_trajectory(acc, gyr, rate_hz, chosen)

    run(signals[:3, :COMPILE_SAMPLES], signals[3:, :COMPILE_SAMPLES])
    seconds = []
    for _ in range(repeats):
        start = time.perf_counter()
        run(signals[:3], signals[3:])
        seconds.append(time.perf_counter() - start)
    peak_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    print(json.dumps({"seconds": seconds, "peak_mb": peak_mb}))


def in_own_process(command: list[object]) -> dict[str, object]:
    """JSON that a process prints; its last words if it fails."""
    threads = dict.fromkeys(
        ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS", "MKL_NUM_THREADS"), "1"
    )
    done = subprocess.run(
        [str(part) for part in command],
        capture_output=True,
        text=True,
        env={**os.environ, **threads},
        check=False,
    )
    if done.returncode:
        return {"note": "failed: " + (done.stderr.strip().splitlines() or ["no message"])[-1]}
    return dict(json.loads(done.stdout.strip().splitlines()[-1]))


def compared(path: Path, rate_hz: float, repeats: int) -> dict[str, dict[str, object]]:
    """Every method once, in turn."""
    own = [sys.executable, Path(__file__).resolve(), "--recording", path, "--rate-hz", rate_hz]
    found = {
        method: in_own_process([*own, "--repeats", repeats, "--measure", method])
        for method in METHODS
    }
    if not GAITMAP.is_file():
        return found | {"gaitmap RTS": {"note": "not installed; run `make peers`"}}
    script = REPOSITORY / "scripts/peers_gaitmap_speed.py"
    peer = [GAITMAP, script, path, "--rate-hz", rate_hz, "--repeats", 2]
    return found | {"gaitmap RTS": in_own_process(peer)}


def report(found: dict[str, dict[str, object]]) -> list[str]:
    """Lines with samples per second (fastest run, and median), memory, ratios and targets."""
    timed = {name: values for name, values in found.items() if "seconds" in values}
    speed = {name: N_SAMPLES / min(values["seconds"]) for name, values in timed.items()}
    usual = {name: N_SAMPLES / median(values["seconds"]) for name, values in timed.items()}
    lines = [
        f"{'':14}{'samples/s':>12}{'median':>12}{'peak MB':>10}{'to vqf':>10}{'to gaitmap':>12}"
    ]
    for name, values in found.items():
        if name not in speed:
            lines.append(f"{name:14}{values['note']}")
            continue
        ratios = [
            f"{speed[name] / speed[other]:.2f}" if other in speed else "-"
            for other in ("vqf", "gaitmap RTS")
        ]
        line = f"{name:14}{speed[name]:12,.0f}{usual[name]:12,.0f}{values['peak_mb']:10.0f}"
        line += f"{ratios[0]:>10}{ratios[1]:>12}"
        if name in TARGETS:
            reached = speed[name] >= TARGETS[name] and values["peak_mb"] <= TARGET_MB
            goal = f"at least {TARGETS[name]:,.0f} samples/s, at most {TARGET_MB:.0f} MB"
            line += f"   {goal}: {'yes' if reached else 'no'}"
        lines.append(line)
    return lines


def main() -> None:
    """Build the recording, run every method, print; or be one of these processes."""
    parser = script_parser(__doc__)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--measure", choices=METHODS, help="internal: run one method")
    parser.add_argument("--recording", type=Path, help="internal")
    parser.add_argument("--rate-hz", type=float, help="internal")
    arguments = parser.parse_args()
    if arguments.measure:
        if not arguments.recording or not arguments.rate_hz:
            raise RecordingError("no recording", expected="--recording and --rate-hz")
        measure(arguments.measure, arguments.recording, arguments.rate_hz, arguments.repeats)
        return
    trial = real_trial()
    signals, rate_hz = trial or simulated_walk()
    source = f"{DATASET} {TRIAL.removesuffix('_LLIO.mat')}" if trial else "a simulated walk"
    print(
        f"{N_SAMPLES:,} samples at {rate_hz:.0f} Hz: {source}, repeated; one thread; fastest of "
        f"{arguments.repeats} runs (gaitmap: of 2) and their median"
    )
    with TemporaryDirectory() as folder:
        path = Path(folder) / "recording.npy"
        np.save(path, repeated(signals))
        print("\n".join(report(compared(path, rate_hz, arguments.repeats))))


if __name__ == "__main__":
    run_script(main)
