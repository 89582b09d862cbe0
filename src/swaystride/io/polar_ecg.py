"""Chest straps: ECG and acceleration of Polar Sensor Logger, ECG of ECGLogger.

* Polar Sensor Logger, semicolons: ``Phone timestamp;sensor timestamp [ns];ecg [uV]`` (a column
  ``timestamp [ms]`` may stand between) or ``…;X [mg];Y [mg];Z [mg]``. The sensor stamp counts ns
  since 2000 in the strap's own clock, which starts anew when the strap was off; the phone stamps
  whole packets and is not used for the rate.
* ECGLogger, commas: ``time,ecg,hr,rr``; Unix time in ns, mV, 1/min, ms.

Stamps are read as whole numbers. A row whose stamp has lost digits is left out with a finding.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from swaystride.ecg_recording import POLAR_EPOCH, UNIX_EPOCH, EcgRecording, make_ecg
from swaystride.errors import RecordingError
from swaystride.findings import Finding
from swaystride.io import checks
from swaystride.io.assembly import SensorRows, assemble, refuse_mostly_missing, single_label
from swaystride.io.hints import ReadHints
from swaystride.io.nanosecond_stamps import drop_truncated_stamps
from swaystride.io.sample_index import index_from_stamps
from swaystride.io.sampling_rate import SamplingRate, resolve_rate
from swaystride.io.source_text import SourceText, open_source
from swaystride.io.table import Table, read_numbers
from swaystride.recording import Recording
from swaystride.units import to_si

ECG_LOGGER_COLUMNS = ("time", "ecg", "hr", "rr")
#: By the definition of ECGLogger.
ECG_LOGGER_UNIT = "mV"
#: Unix time in ns has 19 digits from 2001 to 2286.
ECG_LOGGER_DIGITS = 19
SENSOR_TIME = "sensor timestamp [ns]"
_PHONE_TIME = "Phone timestamp"
_ECG = re.compile(r"ecg \[(.+)\]")
_ACC = re.compile(r"[XYZ] \[(.+)\]")


def is_polar_acc(source: SourceText) -> bool:
    """Tell whether a text is an acceleration file of Polar Sensor Logger.

    Parameters
    ----------
    source : SourceText
        Opened file.
    """
    first = source.first_text()
    return first.startswith(_PHONE_TIME) and _ACC.search(first) is not None


def is_ecg(source: SourceText) -> bool:
    """Tell whether a text is an ECG file of one of the two applications.

    Parameters
    ----------
    source : SourceText
        Opened file.
    """
    first = source.first_text()
    polar = first.startswith(_PHONE_TIME) and _ECG.search(first) is not None
    return polar or tuple(first.split(",")[:2]) == ECG_LOGGER_COLUMNS[:2]


def read_polar_acc(source: SourceText, hints: ReadHints) -> Recording:
    """Read the acceleration of a chest strap as a recording of one sensor.

    Parameters
    ----------
    source : SourceText
    hints : ReadHints
        The label; rate and unit must not contradict the file.

    Returns
    -------
    Recording
        With ``acc`` only; attributes ``start_ns`` and ``clock_epoch``.

    Raises
    ------
    RecordingError
        See :func:`swaystride.io.reading.read_recording`.
    """
    table = _table(source)
    names = [name for name in table.columns if _ACC.fullmatch(name)]
    units = {_unit_of(name) for name in names}
    if len(names) != 3 or len(units) != 1:
        raise RecordingError(
            "the axes of the acceleration are not three of one unit",
            file=source.name,
            place=f"line {table.first_line - 1}",
            expected="X [mg], Y [mg], Z [mg]",
            found=", ".join(names),
        )
    unit = {"acc": units.pop()}
    hints.confirm_units(unit, file=source.name)
    values, stamps_ns, index, rate, findings = _uniform(table, SENSOR_TIME, sorted(names), hints)
    return assemble(
        source,
        [SensorRows(single_label(hints, "chest_strap", file=source.name), {"acc": values})],
        index=index,
        first_line=table.first_line,
        rate=rate,
        units=unit,
        device="Polar",
        findings=findings,
        attributes={"start_ns": int(stamps_ns[0]), "clock_epoch": POLAR_EPOCH},
    )


def read_ecg(path: Path | str, *, rate_hz: float | None = None) -> EcgRecording:
    r"""Read an electrocardiogram of ECGLogger or Polar Sensor Logger; also if it is compressed.

    Parameters
    ----------
    path : path or str
    rate_hz : float, optional
        What you believe the rate to be. It is measured, and an argument that differs is an error.

    Returns
    -------
    EcgRecording
        Drop-outs are NaN.

    Raises
    ------
    RecordingError
        One line, if the file is empty, of another format, damaged, or without a whole time stamp.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp(), "run.csv")
    >>> rows = [f"{1714920600_000000000 + i * 7692308},0.1,NA,NA\n" for i in (0, 1, 2, 5)]
    >>> _ = path.write_text("time,ecg,hr,rr\n" + "".join(rows))
    >>> ecg = read_ecg(path)
    >>> ecg["ecg"].values, round(ecg.attrs["rate_hz"], 3), ecg.attrs["start_ns"]
    (array([0.0001, 0.0001, 0.0001,    nan,    nan, 0.0001]), 130.0, 1714920600000000000)
    """
    source = open_source(path)
    if not is_ecg(source):
        raise RecordingError(
            "not an ECG file",
            file=source.name,
            place="first line",
            expected="time,ecg,hr,rr or Phone timestamp;sensor timestamp [ns];…;ecg [uV]",
            found=repr(source.first_text()[:80]),
        )
    table, hints = _table(source), ReadHints(rate_hz=rate_hz)
    logger = table.columns[0] == ECG_LOGGER_COLUMNS[0]
    if logger:
        names = [name for name in ECG_LOGGER_COLUMNS[1:] if name in table.columns]
        time, unit, digits = ECG_LOGGER_COLUMNS[0], ECG_LOGGER_UNIT, ECG_LOGGER_DIGITS
    else:
        names = [name for name in table.columns if _ECG.fullmatch(name)]
        time, unit, digits = SENSOR_TIME, _unit_of(names[0]), None
    values, stamps_ns, index, rate, findings = _uniform(table, time, names, hints, digits)
    ecg_v = np.full(int(index[-1]) + 1, np.nan)
    ecg_v[index] = to_si(values[0], unit, "voltage")
    file, line = source.name, table.first_line
    findings += checks.packet_loss(index, rate.rate_hz, file=file, first_line=line)
    findings += checks.nan_run(
        values[:1], index, rate.rate_hz, file=file, first_line=line, signal="ecg"
    )
    reports = dict(zip(names[1:], values[1:], strict=True)) if logger else {}
    said = np.zeros(len(index), dtype=bool)
    for column in reports.values():
        said |= np.isfinite(column)
    missing = np.full(len(index), np.nan)
    return make_ecg(
        ecg_v,
        rate_hz=rate.rate_hz,
        rate_source=rate.source,
        start_ns=int(stamps_ns[0]),
        clock_epoch=UNIX_EPOCH if logger else POLAR_EPOCH,
        report_time_s=(stamps_ns - stamps_ns[0])[said] * 1e-9,
        strap_rr_s=reports.get("rr", missing)[said] * 1e-3,
        strap_hr_bpm=reports.get("hr", missing)[said],
        device="Polar, by ECGLogger" if logger else "Polar, by Polar Sensor Logger",
        source_file=source.name,
        source_sha256=source.sha256,
        findings=checks.stop_on_error([*rate.findings, *findings]),
    )


def _unit_of(column: str) -> str:
    return column[column.index("[") + 1 : -1]


def _table(source: SourceText) -> Table:
    row = next(line for line in source.lines() if line.text.strip())
    delimiter = ";" if row.text.startswith(_PHONE_TIME) else ","
    columns = tuple(name.strip() for name in row.text.split(delimiter))
    return Table(source, columns, delimiter, start=row.end, first_line=row.number + 1)


def _uniform(
    table: Table, time: str, names: list[str], hints: ReadHints, digits: int | None = None
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64], SamplingRate, list[Finding]]:
    """Values and stamps of the rows that are kept, their sample index, the rate, and findings."""
    file = table.source.name
    table, stamps_ns, kept, findings = drop_truncated_stamps(table, time, digits=digits)
    values = read_numbers(table, table.positions(names))
    if not kept.all():
        values, stamps_ns = values[:, kept], stamps_ns[kept]
    stamped, irregular = index_from_stamps(
        (stamps_ns - stamps_ns[0]) * 1e-9,
        file=file,
        first_line=table.first_line if kept.all() else 1,
        column=time,
        row_name="line" if kept.all() else "row with a whole time stamp",
    )
    rate = resolve_rate(
        hints, file=file, header_hz=None, header_place=time, measured_hz=stamped.rate_hz
    )
    refuse_mostly_missing(stamped.index, file=file)
    return values, stamps_ns, stamped.index, rate, findings + irregular
