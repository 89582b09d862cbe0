"""Raw files of the simulated experience study, with the truth kept beside."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.gait.event_windows import window_maxima
from swaystride.gait.run_measures import MEASURES, MeasureRules
from swaystride.gait.running_events import SIDES
from swaystride.gait.segment_signals import VERTICAL
from swaystride.io.study_tables import write_study_table
from swaystride.simulate.experience_beats import mean_rate_of_beats_bpm
from swaystride.simulate.experience_cohort import ExperienceTables
from swaystride.simulate.experience_heart import write_strap
from swaystride.simulate.experience_parameters import ExperienceCohort
from swaystride.simulate.experience_plans import PlannedRun, beats_of, planned_run
from swaystride.simulate.experience_recordings import (
    HEAD,
    SENSOR_LABELS,
    Phase,
    WornRun,
    calibration_motion,
    recording,
    running_motion,
    worn_run,
)
from swaystride.simulate.experience_truth import (
    RunTruth,
    true_measures,
    true_strides,
    write_run_truth,
    write_true_values,
)
from swaystride.simulate.running_motion import RunningMotion
from swaystride.simulate.running_recording import n_samples
from swaystride.simulate.running_tissue import SkinPoints
from swaystride.units import GRAVITY_M_S2

Array = NDArray[np.float64]


def write_run(
    run: str,
    *,
    tables: ExperienceTables,
    cohort: ExperienceCohort,
    rules: MeasureRules,
    seed: int,
    folder: Path | str,
    truth_folder: Path | str,
) -> dict[str, Any]:
    """Simulate one run and write its raw files and its truth.

    Written are all files of the run in the table but the ratings, and ``<run>.json``,
    ``<run>_strides.parquet`` and ``<run>.npz`` of the truth.

    Parameters
    ----------
    run : str
        Name, as ``P01_01``.
    tables : ExperienceTables
        Tables of the whole cohort.
    cohort : ExperienceCohort
        Parameters.
    rules : MeasureRules
        How true measures are taken of perfect signals and true events.
    seed : int
        Seed of the cohort.
    folder : path or str
        Receives the files at the relative paths of the table of runs.
    truth_folder : path or str
        Receives the truth.

    Returns
    -------
    dict
        The true values, as written.
    """
    folder, truth_folder = Path(folder), Path(truth_folder)
    planned = planned_run(run, tables, cohort, seed)
    worn = worn_run(planned, cohort, seed)
    row = tables.runs[tables.runs["participant"] + "_" + tables.runs["run"] == run].iloc[0]
    (folder / str(row["imu"])).parent.mkdir(parents=True, exist_ok=True)
    calibration: tuple[Phase, ...] = ("standing", "walking")
    axes: Array = np.empty(0)
    for phase in calibration:
        motion = calibration_motion(worn, phase)
        if phase == "standing":
            axes = standing_axes(motion, worn.sensors.skin)
        for _ in recording(folder / str(row[phase]), worn, motion, phase):
            pass
    write_study_table(events_of(planned, cohort), folder / str(row["events"]))
    if row["ecg"]:
        start = worn.start_unix_us("running")
        write_strap(folder / str(row["ecg"]), planned, cohort, seed, start_unix_us=start)
    motion = running_motion(planned, cohort, seed)
    rate_hz = cohort.protocol.rate_hz
    shape = (len(worn.sensors.names), 6, n_samples(motion, rate_hz))
    ideal: NDArray[np.float32] = np.empty(shape, dtype=np.float32)
    for chunk in recording(folder / str(row["imu"]), worn, motion, "running"):
        assert chunk.ideal is not None
        ideal[..., chunk.first : chunk.first + chunk.ideal.shape[-1]] = chunk.ideal
    _turn(ideal, axes)
    return _write_truth(worn, motion, ideal, axes, rules, truth_folder)


def events_of(planned: PlannedRun, cohort: ExperienceCohort) -> pd.DataFrame:
    """What a lab would note of a run: the turn, and what was lost.

    Parameters
    ----------
    planned : PlannedRun
        The run.
    cohort : ExperienceCohort
        Parameters.

    Returns
    -------
    DataFrame
        ``start_s``, ``stop_s`` (from the first sample of the IMUs, to a tenth of a second),
        ``event`` and ``sensor`` (a label, ``ratings``, ``heart rate``, or empty for all).
    """
    lost, run = cohort.losses, planned.name
    end = cohort.protocol.duration_s
    begin = end - lost.ratings_lost_s
    rows = [(*(round(edge, 1) for edge in planned.turn_s), "turn", "")]
    for runs, start, event, sensor in (
        (lost.heart_rate_runs, 0.0, "data_loss", "heart rate"),
        (lost.head_lost_runs, 0.0, "data_loss", SENSOR_LABELS[HEAD]),
        (lost.head_loose_runs, 0.0, "poor_attachment", SENSOR_LABELS[HEAD]),
        (lost.ratings_runs, begin, "data_loss", "ratings"),
    ):
        if run in runs:
            rows.append((start, end, event, sensor))
    return pd.DataFrame(rows, columns=["start_s", "stop_s", "event", "sensor"])


def _write_truth(
    worn: WornRun,
    motion: RunningMotion,
    ideal: NDArray[np.float32],
    axes: Array,
    rules: MeasureRules,
    folder: Path,
) -> dict[str, Any]:
    """Write the three files of the truth of a run."""
    planned, cohort, sensors = worn.planned, worn.cohort, worn.sensors
    mounting = np.stack([unit.r_sensor_from_body for unit in sensors.units])
    write_run_truth(
        folder / f"{planned.name}.npz", RunTruth(motion, sensors.names, sensors.skin, mounting)
    )
    strides = true_strides(motion, planned.excluded)
    measured = true_measures(
        ideal,
        sensors.names,
        strides,
        rate_hz=cohort.protocol.rate_hz,
        mass_kg=planned.mass_kg,
        rules=rules,
    )
    measured.strides.to_parquet(folder / f"{planned.name}_strides.parquet")
    keep = measured.strides["is_steady"].to_numpy()
    means = measured.mean_over(keep)
    values: dict[str, Any] = {
        "run": planned.name,
        "pattern": planned.pattern,
        "drawn": {
            "duty_factor": planned.duty_factor,
            "speed_m_s": planned.speed_m_s,
            "heart_rate_bpm": planned.heart_rate_bpm,
        },
        "turn_s": list(planned.turn_s),
        "n_strides": int(keep.sum()),
        "measures": {name: _known(means[name]) for name in MEASURES},
        "alignment": {
            name: (own @ unit.r_sensor_from_body.T).ravel().tolist()
            for name, own, unit in zip(sensors.names, axes, sensors.units, strict=True)
        },
        "unfiltered_peak_tibial_g": _unfiltered_peak_g(
            ideal, sensors.names, measured.strides, cohort.protocol.rate_hz, rules
        ),
    }
    beats = beats_of(planned, cohort, worn.seed)
    values["measures"]["heart_rate_bpm"] = mean_rate_of_beats_bpm(beats, planned.steady_s)
    write_true_values(folder / f"{planned.name}.json", values)
    return values


def standing_axes(standing: RunningMotion, points: SkinPoints) -> Array:
    """Anatomical axes of each point: up is the vertical in standing, right is that of its segment.

    Who stands with bent knees has shanks that lean; the printed axis is the vertical all the same.

    Parameters
    ----------
    standing : RunningMotion
        The calibration.
    points : SkinPoints
        Where the sensors are.

    Returns
    -------
    ndarray, shape (n_points, 3, 3)
        ``r_anatomical_from_segment``: rows forward, up, right.
    """
    times = np.linspace(0.0, standing.duration_s, 50)
    rotations = standing.states(times).r_world_from_segment[:, points.rows[:, 0]]
    up = rotations[:, :, 2].mean(axis=0)
    up /= np.linalg.norm(up, axis=1, keepdims=True)
    right = np.array([0.0, 0.0, 1.0]) - up[:, 2:] * up
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    return np.stack([np.cross(up, right), up, right], axis=1)


def _turn(ideal: NDArray[np.float32], axes: Array) -> None:
    """Turn perfect signals from axes of the segments into anatomical ones, in place."""
    for signals, r_anatomical_from_segment in zip(ideal, axes, strict=True):
        turned = r_anatomical_from_segment.astype(np.float32)
        signals[:3], signals[3:] = turned @ signals[:3], turned @ signals[3:]


def _unfiltered_peak_g(
    ideal: NDArray[np.float32],
    names: tuple[str, ...],
    strides: pd.DataFrame,
    rate_hz: float,
    rules: MeasureRules,
) -> float:
    """Mean peak tibial acceleration over the steady strides of perfect sensors without a filter."""
    means = []
    for side in SIDES:
        own = strides[(strides["side"] == side) & strides["is_steady"]]
        contact = own["start_s"].to_numpy(float)
        up = ideal[names.index(f"shank_{side}"), VERTICAL]
        begin, end = contact - rules.impact.before_s, contact + rules.impact.after_s
        means.append(float(np.nanmean(window_maxima(up, begin, end, rate_hz))))
    return float(np.mean(means)) / GRAVITY_M_S2


def _known(value: float) -> float | None:
    """Value, or None where there is none: too few strides."""
    return float(value) if np.isfinite(value) else None
