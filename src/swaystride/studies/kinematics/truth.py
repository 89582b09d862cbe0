"""Errors of markers and filter against the truth of a simulated trial, each on its own."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from swaystride.gait.footfalls import stride_lengths, stride_widths
from swaystride.lower_limb_joints import SEGMENTS, lower_limb_angles
from swaystride.simulate.kinematics_truth import RecordingTruth
from swaystride.simulate.running_motion import RunningMotion
from swaystride.studies.kinematics.estimation import table_angles
from swaystride.studies.kinematics.initialisation import FEET
from swaystride.studies.kinematics.plan import ANGLE_NAMES, SIDES, SOURCES, STRIDE_MEASURES

Array = NDArray[np.float64]

#: Columns of the results after participant and trial.
ANGLE_ERROR_COLUMNS: Final = (
    "source",
    "side",
    "angle",
    "bias_deg",
    "rmsd_deg",
    "rmsd_trial_deg",
    "coverage_95",
    "coverage_95_trial",
)
STRIDE_ERROR_COLUMNS: Final = ("side", "stride", "source", "measure", "estimate", "truth")
#: Columns of the truth's stances: first and last touch.
_TOUCH, _LAST_TOUCH = 0, 1
#: A first touch is further from initial contact than this: another stance.
_SAME_CONTACT_S: Final = 0.15
#: Poses are evaluated in parts of this many samples.
_PART: Final = 4000


def true_angles_deg(motion: RunningMotion, time_s: Array) -> Array:
    """True joint angles by side and name of the tables.

    Parameters
    ----------
    motion : RunningMotion
    time_s : ndarray, shape (n,)

    Returns
    -------
    ndarray, shape (2, 9, n)
        Degrees.
    """
    parts = [
        motion.states(time_s[k : k + _PART]).r_world_from_segment[:, : len(SEGMENTS)]
        for k in range(0, len(time_s), _PART)
    ]
    return table_angles(lower_limb_angles(np.concatenate(parts)))


def angle_errors(
    estimates: xr.Dataset, strides: pd.DataFrame, truth: RecordingTruth
) -> pd.DataFrame:
    """Errors of every angle from the first stride that counts to the last.

    Parameters
    ----------
    estimates : Dataset
        Of one trial.
    strides : DataFrame
        Counted strides of the trial: ``side``, ``initial_contact_s``, ``next_contact_s``.
    truth : RecordingTruth

    Returns
    -------
    DataFrame
        ``source``, ``side``, ``angle``, ``bias_deg``, ``rmsd_deg``, ``rmsd_trial_deg`` (after one
        constant for the trial), ``coverage_95`` and ``coverage_95_trial``: share of the truth within
        the band of the filter, before and after the constant; NaN for the markers.
    """
    time_s = estimates["time"].to_numpy()
    true = true_angles_deg(truth.motion, time_s)
    found = estimates["angle_deg"].to_numpy().astype(np.float64)
    sd = estimates["angle_sd_deg"].to_numpy().astype(np.float64)
    rows = []
    for s, side in enumerate(SIDES):
        own = strides[strides["side"] == side]
        inside = (time_s >= own["initial_contact_s"].min()) & (
            time_s <= own["next_contact_s"].max()
        )
        for k, source in enumerate(SOURCES):
            for a, angle in enumerate(ANGLE_NAMES):
                error = (found[k, s, a] - true[s, a])[inside]
                error = error - 360.0 * np.round(np.nanmedian(error) / 360.0)
                bias = float(np.nanmean(error))
                band = 1.96 * sd[s, a][inside]
                of_filter = source == "erkf"
                rows.append(
                    {
                        "source": source,
                        "side": side,
                        "angle": angle,
                        "bias_deg": bias,
                        "rmsd_deg": float(np.sqrt(np.nanmean(error**2))),
                        "rmsd_trial_deg": float(np.nanstd(error)),
                        "coverage_95": _share(np.abs(error) <= band) if of_filter else np.nan,
                        "coverage_95_trial": _share(np.abs(error - bias) <= band)
                        if of_filter
                        else np.nan,
                    }
                )
    return pd.DataFrame(rows, columns=list(ANGLE_ERROR_COLUMNS))


def _share(inside: NDArray[np.bool_]) -> float:
    """Share of true values."""
    return float(np.mean(inside))


def stride_errors(strides: pd.DataFrame, truth: RecordingTruth) -> pd.DataFrame:
    """Length and width of every counted stride beside those of the true sensors on the feet.

    Parameters
    ----------
    strides : DataFrame
        Counted strides of the trial in long form: ``side``, ``stride``, ``initial_contact_s``,
        ``source``, ``feature``, ``value``.
    truth : RecordingTruth

    Returns
    -------
    DataFrame
        ``side``, ``stride``, ``source``, ``measure``, ``estimate``, ``truth``.
    """
    tables = []
    for side, known in true_strides(truth).items():
        own = strides[(strides["side"] == side) & strides["feature"].isin(STRIDE_MEASURES.values())]
        contact = own["initial_contact_s"].to_numpy(dtype=np.float64)
        at = _nearest(known["touch_s"].to_numpy(), contact)
        far = np.abs(known["touch_s"].to_numpy()[at] - contact) > _SAME_CONTACT_S
        length, width = (known[feature].to_numpy() for feature in STRIDE_MEASURES.values())
        is_width = own["feature"].to_numpy() == STRIDE_MEASURES["stride_width"]
        value = np.where(is_width, width[at], length[at])
        tables.append(
            own[["side", "stride", "source"]].assign(
                measure=own["feature"], estimate=own["value"], truth=np.where(far, np.nan, value)
            )
        )
    return pd.concat(tables, ignore_index=True)[list(STRIDE_ERROR_COLUMNS)]


def true_strides(truth: RecordingTruth) -> dict[str, pd.DataFrame]:
    """Strides of both feet from the places of the sensors on them in the middle of the stances.

    Both systems see the sensor, or the marker on it. A width of other points of the feet would be
    another width: sensors lie beside the middle of the foot, and feet turn out.

    Parameters
    ----------
    truth : RecordingTruth
        Of a running recording.

    Returns
    -------
    dict of str to DataFrame
        By side, of all stances whose middle is recorded: ``touch_s``, ``stride_length_m`` to the next
        stance, ``stride_width_m`` (without a sign); both horizontal.
    """
    touches, places = {}, {}
    for side, sensor, rows in zip(SIDES, FEET, truth.motion.tables.stances, strict=True):
        own = rows[np.isfinite(rows[:, _TOUCH])]
        half_s = np.nanmedian(own[:, _LAST_TOUCH] - own[:, _TOUCH]) / 2.0
        middle = own[:, _TOUCH] + half_s
        recorded = (middle >= 0.0) & (middle <= truth.motion.duration_s)
        touches[side] = own[recorded, _TOUCH]
        places[side] = truth.sensor_position_m(middle[recorded])[:, sensor]
    found: dict[str, pd.DataFrame] = {}
    for side, other in (SIDES, SIDES[::-1]):
        width = stride_widths(places[side], touches[side], places[other], touches[other], side=side)
        length = np.append(stride_lengths(places[side], horizontal=True), np.nan)
        found[side] = pd.DataFrame(
            {
                "touch_s": touches[side],
                "stride_length_m": length,
                "stride_width_m": np.abs(width),
            }
        )
    return found


def _nearest(known: Array, wanted: Array) -> NDArray[np.int64]:
    """Index of the nearest of rising values."""
    after = np.clip(np.searchsorted(known, wanted), 1, len(known) - 1)
    nearer = wanted - known[after - 1] < known[after] - wanted
    return np.asarray(np.where(nearer, after - 1, after), dtype=np.int64)
