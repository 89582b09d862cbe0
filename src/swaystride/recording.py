"""The recording: what every reader returns and every analysis takes.

A recording is an :class:`xarray.Dataset` with

* dimensions ``sensor``, ``axis`` (x, y, z) and ``time``, stored sensor and channel major, so that
  a filter along time runs on contiguous memory;
* ``acc`` in m/s² (proper acceleration: at rest it points up with the size of gravity) and ``gyr``
  in rad/s, both in the frame of their sensor; optionally ``mag`` and, with dimensions ``sensor``,
  ``component`` (w, x, y, z) and ``time``, the vendor's ``quat`` (``r_world_from_sensor``);
* coordinate ``time`` in s from the first sample, uniformly spaced; a lost sample is a row of NaN;
* attributes ``rate_hz``, ``rate_source``, ``device``, ``source_file``, ``source_sha256``,
  ``world_frame`` and ``findings`` (JSON, see :mod:`swaystride.findings`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError
from swaystride.findings import Finding, findings_from_json, findings_to_json

Recording = xr.Dataset

AXES = ("x", "y", "z")
QUATERNION_COMPONENTS = ("w", "x", "y", "z")


def make_recording(
    *,
    rate_hz: float,
    rate_source: str,
    sensors: Sequence[str],
    acc_m_s2: ArrayLike | None = None,
    gyr_rad_s: ArrayLike | None = None,
    mag: ArrayLike | None = None,
    quat_world_from_sensor: ArrayLike | None = None,
    world_frame: str = "unknown",
    device: str = "unknown",
    source_file: str = "",
    source_sha256: str = "",
    findings: Iterable[Finding] = (),
) -> Recording:
    """Assemble a recording from plain arrays.

    Parameters
    ----------
    rate_hz : float
        Sampling rate, positive and finite.
    rate_source : str
        Where the rate was learnt: ``header``, ``time stamps`` or ``argument``.
    sensors : sequence of str
        One label per sensor.
    acc_m_s2, gyr_rad_s, mag : array_like, shape (n_sensors, 3, n_samples), optional
        Signals in the sensor frame. At least one signal must be given.
    quat_world_from_sensor : array_like, shape (n_sensors, 4, n_samples), optional
        The vendor's orientation, scalar first.
    world_frame, device, source_file, source_sha256 : str
        Provenance, stored as attributes.
    findings : iterable of Finding
        What the reader's checks saw.

    Returns
    -------
    Recording

    Raises
    ------
    RecordingError
        If the rate is not positive, no signal is given, or shapes disagree.

    Examples
    --------
    >>> rec = make_recording(rate_hz=100.0, rate_source="argument", sensors=["lumbar"],
    ...                      acc_m_s2=np.zeros((1, 3, 50)), gyr_rad_s=np.zeros((1, 3, 50)))
    >>> dict(rec.sizes)
    {'sensor': 1, 'axis': 3, 'time': 50}
    """
    if not (np.isfinite(rate_hz) and rate_hz > 0):
        raise RecordingError(
            "sampling rate is not a positive number",
            file=source_file or None,
            expected="rate_hz > 0",
            found=str(rate_hz),
        )
    signals = {"acc": acc_m_s2, "gyr": gyr_rad_s, "mag": mag, "quat": quat_world_from_sensor}
    variables: dict[str, tuple[tuple[str, str, str], NDArray[np.float64]]] = {}
    n_samples: int | None = None
    for name, values in signals.items():
        if values is None:
            continue
        array = np.ascontiguousarray(values, dtype=np.float64)
        channels = 4 if name == "quat" else 3
        if n_samples is None and array.ndim == 3:
            n_samples = array.shape[2]
        if array.shape != (len(sensors), channels, n_samples):
            raise RecordingError(
                f"signal {name} has the wrong shape",
                file=source_file or None,
                expected=f"({len(sensors)}, {channels}, {n_samples})",
                found=str(array.shape),
            )
        variables[name] = (
            ("sensor", "component" if name == "quat" else "axis", "time"),
            array,
        )
    if n_samples is None:
        raise RecordingError("recording without any signal", file=source_file or None)
    coords: dict[str, object] = {
        "sensor": list(sensors),
        "axis": list(AXES),
        "time": np.arange(n_samples) / rate_hz,
    }
    if "quat" in variables:
        coords["component"] = list(QUATERNION_COMPONENTS)
    return xr.Dataset(
        variables,
        coords=coords,
        attrs={
            "rate_hz": float(rate_hz),
            "rate_source": rate_source,
            "world_frame": world_frame,
            "device": device,
            "source_file": source_file,
            "source_sha256": source_sha256,
            "findings": findings_to_json(findings),
        },
    )


def findings_of(recording: Recording) -> list[Finding]:
    """Return the findings that a recording carries."""
    return findings_from_json(recording.attrs["findings"])


def with_findings(recording: Recording, findings: Iterable[Finding]) -> Recording:
    """Return the recording with further findings appended to its own."""
    joined = [*findings_of(recording), *findings]
    return recording.assign_attrs(findings=findings_to_json(joined))


def six_axis_signals(recording: Recording) -> NDArray[np.float64]:
    """Accelerometer (m/s²) and gyroscope (rad/s) of a recording of one sensor.

    Parameters
    ----------
    recording : Recording
        With one sensor.

    Returns
    -------
    ndarray, shape (6, n_samples)
    """
    return np.concatenate([recording["acc"].to_numpy()[0], recording["gyr"].to_numpy()[0]])


def save_recordings(path: Path | str, recordings: Mapping[str, Recording]) -> None:
    """Write recordings as float32 netCDF, one group per name, in the given order.

    Parameters
    ----------
    path : path or str
        File to write; replaced if it exists.
    recordings : mapping of str to Recording
        Group name (the trial) to recording.
    """
    import h5netcdf

    path = Path(path)
    # an empty file too: all trials of a unit may be excluded
    with h5netcdf.File(path, "w"):
        pass
    for group, recording in recordings.items():
        encoding = {str(name): {"dtype": "float32"} for name in recording.data_vars}
        encoding["time"] = {"dtype": "float64"}
        recording.to_netcdf(path, mode="a", group=group, engine="h5netcdf", encoding=encoding)


def load_recording(path: Path | str, group: str) -> Recording:
    """Read one recording that :func:`save_recordings` wrote, wholly into memory.

    Parameters
    ----------
    path : path or str
        File written by :func:`save_recordings`.
    group : str
        Name of the recording.

    Raises
    ------
    RecordingError
        If the file has no such group.
    """
    try:
        with xr.open_dataset(path, group=group, engine="h5netcdf") as stored:
            return stored.load().astype("float64")
    except (KeyError, OSError) as error:
        raise RecordingError(
            "no such recording", file=path, place=f"group {group}", found=str(error)
        ) from error


def list_recordings(path: Path | str) -> list[str]:
    """Names of the recordings in a file, sorted.

    Parameters
    ----------
    path : path or str
        File written by :func:`save_recordings`.
    """
    import h5netcdf

    with h5netcdf.File(path, "r") as file:
        return sorted(file.groups)
