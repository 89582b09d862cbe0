"""Read a recording of any known format; the format is found by content, never by extension."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from swaystride.errors import RecordingError
from swaystride.io.acquisition_txt import is_acquisition_txt, read_acquisition_txt
from swaystride.io.apdm_csv import is_apdm_csv, read_apdm_csv
from swaystride.io.hints import DuplicatePackets, ReadHints
from swaystride.io.motion_bids import is_motion_bids, read_motion_bids
from swaystride.io.opal_hdf5 import is_opal_hdf5, read_opal_hdf5
from swaystride.io.polar_ecg import is_polar_acc, read_polar_acc
from swaystride.io.sidecar_csv import is_sidecar_csv, read_sidecar_csv
from swaystride.io.source_binary import SourceBinary, open_binary, refuse_compressed
from swaystride.io.source_text import SourceText, open_source
from swaystride.io.xsens_txt import is_xsens_txt, read_xsens_txt
from swaystride.recording import Recording


class Format(NamedTuple):
    """One format: what it is called, how it is recognised, how it is read."""

    name: str
    recognises: Callable[[SourceText], bool]
    read: Callable[[SourceText, ReadHints], Recording]


class BinaryFormat(NamedTuple):
    """The same for a file that is no text."""

    name: str
    recognises: Callable[[SourceBinary], bool]
    read: Callable[[SourceBinary, ReadHints], Recording]


#: Recognised by their first bytes, before a file is read as text.
BINARY_FORMATS = (BinaryFormat("APDM Opal HDF5", is_opal_hdf5, read_opal_hdf5),)

#: In the order in which they are tried; a sidecar is an explicit statement and comes first.
FORMATS = (
    Format("CSV with a JSON sidecar", is_sidecar_csv, read_sidecar_csv),
    Format("Motion-BIDS", is_motion_bids, read_motion_bids),
    Format("APDM CSV", is_apdm_csv, read_apdm_csv),
    Format("Polar Sensor Logger ACC", is_polar_acc, read_polar_acc),
    Format("text with an acquisition frequency", is_acquisition_txt, read_acquisition_txt),
    Format("Xsens MT Manager TXT", is_xsens_txt, read_xsens_txt),
)


def read_recording(
    path: Path | str,
    *,
    rate_hz: float | None = None,
    units: Mapping[str, str] | None = None,
    sensor: str | Sequence[str] | None = None,
    duplicate_packets: DuplicatePackets = "error",
) -> Recording:
    r"""Read a recording; files compressed with xz, gzip or bzip2 are read as they are.

    Nothing is guessed: what the file does not say must be given, and what is given must not
    contradict the file. A lost packet is a row of NaN, so the time axis stays uniform. What the
    checks saw travels with the recording (:func:`swaystride.recording.findings_of`).

    Parameters
    ----------
    path : path or str
    rate_hz : float, optional
        Sampling rate, for files that state none and have no time stamps.
    units : mapping of str to str, optional
        Unit of ``acc``, ``gyr`` and ``mag``, for files that do not state them.
    sensor : str or sequence of str, optional
        Label for the sensor of a file with one; sensors to keep of a file with several.
    duplicate_packets : {"error", "keep_first"}
        A packet counter that occurs twice is an error, unless the caller decides to keep the first
        of the two rows, which leaves a warning in the findings.

    Returns
    -------
    Recording
        ``acc`` in m/s², ``gyr`` in rad/s, and, where the file has them, ``mag`` and ``quat``.

    Raises
    ------
    RecordingError
        One line with file, place, expected and found, if the format is unknown, the file is damaged
        or contradicts itself or the arguments, an argument is missing, or a check finds an error.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp(), "P01_01.txt")
    >>> _ = path.write_text("// Update Rate: 100.0Hz\nPacketCounter,Acc_X,Acc_Y,Acc_Z\n"
    ...                     "07,0.1,0.2,9.8\n10,0.1,0.2,9.8\n")
    >>> recording = read_recording(path, sensor="lumbar")
    >>> recording["acc"].sel(sensor="lumbar", axis="z").values
    array([9.8, nan, nan, 9.8])
    """
    hints = ReadHints(
        rate_hz=rate_hz,
        units=dict(units or {}),
        sensors=(sensor,) if isinstance(sensor, str) else tuple(sensor or ()),
        duplicate_packets=duplicate_packets,
    )
    binary = open_binary(path)
    if binary is not None:
        return _read_binary(binary, hints)
    source = open_source(path)
    refuse_compressed(source.data, file=source.name)
    for candidate in FORMATS:
        if candidate.recognises(source):
            return candidate.read(source, hints)
    raise RecordingError(
        "unknown format",
        file=source.name,
        place="first line",
        expected="one of " + ", ".join(known.name for known in (*FORMATS, *BINARY_FORMATS)),
        found=repr(source.first_text()[:80]),
    )


def _read_binary(source: SourceBinary, hints: ReadHints) -> Recording:
    for candidate in BINARY_FORMATS:
        if candidate.recognises(source):
            return candidate.read(source, hints)
    raise RecordingError(
        "the file holds no inertial sensors",
        file=source.name,
        expected="one of " + ", ".join(candidate.name for candidate in BINARY_FORMATS),
        found="C3D, whose markers swaystride.io.c3d.read_c3d reads",
    )
