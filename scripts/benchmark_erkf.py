"""Time the error-state Kalman filter of seven sensors, and its memory over six minutes at 200 Hz.

Run by ``python scripts/benchmark_erkf.py``. The body stands still with noisy sensors; the time of a
step depends on which constraints are active, not on the motion, so joint centres and axes are
active at every sample and each foot half of the time. Every case runs in a process of its own with
one thread, compiles on a short piece first, and is timed by the processor time that it used.
"""

import json
import os
import resource
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from statistics import median

import numpy as np

from swaystride.command_line import run_script, script_parser
from swaystride.erkf.body import LOWER_LIMB_JOINTS, SEGMENTS, Body, lower_limb_body
from swaystride.erkf.lower_limbs import estimate_lower_limbs
from swaystride.erkf.noise import RUNNING_PRINTED
from swaystride.erkf.options import PRINTED_OPTIONS, RECOMMENDED_OPTIONS
from swaystride.erkf.start import START_AT_REST, Start
from swaystride.recording import Recording, make_recording
from swaystride.rotations import matrix_from_quaternion
from swaystride.units import GRAVITY_M_S2

RATE_HZ = 200.0
N_SAMPLES = int(360 * RATE_HZ)
COMPILE_SAMPLES = 200
#: Steps per second that each case must reach, and megabytes that none may exceed. `recommended`
#: applies the joints at 50 Hz and has no target of its own.
TARGETS = {
    "9 states, filter": 15_000,
    "12 states, filter": 9_000,
    "9 states, smoother": 3_500,
    "12 states, smoother": 1_800,
    "recommended, smoother": None,
}
TARGET_MB = 1024.0


def standing_body(rng: np.random.Generator) -> tuple[Body, Start]:
    """Sensors anywhere around a body that stands; the joints half way between them."""
    q = rng.normal(size=(len(SEGMENTS), 4))
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    r = matrix_from_quaternion(q)
    position = rng.normal(scale=0.5, size=(len(SEGMENTS), 3))
    centres = {}
    for kind, side, proximal, distal in LOWER_LIMB_JOINTS:
        one, two = SEGMENTS.index(proximal), SEGMENTS.index(distal)
        middle = 0.5 * (position[one] + position[two])
        centres[f"{side}_{kind}"] = tuple(r[j].T @ (middle - position[j]) for j in (one, two))
    levers = {foot: np.array([0.0, -0.08, 0.0]) for foot in ("right_foot", "left_foot")}
    # all anatomical frames agree with the world, so that all joint axes are parallel
    body = lower_limb_body(r, centres, levers)
    still = np.zeros_like(position)
    return body, Start(position, still, q, still, START_AT_REST)


def standing_recording(start: Start, n_samples: int, rng: np.random.Generator) -> Recording:
    """Gravity and white noise."""
    up = matrix_from_quaternion(start.q_world_from_sensor)[:, 2]
    noise = rng.normal(size=(2, len(up), 3, n_samples))
    return make_recording(
        rate_hz=RATE_HZ,
        rate_source="argument",
        sensors=SEGMENTS,
        acc_m_s2=GRAVITY_M_S2 * up[:, :, None] + 0.05 * noise[0],
        gyr_rad_s=0.01 * noise[1],
    )


def measure(case: str, repeats: int) -> None:
    """Run one case and print a line of JSON."""
    states, method = case.split(", ")
    options = {
        "9 states": PRINTED_OPTIONS,
        "12 states": replace(PRINTED_OPTIONS, gyro_bias=True),
        "recommended": RECOMMENDED_OPTIONS,
    }[states]
    rng = np.random.default_rng(1)
    body, start = standing_body(rng)
    feet = np.arange(N_SAMPLES) // 70 % 2 == np.array([[0], [1]])
    recording = standing_recording(start, N_SAMPLES, rng)

    def run(n_samples: int) -> None:
        estimate_lower_limbs(
            recording.isel(time=slice(n_samples)),
            body,
            feet[:, :n_samples],
            RUNNING_PRINTED,
            start=start,
            options=options,
            method=method,
        )

    run(COMPILE_SAMPLES)
    seconds = []
    for _ in range(repeats):
        begin = time.process_time()
        run(N_SAMPLES)
        seconds.append(time.process_time() - begin)
    peak_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    print(json.dumps({"seconds": seconds, "peak_mb": peak_mb}))


def in_own_process(case: str, repeats: int) -> dict[str, object]:
    """JSON that the process of a case prints."""
    threads = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")
    command = [sys.executable, Path(__file__).resolve(), "--measure", case, "--repeats", repeats]
    done = subprocess.run(
        [str(part) for part in command],
        capture_output=True,
        text=True,
        env={**os.environ, **threads},
        check=True,
    )
    return dict(json.loads(done.stdout.strip().splitlines()[-1]))


def report(case: str, found: dict[str, object]) -> str:
    """Line of a case: steps per second (fastest run and median), memory, and its target."""
    speed, usual = (N_SAMPLES / pick(found["seconds"]) for pick in (min, median))
    line = f"{case:24}{speed:10,.0f}{usual:10,.0f}{found['peak_mb']:9.0f}"
    if (target := TARGETS[case]) is not None:
        reached = speed >= target and found["peak_mb"] <= TARGET_MB
        goal = f"at least {target:,} steps/s, at most {TARGET_MB:.0f} MB"
        line += f"   {goal}: {'yes' if reached else 'no'}"
    return line


def main() -> None:
    """Run every case and print; or be one of their processes."""
    parser = script_parser(__doc__)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--measure", choices=TARGETS, help="internal: run one case")
    arguments = parser.parse_args()
    if arguments.measure:
        measure(arguments.measure, arguments.repeats)
        return
    print(f"{N_SAMPLES:,} samples at {RATE_HZ:.0f} Hz, seven sensors; one thread")
    print(f"{'':24}{'steps/s':>10}{'median':>10}{'peak MB':>9}")
    for case in TARGETS:
        print(report(case, in_own_process(case, arguments.repeats)), flush=True)


if __name__ == "__main__":
    run_script(main)
