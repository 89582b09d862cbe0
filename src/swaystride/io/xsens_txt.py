"""Xsens MT Manager TXT: one sensor a file, `//` comments, a column row, any of four delimiters.

Up to version 4.6 the header states ``// Update Rate: 100.0Hz``. From 2019 on it does not, and the
rate comes from the column SampleTimeFine (ticks of 0.1 ms) or from the argument. Accelerations are
in m/s², angular rates in rad/s and the magnetic field in arbitrary units, as the vendor defines
them. Orientation is read as quaternion, matrix (printed by columns) or roll, pitch, yaw in degrees.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.findings import Finding
from swaystride.io.assembly import SensorRows, assemble, single_label
from swaystride.io.hints import ReadHints
from swaystride.io.sample_index import index_from_counter, index_from_stamps
from swaystride.io.sampling_rate import resolve_rate
from swaystride.io.source_text import Line, SourceText
from swaystride.io.table import Table, split_columns
from swaystride.io.xsens_columns import (
    KNOWN_COLUMN,
    PACKET_COUNTER,
    SAMPLE_TIME_FINE,
    read_signals,
)
from swaystride.recording import Recording

#: By the vendor's definition (MT Manager user manual).
UNITS = {"acc": "m/s^2", "gyr": "rad/s", "mag": "a.u."}
TICKS_PER_S = 10_000
TICK_MODULUS = 2**32

_RATE = re.compile(r"Update Rate:\s*([0-9.]+)\s*Hz")
_DEVICE = re.compile(r"DeviceId:\s*(\S+)")
_FRAME = re.compile(r"Coordinate system:\s*(\S+)")
_COMMENT = re.compile(r"Comment:\s*(.+)")
_DEVICE_IN_NAME = re.compile(r"_([0-9A-F]{8})(?=\.|$)")


@dataclass(frozen=True)
class XsensHeader:
    """What the lines above the numbers say; None where they are silent."""

    rate_hz: float | None
    rate_line: int
    device: str | None
    world_frame: str | None
    comment: str
    column_row: Line | None


def is_xsens_txt(source: SourceText) -> bool:
    """Tell whether a text begins like an export of MT Manager: comments or a packet counter.

    Parameters
    ----------
    source : SourceText
        Opened file.
    """
    return source.first_text().lstrip().startswith(("//", PACKET_COUNTER))


def read_xsens_txt(source: SourceText, hints: ReadHints) -> Recording:
    """Read one MT Manager TXT file.

    Parameters
    ----------
    source : SourceText
    hints : ReadHints
        The rate is needed if the file has neither ``// Update Rate:`` nor SampleTimeFine; the
        sensor labels the recording in place of the device id.

    Returns
    -------
    Recording
        With attribute ``first_packet`` if the file counts packets.

    Raises
    ------
    RecordingError
        See :func:`swaystride.io.reading.read_recording`.
    """
    header = _read_header(source)
    row = header.column_row
    if row is None:
        raise RecordingError(
            "the file ends before its column row",
            file=source.name,
            expected=f"a row of column names ({PACKET_COUNTER}, Acc_X, …)",
            found="comment lines only",
        )
    *columns, delimiter = split_columns(
        row.text, file=source.name, line=row.number, known=KNOWN_COLUMN
    )
    table = Table(source, tuple(columns), delimiter, start=row.end, first_line=row.number + 1)
    others, signals = read_signals(table, (PACKET_COUNTER, SAMPLE_TIME_FINE))
    units = {signal: unit for signal, unit in UNITS.items() if signal in signals}
    hints.confirm_units(units, file=source.name)
    axis = _time_axis(table, hints, others, next(iter(signals.values())).shape[1])
    rate = resolve_rate(
        hints,
        file=source.name,
        header_hz=header.rate_hz,
        header_place=f"line {header.rate_line}" if header.rate_line else "'// Update Rate:'",
        measured_hz=axis.rate_hz,
        measured_tolerance=axis.rate_tolerance,
    )
    device = header.device or _device_in_name(source.name)
    attributes: dict[str, str | int] = {}
    if PACKET_COUNTER in others:
        attributes["first_packet"] = int(others[PACKET_COUNTER][0])
    if header.comment:
        attributes["comment"] = header.comment
    return assemble(
        source,
        [SensorRows(single_label(hints, device or "sensor", file=source.name), signals)],
        index=axis.index,
        first_line=table.first_line,
        rate=rate,
        units=units,
        world_frame=header.world_frame or "unknown",
        device=device or "unknown",
        findings=axis.findings,
        attributes=attributes,
    )


@dataclass(frozen=True)
class _TimeAxis:
    index: NDArray[np.int64]
    rate_hz: float | None
    rate_tolerance: float
    findings: list[Finding]


def _time_axis(
    table: Table, hints: ReadHints, others: dict[str, NDArray[np.float64]], n_rows: int
) -> _TimeAxis:
    """Sample index from the packet counter, or else the ticks; the ticks measure the rate."""
    ticks, findings = _unwrap_ticks(table, others.get(SAMPLE_TIME_FINE))
    # Each of the two ends is rounded to a whole tick.
    tolerance = 0.0 if ticks is None else 1.0 / max(ticks[-1] - ticks[0], 1.0)
    if PACKET_COUNTER in others:
        index, duplicates = index_from_counter(
            others[PACKET_COUNTER],
            hints,
            file=table.source.name,
            first_line=table.first_line,
            column=PACKET_COUNTER,
        )
        measured = None
        if ticks is not None and ticks[-1] > ticks[0]:
            measured = TICKS_PER_S * float(index[-1]) / float(ticks[-1] - ticks[0])
        return _TimeAxis(index, measured, tolerance, findings + duplicates)
    if ticks is not None:
        stamped, irregular = index_from_stamps(
            ticks / TICKS_PER_S,
            file=table.source.name,
            first_line=table.first_line,
            column=SAMPLE_TIME_FINE,
        )
        return _TimeAxis(stamped.index, stamped.rate_hz, tolerance, irregular)
    silent = Finding(
        "no_packet_counter",
        "warning",
        table.source.name,
        f"line {table.first_line - 1}",
        f"a column {PACKET_COUNTER} or {SAMPLE_TIME_FINE}",
        "neither; lost packets cannot be seen",
    )
    return _TimeAxis(np.arange(n_rows), None, 0.0, [*findings, silent])


def _unwrap_ticks(
    table: Table, ticks: NDArray[np.float64] | None
) -> tuple[NDArray[np.float64] | None, list[Finding]]:
    """Ticks without wrap-around; None if there are none, or they cannot measure a rate."""
    if ticks is None or len(ticks) < 2 or np.isnan(ticks).any():
        return None, []
    steps = np.diff(ticks)
    backward = np.flatnonzero((steps < 0) & (steps > -TICK_MODULUS / 2))
    if backward.size:
        row = int(backward[0]) + 1
        place = f"line {table.first_line + row}"
        ends = f"more than {ticks[row - 1]:.0f}", f"{ticks[row]:.0f}; the ticks are not used"
        return None, [Finding("sample_time_fine", "warning", table.source.name, place, *ends)]
    return ticks + TICK_MODULUS * np.cumsum(np.diff(ticks, prepend=ticks[0]) < 0), []


def _read_header(source: SourceText) -> XsensHeader:
    """Collect what the comment lines say, up to the first other line that is not blank."""
    found: dict[str, str] = {}
    comments, rate_line = [], 0
    row = None
    for line in source.lines():
        text = line.text.strip()
        if text and not text.startswith("//"):
            row = line
            break
        for key, pattern in (("rate", _RATE), ("device", _DEVICE), ("frame", _FRAME)):
            match = pattern.search(text)
            if match:
                found[key] = match[1]
                rate_line = line.number if key == "rate" else rate_line
        comment = _COMMENT.search(text)
        if comment:
            comments.append(comment[1].strip())
    rate = float(found["rate"]) if _is_positive(found.get("rate", "")) else None
    return XsensHeader(
        rate_hz=rate,
        rate_line=rate_line if rate else 0,
        device=found.get("device"),
        world_frame=found.get("frame"),
        comment="; ".join(comments),
        column_row=row,
    )


def _is_positive(text: str) -> bool:
    try:
        return float(text) > 0
    except ValueError:
        return False


def _device_in_name(name: str) -> str | None:
    """MT Manager ends the file name with the device id; older headers do not repeat it."""
    match = _DEVICE_IN_NAME.search(name)
    return match[1] if match else None
