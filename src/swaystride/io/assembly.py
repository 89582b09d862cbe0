"""From rows of a file to a recording: checks, gaps as NaN, provenance."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.findings import Finding
from swaystride.io import checks
from swaystride.io.hints import QUANTITY_OF, ReadHints
from swaystride.io.sampling_rate import SamplingRate
from swaystride.recording import Recording, make_recording
from swaystride.units import to_si

Array = NDArray[np.float64]

#: More lost than present samples by this factor is a broken counter, not a lossy recording.
MOST_LOST_PER_ROW = 1000


class Source(Protocol):
    """What :func:`assemble` asks of an opened file, be it text or binary."""

    @property
    def name(self) -> str:
        """Name without folder."""

    @property
    def sha256(self) -> str:
        """Hash of the file as it lies on the disk."""

    @property
    def row_name(self) -> str:
        """What its rows are called in findings."""

    def has_unfinished_last_line(self) -> bool:
        """Tell whether the last number may be cut."""


@dataclass(frozen=True)
class SensorRows:
    """Signals of one sensor as they stand in the rows of a file.

    Parameters
    ----------
    label : str
    signals : dict of str to ndarray, shape (n_channels, n_rows)
        ``acc``, ``gyr``, ``mag`` in the units of the file, ``quat`` (r_world_from_sensor).
    """

    label: str
    signals: dict[str, NDArray[Any]] = field(default_factory=dict)


def select_sensors(labels: Sequence[str], hints: ReadHints, *, file: str) -> list[str]:
    """Labels to keep in a file with several sensors: those asked for, or all.

    Parameters
    ----------
    labels : sequence of str
        Sensors of the file.
    hints : ReadHints
        The caller's choice.

    Raises
    ------
    RecordingError
        If the file has no sensor of that name.
    """
    for label in hints.sensors:
        if label not in labels:
            raise RecordingError(
                "no such sensor",
                file=file,
                expected="one of " + ", ".join(labels),
                found=repr(label),
            )
    return list(hints.sensors) or list(labels)


def single_label(hints: ReadHints, default: str, *, file: str) -> str:
    """Return the label of the only sensor of a file: the argument, or the default.

    Parameters
    ----------
    hints : ReadHints
        The caller's label, if any.

    Raises
    ------
    RecordingError
        If more than one label is given.
    """
    if len(hints.sensors) > 1:
        raise RecordingError(
            "the file holds one sensor",
            file=file,
            expected="one label in the argument sensor",
            found=", ".join(hints.sensors),
        )
    return hints.sensors[0] if hints.sensors else default


def refuse_mostly_missing(index: NDArray[np.int64], *, file: str) -> None:
    """Refuse a time axis that is almost empty before memory is taken for it.

    Parameters
    ----------
    index : ndarray of int, shape (n_rows,)
        Sample index of each row.
    file : str

    Raises
    ------
    RecordingError
        If there is less than one row for :data:`MOST_LOST_PER_ROW` samples.
    """
    n_samples, n_rows = int(index[-1]) + 1, len(index)
    if n_samples > MOST_LOST_PER_ROW * n_rows:
        raise RecordingError(
            "almost every sample is missing",
            file=file,
            expected=f"at least one row for {MOST_LOST_PER_ROW} samples",
            found=f"{n_rows} rows for {n_samples} samples",
        )


def assemble(
    source: Source,
    sensors: Sequence[SensorRows],
    *,
    index: NDArray[np.int64],
    first_line: int,
    rate: SamplingRate,
    units: Mapping[str, str],
    world_frame: str = "unknown",
    device: str = "unknown",
    findings: Iterable[Finding] = (),
    attributes: Mapping[str, str | int] | None = None,
) -> Recording:
    """Convert units, run the checks, put rows on the uniform time axis, and make the recording.

    Parameters
    ----------
    source : Source
    sensors : sequence of SensorRows
        In the order of the recording. A signal that only some sensors have is NaN for the others.
    index : ndarray of int, shape (n_rows,)
        Sample index of each row; samples in between become NaN, and of rows with the same index
        the first is kept.
    first_line : int
        Number of the first row.
    rate : SamplingRate
    units : mapping of str to str
        Unit of each signal in the file.
    world_frame, device : str
    findings : iterable of Finding
        What the reader saw before.
    attributes : mapping, optional
        Further attributes of the recording.

    Returns
    -------
    Recording

    Raises
    ------
    RecordingError
        If a check finds an error, or far more samples are lost than are there.
    """
    refuse_mostly_missing(index, file=source.name)
    n_samples, n_rows = int(index[-1]) + 1, len(index)
    seen = [*findings, *rate.findings, *_unfinished_last_line(source)]
    seen += checks.packet_loss(
        index,
        rate.rate_hz,
        file=source.name,
        first_line=first_line,
        row_name=source.row_name,
    )
    names = [
        name for name in ("acc", "gyr", "mag", "quat") if any(name in s.signals for s in sensors)
    ]
    stacked = {
        name: np.full((len(sensors), 4 if name == "quat" else 3, n_samples), np.nan)
        for name in names
    }
    first = slice(None) if n_samples == n_rows else np.diff(index, prepend=-1) > 0
    for position, sensor in enumerate(sensors):
        prefix = f"{sensor.label} " if len(sensors) > 1 else ""
        for name, raw in sensor.signals.items():
            values = (
                to_si(raw, units[name], QUANTITY_OF[name])
                if name in units
                else np.asarray(raw, dtype=np.float64)
            )
            if name in _UNIT_CHECKS:
                seen += _UNIT_CHECKS[name](values, file=source.name, signal=prefix + name)
            seen += checks.nan_run(
                values,
                index,
                rate.rate_hz,
                file=source.name,
                first_line=first_line,
                signal=prefix + name,
                row_name=source.row_name,
            )
            stacked[name][position][:, index[first]] = values[:, first]
    recording = make_recording(
        rate_hz=rate.rate_hz,
        rate_source=rate.source,
        sensors=[sensor.label for sensor in sensors],
        acc_m_s2=stacked.get("acc"),
        gyr_rad_s=stacked.get("gyr"),
        mag=stacked.get("mag"),
        quat_world_from_sensor=stacked.get("quat"),
        world_frame=world_frame,
        device=device,
        source_file=source.name,
        source_sha256=source.sha256,
        findings=checks.stop_on_error(seen),
    )
    si_units = {
        "acc": "m/s^2",
        "gyr": "rad/s",
        "mag": "a.u." if units.get("mag") == "a.u." else "T",
    }
    for name in names:
        if name in si_units:
            recording[name].attrs["units"] = si_units[name]
    return recording.assign_attrs(attributes or {})


_UNIT_CHECKS: dict[str, Callable[..., list[Finding]]] = {
    "acc": checks.acceleration_unit,
    "gyr": checks.angular_rate_unit,
}


def _unfinished_last_line(source: Source) -> list[Finding]:
    """A last line without line end may have lost the end of its last number."""
    if not source.has_unfinished_last_line():
        return []
    return [
        Finding(
            "unfinished_last_line",
            "warning",
            source.name,
            "last line",
            "a line end",
            "end of file; the last number may be cut",
        )
    ]
