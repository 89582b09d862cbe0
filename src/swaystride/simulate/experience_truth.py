"""Truth of a run of the simulated experience study: motion, true strides and true measures."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.gait.run_measures import MeasureRules, RunMeasures, measure_run
from swaystride.gait.running_events import SIDES
from swaystride.gait.segment_signals import SegmentSignals
from swaystride.gait.spatiotemporal import RUNNING_STRIDES, running_strides
from swaystride.gait.steady_parts import is_steady
from swaystride.simulate.running_body import SEGMENTS
from swaystride.simulate.running_motion import RunningMotion
from swaystride.simulate.running_tissue import SkinPoints
from swaystride.simulate.running_truth import (
    Arrays,
    motion_arrays,
    motion_from_arrays,
    points_arrays,
    points_from_arrays,
    reading_truth,
)

Array = NDArray[np.float64]

_FORMAT: Final = "swaystride-experience-truth-1"
_NOTE: Final = "simulated by swaystride, not a measurement"
_POINTS: Final = "sensors"


@dataclass(frozen=True)
class RunTruth:
    """What happened in a run; times are those of its IMUs.

    Parameters
    ----------
    motion : RunningMotion
        What the participant did.
    sensors : tuple of str
        Names, in the order of the points.
    points : SkinPoints
        Where the sensors were and how soft tissue moved them.
    r_sensor_from_segment : ndarray, shape (n_sensors, 3, 3)
        Mounting: from axes of the segment, turned with the soft tissue, to axes of the sensor.
    """

    motion: RunningMotion
    sensors: tuple[str, ...]
    points: SkinPoints
    r_sensor_from_segment: Array


def true_strides(motion: RunningMotion, excluded: pd.DataFrame) -> pd.DataFrame:
    """Strides from first touch to first touch, with true lengths.

    Parameters
    ----------
    motion : RunningMotion
        What happened.
    excluded : DataFrame
        Parts that are not steady.

    Returns
    -------
    DataFrame
        As from :func:`swaystride.gait.spatiotemporal.with_lengths`, and ``is_steady``. The length
        is the way of the ankle over the ground between the two first touches.
    """
    tables = []
    for side, name in enumerate(SIDES):
        contact, off = motion.contacts_s(side)
        nth = np.searchsorted(off, contact, side="right")
        following = np.append(off, np.nan)[nth]
        tables.append(
            pd.DataFrame({"side": name, "initial_contact_s": contact, "toe_off_s": following})
        )
    strides = running_strides(pd.concat(tables, ignore_index=True), RUNNING_STRIDES)
    foot = SEGMENTS.index("foot_right") + (strides["side"] == "left").to_numpy().astype(int)
    row = np.arange(len(strides))
    begin, end = (
        motion.states(strides[edge].to_numpy()).position_m[row, foot, :2]
        for edge in ("start_s", "stop_s")
    )
    length = np.hypot(*(end - begin).T)
    steady = is_steady(strides["start_s"], strides["stop_s"], excluded) & strides["is_valid"]
    return strides.assign(
        stride_length_m=length,
        speed_m_s=length / strides["stride_time_s"].to_numpy(),
        is_steady=steady.to_numpy(),
    )


def true_measures(
    ideal: NDArray[np.float32],
    sensors: tuple[str, ...],
    strides: pd.DataFrame,
    *,
    rate_hz: float,
    mass_kg: float,
    rules: MeasureRules,
) -> RunMeasures:
    """Measures of a run from perfect sensors, true events and true lengths.

    Parameters
    ----------
    ideal : ndarray, shape (n_sensors, 6, n_samples)
        Acceleration and angular rate in axes of the segments, as
        :func:`swaystride.simulate.running_recording.recorded` hands them out.
    sensors : tuple of str
        Names, as ``foot_right``.
    strides : DataFrame
        As from :func:`true_strides`.
    rate_hz : float
        Sampling rate.
    mass_kg : float
        Of the runner.
    rules : MeasureRules
        How measures are taken.

    Returns
    -------
    RunMeasures
    """
    signals = {name: SegmentSignals(ideal[k, :3], ideal[k, 3:]) for k, name in enumerate(sensors)}
    return measure_run(signals, strides, rate_hz=rate_hz, mass_kg=mass_kg, rules=rules)


def write_run_truth(path: Path | str, truth: RunTruth) -> None:
    """Write what happened in a run.

    Parameters
    ----------
    path : path or str
        File to write, ``.npz``; its folder is made.
    truth : RunTruth
        What was simulated.
    """
    head = {"format": _FORMAT, "note": _NOTE, "sensors": truth.sensors}
    arrays: Arrays = {
        "head": np.array(json.dumps(head)),
        "r_sensor_from_segment": truth.r_sensor_from_segment,
    }
    arrays |= motion_arrays(truth.motion) | points_arrays({_POINTS: truth.points})
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("wb") as file:
        np.savez_compressed(file, **arrays)


def read_run_truth(path: Path | str) -> RunTruth:
    """Read what happened in a run.

    Parameters
    ----------
    path : path or str
        From :func:`write_run_truth`.

    Returns
    -------
    RunTruth

    Raises
    ------
    RecordingError
        If the file is not such a file.
    """
    with reading_truth(path, "a run of the experience study"):
        with np.load(Path(path), allow_pickle=False) as file:
            arrays: Arrays = {name: file[name] for name in file.files}
        head = json.loads(str(arrays["head"]))
        return RunTruth(
            motion=motion_from_arrays(arrays),
            sensors=tuple(head["sensors"]),
            points=points_from_arrays(arrays)[_POINTS],
            r_sensor_from_segment=arrays["r_sensor_from_segment"],
        )


def write_true_values(path: Path | str, values: dict[str, Any]) -> None:
    """Write the true values of a run as JSON.

    Parameters
    ----------
    path : path or str
        File to write; its folder is made.
    values : dict
        Plain values; a missing number is written as null.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    plain = {"note": _NOTE, **values}
    path.write_text(json.dumps(plain, indent=1, allow_nan=False) + "\n", encoding="utf-8")
