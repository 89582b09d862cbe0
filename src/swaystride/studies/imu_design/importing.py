"""Import of all foot recordings of one participant: read, check, hold against the sensors' ranges."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
import pandas as pd

from swaystride.findings import FINDING_COLUMNS, Finding
from swaystride.recording import Recording, save_recordings
from swaystride.studies.imu_design.design import KEYS, Imu, ImuDesign
from swaystride.studies.imu_design.sensors import SensorSpecification
from swaystride.sway.trial_import import EXCLUSION_COLUMNS, RecordingRules, import_trials
from swaystride.units import DEG_PER_RAD, GRAVITY_M_S2

#: A sample this close to the range counts as at the range: scale errors are half a percent.
AT_RANGE: Final = 0.99

RANGE_COLUMNS: Final = (
    "participant",
    "trial",
    "foot",
    "imu",
    "rate_hz",
    "duration_s",
    "peak_acc_g",
    "peak_gyr_deg_s",
    "acc_at_range_percent",
    "gyr_at_range_percent",
)


@dataclass(frozen=True)
class ImportTables:
    """What the import of one participant leaves beside the recordings.

    Parameters
    ----------
    findings, exclusions : DataFrame
        What the checks saw; which recordings are left out and why.
    ranges : DataFrame
        :data:`RANGE_COLUMNS`: rate, duration and largest readings of every usable recording.
    """

    findings: pd.DataFrame
    exclusions: pd.DataFrame
    ranges: pd.DataFrame

    @property
    def summary(self) -> str:
        """How many recordings, usable and excluded, and findings."""
        return (
            f"{len(self.ranges)} recordings, {len(self.exclusions)} excluded, "
            f"{len(self.findings)} findings"
        )


def import_participant(
    participant: str,
    design: ImuDesign,
    folder: Path,
    rules: RecordingRules,
    sensors: Mapping[Imu, SensorSpecification],
    output: Path,
) -> ImportTables:
    """Import the recordings of one participant and write them as netCDF.

    Parameters
    ----------
    participant : str
    design : ImuDesign
    folder : Path
        Where the study's recordings lie.
    rules : RecordingRules
    sensors : mapping
        Specification of each IMU.
    output : Path
        netCDF, one group per usable recording.

    Returns
    -------
    ImportTables

    Raises
    ------
    RecordingError
        If a file is missing or is not a usable recording; nothing is written then.
    """
    trials = design.trials
    own = trials[trials["participant"] == participant].set_index("recording")
    imported = import_trials(
        {str(name): Path(file) for name, file in own["file"].items()},
        folder,
        rules,
        {str(name): str(why) for name, why in own["exclude"].items() if why != ""},
    )
    rows, saturated = [], []
    for name, recording in imported.recordings.items():
        imu: Imu = "imu_1" if own.loc[name, "imu"] == "imu_1" else "imu_2"
        keys = {str(k): v for k, v in own.loc[name, [*KEYS[:-1]]].items()} | {"imu": imu}
        row = {**keys, **recording_range(recording, sensors[imu])}
        rows.append(row)
        saturated += _saturation(row, str(own.loc[name, "file"]), sensors[imu])
    save_recordings(output, imported.recordings)
    by_reader = _with_keys(imported.findings, own, ["participant", "trial"])
    findings = pd.concat([by_reader, pd.DataFrame(saturated)], ignore_index=True)
    return ImportTables(
        findings[["participant", "trial", *FINDING_COLUMNS]],
        _with_keys(imported.exclusions, own, ["participant", "trial", "foot", "imu"])[
            ["participant", "foot", "imu", *EXCLUSION_COLUMNS]
        ],
        pd.DataFrame(rows, columns=list(RANGE_COLUMNS)),
    )


def recording_range(recording: Recording, sensor: SensorSpecification) -> dict[str, float]:
    """Rate, duration and largest readings of a recording.

    Parameters
    ----------
    recording : Recording
        Of one sensor.
    sensor : SensorSpecification
        Its ranges.

    Returns
    -------
    dict
        The columns of :data:`RANGE_COLUMNS` from ``rate_hz`` on.
    """
    acc_g = np.abs(recording["acc"].to_numpy()[0]) / GRAVITY_M_S2
    gyr_deg_s = np.abs(recording["gyr"].to_numpy()[0]) * DEG_PER_RAD
    rate_hz = float(recording.attrs["rate_hz"])
    return {
        "rate_hz": rate_hz,
        "duration_s": (recording.sizes["time"] - 1) / rate_hz,
        "peak_acc_g": float(np.nanmax(acc_g)),
        "peak_gyr_deg_s": float(np.nanmax(gyr_deg_s)),
        "acc_at_range_percent": _at_range(acc_g, sensor.accelerometer_range_g),
        "gyr_at_range_percent": _at_range(gyr_deg_s, sensor.gyro_range_deg_s),
    }


def _at_range(size: np.ndarray[Any, Any], limit: float) -> float:
    """Percentage of samples of which at least one axis is at the range."""
    return 100.0 * float((size >= AT_RANGE * limit).any(axis=0).mean())


def _saturation(
    row: Mapping[str, Any], file: str, sensor: SensorSpecification
) -> list[dict[str, str]]:
    """Findings of a recording that reaches the range of its sensor."""
    signals = (
        ("accelerometer", row["acc_at_range_percent"], f"{sensor.accelerometer_range_g:g} g"),
        ("gyroscope", row["gyr_at_range_percent"], f"{sensor.gyro_range_deg_s:g} °/s"),
    )
    return [
        {
            "participant": row["participant"],
            "trial": row["trial"],
            **asdict(
                Finding(
                    "saturated",
                    "warning",
                    file,
                    f"{name}, {row['foot']} foot, {row['imu']}",
                    f"readings below ±{limit}",
                    f"{share:.2g} % of the samples at the range",
                )
            ),
        }
        for name, share, limit in signals
        if share > 0
    ]


def _with_keys(table: pd.DataFrame, own: pd.DataFrame, keys: list[str]) -> pd.DataFrame:
    """Put what names a recording in front of rows that know its name only."""
    named = own.loc[table["trial"], keys].reset_index(drop=True)
    return pd.concat([named, table.drop(columns="trial").reset_index(drop=True)], axis=1)
