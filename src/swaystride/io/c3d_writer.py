"""Write C3D: header and parameters by ``ezc3d``, frames by NumPy in pieces.

``ezc3d`` alone would hold every frame of a long trial as an object and cut it at 65535 frames; a
longer trial says its length in ``TRIAL:ACTUAL_END_FIELD``, where readers look for it.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.io.c3d_header import (
    FIRST_FRAME_OFFSET,
    INTEGER,
    LARGEST_FRAME,
    LAST_FRAME_OFFSET,
    C3dHeader,
    read_header,
)
from swaystride.io.hints import rates_agree
from swaystride.io.source_binary import require_binary
from swaystride.marker_recording import MarkerRecording
from swaystride.units import FACTORS_TO_SI

#: Number of labels that one parameter holds.
MOST_POINTS = 255
_LONGEST_NAME = 127
_FRAMES_AT_ONCE = 8192
_LOST = -1.0


def write_c3d(
    path: Path | str, recording: MarkerRecording, *, unit: str, description: str = ""
) -> None:
    """Write markers and analog channels; a lost marker has residual -1.

    Positions are single-precision floats in `unit`: at 10 m from the origin, steps of 1 µm.

    Parameters
    ----------
    path : path or str
        File to write; replaced if it exists.
    recording : MarkerRecording
        See :mod:`swaystride.marker_recording`.
    unit : {"m", "cm", "mm"}
        Unit of the positions in the file.
    description : str
        Stored in ``TRIAL:DESCRIPTION``, for example that the trial is simulated.

    Raises
    ------
    RecordingError
        If a name or unit does not fit the format, there are too many points, or the analog channels
        do not have a whole number of samples per frame.
    """
    path = Path(path)
    if unit not in FACTORS_TO_SI["length"]:
        raise RecordingError(
            "unknown unit",
            place="argument unit",
            expected=", ".join(FACTORS_TO_SI["length"]),
            found=repr(unit),
        )
    markers = [str(name) for name in recording["marker"].values]
    channels = [str(name) for name in recording["channel"].values] if "channel" in recording else []
    units = [str(u) for u in recording["analog_unit"].values] if channels else []
    _require_names(path, [*markers, *channels], [*units, recording.attrs["subject"], description])
    if max(len(markers), len(channels)) > MOST_POINTS or not markers:
        raise RecordingError(
            "the number of markers or channels does not fit the format",
            file=path.name,
            expected=f"1 to {MOST_POINTS} markers, 0 to {MOST_POINTS} channels",
            found=f"{len(markers)} markers, {len(channels)} channels",
        )
    ratio = _samples_per_frame(path, recording) if channels else 0
    with tempfile.TemporaryDirectory() as folder:
        head = _head(Path(folder, "head.c3d"), recording, unit, description, ratio)
    with path.open("wb") as file:
        file.write(head)
        _write_frames(file, recording, unit, ratio)


def _require_names(path: Path, names: list[str], texts: list[str]) -> None:
    for name in (*names, *filter(None, texts)):
        if not (
            0 < len(name) <= _LONGEST_NAME
            and name.isascii()
            and name.isprintable()
            and name == name.strip()
        ):
            raise RecordingError(
                "a name does not fit the format",
                file=path.name,
                expected=f"1 to {_LONGEST_NAME} ASCII characters without outer spaces",
                found=repr(name),
            )


def _samples_per_frame(path: Path, recording: MarkerRecording) -> int:
    rates = recording.attrs["analog_rate_hz"], recording.attrs["rate_hz"]
    ratio: int = round(rates[0] / rates[1])
    n_frames, n_analog = recording.sizes["time"], recording.sizes["analog_time"]
    if not rates_agree(rates[0], ratio * rates[1], 1e-9) or n_analog != ratio * n_frames:
        raise RecordingError(
            "analog samples per frame are not a whole number",
            file=path.name,
            expected=f"a multiple of {rates[1]:g} Hz and of {n_frames} frames",
            found=f"{rates[0]:g} Hz and {n_analog} samples",
        )
    return ratio


def _head(path: Path, recording: MarkerRecording, unit: str, description: str, ratio: int) -> bytes:
    """Header and parameters of the whole trial, from a file of one frame."""
    import ezc3d

    template: Any = ezc3d.c3d()
    points, analogs = template["parameters"]["POINT"], template["parameters"]["ANALOG"]
    n_markers, n_frames = recording.sizes["marker"], recording.sizes["time"]
    points["RATE"]["value"] = [recording.attrs["rate_hz"]]
    points["UNITS"]["value"] = [unit]
    points["LABELS"]["value"] = [str(name) for name in recording["marker"].values]
    template["data"]["points"] = np.ones((4, n_markers, 1))
    if ratio:
        n_channels = recording.sizes["channel"]
        analogs["RATE"]["value"] = [recording.attrs["analog_rate_hz"]]
        analogs["LABELS"]["value"] = [str(name) for name in recording["channel"].values]
        analogs["UNITS"]["value"] = [str(u) for u in recording["analog_unit"].values]
        template["data"]["analogs"] = np.zeros((1, n_channels, ratio))
    if recording.attrs["subject"]:
        template.add_parameter("SUBJECTS", "NAMES", [recording.attrs["subject"]])
        template.add_parameter("SUBJECTS", "USED", [1])
    first = recording.attrs["first_frame"] + 1
    for name in ("ACTUAL_START_FIELD", "ACTUAL_END_FIELD"):
        template.add_parameter("TRIAL", name, [1, 0])
        # Two words of an integer; ezc3d would make them floats, which readers do not look for.
        template["parameters"]["TRIAL"][name]["type"] = INTEGER
    if description:
        template.add_parameter("TRIAL", "DESCRIPTION", [description])
    template.write(str(path))
    header = read_header(require_binary(path, "C3D", expected="a C3D file"))
    return _with_frames(path.read_bytes()[: header.data_offset], header, first, n_frames)


def _with_frames(head: bytes, header: C3dHeader, first: int, n_frames: int) -> bytes:
    """Header and parameters, changed from one frame to many; beyond 65535, only TRIAL counts on."""
    last = first + n_frames - 1
    changed = bytearray(head)
    words = {
        FIRST_FRAME_OFFSET: first,
        LAST_FRAME_OFFSET: last,
        header.parameters["POINT:FRAMES"].offset: n_frames,
    }
    for offset, value in words.items():
        changed[offset : offset + 2] = min(value, LARGEST_FRAME).to_bytes(2, "little")
    for name, frame in (("START", first), ("END", last)):
        offset = header.parameters[f"TRIAL:ACTUAL_{name}_FIELD"].offset
        changed[offset : offset + 4] = frame.to_bytes(4, "little")
    return bytes(changed)


def _write_frames(file: Any, recording: MarkerRecording, unit: str, ratio: int) -> None:
    """Frames in pieces: x, y, z, residual of every marker, then the analog samples in turn."""
    position = recording["position"].values
    n_markers, _, n_frames = position.shape
    factor = FACTORS_TO_SI["length"][unit]
    analog = recording["analog"].values if ratio else np.empty((0, 0))
    width = 4 * n_markers + len(analog) * ratio
    for start in range(0, n_frames, _FRAMES_AT_ONCE):
        stop = min(start + _FRAMES_AT_ONCE, n_frames)
        frames: NDArray[np.float32] = np.zeros((stop - start, width), dtype="<f4")
        piece = position[:, :, start:stop].transpose(2, 0, 1) / factor
        lost = np.isnan(piece).any(axis=2)
        piece[lost] = 0.0
        points = frames[:, : 4 * n_markers].reshape(stop - start, n_markers, 4)
        points[:, :, :3] = piece
        points[:, :, 3] = np.where(lost, _LOST, 0.0)
        frames[:, : 4 * n_markers] = points.reshape(stop - start, -1)
        if ratio:
            samples = analog[:, start * ratio : stop * ratio]
            frames[:, 4 * n_markers :] = samples.T.reshape(stop - start, -1)
        file.write(frames.tobytes())
