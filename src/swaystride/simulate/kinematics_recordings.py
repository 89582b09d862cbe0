"""Raw files of the simulated kinematics study: Opal HDF5 and C3D, with the truth kept beside."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from swaystride.io.c3d_writer import write_c3d
from swaystride.io.opal_hdf5_writer import OpalRun, OpalWriter
from swaystride.marker_recording import make_marker_recording
from swaystride.simulate.kinematics_cohort import (
    KinematicsTables,
    body_of,
    manner_of,
    trial_names,
)
from swaystride.simulate.kinematics_parameters import STUDY, KinematicsCohort
from swaystride.simulate.kinematics_truth import (
    PHASES,
    ParticipantTruth,
    Phase,
    RecordingTruth,
    WornEquipment,
    write_truth,
)
from swaystride.simulate.running_body import RunnerBody
from swaystride.simulate.running_manner import steady_run
from swaystride.simulate.running_markers import WornMarkers, filmed, wear_markers
from swaystride.simulate.running_motion import RunningMotion
from swaystride.simulate.running_recording import recorded
from swaystride.simulate.running_run import Treadmill, run_motion
from swaystride.simulate.running_sensors import WornSensors, wear_sensors
from swaystride.simulate.running_standing import standing_motion
from swaystride.simulate.running_tissue import common_tissue, usual_tissue
from swaystride.simulate.seeds import generator

_NOTE: Final = "simulated by swaystride, not a measurement"

#: Labels in the files of the sensors of the lower body, in the order of the methods (§0.2).
SENSOR_LABELS: Final = {
    "lumbar": "Lumbar",
    "thigh_right": "Right Thigh",
    "thigh_left": "Left Thigh",
    "shank_right": "Right Shank",
    "shank_left": "Left Shank",
    "foot_right": "Right Foot",
    "foot_left": "Left Foot",
}
#: When the first recording of everybody begins, and the time from one to the next, µs [N].
_START_UNIX_US: Final = 1_700_000_000_000_000
_STEP_US: Final = 900_000_000


@dataclass(frozen=True)
class Runner:
    """A participant with all that is worn.

    Parameters
    ----------
    participant : str
        Name.
    body : RunnerBody
        Lengths.
    sensors : WornSensors
        The IMUs.
    markers : WornMarkers
        The markers.
    """

    participant: str
    body: RunnerBody
    sensors: WornSensors
    markers: WornMarkers

    @property
    def worn(self) -> WornEquipment:
        """What the truth tells of sensors and markers."""
        return WornEquipment(
            sensors=tuple(SENSOR_LABELS[name] for name in self.sensors.names),
            markers=self.markers.names,
            sensor_points=self.sensors.skin,
            marker_points=self.markers.skin,
            r_sensor_from_segment=np.stack(
                [unit.r_sensor_from_body for unit in self.sensors.units]
            ),
        )


def write_participant(
    participant: str,
    *,
    tables: KinematicsTables,
    cohort: KinematicsCohort,
    seed: int,
    folder: Path | str,
    truth_file: Path | str,
) -> ParticipantTruth:
    """Simulate one participant and write the raw files and the truth.

    Parameters
    ----------
    participant : str
        Name in the tables.
    tables : KinematicsTables
        Tables of the whole cohort.
    cohort : KinematicsCohort
        Parameters.
    seed : int
        Seed of the cohort.
    folder : path or str
        Receives the recordings at the relative paths of the column ``file``.
    truth_file : path or str
        Receives the truth (:func:`swaystride.simulate.kinematics_truth.read_truth`).

    Returns
    -------
    ParticipantTruth
        The truth, as written.
    """
    folder = Path(folder)
    (folder / participant).mkdir(parents=True, exist_ok=True)
    people = tables.participants.set_index("participant")
    height_m, mass_kg = (float(people[name][participant]) for name in ("height_m", "mass_kg"))
    runner = dressed(participant, body_of(height_m, mass_kg), cohort, seed)
    files = tables.trials.set_index(["participant", "trial", "kind"])["file"]
    recordings: dict[tuple[str, Phase], RecordingTruth] = {}
    for trial in trial_names(cohort):
        for phase in PHASES:
            rng = generator(seed, STUDY, participant, f"trial {trial}", phase, "sync")
            truth = RecordingTruth(
                motion=motion_of(runner, trial, phase, cohort, seed),
                worn=runner.worn,
                marker_start_s=float(cohort.protocol.sync_jitter_s * rng.uniform(-1.0, 1.0)),
            )
            recordings[trial, phase] = truth
            imu, optics = (
                folder / str(files[participant, trial, f"{phase}_{kind}"])
                for kind in ("imu", "markers")
            )
            _write_imus(imu, runner, trial, phase, truth, cohort, seed)
            _write_markers(optics, runner, trial, phase, truth, cohort, seed)
    whole = ParticipantTruth(participant, runner.worn, recordings)
    write_truth(truth_file, whole)
    return whole


def dressed(participant: str, body: RunnerBody, cohort: KinematicsCohort, seed: int) -> Runner:
    """Participant with sensors and markers, which stay on for all trials.

    Parameters
    ----------
    participant : str
        Name.
    body : RunnerBody
        Lengths.
    cohort : KinematicsCohort
        Parameters.
    seed : int
        Seed of the cohort.
    """
    common = common_tissue(generator(seed, STUDY, participant, "tissue"))
    sensors = wear_sensors(
        body,
        tuple(SENSOR_LABELS),
        mounting=cohort.mounting,
        tissue=usual_tissue(),
        common=common,
        rng=generator(seed, STUDY, participant, "sensors"),
    )
    markers = wear_markers(
        body,
        sensors,
        place_sd_m=cohort.marker_place_sd_m,
        tissue=usual_tissue(),
        common=common,
        rng=generator(seed, STUDY, participant, "markers"),
    )
    return Runner(participant, body, sensors, markers)


def motion_of(
    runner: Runner, trial: str, phase: Phase, cohort: KinematicsCohort, seed: int
) -> RunningMotion:
    """What a participant does in one recording.

    Parameters
    ----------
    runner : Runner
        Who.
    trial : str
        Name of the trial.
    phase : {"running", "standing"}
        Which of its two recordings.
    cohort : KinematicsCohort
        Parameters.
    seed : int
        Seed of the cohort.

    Returns
    -------
    RunningMotion
    """
    protocol = cohort.protocol
    rng = generator(seed, STUDY, runner.participant, f"trial {trial}", phase, "motion")
    if phase == "standing":
        return standing_motion(
            runner.body, cohort.standing, duration_s=protocol.standing_s, rng=rng
        )
    treadmill = Treadmill(float(rng.uniform(*protocol.belt_dip)))
    return run_motion(
        runner.body,
        manner_of(runner.participant, trial, cohort, seed),
        steady_run(protocol.duration_s, protocol.belt_speed_m_s),
        duration_s=protocol.duration_s,
        variability=cohort.stride,
        rng=rng,
        treadmill=treadmill,
    )


def lost_marker(participant: str, trial: str, cohort: KinematicsCohort, seed: int) -> str | None:
    """Marker that is lost throughout a running trial, or None where the optics work.

    Parameters
    ----------
    participant, trial : str
        Names.
    cohort : KinematicsCohort
        Parameters.
    seed : int
        Seed of the cohort.
    """
    protocol = cohort.protocol
    if f"{participant}/{trial}" not in protocol.failed_optics:
        return None
    rng = generator(seed, STUDY, participant, f"trial {trial}", "failed optics")
    return str(rng.choice(protocol.failed_markers))


def _write_imus(
    path: Path,
    runner: Runner,
    trial: str,
    phase: Phase,
    truth: RecordingTruth,
    cohort: KinematicsCohort,
    seed: int,
) -> None:
    """Record the IMUs and write their file, piece by piece."""
    rate_hz = cohort.protocol.rate_hz
    nth = 2 * trial_names(cohort).index(trial) + PHASES.index(phase)
    run = OpalRun(
        ids=tuple(f"SI-{number:06d}" for number in range(1, len(SENSOR_LABELS) + 1)),
        labels=truth.worn.sensors,
        rate_hz=rate_hz,
        start_unix_us=_START_UNIX_US + nth * _STEP_US,
        note=_NOTE,
    )
    rng = generator(seed, STUDY, runner.participant, f"trial {trial}", phase, "imu")
    with OpalWriter(path, run) as writer:
        for chunk in recorded(truth.motion, runner.sensors, rate_hz=rate_hz, rng=rng):
            writer.append(acc_m_s2=chunk.acc_m_s2, gyr_rad_s=chunk.gyr_rad_s)


def _write_markers(
    path: Path,
    runner: Runner,
    trial: str,
    phase: Phase,
    truth: RecordingTruth,
    cohort: KinematicsCohort,
    seed: int,
) -> None:
    """Film the markers and write their file."""
    rng = generator(seed, STUDY, runner.participant, f"trial {trial}", phase, "cameras")
    chunks = filmed(
        truth.motion,
        runner.markers,
        rate_hz=cohort.protocol.rate_hz,
        errors=cohort.cameras,
        rng=rng,
        start_s=truth.marker_start_s,
    )
    film = np.concatenate([chunk.position_m for chunk in chunks])
    lost = lost_marker(runner.participant, trial, cohort, seed)
    if phase == "running" and lost is not None:
        film[:, runner.markers.names.index(lost)] = np.nan
    recording = make_marker_recording(
        np.moveaxis(film, 0, -1),
        markers=runner.markers.names,
        rate_hz=cohort.protocol.rate_hz,
        rate_source="simulation",
        subject=runner.participant,
        device=_NOTE,
    )
    write_c3d(path, recording, unit="mm", description=_NOTE)
