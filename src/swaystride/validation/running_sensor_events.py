"""The events of chapter 5 on sensors derived from markers, against the force plates."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from swaystride.gait.push_off import PUSH_OFF_END
from swaystride.gait.running_events import (
    PRINTED_EVENTS,
    RECOMMENDED_EVENTS,
    RunningEventRule,
    running_events,
)
from swaystride.gait.segment_signals import SegmentSignals
from swaystride.gait.spatiotemporal import (
    LITERAL_STRIDES,
    RUNNING_STRIDES,
    StrideRule,
    running_strides,
)
from swaystride.gait.toe_off import RESULTANT_MINIMUM
from swaystride.mocap.marker_set import SIDES
from swaystride.validation.running_optical import OpticalRun, optical_runs
from swaystride.validation.running_sensors import (
    MARKER_CUTOFF_HZ,
    SMOOTH_CUTOFF_HZ,
    MarkerSensors,
    marker_sensors,
)

#: Contacts by sensors and by force plates are the same within this time.
_PAIRED_S: Final = 0.1


@dataclass(frozen=True)
class EventMethod:
    """Events, and which strides between them count.

    Parameters
    ----------
    events : RunningEventRule
    strides : StrideRule
    """

    events: RunningEventRule
    strides: StrideRule


#: The three variants of the study; toe-off by the end of push-off after the recommended contact; the
#: sharpest peak within ± 60 ms as it is.
METHODS: Final = {
    "printed": EventMethod(PRINTED_EVENTS, RUNNING_STRIDES),
    "literal_toe_off": EventMethod(
        replace(PRINTED_EVENTS, toe_off=RESULTANT_MINIMUM), LITERAL_STRIDES
    ),
    "recommended": EventMethod(RECOMMENDED_EVENTS, RUNNING_STRIDES),
    "push_off_end": EventMethod(replace(RECOMMENDED_EVENTS, toe_off=PUSH_OFF_END), RUNNING_STRIDES),
    "sharpest_peak": EventMethod(replace(PRINTED_EVENTS, contact="sharpest_peak"), RUNNING_STRIDES),
}
#: Column of the strides that gives each error.
ERRORS: Final = {
    "initial_contact": "start_s",
    "toe_off": "toe_off_s",
    "stride_time": "stride_time_s",
    "contact_time": "contact_time_s",
    "step_time": "step_time_s",
}


def sensor_strides(sensors: MarkerSensors, method: EventMethod) -> pd.DataFrame:
    """Strides of a runner as the study finds them.

    Parameters
    ----------
    sensors : MarkerSensors
    method : EventMethod

    Returns
    -------
    DataFrame
        As from :func:`swaystride.gait.spatiotemporal.running_strides`; those that do not count are
        flagged.
    """
    feet: dict[str, SegmentSignals] = {side: sensors.segments[f"{side}_foot"] for side in SIDES}
    events = running_events(
        feet, sensors.segments["pelvis"], rate_hz=sensors.rate_hz, rule=method.events
    )
    return running_strides(events, method.strides)


def plate_strides(found: OpticalRun) -> pd.DataFrame:
    """Strides by the force plates, with the same definitions.

    Parameters
    ----------
    found : OpticalRun
        With force plates.
    """
    events = [frame.assign(side=side) for side, frame in found.plates.items()]
    return running_strides(pd.concat(events), RUNNING_STRIDES)


def stride_errors(strides: pd.DataFrame, reference: pd.DataFrame) -> pd.DataFrame:
    """Strides minus the strides of a reference that begin at the same contact.

    Parameters
    ----------
    strides, reference : DataFrame
        As from :func:`swaystride.gait.spatiotemporal.running_strides`; only valid ones count.

    Returns
    -------
    DataFrame
        ``side``; an error in ms for each name of :data:`ERRORS`; ``duty_factor``. A row per stride
        that has a partner.
    """
    rows = []
    columns = [*ERRORS.values(), "duty_factor"]
    for side in SIDES:
        own, real = (
            table.loc[(table["side"] == side) & table["is_valid"], columns].reset_index(drop=True)
            for table in (strides, reference)
        )
        if own.empty or real.empty:
            continue
        apart = np.abs(own["start_s"].to_numpy()[:, None] - real["start_s"].to_numpy())
        nearest = apart.argmin(axis=1)
        late = own - real.loc[nearest].reset_index(drop=True)
        late[list(ERRORS.values())] *= 1e3
        late.insert(0, "side", side)
        rows.append(late[apart.min(axis=1) < _PAIRED_S])
    errors: pd.DataFrame = pd.concat(rows, ignore_index=True)
    return errors.rename(columns={column: name for name, column in ERRORS.items()})


def single_errors(folder: Path) -> pd.DataFrame:
    """Errors of every stride of every trial with force plates.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.

    Returns
    -------
    DataFrame
        ``trial``, ``cutoff_hz`` (of the markers), ``method``, ``found`` and ``plates`` (strides of
        the side that count), and the columns of :func:`stride_errors`.
    """
    parts = []
    for cutoff_hz in (MARKER_CUTOFF_HZ, SMOOTH_CUTOFF_HZ):
        for found, worn in zip(
            optical_runs(folder), marker_sensors(folder, cutoff_hz), strict=True
        ):
            if not found.plates:
                continue
            real = plate_strides(found)
            for name, method in METHODS.items():
                strides = sensor_strides(worn, method)
                errors = stride_errors(strides, real)
                errors.insert(0, "method", name)
                errors.insert(0, "cutoff_hz", cutoff_hz)
                errors.insert(0, "trial", found.run.label)
                for column, table in (("found", strides), ("plates", real)):
                    count = table.loc[table["is_valid"], "side"].value_counts()
                    errors[column] = errors["side"].map(count)
                parts.append(errors)
    return pd.concat(parts, ignore_index=True)


def sensor_event_table(errors: pd.DataFrame) -> pd.DataFrame:
    """Errors of each foot.

    Parameters
    ----------
    errors : DataFrame
        From :func:`single_errors`.

    Returns
    -------
    DataFrame
        ``trial``, ``side``, ``cutoff_hz``, ``method``; strides ``found``, by ``plates`` and
        ``paired``; bias and standard deviation of each error, ms; ``stride_time_rms_ms``;
        ``duty_factor_bias``.
    """
    rows = []
    keys = ["trial", "side", "cutoff_hz", "method"]
    for key, foot in errors.groupby(keys, sort=False):
        row: dict[str, object] = dict(zip(keys, key, strict=True))
        row |= {"found": int(foot["found"].iloc[0]), "plates": int(foot["plates"].iloc[0])}
        row["paired"] = len(foot)
        for name in ERRORS:
            row[f"{name}_bias_ms"] = float(foot[name].mean())
            row[f"{name}_sd_ms"] = float(foot[name].std(ddof=0))
        row["stride_time_rms_ms"] = float(np.sqrt((foot["stride_time"] ** 2).mean()))
        row["duty_factor_bias"] = float(foot["duty_factor"].mean())
        rows.append(row)
    return pd.DataFrame(rows)
