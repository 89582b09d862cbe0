r"""Any delimited text with a JSON file beside it that says what its columns are.

For a lab whose format has no reader: put ``walk.json`` beside ``walk.csv``. The keys:

``format``
    ``"swaystride-csv-1"``; without it the JSON file is not taken for a sidecar.
``delimiter``, ``decimal``, ``skip_lines``
    One character; ``"."`` (default) or ``","``; lines above the column row (default 0).
``sensors``
    Label of each sensor to its signals: ``acc``, ``gyr``, ``mag`` to three column names (x, y, z)
    and ``quat`` (sensor to world) to four (w, x, y, z).
``units``
    Unit of ``acc``, ``gyr``, ``mag``, spelled as in :data:`swaystride.units.FACTORS_TO_SI`; required
    for every signal in use.
``rate_hz`` or ``time``
    The sampling rate, or ``{"column": …, "unit": "s" | "ms" | "us" | "ns"}``; at least one. With
    both, the rate is checked against the time stamps.
``packet_counter``
    Name of a column that counts packets; else gaps are found in the time stamps.
``world_frame``, ``device``
    Provenance.

The schema is ``sidecar.schema.json`` in this folder. For example::

    {"format": "swaystride-csv-1", "delimiter": ",", "rate_hz": 100.0,
     "units": {"acc": "g", "gyr": "deg/s"},
     "sensors": {"lumbar": {"acc": ["ax", "ay", "az"], "gyr": ["gx", "gy", "gz"]}}}
"""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.findings import Finding
from swaystride.io.assembly import SensorRows, assemble, select_sensors
from swaystride.io.hints import QUANTITY_OF, ReadHints
from swaystride.io.sample_index import index_from_counter, index_from_stamps
from swaystride.io.sampling_rate import resolve_rate
from swaystride.io.source_text import Line, SourceText
from swaystride.io.table import Table, name_of_delimiter, read_numbers
from swaystride.recording import Recording

FORMAT = "swaystride-csv-1"
_COMPRESSED = {".xz", ".gz", ".bz2"}


def sidecar_path(path: Path | str) -> Path:
    """Return the JSON file that belongs to a recording.

    Parameters
    ----------
    path : path or str
        The CSV file.

    Examples
    --------
    >>> sidecar_path("raw/walk.csv.gz").name
    'walk.json'
    """
    path = Path(path)
    if path.suffix in _COMPRESSED:
        path = path.with_suffix("")
    return path.with_suffix(".json")


def is_sidecar_csv(source: SourceText) -> bool:
    """Tell whether the file has a sidecar of this format beside it.

    Parameters
    ----------
    source : SourceText
        Opened file.
    """
    path = sidecar_path(source.path)
    return path != source.path and path.is_file() and FORMAT.encode() in path.read_bytes()


def read_sidecar_csv(source: SourceText, hints: ReadHints) -> Recording:
    """Read a delimited file as its sidecar describes it.

    Parameters
    ----------
    source : SourceText
    hints : ReadHints
        Sensors select by label; rate and units must not contradict the sidecar.

    Returns
    -------
    Recording

    Raises
    ------
    RecordingError
        If the sidecar is invalid, or the file is not as it says.
    """
    sidecar = _load_sidecar(sidecar_path(source.path))
    table = _table(source, sidecar)
    labels = select_sensors(list(sidecar["sensors"]), hints, file=source.name)
    columns_of = {
        (label, signal): names
        for label in labels
        for signal, names in sidecar["sensors"][label].items()
    }
    units = _units(sidecar, {signal for _, signal in columns_of}, sidecar_path(source.path).name)
    hints.confirm_units(units, file=source.name)
    stamps = [sidecar["time"]["column"]] if "time" in sidecar else []
    counters = [sidecar["packet_counter"]] if "packet_counter" in sidecar else []
    names = [*stamps, *counters, *(name for group in columns_of.values() for name in group)]
    rows = read_numbers(table, table.positions(names))
    sizes = [len(stamps), len(counters), *map(len, columns_of.values())]
    time, counter, *signals = np.split(rows, np.cumsum(sizes)[:-1])
    if stamps:
        time = time * _time_factor(sidecar)
    index, measured, findings = _time_axis(table, hints, time, counter, names)
    rate = resolve_rate(
        hints,
        file=source.name,
        header_hz=sidecar.get("rate_hz"),
        header_place="rate_hz of the sidecar",
        measured_hz=measured,
    )
    sensors = {label: SensorRows(label) for label in labels}
    for (label, signal), values in zip(columns_of, signals, strict=True):
        sensors[label].signals[signal] = values
    return assemble(
        source,
        list(sensors.values()),
        index=index,
        first_line=table.first_line,
        rate=rate,
        units=units,
        world_frame=sidecar.get("world_frame", "unknown"),
        device=sidecar.get("device", "unknown"),
        findings=findings,
        attributes={"first_packet": int(counter[0, 0])} if counters else None,
    )


@cache
def _validator() -> jsonschema.Draft202012Validator:
    schema = json.loads(Path(__file__).with_name("sidecar.schema.json").read_text("utf-8"))
    return jsonschema.Draft202012Validator(schema)


def _load_sidecar(path: Path) -> dict[str, Any]:
    try:
        sidecar: dict[str, Any] = json.loads(path.read_text("utf-8"))
    except ValueError as error:
        raise RecordingError(
            "the sidecar is not JSON", file=path.name, expected="JSON", found=str(error)
        ) from error
    for problem in _validator().iter_errors(sidecar):
        raise RecordingError(
            "the sidecar does not follow its schema",
            file=path.name,
            place=problem.json_path,
            expected="what swaystride.io.sidecar_csv describes",
            found=problem.message,
        )
    return sidecar


def _units(sidecar: dict[str, Any], signals: set[str], file: str) -> dict[str, str]:
    """Return the units of the signals in use; the sidecar must state each."""
    for signal in QUANTITY_OF:
        if signal in signals and signal not in sidecar["units"]:
            raise RecordingError(
                f"the sidecar states no unit of {signal}",
                file=file,
                place="$.units",
                expected=f"a key {signal}",
                found=", ".join(sidecar["units"]) or "no units",
            )
    return {signal: unit for signal, unit in sidecar["units"].items() if signal in signals}


def _time_factor(sidecar: dict[str, Any]) -> float:
    return {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9}[sidecar["time"]["unit"]]


def _table(source: SourceText, sidecar: dict[str, Any]) -> Table:
    """Find the column row where the sidecar says it is."""
    skip, delimiter = sidecar.get("skip_lines", 0), sidecar["delimiter"]
    row = next((line for line in source.lines() if line.number == skip + 1), None)
    row = row or Line(skip + 1, "", len(source.data))
    columns = tuple(name.strip().strip('"') for name in row.text.split(delimiter))
    if len(columns) < 2:
        raise RecordingError(
            "wrong delimiter: one column found",
            file=source.name,
            place=f"line {row.number}",
            expected=f"column names separated by {name_of_delimiter(delimiter)}",
            found=repr(row.text[:60]),
        )
    return Table(
        source,
        columns,
        delimiter,
        start=row.end,
        first_line=row.number + 1,
        decimal=sidecar.get("decimal", "."),
    )


def _time_axis(
    table: Table,
    hints: ReadHints,
    time: NDArray[np.float64],
    counter: NDArray[np.float64],
    names: list[str],
) -> tuple[NDArray[np.int64], float | None, list[Finding]]:
    """Sample index from the counter, or else the time stamps, which also measure the rate."""
    file, first_line = table.source.name, table.first_line
    measured: float | None = None
    findings: list[Finding] = []
    if len(counter):
        index, findings = index_from_counter(
            counter[0], hints, file=file, first_line=first_line, column=names[len(time)]
        )
        span = float(time[0, -1] - time[0, 0]) if len(time) else 0.0
        measured = float(index[-1]) / span if span > 0 else None
    elif len(time):
        stamped, findings = index_from_stamps(
            time[0], file=file, first_line=first_line, column=names[0]
        )
        index, measured = stamped.index, stamped.rate_hz
    else:
        index = np.arange(time.shape[1])
        findings = [
            Finding(
                "no_packet_counter",
                "warning",
                file,
                f"line {first_line - 1}",
                "packet_counter or time in the sidecar",
                "neither; lost packets cannot be seen",
            )
        ]
    return index, measured, findings
