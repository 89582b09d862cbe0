"""A binary recording file: recognised by its first bytes, hashed, never read as text."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import ClassVar

from swaystride.checksums import file_sha256
from swaystride.errors import RecordingError

HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_C3D_KEY = 0x50
_COMPRESSION = {b"\xfd7zXZ\x00": "xz", b"\x1f\x8b": "gzip", b"BZh": "bzip2"}


@dataclass(frozen=True)
class SourceBinary:
    """A binary file on the disk; its library reads it from there.

    Parameters
    ----------
    path : Path
        As given.
    kind : {"HDF5", "C3D"}
        What its first bytes say.
    size : int
        Number of bytes.
    """

    path: Path
    kind: str
    size: int
    row_name: ClassVar[str] = "row"

    @property
    def name(self) -> str:
        """Name of the file without its folder, as errors and findings show it."""
        return self.path.name

    @cached_property
    def sha256(self) -> str:
        """Hash of the file."""
        return file_sha256(self.path)

    def has_unfinished_last_line(self) -> bool:
        """Tell that a binary file has no lines."""
        return False


def binary_kind(head: bytes) -> str | None:
    r"""Kind of a binary file from its first bytes.

    Parameters
    ----------
    head : bytes
        At least the first eight bytes of the file.

    Returns
    -------
    str or None
        ``HDF5``, ``C3D``, or None for anything else.

    Examples
    --------
    >>> binary_kind(b"\x89HDF\r\n\x1a\n"), binary_kind(b"\x02\x50\x2d\x00"), binary_kind(b"Time,a,b")
    ('HDF5', 'C3D', None)
    """
    if head.startswith(HDF5_SIGNATURE):
        return "HDF5"
    # Block of the parameters, then the key; no text begins with a control character.
    if len(head) > 1 and head[1] == _C3D_KEY and 0 < head[0] < ord("\t"):
        return "C3D"
    return None


def open_binary(path: Path | str) -> SourceBinary | None:
    """Open a file if it is of a known binary kind.

    Parameters
    ----------
    path : path or str

    Returns
    -------
    SourceBinary or None
        None if the file is not binary, or cannot be opened.
    """
    path = Path(path)
    try:
        with path.open("rb") as file:
            kind = binary_kind(file.read(len(HDF5_SIGNATURE)))
        return None if kind is None else SourceBinary(path, kind, path.stat().st_size)
    except OSError:
        return None


def require_binary(path: Path | str, kind: str, *, expected: str) -> SourceBinary:
    """Open a file that must be of one kind.

    Parameters
    ----------
    path : path or str
    kind : {"HDF5", "C3D"}
    expected : str
        What the caller wants, for the error.

    Raises
    ------
    RecordingError
        If the file cannot be opened, is compressed, or is something else.
    """
    path = Path(path)
    try:
        with path.open("rb") as file:
            head = file.read(len(HDF5_SIGNATURE))
    except OSError as error:
        raise RecordingError(
            "the file cannot be opened", file=path, expected="a readable file", found=str(error)
        ) from error
    if binary_kind(head) == kind:
        return SourceBinary(path, kind, path.stat().st_size)
    compression = next((name for magic, name in _COMPRESSION.items() if head.startswith(magic)), "")
    found = f"a file compressed with {compression}" if compression else f"first bytes {head!r}"
    raise RecordingError(
        f"this is no {kind} file" if head else "empty file",
        file=path.name,
        expected=f"{expected}, not compressed",
        found=found if head else "0 bytes",
    )


def refuse_compressed(data: bytes, *, file: str) -> None:
    """Refuse a binary format inside a compressed file, and say what to do.

    Parameters
    ----------
    data : bytes
        Decompressed content.
    file : str
        Name of the file.

    Raises
    ------
    RecordingError
        If the content is HDF5 or C3D.
    """
    kind = binary_kind(data[: len(HDF5_SIGNATURE)])
    if kind is not None:
        raise RecordingError(
            f"a compressed {kind} file is not read",
            file=file,
            expected="the file as the vendor wrote it; decompress it first",
            found=f"{kind} inside a compressed file",
        )
