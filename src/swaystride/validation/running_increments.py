"""Strides of real runners as changes of four segment angles, from rates and from angles.

Strides end at the force plates, or at the contacts from markers where there are none; segments turn
as the markers of ``running_markers_grf`` say.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.gait.segment_signals import ML, lowpassed_parts
from swaystride.gait.stride_curves import stride_curves
from swaystride.gait.vector_coding import N_INTERVALS, segment_increments
from swaystride.lower_limb_joints import Side
from swaystride.mocap.marker_set import SIDES
from swaystride.units import DEG_PER_RAD
from swaystride.validation.running_optical import ONE_STRIDE, OpticalRun, optical_runs
from swaystride.validation.running_sensors import MARKER_CUTOFF_HZ, MarkerSensors, marker_sensors

Array = NDArray[np.float64]

#: Low-pass of rates and angles (methods §6).
RATE_CUTOFF_HZ: Final = 15.0


def whole_strides(contacts: pd.DataFrame) -> pd.DataFrame:
    """Strides of one foot between contacts that follow each other.

    Parameters
    ----------
    contacts : DataFrame
        ``initial_contact_s``, ``toe_off_s``, rising.

    Returns
    -------
    DataFrame
        ``start_s``, ``toe_off_s``, ``stop_s``; a pair of contacts with one missing between them is
        none.

    Examples
    --------
    >>> contacts = pd.DataFrame({"initial_contact_s": [0.0, 0.7, 1.4, 2.8],
    ...                          "toe_off_s": [0.2, 0.9, 1.6, 3.0]})
    >>> whole_strides(contacts)["stop_s"].tolist()
    [0.7, 1.4]
    """
    start, off = (contacts[name].to_numpy(float) for name in ("initial_contact_s", "toe_off_s"))
    length = np.diff(start)
    whole = length < ONE_STRIDE * np.median(length)
    columns = {"start_s": start[:-1], "toe_off_s": off[:-1], "stop_s": start[1:]}
    strides: pd.DataFrame = pd.DataFrame(columns)[whole].reset_index(drop=True)
    return strides


def increments_from_rates(
    sensors: MarkerSensors, side: Side, strides: pd.DataFrame
) -> dict[str, Array]:
    """Changes of the four segments of a side as the library finds them, from rates.

    Parameters
    ----------
    sensors : MarkerSensors
    side : {"right", "left"}
    strides : DataFrame
        From :func:`whole_strides`.

    Returns
    -------
    dict of str to ndarray, shape (n_strides, 200)
        Degrees.
    """
    return {
        part: segment_increments(
            lowpassed_parts(sensors.segments[name].gyr_rad_s[ML], RATE_CUTOFF_HZ, sensors.rate_hz),
            strides,
            sensors.rate_hz,
        )
        for part, name in _segments(side).items()
    }


def increments_from_angles(
    sensors: MarkerSensors, side: Side, strides: pd.DataFrame
) -> dict[str, Array]:
    """The same from angles to the ground: no rate, no integral, no drift.

    Parameters
    ----------
    sensors : MarkerSensors
    side : {"right", "left"}
    strides : DataFrame
        From :func:`whole_strides`.

    Returns
    -------
    dict of str to ndarray, shape (n_strides, 200)
        Degrees.
    """
    start, off, stop = (
        strides[name].to_numpy(float) * sensors.rate_hz
        for name in ("start_s", "toe_off_s", "stop_s")
    )
    steps = {}
    for part, name in _segments(side).items():
        angle = lowpassed_parts(sensors.pitch_rad[name], RATE_CUTOFF_HZ, sensors.rate_hz)
        parts = [
            stride_curves(angle, *ends, N_INTERVALS + 1) for ends in ((start, off), (off, stop))
        ]
        steps[part] = DEG_PER_RAD * np.concatenate([np.diff(p, axis=-1) for p in parts], axis=-1)
    return steps


def _segments(side: Side) -> dict[str, str]:
    return {"pelvis": "pelvis", **{p: f"{side}_{p}" for p in ("thigh", "shank", "foot")}}


@cache
def coordination_trials(
    folder: Path,
) -> tuple[tuple[OpticalRun, Side, dict[str, Array], dict[str, Array]], ...]:
    """Changes of the segments of every trial and side.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.

    Returns
    -------
    tuple
        Trial, side, changes from rates, changes from angles.
    """
    sensors = marker_sensors(folder, MARKER_CUTOFF_HZ)
    rows = []
    for found, worn in zip(optical_runs(folder), sensors, strict=True):
        for side in SIDES:
            strides = whole_strides(found.plates.get(side, found.contacts[side]))
            rates = increments_from_rates(worn, side, strides)
            rows.append((found, side, rates, increments_from_angles(worn, side, strides)))
    return tuple(rows)
