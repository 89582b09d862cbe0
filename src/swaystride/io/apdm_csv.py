"""APDM CSV, two layouts, several sensors a file.

* Four header lines: ``Test Name:``, ``Sample Rate:,128,Hz``, the column row
  (``Time,<label>/Acceleration/X,…``) and a row of units.
* ``Format=7``: three header lines with an id and a label per sensor, names of quantities and axes;
  14 columns per sensor; time in µs since 1970 and no rate, which is measured. Units are those of
  the vendor's definition. The barometer prints the bits of a float64 as an integer.

Gaps are found in the time stamps. The orientation rotates sensor to world coordinates, z up.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import islice

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError
from swaystride.io.assembly import SensorRows, assemble, select_sensors
from swaystride.io.hints import QUANTITY_OF, ReadHints
from swaystride.io.sample_index import index_from_stamps
from swaystride.io.sampling_rate import resolve_rate
from swaystride.io.source_text import Line, SourceText
from swaystride.io.table import Table, read_numbers
from swaystride.recording import Recording
from swaystride.units import FACTORS_TO_SI, to_si

Array = NDArray[np.float64]

FORMAT_7_UNITS = {"acc": "m/s^2", "gyr": "rad/s", "mag": "uT"}
_FORMAT_7_WIDTH = 14
#: First column of each signal inside the 14 of a sensor, and the number of its columns.
_FORMAT_7_PLACES = {"acc": (0, 3), "gyr": (3, 3), "mag": (6, 3), "quat": (10, 4)}
_FORMAT_7_ROW = ["Accelerometer", "", "", "Gyroscope", "", "", "Magnetometer", "", "", "Barometer"]
_FORMAT_7_ROW += ["Orientation", "", "", ""]
_QUANTITIES = {
    "acc": ("Acceleration", "XYZ"),
    "gyr": ("Angular Velocity", "XYZ"),
    "mag": ("Magnetic Field", "XYZ"),
    "quat": ("Orientation", ("Scalar", "X", "Y", "Z")),
}
_SAMPLE_RATE = re.compile(r"Sample Rate:,\s*([0-9.]+)\s*,\s*Hz")


def is_apdm_csv(source: SourceText) -> bool:
    """Tell whether a text begins like one of the two layouts.

    Parameters
    ----------
    source : SourceText
        Opened file.
    """
    return source.first_text().startswith(("Format=", "Test Name:", "Sample Rate:"))


def read_apdm_csv(source: SourceText, hints: ReadHints) -> Recording:
    """Read one APDM CSV file.

    Parameters
    ----------
    source : SourceText
    hints : ReadHints
        Sensors select by label, in the order wanted.

    Returns
    -------
    Recording
        One sensor per label.

    Raises
    ------
    RecordingError
        See :func:`swaystride.io.reading.read_recording`.
    """
    first = source.first_text()
    if not first.startswith("Format="):
        layout = _layout_with_units(source)
    elif re.match(r"Format=7\s*(,|$)", first):
        layout = _layout_format_7(source)
    else:
        raise RecordingError(
            "unknown version of APDM CSV",
            file=source.name,
            place="line 1",
            expected="Format=7",
            found=first.split(",")[0],
        )
    labels = select_sensors(list(layout.positions), hints, file=source.name)
    units = dict(layout.units)
    hints.confirm_units(units, file=source.name)
    order = [(label, signal) for label in labels for signal in layout.positions[label]]
    wanted = [0]
    for label, signal in order:
        wanted += layout.positions[label][signal]
    rows = read_numbers(layout.table, wanted)
    stamped, findings = index_from_stamps(
        to_si(rows[0], layout.time_unit, "time"),
        file=source.name,
        first_line=layout.table.first_line,
        column="Time",
    )
    rate = resolve_rate(
        hints,
        file=source.name,
        header_hz=layout.rate_hz,
        header_place="'Sample Rate:'",
        measured_hz=stamped.rate_hz,
    )
    sensors = {label: SensorRows(label) for label in labels}
    start = 1
    for label, signal in order:
        stop = start + len(layout.positions[label][signal])
        sensors[label].signals[signal] = rows[start:stop]
        start = stop
    return assemble(
        source,
        list(sensors.values()),
        index=stamped.index,
        first_line=layout.table.first_line,
        rate=rate,
        units=units,
        device="APDM Opal",
        findings=findings,
    )


def barometer_kpa_from_bits(printed: ArrayLike) -> Array:
    """Pressure behind the integers that ``Format=7`` prints for the barometer.

    Parameters
    ----------
    printed : array_like
        The number as printed: the 64 bits of the pressure in kPa, read as an integer.

    Returns
    -------
    ndarray
        Pressure in kPa.

    Examples
    --------
    >>> barometer_kpa_from_bits([4636858284341460992]).round(2)
    array([101.72])
    """
    return np.asarray(printed).astype(np.int64).view(np.float64)


@dataclass(frozen=True)
class _Layout:
    """Columns of each signal of each sensor, and what the header says."""

    table: Table
    positions: dict[str, dict[str, list[int]]]
    units: Mapping[str, str]
    time_unit: str
    rate_hz: float | None


def _layout_with_units(source: SourceText) -> _Layout:
    """Layout of four header lines: columns are found by name, units in the row below."""
    rate = None
    lines = source.lines()
    for line in lines:
        match = _SAMPLE_RATE.match(line.text)
        rate = float(match[1]) if match else rate
        if line.text.startswith("Time"):
            break
    else:
        raise RecordingError(
            "no column row", file=source.name, expected="a row that begins with Time", found="none"
        )
    columns = _fields(line)
    unit_line = next(lines, Line(line.number + 1, "", line.end))
    unit_row = _fields(unit_line)
    if len(unit_row) != len(columns) or unit_row[0] not in FACTORS_TO_SI["time"]:
        raise RecordingError(
            "no row of units",
            file=source.name,
            place=f"line {unit_line.number}",
            expected=f"{len(columns)} units, beginning with that of Time",
            found=repr(unit_line.text[:60]),
        )
    table = Table(source, tuple(columns), ",", start=unit_line.end, first_line=unit_line.number + 1)
    positions: dict[str, dict[str, list[int]]] = {}
    units: dict[str, str] = {}
    for label in dict.fromkeys(name.rsplit("/", 2)[0] for name in columns if name.count("/") >= 2):
        positions[label] = {}
        for signal, (quantity, components) in _QUANTITIES.items():
            names = [f"{label}/{quantity}/{component}" for component in components]
            if not any(name in columns for name in names):
                continue
            positions[label][signal] = table.positions(names)
            if signal in QUANTITY_OF:
                stated = {unit_row[position] for position in positions[label][signal]}
                units.setdefault(signal, unit_row[positions[label][signal][0]])
                if stated != {units[signal]}:
                    raise RecordingError(
                        f"columns of one quantity differ in unit ({label}/{quantity})",
                        file=source.name,
                        place=f"line {unit_line.number}",
                        expected=units[signal],
                        found=", ".join(sorted(stated)),
                    )
    return _Layout(table, {k: v for k, v in positions.items() if v}, units, unit_row[0], rate)


def _layout_format_7(source: SourceText) -> _Layout:
    """Layout of Format=7: 14 columns per sensor at fixed places, confirmed by the second line."""
    head = list(islice(source.lines(), 3))
    fields = [_fields(line) for line in head]
    labels = fields[0][4::_FORMAT_7_WIDTH]
    n_columns = 1 + _FORMAT_7_WIDTH * len(labels)
    _require(source, 2, fields, ["Time", *_FORMAT_7_ROW * len(labels)])
    axes = [*"XYZXYZXYZ", "", *"SXYZ"]
    _require(source, 3, fields, ["", *axes * len(labels)])
    if len(set(labels)) != len(labels):
        # Ids are unique where labels are not.
        labels = fields[0][1::_FORMAT_7_WIDTH][: len(labels)]
    table = Table(
        source,
        tuple(f"column {position + 1}" for position in range(n_columns)),
        ",",
        start=head[-1].end,
        first_line=4,
    )
    positions = {
        label: {
            signal: list(range(1 + 14 * i + start, 1 + 14 * i + start + count))
            for signal, (start, count) in _FORMAT_7_PLACES.items()
        }
        for i, label in enumerate(labels)
    }
    return _Layout(table, positions, FORMAT_7_UNITS, "us", None)


def _require(
    source: SourceText, number: int, fields: Sequence[Sequence[str]], expected: Sequence[str]
) -> None:
    found = list(fields[number - 1]) if len(fields) >= number else []
    if found != list(expected):
        first = next(
            (i for i, (a, b) in enumerate(zip(found, expected, strict=False)) if a != b),
            min(len(found), len(expected)),
        )
        raise RecordingError(
            "the header is not that of Format=7",
            file=source.name,
            place=f"line {number}, column {first + 1}",
            expected=repr(expected[first]) if first < len(expected) else "end of line",
            found=repr(found[first]) if first < len(found) else "end of line",
        )


def _fields(line: Line) -> list[str]:
    return [name.strip().strip('"') for name in line.text.split(",")]
