"""Motion-BIDS: one tracking system a file, channels described beside it.

``…_motion.tsv`` has no header: its columns follow the rows of ``…_channels.tsv`` in the same folder,
rate and device stand in ``…_motion.json``, frames of reference in ``…_channels.json`` (optional).
Channels of types ACCEL, GYRO, MAGN and ORNT (quaternions) make one sensor per tracked point; a
LATENCY channel (s since onset) shows gaps. All other types are left out with a finding.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.findings import Finding
from swaystride.io.assembly import SensorRows, assemble, select_sensors
from swaystride.io.hints import ReadHints, rates_agree
from swaystride.io.sample_index import index_from_stamps
from swaystride.io.sampling_rate import resolve_rate
from swaystride.io.source_text import SourceText
from swaystride.io.table import Table, read_numbers
from swaystride.recording import Recording
from swaystride.units import to_si

REQUIRED_COLUMNS = ("name", "component", "type", "tracked_point", "units")
_SIGNALS = {"ACCEL": "acc", "GYRO": "gyr", "MAGN": "mag"}
_AXES = ("x", "y", "z")
_QUATERNION = ("quat_w", "quat_x", "quat_y", "quat_z")
_SUFFIX = "_motion.tsv"
_COMPRESSED = {".xz", ".gz", ".bz2"}


@dataclass(frozen=True)
class _Channels:
    """What the channels file says: columns of each signal of each tracked point, and units."""

    names: tuple[str, ...]
    positions: dict[str, dict[str, list[int]]]
    units: dict[str, str]
    latency: tuple[int, str] | None
    rates: dict[str, float]
    frames: dict[str, str]
    left_out: list[str]


def companion(path: Path | str, suffix: str) -> Path:
    """Return a file that describes a motion file.

    Parameters
    ----------
    path : path or str
        The ``_motion.tsv`` file.
    suffix : str
        Such as ``_channels.tsv``.

    Examples
    --------
    >>> companion("sub-1/sub-1_task-run_tracksys-imu_motion.tsv.gz", "_channels.tsv").name
    'sub-1_task-run_tracksys-imu_channels.tsv'
    """
    path = Path(path)
    name = path.stem if path.suffix in _COMPRESSED else path.name
    return path.with_name(name.removesuffix(_SUFFIX) + suffix)


def is_motion_bids(source: SourceText) -> bool:
    """Tell whether a file is a motion file with its channels beside it.

    Parameters
    ----------
    source : SourceText
        Opened file. It has no header, so that its companions decide.
    """
    path = source.path
    name = path.stem if path.suffix in _COMPRESSED else path.name
    described = (companion(path, suffix) for suffix in ("_channels.tsv", "_motion.json"))
    return name.endswith(_SUFFIX) and any(file.is_file() for file in described)


def read_motion_bids(source: SourceText, hints: ReadHints) -> Recording:
    """Read the inertial channels of one tracking system.

    Parameters
    ----------
    source : SourceText
    hints : ReadHints
        Sensors select tracked points; rate and units must not contradict the files.

    Returns
    -------
    Recording
        One sensor per tracked point with an inertial channel.

    Raises
    ------
    RecordingError
        If a companion is missing or invalid, the numbers of columns disagree, components of a
        signal are missing or differ in unit, or a signal is no inertial one at all.
    """
    motion = _json(companion(source.path, "_motion.json"))
    channels = _channels(companion(source.path, "_channels.tsv"))
    # BIDS spells a missing number n/a; of the same length, so that places in the file stay.
    source = replace(source, data=source.data.replace(b"n/a", b"NaN"))
    first = source.first_text().split("\t")
    if len(first) != len(channels.names):
        raise RecordingError(
            "columns and channels differ in number",
            file=source.name,
            place="line 1",
            expected=f"{len(channels.names)} columns, as in _channels.tsv",
            found=f"{len(first)} columns",
        )
    table = Table(source, channels.names, "\t", start=0, first_line=1)
    labels = select_sensors(list(channels.positions), hints, file=source.name)
    used = {signal for label in labels for signal in channels.positions[label]}
    units = {signal: unit for signal, unit in channels.units.items() if signal in used}
    hints.confirm_units(units, file=companion(source.path, "_channels.tsv").name)
    sensors, latency = _read_rows(table, channels, labels)
    n_rows = next(iter(sensors[0].signals.values())).shape[1]
    index, measured, findings = _time_axis(table, channels, latency, n_rows)
    return assemble(
        source,
        sensors,
        index=index,
        first_line=1,
        rate=resolve_rate(
            hints,
            file=source.name,
            header_hz=_rate(motion, channels, source),
            header_place="SamplingFrequency of _motion.json",
            measured_hz=measured,
        ),
        units=units,
        world_frame=_world_frame(companion(source.path, "_channels.json"), channels, labels),
        device=" ".join(
            str(motion[key]) for key in ("Manufacturer", "ManufacturersModelName") if key in motion
        )
        or "unknown",
        findings=[*_left_out(channels, source), *findings],
        attributes={"task": str(motion["TaskName"])} if "TaskName" in motion else None,
    )


def _json(path: Path) -> dict[str, Any]:
    try:
        value = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise RecordingError(
            "a companion of the motion file cannot be read",
            file=path.name,
            expected="a JSON file beside it",
            found=str(error) if isinstance(error, ValueError) else "no such file",
        ) from error
    if not isinstance(value, dict):
        raise RecordingError("not a JSON object", file=path.name, expected="keys and values")
    return value


def _channels(path: Path) -> _Channels:
    try:
        text = path.read_bytes().removeprefix(b"\xef\xbb\xbf")
        frame = pd.read_csv(BytesIO(text), sep="\t", dtype=str, keep_default_na=False)
    except (OSError, ValueError) as error:
        raise RecordingError(
            "a companion of the motion file cannot be read",
            file=path.name,
            expected="a tab-separated table beside it",
            found=str(error) if isinstance(error, ValueError) else "no such file",
        ) from error
    missing = [name for name in REQUIRED_COLUMNS if name not in frame]
    if missing or frame.empty:
        raise RecordingError(
            "no channels" if not missing else f"column {missing[0]} is missing",
            file=path.name,
            place="line 1",
            expected=", ".join(REQUIRED_COLUMNS),
            found=", ".join(map(str, frame.columns)),
        )
    places: dict[tuple[str, str], dict[str, tuple[int, str]]] = {}
    latency: tuple[int, str] | None = None
    left_out = []
    for position, row in enumerate(frame.to_dict("records")):
        kind, component = row["type"].upper(), row["component"].lower()
        signal = _SIGNALS.get(kind) if component in _AXES else None
        signal = "quat" if kind == "ORNT" and component in _QUATERNION else signal
        if kind == "LATENCY" and latency is None:
            latency = (position, row["units"])
        elif signal is None:
            left_out.append(f"{row['name']} ({row['type']})")
        else:
            group = places.setdefault((row["tracked_point"], signal), {})
            if component in group:
                raise _ambiguous(path, row, position)
            group[component] = (position, row["units"])
    positions, units = _signals(places, path)
    return _Channels(
        names=tuple(frame["name"]),
        positions=positions,
        units=units,
        latency=latency,
        rates=_rates(frame, path),
        frames=_frames(frame),
        left_out=left_out,
    )


def _ambiguous(path: Path, row: dict[Any, Any], position: int) -> RecordingError:
    return RecordingError(
        "two channels for one component",
        file=path.name,
        place=f"line {position + 2} ({row['name']})",
        expected=f"one {row['type']} {row['component']} of {row['tracked_point']}",
        found="another one above",
    )


def _signals(
    places: dict[tuple[str, str], dict[str, tuple[int, str]]], path: Path
) -> tuple[dict[str, dict[str, list[int]]], dict[str, str]]:
    """Columns of the signals in the order x, y, z or w, x, y, z; one unit per quantity."""
    positions: dict[str, dict[str, list[int]]] = {}
    units: dict[str, str] = {}
    for (point, signal), group in places.items():
        wanted = _QUATERNION if signal == "quat" else _AXES
        absent = [component for component in wanted if component not in group]
        stated = {unit for _, unit in group.values()}
        if signal != "quat":
            stated.add(units.setdefault(signal, next(iter(stated))))
        if absent or (signal != "quat" and len(stated) > 1):
            raise RecordingError(
                f"{signal} of {point} is not complete" if absent else f"{signal} in several units",
                file=path.name,
                place=f"tracked point {point}",
                expected=", ".join(wanted) if absent else "one unit for all channels of a quantity",
                found=", ".join(group) if absent else ", ".join(sorted(stated)),
            )
        positions.setdefault(point, {})[signal] = [group[component][0] for component in wanted]
    if not positions:
        raise RecordingError(
            "no inertial channel", file=path.name, expected="ACCEL, GYRO, MAGN or quaternions"
        )
    return positions, units


def _rates(frame: pd.DataFrame, path: Path) -> dict[str, float]:
    if "sampling_frequency" not in frame:
        return {}
    try:
        return {
            str(name): float(rate)
            for name, rate in zip(frame["name"], frame["sampling_frequency"], strict=True)
            if rate not in ("", "n/a")
        }
    except ValueError as error:
        raise RecordingError(
            "sampling_frequency is not a number", file=path.name, found=str(error)
        ) from error


def _frames(frame: pd.DataFrame) -> dict[str, str]:
    if "reference_frame" not in frame:
        return {}
    return dict(zip(frame["tracked_point"], frame["reference_frame"], strict=True))


def _rate(motion: dict[str, Any], channels: _Channels, source: SourceText) -> float:
    stated = motion.get("SamplingFrequency")
    if isinstance(stated, bool) or not isinstance(stated, int | float) or not stated > 0:
        raise RecordingError(
            "no sampling rate",
            file=companion(source.path, "_motion.json").name,
            place="SamplingFrequency",
            expected="a number above 0, in Hz",
            found=repr(stated),
        )
    for name, rate_hz in channels.rates.items():
        if not rates_agree(float(stated), rate_hz):
            raise RecordingError(
                "channels of unequal rate",
                file=companion(source.path, "_channels.tsv").name,
                place=name,
                expected=f"{stated:g} Hz, the SamplingFrequency",
                found=f"{rate_hz:g} Hz",
            )
    return float(stated)


def _read_rows(
    table: Table, channels: _Channels, labels: list[str]
) -> tuple[list[SensorRows], NDArray[np.float64] | None]:
    order = [(label, signal) for label in labels for signal in channels.positions[label]]
    groups = [channels.positions[label][signal] for label, signal in order]
    time = [] if channels.latency is None else [channels.latency[0]]
    rows = read_numbers(table, [*time, *(position for group in groups for position in group)])
    latency, *signals = np.split(rows, np.cumsum([len(time), *map(len, groups)])[:-1])
    sensors = {label: SensorRows(label) for label in labels}
    for (label, signal), values in zip(order, signals, strict=True):
        sensors[label].signals[signal] = values
    return list(sensors.values()), latency[0] if time else None


def _time_axis(
    table: Table, channels: _Channels, latency: NDArray[np.float64] | None, n_rows: int
) -> tuple[NDArray[np.int64], float | None, list[Finding]]:
    file = table.source.name
    if latency is None or channels.latency is None:
        finding = Finding(
            "no_packet_counter", "warning", file, "_channels.tsv", "a LATENCY channel",
            "none; lost samples cannot be seen",
        )  # fmt: skip
        return np.arange(n_rows), None, [finding]
    position, unit = channels.latency
    stamped, findings = index_from_stamps(
        to_si(latency, unit, "time"), file=file, first_line=1, column=channels.names[position]
    )
    return stamped.index, stamped.rate_hz, findings


def _world_frame(path: Path, channels: _Channels, labels: list[str]) -> str:
    """Axes of the frame that the orientation refers to, as far as the files say."""
    name = next((channels.frames[label] for label in labels if label in channels.frames), "n/a")
    if name in ("", "n/a"):
        return "unknown"
    if not path.is_file():
        return name
    levels = _json(path).get("reference_frame", {}).get("Levels", {})
    axes = levels.get(name, {}) if isinstance(levels, dict) else {}
    axes = axes.get("SpatialAxes", "") if isinstance(axes, dict) else ""
    return f"{name} ({axes})" if axes else name


def _left_out(channels: _Channels, source: SourceText) -> list[Finding]:
    if not channels.left_out:
        return []
    return [
        Finding(
            "channels_left_out",
            "info",
            companion(source.path, "_channels.tsv").name,
            "type",
            "ACCEL, GYRO, MAGN, ORNT as quaternion, LATENCY",
            ", ".join(channels.left_out),
        )
    ]
