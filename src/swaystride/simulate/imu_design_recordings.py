"""Raw files of the simulated IMU-design study, one per sensor, with the truth kept beside."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.io.apdm_csv_writer import write_apdm_csv
from swaystride.io.sidecar_csv_writer import write_sidecar_csv
from swaystride.recording import Recording, make_recording
from swaystride.simulate.foot_anchors import gait_anchors
from swaystride.simulate.foot_kinematics import point_signals
from swaystride.simulate.foot_motion import FootMotion
from swaystride.simulate.foot_person import Foot
from swaystride.simulate.foot_pieces import foot_motion
from swaystride.simulate.foot_trial import FootTrial, foot_trial
from swaystride.simulate.imu_design_cohort import IMUS, ImuDesignTables, mean_speeds, person_of
from swaystride.simulate.imu_design_parameters import STUDY, FootSensor, ImuDesignCohort
from swaystride.simulate.imu_design_truth import write_truth
from swaystride.simulate.inertial_sensor import SensorUnit, draw_unit, measure
from swaystride.simulate.sampling import decimation_factor, filter_reach
from swaystride.simulate.seeds import generator

Array = NDArray[np.float64]

_NOTE = "simulated by swaystride, not a measurement"
#: Samples of the simulation that are evaluated at once: they fit into a processor's cache.
_CHUNK = 16384


def write_participant(
    participant: str,
    *,
    tables: ImuDesignTables,
    cohort: ImuDesignCohort,
    seed: int,
    folder: Path | str,
    truth_file: Path | str,
) -> dict[str, FootTrial]:
    """Simulate one participant and write the raw files and the truth.

    Parameters
    ----------
    participant : str
        Name in the tables.
    tables : ImuDesignTables
        Tables of the whole cohort.
    cohort : ImuDesignCohort
        Parameters.
    seed : int
        Seed of the cohort.
    folder : path or str
        Receives the recordings at the relative paths of the column ``file``.
    truth_file : path or str
        Receives the truth (:func:`swaystride.simulate.imu_design_truth.read_truth`).

    Returns
    -------
    dict of str to FootTrial
        What the feet did in each trial.
    """
    folder = Path(folder)
    people = tables.participants.set_index("participant")
    height_m = float(people["height_m"][participant])
    person = person_of(participant, height_m, cohort, seed)
    own = tables.trials[tables.trials["participant"] == participant]
    speeds = mean_speeds(participant, cohort, seed)
    trials = {}
    units: dict[tuple[str, str], SensorUnit] = {
        (foot.side, imu): sensor_unit(foot, cohort.imu(imu), participant, imu, seed)
        for foot in person.feet
        for imu in IMUS
    }
    for (trial, rows), speed in zip(own.groupby("trial"), speeds, strict=True):
        trials[str(trial)] = foot_trial(
            person,
            float(speed),
            course=cohort.course,
            scatter=cohort.stride,
            anchors=gait_anchors(),
            rng=generator(seed, STUDY, participant, f"trial {trial}"),
        )
        for foot in person.feet:
            motion = foot_motion(foot.sole, getattr(trials[str(trial)], foot.side))
            for imu in IMUS:
                file = rows.loc[(rows["foot"] == foot.side) & (rows["imu"] == imu), "file"].item()
                rng = generator(seed, STUDY, participant, f"trial {trial}", foot.side, imu)
                acc, gyr = sensor_signals(
                    motion,
                    foot.sensor_m[IMUS.index(imu)],
                    cohort.imu(imu),
                    units[foot.side, imu],
                    duration_s=trials[str(trial)].duration_s,
                    rng=rng,
                )
                _write(folder / file, acc, gyr, cohort.imu(imu), foot.side, imu)
    write_truth(truth_file, participant, person, trials, distance_m=cohort.course.distance_m)
    return trials


def sensor_unit(
    foot: Foot, sensor: FootSensor, participant: str, imu: str, seed: int
) -> SensorUnit:
    """Constant errors of one sensor on one foot, mounted as the foot says.

    Parameters
    ----------
    foot : Foot
        Which foot.
    sensor : FootSensor
        Which type.
    participant, imu : str
        Whose sensor, and its name.
    seed : int
        Seed of the cohort.
    """
    unit = draw_unit(
        sensor.model,
        tilt_sd_deg=0.0,
        heading_sd_deg=0.0,
        rng=generator(seed, STUDY, participant, foot.side, imu),
    )
    return replace(unit, r_sensor_from_body=foot.r_sensor_from_foot)


def sensor_signals(
    motion: FootMotion,
    point_m: Array,
    sensor: FootSensor,
    unit: SensorUnit,
    *,
    duration_s: float,
    rng: np.random.Generator,
) -> tuple[Array, Array]:
    """What a sensor on a foot reports of a trial.

    Parameters
    ----------
    motion : FootMotion
        What the foot does.
    point_m : ndarray, shape (3,)
        The sensor from the ankle, in axes of the foot.
    sensor : FootSensor
        Type and rates.
    unit : SensorUnit
        Its constant errors.
    duration_s : float
        Length of the recording.
    rng : numpy.random.Generator
        Source of the noise.

    Returns
    -------
    acc_m_s2, gyr_rad_s : ndarray, shape (3, n_samples)
    """
    rate = sensor.simulation_rate_hz
    factor = decimation_factor(rate, sensor.rate_hz)
    reach = filter_reach(rate, sensor.rate_hz)
    n_samples = int(duration_s * sensor.rate_hz) + 1
    n_fine = (n_samples - 1) * factor + 1 + 2 * reach
    acc, gyr = np.empty((3, n_fine)), np.empty((3, n_fine))
    for begin in range(0, n_fine, _CHUNK):
        place = slice(begin, min(begin + _CHUNK, n_fine))
        time = (np.arange(place.start, place.stop) - reach) / rate
        acc[:, place], gyr[:, place] = point_signals(motion.pose(time), point_m)
    return measure(
        sensor.model,
        unit,
        acc_m_s2=acc,
        gyr_rad_s=gyr,
        rate_hz=rate,
        output_rate_hz=sensor.rate_hz,
        rng=rng,
    )


def _write(path: Path, acc: Array, gyr: Array, sensor: FootSensor, side: str, imu: str) -> None:
    """Write the file that the vendor's software would export."""
    path.parent.mkdir(parents=True, exist_ok=True)
    label = f"{side.capitalize()} Foot"
    recording: Recording = make_recording(
        rate_hz=sensor.rate_hz,
        rate_source="argument",
        sensors=[label],
        acc_m_s2=acc[None],
        gyr_rad_s=gyr[None],
        device=f"{imu.replace('_', ' ').upper()}, {_NOTE}",
    )
    if imu == "imu_1":
        write_apdm_csv(path, recording, test_name=f"{path.stem}: {_NOTE.replace(',', ' -')}")
    else:
        write_sidecar_csv(path, recording, whole={"acc": "mg", "gyr": "mdeg/s"})


def trial_summary(trials: dict[str, FootTrial], distance_m: float) -> pd.DataFrame:
    """Mean speed and steps of each trial.

    Parameters
    ----------
    trials : dict of str to FootTrial
        From :func:`write_participant`.
    distance_m : float
        From rest to rest.
    """
    return pd.DataFrame(
        {
            "trial": list(trials),
            "mean_speed_m_s": [distance_m / (t.stop_s - t.start_s) for t in trials.values()],
            "n_steps": [len(t.left) + len(t.right) - 2 for t in trials.values()],
        }
    )
