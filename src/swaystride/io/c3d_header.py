"""Header and parameters of a C3D file; what they claim is checked against the size of the file.

Written anew rather than taken from ``ezc3d``, which trusts the header: one changed byte can make it
ask for gigabytes or end the process.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping
from dataclasses import dataclass
from math import prod

import numpy as np
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.io.source_binary import SourceBinary

Array = NDArray[np.float64]

BLOCK = 512
#: Largest frame number of the header; longer trials say how long they are in TRIAL.
LARGEST_FRAME = 65535
#: Byte offsets of the numbers of the first and the last frame in the header.
FIRST_FRAME_OFFSET, LAST_FRAME_OFFSET = 6, 8
INTEL, DEC, MIPS = 84, 85, 86
TEXT, BYTE, INTEGER, FLOAT = -1, 1, 2, 4


@dataclass(frozen=True)
class Parameter:
    """One parameter of the header.

    Parameters
    ----------
    type : int
        -1 text, 1 byte, 2 integer, 4 float.
    dimensions : tuple of int
    offset : int
        Byte offset of its values in the file.
    raw : bytes
        Its values.
    processor : int
        84 Intel, 85 DEC, 86 MIPS: how numbers are stored.
    """

    type: int
    dimensions: tuple[int, ...]
    offset: int
    raw: bytes
    processor: int

    def texts(self) -> list[str]:
        """Texts without padding; none if it is a number."""
        if self.type != TEXT or not self.raw:
            return []
        width = self.dimensions[0] if self.dimensions else 1
        pieces = [self.raw[i : i + width] for i in range(0, len(self.raw), max(width, 1))]
        return [piece.decode("latin-1").split("\x00")[0].strip() for piece in pieces]

    def numbers(self) -> Array:
        """Numbers in the order of the file, integers without sign; none if it is text."""
        if self.type == TEXT:
            return np.empty(0)
        if self.type == FLOAT:
            return decode_floats(np.frombuffer(self.raw, np.uint8), self.processor)
        order = ">" if self.processor == MIPS else "<"
        return np.frombuffer(self.raw, f"{order}u{self.type}").astype(np.float64)


def decode_floats(raw: NDArray[np.uint8], processor: int) -> Array:
    """Single-precision numbers of the three processors.

    Parameters
    ----------
    raw : ndarray of uint8, shape (..., 4 * n)
    processor : int
        84 Intel, 85 DEC, 86 MIPS.

    Examples
    --------
    >>> decode_floats(np.array([0, 64, 0, 0], np.uint8), DEC), decode_floats(
    ...     np.array([63, 128, 0, 0], np.uint8), MIPS)
    (array([0.5]), array([1.]))
    """
    # A NaN of any kind is one.
    with np.errstate(invalid="ignore"):
        if processor == DEC:
            # Words in the other order, and an exponent that counts from two places further.
            words = np.ascontiguousarray(raw).view("<u2")
            pairs = words.reshape(*words.shape[:-1], -1, 2)[..., ::-1]
            swapped = np.ascontiguousarray(pairs.reshape(words.shape))
            return swapped.view("<f4").astype(np.float64) / 4
        kind = ">f4" if processor == MIPS else "<f4"
        return np.ascontiguousarray(raw).view(kind).astype(np.float64)


@dataclass(frozen=True)
class C3dHeader:
    """What a header claims.

    Parameters
    ----------
    n_points, n_analog, n_frames : int
        Points, analog values per frame of points, frames.
    samples_per_frame : int
        Samples of each analog channel per frame.
    first_frame : int
        Number of the first frame, from zero.
    scale : float
        Below zero: the frames are floats. Otherwise integers of this size.
    data_offset : int
        Byte offset of the first frame.
    rate_hz : float
    processor : int
        84 Intel, 85 DEC, 86 MIPS.
    parameters : mapping of str to Parameter
        By ``GROUP:NAME``, in capitals.
    """

    n_points: int
    n_analog: int
    n_frames: int
    samples_per_frame: int
    first_frame: int
    scale: float
    data_offset: int
    rate_hz: float
    processor: int
    parameters: Mapping[str, Parameter]

    @property
    def bytes_per_value(self) -> int:
        """4 for floats, 2 for integers."""
        return 4 if self.scale < 0 else 2

    @property
    def frame_bytes(self) -> int:
        """Bytes of one frame: three coordinates and a residual per point, and the analog values."""
        return (4 * self.n_points + self.n_analog) * self.bytes_per_value

    def texts(self, name: str) -> list[str]:
        """Texts of ``GROUP:NAME``, continued in those with a number behind the name."""
        texts: list[str] = []
        for number in ("", *map(str, range(2, 10))):
            if name + number not in self.parameters:
                break
            texts += self.parameters[name + number].texts()
        return texts

    def numbers(self, name: str) -> Array:
        """Numbers of ``GROUP:NAME``; none if there is no such parameter."""
        parameter = self.parameters.get(name)
        return np.empty(0) if parameter is None else parameter.numbers()


def read_header(source: SourceBinary) -> C3dHeader:
    """Read header and parameters, and refuse what the file cannot hold.

    Parameters
    ----------
    source : SourceBinary

    Returns
    -------
    C3dHeader

    Raises
    ------
    RecordingError
        If the parameters run out of their section, or the file is smaller than header and
        parameters claim.
    """
    with source.path.open("rb") as file:
        head = file.read(BLOCK)
        file.seek((head[0] - 1) * BLOCK)
        start = file.tell()
        section = file.read(4)
        if len(head) < BLOCK or len(section) < 4:
            raise _damaged(source, "header", f"{source.size} bytes")
        # Its number of blocks is 0 in some files; 255 is the most it can be.
        section += file.read((section[2] or 255) * BLOCK - 4)
    processor = section[3]
    if processor not in (INTEL, DEC, MIPS):
        raise _damaged(source, "processor", str(processor))
    parameters = _parameters(section, start, processor, source)
    order = ">" if processor == MIPS else "<"
    n_points, n_analog, first, last = struct.unpack_from(order + "4H", head, 2)
    data_block, ratio = struct.unpack_from(order + "2H", head, 16)
    header = C3dHeader(
        n_points=n_points,
        n_analog=n_analog,
        n_frames=_n_frames(parameters, first, last),
        samples_per_frame=ratio,
        first_frame=_first_frame(parameters, first),
        scale=float(decode_floats(np.frombuffer(head[12:16], np.uint8), processor)[0]),
        data_offset=(data_block - 1) * BLOCK,
        rate_hz=float(decode_floats(np.frombuffer(head[20:24], np.uint8), processor)[0]),
        processor=processor,
        parameters=parameters,
    )
    _require_agreement(header, source)
    claimed = header.frame_bytes * header.n_frames
    if header.data_offset <= 0 or claimed > source.size - header.data_offset:
        raise RecordingError(
            "the file does not hold what it declares",
            file=source.name,
            place="header",
            expected=f"{claimed} bytes ({header.n_frames} frames of {header.frame_bytes})",
            found=f"{max(source.size - max(header.data_offset, 0), 0)} bytes",
        )
    return header


def _require_agreement(header: C3dHeader, source: SourceBinary) -> None:
    """Header and parameters must name the same numbers of points and channels."""
    ratio = header.samples_per_frame
    for name, count in (("POINT:USED", header.n_points), ("ANALOG:USED", header.n_analog)):
        used = header.numbers(name)
        per_frame = 1 if name.startswith("POINT") else ratio
        if used.size and int(used[0]) * max(per_frame, 1) != count:
            raise RecordingError(
                "header and parameters contradict each other",
                file=source.name,
                place=name,
                expected=f"{count / max(per_frame, 1):g}, as in the header",
                found=f"{used[0]:g}",
            )


def _two_words(parameters: Mapping[str, Parameter], name: str) -> int | None:
    """A number that TRIAL stores in two words."""
    words = parameters[name].numbers() if name in parameters else np.empty(0)
    if words.size != 2 or not np.isfinite(words).all():
        return None
    return int(words[0]) + int(words[1]) * (LARGEST_FRAME + 1)


def _first_frame(parameters: Mapping[str, Parameter], first: int) -> int:
    stated = _two_words(parameters, "TRIAL:ACTUAL_START_FIELD")
    return max((first if stated is None or first < LARGEST_FRAME else stated) - 1, 0)


def _n_frames(parameters: Mapping[str, Parameter], first: int, last: int) -> int:
    """Frames by the header, or where its number is at its end, by TRIAL."""
    ends = [_two_words(parameters, f"TRIAL:ACTUAL_{end}_FIELD") for end in ("START", "END")]
    if last == LARGEST_FRAME and ends[0] is not None and ends[1] is not None:
        return max(ends[1] - ends[0] + 1, 0)
    return max(last - first + 1, 0)


def _parameters(
    section: bytes, start: int, processor: int, source: SourceBinary
) -> dict[str, Parameter]:
    """Walk over the chain of groups and parameters; every one must end before the next begins."""
    groups: dict[int, str] = {}
    found: list[tuple[int, str, Parameter]] = []
    place, order = 4, ">" if processor == MIPS else "<"
    while place + 2 <= len(section):
        length, group = struct.unpack_from("2b", section, place)
        name_end = place + 2 + abs(length)
        if length == 0 or name_end + 2 > len(section):
            break
        name = section[place + 2 : name_end].decode("latin-1").strip().upper()
        step = struct.unpack_from(order + "H", section, name_end)[0]
        following = name_end + step if step else len(section)
        if following > len(section) or 0 < step < 3:
            raise _damaged(source, f"parameter {name}", "it ends outside of its section")
        if group < 0:
            groups[-group] = name
        else:
            parameter = _parameter(section, name_end + 2, following, start, processor)
            if parameter is None:
                raise _damaged(source, f"parameter {name}", "sizes beyond the file")
            found.append((group, name, parameter))
        if not step:
            break
        place = following
    return {f"{groups.get(group, group)}:{name}": item for group, name, item in found}


def _parameter(
    section: bytes, place: int, stop: int, start: int, processor: int
) -> Parameter | None:
    """One parameter; None if its declared size does not fit before `stop`."""
    if place + 2 > stop:
        return None
    kind, n_dimensions = struct.unpack_from("bB", section, place)
    values = place + 2 + n_dimensions
    if kind not in (TEXT, BYTE, INTEGER, FLOAT) or values > stop:
        return None
    dimensions = tuple(section[place + 2 : values])
    end = values + prod(dimensions) * abs(kind)
    if end > stop:
        return None
    return Parameter(kind, dimensions, start + values, section[values:end], processor)


def _damaged(source: SourceBinary, place: str, found: str) -> RecordingError:
    return RecordingError(
        "the header of the C3D file is damaged",
        file=source.name,
        place=place,
        expected="header and parameters within the file",
        found=found,
    )
