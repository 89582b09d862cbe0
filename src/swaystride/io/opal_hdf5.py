"""APDM Opal HDF5: several sensors a file, versions 2 to 5.

* Version 5: ``/Sensors/<id>`` with ``Time`` (whole µs since 1970 UTC), ``Accelerometer`` (m/s²),
  ``Gyroscope`` (rad/s), ``Magnetometer`` (µT), one row a sample; label, rate and time zone in
  ``Configuration``; orientation in ``/Processed/<id>/Orientation``, scalar first.
* Versions 2 to 4: the root lists cases and their labels; ``/<case>/Time`` and
  ``/<case>/Calibrated/Accelerometers``, ``Gyroscopes``, ``Magnetometers``, ``Orientation``.

Sensors of one file share one clock: unequal stamps are an error that names both. Gaps are found in
the time stamps. Declared sizes are checked against the file before they are read.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.findings import Finding
from swaystride.io.assembly import SensorRows, assemble, select_sensors
from swaystride.io.hdf5_arrays import numeric_array, open_hdf5, padded_texts, require_stored
from swaystride.io.hints import ReadHints, rates_agree
from swaystride.io.opal_layout import OpalSensor, opal_sensors, opal_version
from swaystride.io.sample_index import index_from_stamps
from swaystride.io.sampling_rate import resolve_rate
from swaystride.io.source_binary import SourceBinary, require_binary
from swaystride.recording import Recording

#: By the vendor's definition.
UNITS = {"acc": "m/s^2", "gyr": "rad/s", "mag": "uT"}
#: Share of a sampling interval by which the clocks of two sensors may differ without a finding.
CLOCK_TOLERANCE = 0.01


def is_opal_hdf5(source: SourceBinary) -> bool:
    """Tell whether a file is HDF5, which is read as that of an Opal.

    Parameters
    ----------
    source : SourceBinary
        Opened file.
    """
    return source.kind == "HDF5"


def read_opal_hdf5(source: SourceBinary, hints: ReadHints) -> Recording:
    """Read the sensors of one Opal file into one recording.

    Parameters
    ----------
    source : SourceBinary
    hints : ReadHints
        Sensors select by label, in the order wanted.

    Returns
    -------
    Recording
        Attributes ``start_unix_us`` (first time stamp) and, if the file states it,
        ``timezone_offset_h``.

    Raises
    ------
    RecordingError
        See :func:`swaystride.io.reading.read_recording`; also if sensors differ in length, clock or
        rate.
    """
    with open_hdf5(source) as file:
        by_label = _unique_labels(opal_sensors(file, source))
        labels = select_sensors(list(by_label), hints, file=source.name)
        chosen = [by_label[label] for label in labels]
        names = {name for sensor in chosen for name in sensor.paths}
        units = {signal: unit for signal, unit in UNITS.items() if signal in names}
        hints.confirm_units(units, file=source.name)
        time_us, clock_findings = _common_clock(chosen, labels, source)
        rows = [
            _rows(sensor, label, len(time_us), source)
            for sensor, label in zip(chosen, labels, strict=True)
        ]
        rate_hz = _common_rate(chosen, labels, source)
        timezone_h = chosen[0].timezone_h
    stamped, findings = index_from_stamps(
        np.asarray(time_us - time_us[0], dtype=np.float64) * 1e-6,
        file=source.name,
        first_line=0,
        column="Time",
        row_name=source.row_name,
    )
    attributes: dict[str, Any] = {"start_unix_us": int(time_us[0])}
    if timezone_h is not None:
        attributes["timezone_offset_h"] = timezone_h
    return assemble(
        source,
        rows,
        index=stamped.index,
        first_line=0,
        rate=resolve_rate(
            hints,
            file=source.name,
            header_hz=rate_hz,
            header_place="Sample Rate",
            measured_hz=stamped.rate_hz,
        ),
        units=units,
        device="APDM Opal",
        findings=[*clock_findings, *findings],
        attributes=attributes,
    )


def read_opal_annotations(path: Path | str) -> pd.DataFrame:
    """Read what was annotated during an Opal recording.

    Parameters
    ----------
    path : path or str
        File of version 5.

    Returns
    -------
    DataFrame
        Columns ``time_unix_us`` (int64), ``sensor`` (id) and ``annotation``; no row if there are none.

    Raises
    ------
    RecordingError
        If the file is not an Opal file or is damaged.
    """
    source = require_binary(path, "HDF5", expected="an Opal HDF5 file")
    with open_hdf5(source) as file:
        opal_version(file, source)
        dataset = file.get("Annotations")
        rows: Any = ()
        if dataset is not None and dataset.dtype.names is not None:
            require_stored(dataset, source=source)
            rows = dataset[()]
    return pd.DataFrame(
        {
            "time_unix_us": np.array([int(row["Time"]) for row in rows], dtype=np.int64),
            "sensor": [str(*padded_texts(row["Sensor ID"])) for row in rows],
            "annotation": [str(*padded_texts(row["Annotation"])) for row in rows],
        }
    )


def _unique_labels(sensors: Sequence[OpalSensor]) -> dict[str, OpalSensor]:
    """Sensors by label, or by id where labels repeat: ids are unique."""
    by_label = {sensor.label: sensor for sensor in sensors}
    if len(by_label) == len(sensors):
        return by_label
    return {sensor.group.name.rsplit("/", 1)[-1]: sensor for sensor in sensors}


def _common_clock(
    sensors: Sequence[OpalSensor], labels: Sequence[str], source: SourceBinary
) -> tuple[NDArray[np.int64], list[Finding]]:
    """Time stamps that all sensors share."""
    first: NDArray[np.int64] | None = None
    findings = []
    for sensor, label in zip(sensors, labels, strict=True):
        time_us = numeric_array(sensor.group, "Time", kinds="iu", columns=None, source=source)
        if time_us.size and int(time_us.max()) > np.iinfo(np.int64).max:
            raise RecordingError(
                "a time stamp is beyond counting",
                file=source.name,
                place=f"{sensor.group.name}/Time",
                expected="µs since 1970",
                found=str(time_us.max()),
            )
        time_us = time_us.astype(np.int64)
        if first is None:
            first = time_us
            continue
        if len(time_us) != len(first):
            raise RecordingError(
                "sensors of unequal length",
                file=source.name,
                place=f"{label} beside {labels[0]}",
                expected=f"{len(first)} samples",
                found=f"{len(time_us)} samples",
            )
        findings += _compare_clocks(first, time_us, f"{label} beside {labels[0]}", source.name)
    if first is None or len(first) < 2:
        raise RecordingError(
            "no sampling rate", file=source.name, place="Time", expected="at least two samples",
            found=f"{0 if first is None else len(first)} samples",
        )  # fmt: skip
    return first, findings


def _compare_clocks(
    first: NDArray[np.int64], other: NDArray[np.int64], place: str, file: str
) -> list[Finding]:
    """Stamps of two sensors, row by row: an error from half a sampling interval on."""
    apart = np.abs(other - first)
    if not apart.any():
        return []
    row = int(apart.argmax())
    interval = float(np.median(np.diff(first))) if len(first) > 1 else 0.0
    expected = "the same time stamps"
    found = f"stamps {int(apart[row])} µs apart, in row {row}"
    if apart[row] >= interval / 2:
        raise RecordingError(
            "sensors of unequal clock", file=file, place=place, expected=expected, found=found
        )
    if apart[row] <= CLOCK_TOLERANCE * interval:
        return []
    return [Finding("sensor_clock", "warning", file, place, expected, found)]


def _common_rate(
    sensors: Sequence[OpalSensor], labels: Sequence[str], source: SourceBinary
) -> float | None:
    stated = {
        label: sensor.rate_hz
        for label, sensor in zip(labels, sensors, strict=True)
        if sensor.rate_hz is not None
    }
    first = next(iter(stated), None)
    for label, rate_hz in stated.items():
        if first is not None and not rates_agree(stated[first], rate_hz):
            raise RecordingError(
                "sensors of unequal rate",
                file=source.name,
                place=f"{label} beside {first}",
                expected=f"{stated[first]:.7g} Hz",
                found=f"{rate_hz:.7g} Hz",
            )
    if first is None:
        return None
    if stated[first] <= 0:
        raise RecordingError(
            "the sampling rate is not a positive number",
            file=source.name,
            place=f"Sample Rate of {first}",
            expected="a rate above 0 Hz",
            found=f"{stated[first]:g} Hz",
        )
    return stated[first]


def _rows(sensor: OpalSensor, label: str, n_rows: int, source: SourceBinary) -> SensorRows:
    """Signals of one sensor, channels first, in the type in which they are stored."""
    rows = SensorRows(label)
    for signal, path in sensor.paths.items():
        values = numeric_array(
            sensor.group, path, kinds="fiu", columns=4 if signal == "quat" else 3, source=source
        )
        if len(values) != n_rows:
            raise RecordingError(
                "a signal and its time stamps differ in length",
                file=source.name,
                place=f"{sensor.group.name}: {path}",
                expected=f"{n_rows} rows",
                found=f"{len(values)} rows",
            )
        if values.dtype.kind == "f" and np.isinf(values).any():
            row = int(np.flatnonzero(np.isinf(values).any(axis=1))[0])
            raise RecordingError(
                "an infinite number",
                file=source.name,
                place=f"{sensor.group.name}: {path}, row {row}",
                expected="a finite number or NaN",
            )
        rows.signals[signal] = values.T if values.dtype.kind == "f" else values.T.astype(float)
    return rows
