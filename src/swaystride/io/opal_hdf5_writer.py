"""Write Opal HDF5 files of version 5, in pieces, as :mod:`swaystride.io.opal_hdf5` reads them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError
from swaystride.io.hints import QUANTITY_OF
from swaystride.io.opal_hdf5 import UNITS
from swaystride.recording import Recording
from swaystride.units import FACTORS_TO_SI

if TYPE_CHECKING:
    import h5py

VERSION = 5
#: Rows of a chunk of the file: one chunk of three float32 channels is 48 KiB.
CHUNK_ROWS = 4096
#: Cache of each data set: its current chunk, and not the 8 MiB that 52 data sets would each take.
CACHE_BYTES = 2**17
LABEL_BYTES = 32
_NAMES = {"acc": "Accelerometer", "gyr": "Gyroscope", "mag": "Magnetometer"}


@dataclass(frozen=True)
class OpalRun:
    """What a file says about a run, beside its samples.

    Parameters
    ----------
    ids, labels : tuple of str
        Id (such as ``XI-010284``) and label of each sensor.
    rate_hz : float
    start_unix_us : int
        First time stamp, µs since 1970 UTC.
    timezone_offset_h : float
        Local time minus UTC.
    mag, quat : bool
        Whether the magnetometer and the orientation are written.
    note : str
        Stored at the root, for example that the run is simulated; empty for none.
    """

    ids: tuple[str, ...]
    labels: tuple[str, ...]
    rate_hz: float
    start_unix_us: int
    timezone_offset_h: float = 0.0
    mag: bool = False
    quat: bool = False
    note: str = ""

    def __post_init__(self) -> None:
        texts = [*self.ids, *self.labels]
        bad = next((t for t in texts if not _fits(t)), None)
        if bad is None:
            bad = next((t for t in self.ids if "/" in t or t == "."), None)
        if bad is not None or not self.ids or len(set(self.ids)) != len(self.labels):
            raise RecordingError(
                "ids and labels of the sensors do not fit an Opal file",
                expected=f"one label per id, ids unique and without '/', 1 to {LABEL_BYTES} bytes "
                "without NUL or outer spaces",
                found=repr(bad) if bad is not None else f"{self.ids} and {self.labels}",
            )
        if not (np.isfinite(self.rate_hz) and self.rate_hz > 0):
            raise RecordingError(
                "the sampling rate is not a positive number",
                expected="rate_hz > 0",
                found=str(self.rate_hz),
            )


class OpalWriter:
    """Write one run in pieces; memory is bounded by one piece.

    Samples in which every signal of every sensor is NaN are left out between the first and the
    last, as lost packets; the time stamps show them.

    Parameters
    ----------
    path : path or str
        File to write; replaced if it exists.
    run : OpalRun

    Examples
    --------
    >>> import tempfile
    >>> from swaystride.io.reading import read_recording
    >>> path = Path(tempfile.mkdtemp(), "run.h5")
    >>> run = OpalRun(ids=("XI-1", "XI-2"), labels=("Lumbar", "Left Foot"), rate_hz=500.0,
    ...               start_unix_us=1_700_000_000_000_000)
    >>> with OpalWriter(path, run) as writer:
    ...     for _ in range(3):
    ...         writer.append(acc_m_s2=np.full((2, 3, 40), 5.75), gyr_rad_s=np.zeros((2, 3, 40)))
    >>> recording = read_recording(path, sensor="Left Foot")
    >>> dict(recording.sizes), recording.attrs["rate_hz"], recording.attrs["rate_source"]
    ({'sensor': 1, 'axis': 3, 'time': 120}, 500.0, 'header')
    """

    def __init__(self, path: Path | str, run: OpalRun) -> None:
        import h5py

        self._run = run
        self._path = Path(path)
        self._n_samples = 0
        self._n_rows = 0
        self._last_is_written = True
        self._annotations: list[tuple[int, str, str]] = []
        self._file = h5py.File(self._path, "w", rdcc_nbytes=CACHE_BYTES)
        self._file.attrs["FileFormatVersion"] = np.int64(VERSION)
        if run.note:
            self._file.attrs["Note"] = np.bytes_(run.note.encode())
        self._datasets = [
            _create_sensor(self._file, run, name, label)
            for name, label in zip(run.ids, run.labels, strict=True)
        ]

    def __enter__(self) -> Self:
        """Return the writer."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Finish the file; a run that broke off is removed, for half a run looks like a whole one."""
        if kind is None:
            self.close()
        else:
            self._file.close()
            self._path.unlink(missing_ok=True)

    def append(
        self,
        *,
        acc_m_s2: ArrayLike,
        gyr_rad_s: ArrayLike,
        mag_t: ArrayLike | None = None,
        quat_world_from_sensor: ArrayLike | None = None,
    ) -> None:
        """Append the next samples of all sensors.

        Parameters
        ----------
        acc_m_s2, gyr_rad_s : array_like, shape (n_sensors, 3, n)
        mag_t : array_like, shape (n_sensors, 3, n), optional
            In T; needed if the run has a magnetometer.
        quat_world_from_sensor : array_like, shape (n_sensors, 4, n), optional
            Scalar first; needed if the run has the orientation.

        Raises
        ------
        RecordingError
            If a signal is missing or superfluous, or shapes disagree.
        """
        pieces = {
            "acc": acc_m_s2,
            "gyr": gyr_rad_s,
            "mag": mag_t,
            "quat": quat_world_from_sensor,
        }
        wanted = {"acc", "gyr"} | ({"mag"} if self._run.mag else set())
        wanted |= {"quat"} if self._run.quat else set()
        arrays: dict[str, NDArray[np.floating]] = {
            name: np.asarray(piece) for name, piece in pieces.items() if piece is not None
        }
        n = arrays["acc"].shape[-1]
        shapes = {name: (len(self._run.ids), 4 if name == "quat" else 3, n) for name in wanted}
        found = {name: array.shape for name, array in arrays.items()}
        if found != shapes:
            raise RecordingError(
                "the signals do not fit the run",
                file=self._path.name,
                expected=str(dict(sorted(shapes.items()))),
                found=str(dict(sorted(found.items()))),
            )
        there = np.zeros(n, dtype=bool)
        for array in arrays.values():
            there |= np.isfinite(array).any(axis=(0, 1))
        if n and self._n_samples == 0:
            there[0] = True
        self._write(arrays, there)

    def annotate(self, time_unix_us: int, annotation: str, *, sensor: str = "") -> None:
        """Add a note with its time.

        Parameters
        ----------
        time_unix_us : int
            µs since 1970 UTC.
        annotation : str
        sensor : str
            Id of the sensor that it concerns.
        """
        self._annotations.append((time_unix_us, sensor, annotation))

    def close(self) -> None:
        """Write what is left and close the file."""
        if not self._last_is_written:
            arrays = {
                name: np.full((len(self._datasets), dataset.shape[1], 1), np.nan)
                for name, dataset in self._datasets[0].items()
                if name != "Time"
            }
            self._n_samples -= 1
            self._write(arrays, np.array([True]))
        for group in self._file["Sensors"].values():
            group["Temperature"].resize((self._n_rows,))
        _write_annotations(self._file, self._annotations)
        self._file.close()

    def _write(self, arrays: dict[str, NDArray[np.floating]], there: NDArray[np.bool_]) -> None:
        kept = np.flatnonzero(there)
        whole = len(kept) == len(there)
        samples = self._n_samples + kept
        time_us = self._run.start_unix_us + np.rint(samples * (1e6 / self._run.rate_hz)).astype(
            np.int64
        )
        start, stop = self._n_rows, self._n_rows + len(kept)
        for position, datasets in enumerate(self._datasets):
            datasets["Time"].resize((stop,))
            datasets["Time"][start:stop] = time_us
            for name, array in arrays.items():
                values = array[position] if whole else array[position][:, kept]
                if name == "mag":
                    values = values / FACTORS_TO_SI[QUANTITY_OF["mag"]][UNITS["mag"]]
                datasets[name].resize((stop, len(values)))
                datasets[name][start:stop] = np.ascontiguousarray(values.T, dtype=np.float32)
        self._n_rows = stop
        self._n_samples += len(there)
        self._last_is_written = bool(there[-1]) if len(there) else self._last_is_written


def write_opal_hdf5(
    path: Path | str,
    recording: Recording,
    *,
    ids: Sequence[str],
    start_unix_us: int,
    timezone_offset_h: float = 0.0,
    note: str = "",
) -> None:
    """Write a whole recording as one Opal file.

    Parameters
    ----------
    path : path or str
        File to write; replaced if it exists.
    recording : Recording
        With ``acc`` and ``gyr``; ``mag`` (in T) and ``quat`` are written if they are there.
    ids : sequence of str
        Id of each sensor.
    start_unix_us, timezone_offset_h, note
        As for :class:`OpalRun`.

    Raises
    ------
    RecordingError
        If a signal is missing, the magnetic field has no unit, or ids and labels do not fit.
    """
    for signal in ("acc", "gyr"):
        if signal not in recording:
            raise RecordingError(
                f"a signal is missing ({signal})", file=Path(path).name, expected="acc and gyr"
            )
    mag = recording.get("mag")
    if mag is not None and mag.attrs.get("units") != "T":
        raise RecordingError(
            "the magnetic field has no unit that the format knows",
            file=Path(path).name,
            expected="T",
            found=repr(mag.attrs.get("units")),
        )
    quat = recording["quat"].values if "quat" in recording else None
    run = OpalRun(
        ids=tuple(ids),
        labels=tuple(str(label) for label in recording["sensor"].values),
        rate_hz=recording.attrs["rate_hz"],
        start_unix_us=start_unix_us,
        timezone_offset_h=timezone_offset_h,
        mag=mag is not None,
        quat=quat is not None,
        note=note,
    )
    with OpalWriter(path, run) as writer:
        writer.append(
            acc_m_s2=recording["acc"].values,
            gyr_rad_s=recording["gyr"].values,
            mag_t=None if mag is None else mag.values,
            quat_world_from_sensor=quat,
        )


def _fits(text: str) -> bool:
    return 0 < len(text.encode()) <= LABEL_BYTES and text == text.strip() and "\x00" not in text


def _create_sensor(file: h5py.File, run: OpalRun, name: str, label: str) -> dict[str, h5py.Dataset]:
    """Empty, growing data sets of one sensor; its temperature is unknown (NaN) and takes no space."""
    group = file.create_group(f"Sensors/{name}")
    configuration = group.create_group("Configuration")
    configuration.attrs["Label 0"] = np.array(label.encode(), dtype=f"S{LABEL_BYTES}")
    configuration.attrs["Sample Rate"] = np.float64(run.rate_hz)
    if float(run.rate_hz).is_integer():
        configuration.attrs["Sample Rate"] = np.int64(run.rate_hz)
    configuration.attrs["Timezone Offset"] = np.float64(run.timezone_offset_h)

    def growing(path: str, columns: int | None, dtype: str) -> h5py.Dataset:
        inner = () if columns is None else (columns,)
        return file.create_dataset(
            path,
            shape=(0, *inner),
            maxshape=(None, *inner),
            chunks=(CHUNK_ROWS, *inner),
            dtype=dtype,
            fillvalue=np.nan if dtype == "f4" else None,
        )

    datasets = {"Time": growing(f"Sensors/{name}/Time", None, "i8")}
    for signal in ("acc", "gyr", *(["mag"] if run.mag else [])):
        datasets[signal] = growing(f"Sensors/{name}/{_NAMES[signal]}", 3, "f4")
    if run.quat:
        datasets["quat"] = growing(f"Processed/{name}/Orientation", 4, "f4")
    growing(f"Sensors/{name}/Temperature", None, "f4")
    return datasets


def _write_annotations(file: h5py.File, annotations: Sequence[tuple[int, str, str]]) -> None:
    texts = [(sensor.encode(), text.encode()) for _, sensor, text in annotations]
    widths = [max([1, *map(len, column)]) for column in zip(*texts, strict=True)] or [1, 1]
    rows = [(note[0], *text) for note, text in zip(annotations, texts, strict=True)]
    layout = [("Time", "i8"), ("Sensor ID", f"S{widths[0]}"), ("Annotation", f"S{widths[1]}")]
    file.create_dataset("Annotations", data=np.array(rows, dtype=layout))
