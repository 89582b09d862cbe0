"""Estimates of a simulated run against the truth: measures, events, axes of the sensors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.gait.running_events import SIDES
from swaystride.simulate.running_motion import RunningMotion
from swaystride.studies.experience.plan import MEASURE_KEYS
from swaystride.units import DEG_PER_RAD

Array = NDArray[np.float64]

TRUTH_COLUMNS: Final = ("run", "measure", "estimate", "truth", "error")
#: An event is that of a true one if it is nearer than this, s: a fourth of a stride.
_NEAR_S: Final = 0.17
#: Strides of each side whose joint angles are looked at for the range of the bones.
_BONE_STRIDES: Final = 60
_BONE_RATE_HZ: Final = 100.0


def truth_rows(
    run: str,
    *,
    whole: pd.DataFrame,
    strides: pd.DataFrame,
    alignment: pd.DataFrame,
    true_values: Mapping[str, Any],
    true_strides: pd.DataFrame,
    motion: RunningMotion,
) -> pd.DataFrame:
    """Errors of one run.

    Parameters
    ----------
    run : str
        Name.
    whole, strides : DataFrame
        Measures of the run and of its strides.
    alignment : DataFrame
        Axes of its sensors, from the import.
    true_values : mapping
        True means over the steady part, and the mounting of the sensors.
    true_strides : DataFrame
        True times and measures of the strides.
    motion : RunningMotion
        What the bones did.

    Returns
    -------
    DataFrame
        ``run``, ``measure``, ``estimate``, ``truth``, ``error``: all means of the run; range of the
        bones and the unfiltered peak of the shin against the same estimates
        (``hip_range_deg_bone``, ``peak_tibial_g_unfiltered``); ``initial_contact_bias_ms`` and
        ``_sd_ms``, ``toe_off_…``; ``alignment_<sensor>_vertical_deg`` and ``…_ml_deg``. No rows for
        a run that is left out.
    """
    if whole.empty:
        return pd.DataFrame(columns=list(TRUTH_COLUMNS))
    estimates = whole.iloc[0]
    true = true_values["measures"]
    rows = [(key, float(estimates[key]), float(true[key])) for key in MEASURE_KEYS]
    steady = true_strides[true_strides["is_steady"]]
    for joint, value in bone_ranges_deg(motion, steady).items():
        rows.append((f"{joint}_range_deg_bone", float(estimates[f"{joint}_range_deg"]), value))
    unfiltered = float(true_values["unfiltered_peak_tibial_g"])
    rows.append(("peak_tibial_g_unfiltered", float(estimates["peak_tibial_g"]), unfiltered))
    kept = strides[strides["is_steady"] & strides["is_valid"]]
    for event, column in (("initial_contact", "start_s"), ("toe_off", "toe_off_s")):
        lag_ms = 1e3 * event_errors_s(kept, steady, column)
        rows.append((f"{event}_bias_ms", float(lag_ms.mean()), 0.0))
        rows.append((f"{event}_sd_ms", float(lag_ms.std(ddof=1)), 0.0))
    rows += axis_errors_deg(alignment, true_values["alignment"])
    table = pd.DataFrame(rows, columns=["measure", "estimate", "truth"])
    table.insert(0, "run", run)
    return table.assign(error=table["estimate"] - table["truth"])


def event_errors_s(strides: pd.DataFrame, true_strides: pd.DataFrame, column: str) -> Array:
    """Estimated minus true times of one kind of event, matched by the contacts of each foot.

    Parameters
    ----------
    strides, true_strides : DataFrame
        With ``side``, ``start_s`` and `column`.
    column : str
        ``start_s`` or ``toe_off_s``.

    Returns
    -------
    ndarray
        Of all strides that have a true one.
    """
    parts = []
    for side in SIDES:
        own = strides[strides["side"] == side]
        theirs = true_strides[true_strides["side"] == side]
        if own.empty or theirs.empty:
            continue
        known, found = (table["start_s"].to_numpy(float) for table in (theirs, own))
        after = np.clip(np.searchsorted(known, found), 1, len(known) - 1)
        nearest = after - (found - known[after - 1] < known[after] - found)
        matched = np.abs(known[nearest] - found) < _NEAR_S
        at = own[column].to_numpy(float)[matched]
        parts.append(at - theirs[column].to_numpy(float)[nearest[matched]])
    return np.concatenate(parts) if parts else np.empty(0)


def axis_errors_deg(
    alignment: pd.DataFrame, true_mounting: Mapping[str, Sequence[float]]
) -> list[tuple[str, float, float]]:
    """Angles between estimated and true axes of the sensors.

    Parameters
    ----------
    alignment : DataFrame
        ``sensor`` and ``r_00`` … ``r_22`` (anatomical from sensor).
    true_mounting : mapping of str to sequence of float
        ``r_segment_from_sensor`` of each sensor, row by row.

    Returns
    -------
    list of tuple
        Measure, angle, 0: of the vertical and of the medio-lateral axis.
    """
    rows = []
    for row in alignment.to_dict("records"):
        name = str(row["sensor"])
        estimated = np.array([[row[f"r_{i}{j}"] for j in range(3)] for i in range(3)], dtype=float)
        true = np.asarray(true_mounting[name], dtype=float).reshape(3, 3)
        cosine = np.clip(np.sum(estimated * true, axis=1), -1.0, 1.0)
        for axis, kind in ((1, "vertical"), (2, "ml")):
            angle = float(DEG_PER_RAD * np.arccos(cosine[axis]))
            rows.append((f"alignment_{name}_{kind}_deg", angle, 0.0))
    return rows


def bone_ranges_deg(motion: RunningMotion, strides: pd.DataFrame) -> dict[str, float]:
    """Sagittal range of motion of the bones of hip and knee over evenly spread strides.

    Parameters
    ----------
    motion : RunningMotion
        Of the run.
    strides : DataFrame
        True strides that count.

    Returns
    -------
    dict of str to float
        ``hip`` and ``knee``: mean per side, then of both.
    """
    found: dict[str, list[float]] = {"hip": [], "knee": []}
    for side in SIDES:
        own = strides[strides["side"] == side]
        own = own.iloc[:: max(1, len(own) // _BONE_STRIDES)]
        n = int(np.ceil(_BONE_RATE_HZ * own["stride_time_s"].max()))
        phase = np.linspace(0.0, 1.0, n)
        start, length = own["start_s"].to_numpy(float), own["stride_time_s"].to_numpy(float)
        angles = motion.states(
            (start[:, None] + length[:, None] * phase).ravel()
        ).joint_angles_rad()
        for joint, values in found.items():
            flexion = angles[f"{joint}_{side}"][..., 0].reshape(-1, n)
            values.append(float(DEG_PER_RAD * np.ptp(flexion, axis=1).mean()))
    return {joint: float(np.mean(values)) for joint, values in found.items()}
