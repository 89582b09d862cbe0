"""The text of a recording file: decompressed by content, hashed, with numbered lines."""

from __future__ import annotations

import bz2
import gzip
import hashlib
import lzma
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, NamedTuple

from swaystride.errors import RecordingError

_DECOMPRESSORS: dict[bytes, tuple[str, Callable[[bytes], bytes]]] = {
    b"\xfd7zXZ\x00": ("xz", lzma.decompress),
    b"\x1f\x8b": ("gzip", gzip.decompress),
    b"BZh": ("bzip2", bz2.decompress),
}
_UTF8_MARK = b"\xef\xbb\xbf"
_UTF16_MARKS = (b"\xff\xfe", b"\xfe\xff")


class Line(NamedTuple):
    """One line: its 1-based number, its text, and the byte offset at which the next one starts."""

    number: int
    text: str
    end: int


@dataclass(frozen=True)
class SourceText:
    """A text file in memory.

    Parameters
    ----------
    path : Path
        As given.
    data : bytes
        Decompressed content, UTF-8 or a single-byte encoding, without byte order mark.
    sha256 : str
        Hash of the file as it lies on the disk (compressed, if it is).
    """

    path: Path
    data: bytes
    sha256: str
    row_name: ClassVar[str] = "line"

    @property
    def name(self) -> str:
        """Name of the file without its folder, as errors and findings show it."""
        return self.path.name

    def lines(self) -> Iterator[Line]:
        """Walk over the lines from the start; meant for headers."""
        start, number = 0, 0
        while start < len(self.data):
            stop = self.data.find(b"\n", start)
            end = len(self.data) if stop < 0 else stop + 1
            number += 1
            yield Line(number, decode(self.data[start:end]).rstrip("\r\n"), end)
            start = end

    def first_text(self) -> str:
        """Return the first line that is not blank."""
        return next((line.text for line in self.lines() if line.text.strip()), "")

    def has_unfinished_last_line(self) -> bool:
        """Tell whether the last line lacks its line end."""
        return not self.data.endswith((b"\n", b"\r"))


def decode(raw: bytes) -> str:
    """Decode a piece of a file: UTF-8, or else Windows-1252 (degree signs of older exports).

    Parameters
    ----------
    raw : bytes
        Content of a file.
    """
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError:
        return raw.decode("cp1252", errors="replace")


def open_source(path: Path | str) -> SourceText:
    r"""Read a file whole; xz, gzip and bzip2 are recognised by their first bytes.

    Raises
    ------
    RecordingError
        If the file does not exist, is empty, or its compression is damaged.

    Examples
    --------
    >>> import gzip, pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp(), "walk.txt")
    >>> _ = path.write_bytes(gzip.compress(b"first\nsecond\n"))
    >>> [line.text for line in open_source(path).lines()]
    ['first', 'second']
    """
    path = Path(path)
    try:
        raw = path.read_bytes()
    except OSError as error:
        raise RecordingError(
            "the file cannot be opened", file=path, expected="a readable file", found=str(error)
        ) from error
    data = _decompress(raw, path)
    if data.startswith(_UTF8_MARK):
        data = data[len(_UTF8_MARK) :]
    elif data.startswith(_UTF16_MARKS):
        data = data.decode("utf-16", errors="replace").encode("utf-8")
    if not data.strip():
        raise RecordingError(
            "empty file",
            file=path.name,
            expected="a header and rows of data",
            found=f"{len(data)} bytes",
        )
    return SourceText(path=path, data=data, sha256=hashlib.sha256(raw).hexdigest())


def _decompress(raw: bytes, path: Path) -> bytes:
    for magic, (name, decompress) in _DECOMPRESSORS.items():
        if raw.startswith(magic):
            try:
                return decompress(raw)
            except (lzma.LZMAError, zlib.error, EOFError, OSError, ValueError) as error:
                raise RecordingError(
                    "the compressed file is damaged or truncated",
                    file=path.name,
                    expected=f"a whole {name} stream",
                    found=str(error),
                ) from error
    return raw
