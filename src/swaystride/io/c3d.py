"""C3D: markers of motion capture and the analog channels beside them.

Positions are converted from ``POINT:UNITS`` to m. A marker that was not seen (residual below zero, or
NaN) is NaN. Points that are no positions (angles, forces, … by the lists of the group ``POINT``) are
left out with a finding. Sizes in the header are checked against the file before it is read.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.findings import Finding
from swaystride.io.c3d_header import MIPS, C3dHeader, decode_floats, read_header
from swaystride.io.hints import ReadHints, rates_agree
from swaystride.io.sampling_rate import resolve_rate
from swaystride.io.source_binary import SourceBinary, require_binary
from swaystride.marker_recording import MarkerRecording, make_marker_recording, marker_positions
from swaystride.units import FACTORS_TO_SI, to_si

Array = NDArray[np.float64]

_NO_POSITIONS = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS", "REACTIONS")
_MOST_NAMED = 5
_HALF = 2**15


def read_c3d(
    path: Path | str,
    *,
    markers: Sequence[str] | None = None,
    unit: str | None = None,
    rate_hz: float | None = None,
) -> MarkerRecording:
    """Read markers and analog channels of a C3D file.

    Parameters
    ----------
    path : path or str
    markers : sequence of str, optional
        Markers to keep, in the order wanted; all by default.
    unit : {"m", "cm", "mm"}, optional
        Unit of the positions, for files that do not state it.
    rate_hz : float, optional
        Rate of the frames, for files that do not state it.

    Returns
    -------
    MarkerRecording
        See :mod:`swaystride.marker_recording`.

    Raises
    ------
    RecordingError
        One line, if the file is damaged or does not hold what its header declares, unit or rate
        are missing or contradicted by an argument, or a marker is absent.

    Examples
    --------
    >>> import tempfile
    >>> from swaystride.io.c3d_writer import write_c3d
    >>> path = Path(tempfile.mkdtemp(), "run.c3d")
    >>> heel = make_marker_recording(np.full((1, 3, 4), 0.25), markers=["L.Heel"], rate_hz=200.0,
    ...                              rate_source="argument")
    >>> write_c3d(path, heel, unit="mm")
    >>> found = read_c3d(path)
    >>> found["position"].values[0, :, 0], found.attrs["file_unit"], found.attrs["rate_hz"]
    (array([0.25, 0.25, 0.25]), 'mm', 200.0)
    """
    source = require_binary(path, "C3D", expected="a C3D file")
    header = read_header(source)
    points, unseen, analog = _read_frames(header, source)
    labels = header.texts("POINT:LABELS")
    if len(labels) < len(points):
        raise RecordingError(
            "markers without a name",
            file=source.name,
            place="POINT:LABELS",
            expected=f"{len(points)} labels",
            found=f"{len(labels)} labels",
        )
    stated = _unit(header.texts("POINT:UNITS"), unit, source)
    position = to_si(points, stated, "length")
    position.transpose(0, 2, 1)[unseen] = np.nan
    names, position, findings = _positions_only(header, labels, position, source)
    rate = resolve_rate(
        ReadHints(rate_hz=rate_hz),
        file=source.name,
        header_hz=_rate(header, "POINT:RATE"),
        header_place="POINT:RATE",
        measured_hz=header.rate_hz if np.isfinite(header.rate_hz) and header.rate_hz > 0 else None,
    )
    recording = make_marker_recording(
        position,
        markers=names,
        rate_hz=rate.rate_hz,
        rate_source=rate.source,
        file_unit=stated,
        subject=", ".join(filter(None, header.texts("SUBJECTS:NAMES"))),
        first_frame=header.first_frame,
        device=" ".join(
            header.texts("MANUFACTURER:COMPANY") + header.texts("MANUFACTURER:SOFTWARE")
        )
        or "unknown",
        source_file=source.name,
        source_sha256=source.sha256,
        findings=[*rate.findings, *findings, *_gaps(names, position, source)],
        **(_analog(header, analog, rate.rate_hz, source) if analog.size else {}),
    )
    if markers is None:
        return recording
    marker_positions(recording, markers)
    return recording.sel(marker=list(markers))


def _read_frames(header: C3dHeader, source: SourceBinary) -> tuple[Array, NDArray[np.bool_], Array]:
    """Positions (marker, axis, frame), where a marker was not seen, analog (channel, sample)."""
    if header.n_frames == 0 or header.frame_bytes == 0:
        raise RecordingError(
            "no frames", file=source.name, expected="one frame at least", found="none"
        )
    shape = (header.n_frames, header.frame_bytes)
    raw = np.memmap(source.path, np.uint8, "r", header.data_offset, shape)
    split = 4 * header.n_points * header.bytes_per_value
    points = _decode(raw[:, :split], header, signed=True)
    points = points.reshape(len(raw), header.n_points, 4).transpose(1, 2, 0)
    position, unseen = points[:, :3], points[:, 3] < 0
    if header.scale >= 0:
        position = position * header.scale
    n_channels = header.n_analog // max(header.samples_per_frame, 1)
    if n_channels == 0:
        return position, unseen, np.empty((0, 0))
    signed = header.texts("ANALOG:FORMAT") != ["UNSIGNED"]
    values = _decode(raw[:, split:], header, signed=signed).reshape(-1, n_channels).T
    scales = {"SCALE": np.ones(n_channels), "OFFSET": np.zeros(n_channels), "GEN_SCALE": np.ones(1)}
    for name in scales:
        stated = header.numbers(f"ANALOG:{name}")
        if name == "OFFSET" and signed:
            stated = np.where(stated >= _HALF, stated - 2 * _HALF, stated)
        if stated.size:
            scales[name] = stated[: scales[name].size]
    if any(scales[name].size < n_channels for name in ("SCALE", "OFFSET")):
        raise RecordingError(
            "analog channels without a scale",
            file=source.name,
            place="ANALOG",
            expected=f"SCALE and OFFSET of {n_channels} channels",
            found=f"{scales['SCALE'].size} and {scales['OFFSET'].size}",
        )
    factor = scales["SCALE"] * scales["GEN_SCALE"][0]
    return position, unseen, (values - scales["OFFSET"][:, None]) * factor[:, None]


def _decode(raw: NDArray[np.uint8], header: C3dHeader, *, signed: bool) -> Array:
    if header.scale < 0:
        return decode_floats(raw, header.processor)
    order = ">" if header.processor == MIPS else "<"
    kind = f"{order}{'i' if signed else 'u'}2"
    return np.ascontiguousarray(raw).view(kind).astype(np.float64)


def _rate(header: C3dHeader, name: str) -> float | None:
    value = header.numbers(name)
    return float(value[0]) if value.size and np.isfinite(value[0]) and value[0] > 0 else None


def _unit(stated: list[str], argued: str | None, source: SourceBinary) -> str:
    """Unit of the positions: the file's, or the argument; they must not contradict each other."""
    known = FACTORS_TO_SI["length"]
    if argued is not None and argued not in known:
        raise RecordingError(
            "unknown unit", place="argument unit", expected=", ".join(known), found=repr(argued)
        )
    file_unit = next(filter(None, stated), None)
    if file_unit is None:
        if argued is None:
            raise RecordingError(
                "the file does not state its units",
                file=source.name,
                place="POINT:UNITS",
                expected=f"one of {', '.join(known)}, or the argument unit",
                found="neither",
            )
        return argued
    if file_unit not in known or (argued is not None and argued != file_unit):
        problem = "the argument unit contradicts the file" if file_unit in known else "unknown unit"
        raise RecordingError(
            problem,
            file=source.name,
            place="POINT:UNITS",
            expected=file_unit if file_unit in known else ", ".join(known),
            found=repr(argued) if file_unit in known else repr(file_unit),
        )
    return file_unit


def _positions_only(
    header: C3dHeader, labels: list[str], position: Array, source: SourceBinary
) -> tuple[list[str], Array, list[Finding]]:
    """Markers without the points that the file lists as angles, forces, …; names must differ."""
    others = {label for kind in _NO_POSITIONS for label in header.texts(f"POINT:{kind}")}
    names = labels[: len(position)]
    kept = [i for i, name in enumerate(names) if name not in others]
    chosen = [names[i] for i in kept]
    repeated = sorted({name for name in chosen if chosen.count(name) > 1})
    if repeated or not chosen:
        raise RecordingError(
            "two markers of one name" if repeated else "no marker",
            file=source.name,
            place="POINT:LABELS",
            expected="every name once" if repeated else "one marker at least",
            found=", ".join(repeated) or f"{len(names)} points",
        )
    if len(kept) == len(names):
        return chosen, position, []
    left_out = ", ".join(name for name in names if name in others)
    finding = Finding(
        "points_left_out", "info", source.name, "POINT:LABELS", "positions of markers", left_out
    )
    return chosen, position[kept], [finding]


def _gaps(names: list[str], position: Array, source: SourceBinary) -> list[Finding]:
    """Markers that were not seen all the time, and positions that are exactly zero."""
    missing = np.isnan(position).any(axis=1).mean(axis=1)
    origin = (position == 0).all(axis=1).mean(axis=1)
    findings = []
    for check, share, expected in (
        ("marker_gap", missing, "every marker in every frame"),
        ("marker_at_origin", origin, "a lost marker marked as lost, not at 0, 0, 0"),
    ):
        order = [int(i) for i in np.argsort(-share, kind="stable") if share[i] > 0]
        if order:
            worst = ", ".join(f"{names[i]} {share[i]:.1%}" for i in order[:_MOST_NAMED])
            found = f"{len(order)} of {len(names)} markers, the worst: {worst} of the frames"
            findings.append(Finding(check, "warning", source.name, "points", expected, found))
    return findings


def _analog(
    header: C3dHeader, analog: Array, rate_hz: float, source: SourceBinary
) -> dict[str, Any]:
    """Arguments for the analog channels; their rate must be a whole multiple of the frames'."""
    n_channels = len(analog)
    labels = header.texts("ANALOG:LABELS")[:n_channels]
    units = header.texts("ANALOG:UNITS")[:n_channels]
    rate = rate_hz * header.samples_per_frame
    stated = _rate(header, "ANALOG:RATE") or rate
    if len(labels) < n_channels or not rates_agree(stated, rate):
        raise RecordingError(
            "analog channels and their description disagree",
            file=source.name,
            place="ANALOG",
            expected=f"{n_channels} labels, {rate:g} Hz",
            found=f"{len(labels)} labels, {stated:g} Hz",
        )
    return {
        "analog": analog,
        "analog_rate_hz": rate,
        "channels": labels,
        "analog_units": units + [""] * (n_channels - len(units)),
    }
