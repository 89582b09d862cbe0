"""What the IMUs of the simulated experience study record: calibration and run, with what is lost."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal

import numpy as np

from swaystride.io.opal_hdf5_writer import OpalRun, OpalWriter
from swaystride.simulate.experience_parameters import STUDY, ExperienceCohort
from swaystride.simulate.experience_plans import PlannedRun
from swaystride.simulate.running_motion import RunningMotion
from swaystride.simulate.running_recording import SensorChunk, recorded
from swaystride.simulate.running_run import run_motion
from swaystride.simulate.running_sensors import WornSensors, wear_sensors
from swaystride.simulate.running_standing import standing_motion
from swaystride.simulate.running_tissue import common_tissue, usual_tissue
from swaystride.simulate.running_walk import walk_motion
from swaystride.simulate.seeds import generator

Phase = Literal["standing", "walking", "running"]

_NOTE: Final = "simulated by swaystride, not a measurement"

#: Labels in the files of the 13 sensors.
SENSOR_LABELS: Final = {
    "foot_right": "Right Foot",
    "foot_left": "Left Foot",
    "shank_right": "Right Shank",
    "shank_left": "Left Shank",
    "thigh_right": "Right Thigh",
    "thigh_left": "Left Thigh",
    "lumbar": "Lumbar",
    "sternum": "Sternum",
    "upper_arm_right": "Right Upper Arm",
    "upper_arm_left": "Left Upper Arm",
    "wrist_right": "Right Wrist",
    "wrist_left": "Left Wrist",
    "head": "Head",
}
HEAD: Final = "head"
#: When everybody's first run begins, the time to the next run, and from one recording to the next,
#: µs [N].
_START_UNIX_US: Final = 1_700_000_000_000_000
_RUN_STEP_US: Final = 3 * 86_400_000_000
_BEFORE_US: Final[dict[Phase, int]] = {
    "standing": 600_000_000,
    "walking": 420_000_000,
    "running": 0,
}


@dataclass(frozen=True)
class WornRun:
    """A run with all that its files are made of.

    Parameters
    ----------
    planned : PlannedRun
        What it is meant to be.
    sensors : WornSensors
        As they are worn in its three recordings.
    cohort : ExperienceCohort
        Parameters.
    seed : int
        Seed of the cohort.
    """

    planned: PlannedRun
    sensors: WornSensors
    cohort: ExperienceCohort
    seed: int

    def rng(self, *names: str) -> np.random.Generator:
        """Random numbers of something that belongs to this run."""
        return generator(self.seed, STUDY, self.planned.name, *names)

    def start_unix_us(self, phase: Phase) -> int:
        """First time stamp of one of its recordings."""
        nth = int(self.planned.name.split("_")[1]) - 1
        return _START_UNIX_US + nth * _RUN_STEP_US - _BEFORE_US[phase]


def worn_run(planned: PlannedRun, cohort: ExperienceCohort, seed: int) -> WornRun:
    """Put the sensors on for a run; the soft tissue is the person's.

    Parameters
    ----------
    planned : PlannedRun
        The run.
    cohort : ExperienceCohort
        Parameters.
    seed : int
        Seed of the cohort.
    """
    participant = planned.name.split("_")[0]
    sensors = wear_sensors(
        planned.body,
        tuple(SENSOR_LABELS),
        mounting=cohort.mounting,
        tissue=usual_tissue(),
        common=common_tissue(generator(seed, STUDY, participant, "tissue")),
        rng=generator(seed, STUDY, planned.name, "sensors"),
    )
    return WornRun(planned, sensors, cohort, seed)


def running_motion(planned: PlannedRun, cohort: ExperienceCohort, seed: int) -> RunningMotion:
    """Motion of the run itself.

    Parameters
    ----------
    planned : PlannedRun
        The run.
    cohort : ExperienceCohort
        Parameters.
    seed : int
        Seed of the cohort.
    """
    return run_motion(
        planned.body,
        planned.manner,
        planned.profile,
        duration_s=cohort.protocol.duration_s,
        variability=cohort.stride,
        rng=generator(seed, STUDY, planned.name, "motion"),
    )


def calibration_motion(worn: WornRun, phase: Phase) -> RunningMotion:
    """Motion of the calibration before a run.

    Parameters
    ----------
    worn : WornRun
        The run.
    phase : {"standing", "walking"}
        Which calibration.
    """
    cohort, planned = worn.cohort, worn.planned
    rng = worn.rng(phase, "motion")
    if phase == "standing":
        return standing_motion(
            planned.body, cohort.standing, duration_s=cohort.protocol.standing_s, rng=rng
        )
    protocol = cohort.protocol
    z = float(np.clip(rng.standard_normal(), -2.0, 2.0))
    return walk_motion(
        planned.body,
        planned.manner,
        protocol.walking_speed_m_s + protocol.walking_speed_sd_m_s * z,
        course=cohort.walk,
        scatter=cohort.walking_stride,
        rng=rng,
    )


def recording(
    path: Path, worn: WornRun, motion: RunningMotion, phase: Phase
) -> Iterator[SensorChunk]:
    """Record a motion and write its file, part by part.

    Parameters
    ----------
    path : Path
        File to write; its folder exists. It is whole when the last part has been taken.
    worn : WornRun
        Who wears what.
    motion : RunningMotion
        What happens.
    phase : {"standing", "walking", "running"}
        Which recording of the run.

    Yields
    ------
    SensorChunk
        As written; that of the run with ideal signals, of all sensors.
    """
    losses, run = worn.cohort.losses, worn.planned.name
    is_run = phase == "running"
    kept = [
        k
        for k, name in enumerate(worn.sensors.names)
        if not (is_run and name == HEAD and run in losses.head_lost_runs)
    ]
    labels = tuple(SENSOR_LABELS[name] for name in worn.sensors.names)
    header = OpalRun(
        ids=tuple(f"SI-{k + 1:06d}" for k in kept),
        labels=tuple(labels[k] for k in kept),
        rate_hz=worn.cohort.protocol.rate_hz,
        start_unix_us=worn.start_unix_us(phase),
        note=_NOTE,
    )
    with OpalWriter(path, header) as writer:
        for chunk in recorded(
            motion,
            worn.sensors,
            rate_hz=header.rate_hz,
            rng=worn.rng(phase, "imu"),
            with_ideal=is_run,
        ):
            if is_run and run in losses.head_loose_runs:
                _shake(chunk, worn)
            writer.append(acc_m_s2=chunk.acc_m_s2[kept], gyr_rad_s=chunk.gyr_rad_s[kept])
            yield chunk


def _shake(chunk: SensorChunk, worn: WornRun) -> None:
    """Add what a badly attached sensor of the head does: it shakes, more in some moments."""
    losses = worn.cohort.losses
    rng = worn.rng("loose")
    direction = rng.standard_normal(3)
    phase = 2.0 * np.pi * rng.random(2)
    n = chunk.acc_m_s2.shape[-1]
    time = (chunk.first + np.arange(n)) / worn.cohort.protocol.rate_hz
    swell = 1.0 + np.sin(2.0 * np.pi * 0.1 * losses.loose_hz * time + phase[0])
    shaking = losses.loose_m_s2 * swell * np.sin(2.0 * np.pi * losses.loose_hz * time + phase[1])
    head = worn.sensors.names.index(HEAD)
    chunk.acc_m_s2[head] += np.outer(direction / np.linalg.norm(direction), shaking)
