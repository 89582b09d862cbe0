"""The netCDF file of one run: its sensors in anatomical axes, float32."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import h5netcdf
import numpy as np
import xarray as xr

from swaystride.errors import RecordingError
from swaystride.gait.segment_signals import SegmentSignals

#: Group of the only recording in the file.
GROUP = "run"


def save_signals(
    path: Path, signals: Mapping[str, SegmentSignals], rate_hz: float, attributes: Mapping[str, str]
) -> None:
    """Write the sensors of a run.

    Parameters
    ----------
    path : Path
        netCDF.
    signals : mapping of str to SegmentSignals
        By sensor; none at all if the run is left out.
    rate_hz : float
        Sampling rate.
    attributes : mapping of str to str
        Provenance.
    """
    with h5netcdf.File(path, "w"):
        pass
    if not signals:
        return
    names = list(signals)
    n_samples = signals[names[0]].acc_m_s2.shape[1]
    dims = ("sensor", "axis", "time")
    shape = (len(names), 3, n_samples)
    acc, gyr = (np.empty(shape, dtype=np.float32) for _ in range(2))
    for k, name in enumerate(names):
        acc[k], gyr[k] = signals[name].acc_m_s2, signals[name].gyr_rad_s
    recording = xr.Dataset(
        {"acc": (dims, acc, {"units": "m/s^2"}), "gyr": (dims, gyr, {"units": "rad/s"})},
        coords={
            "sensor": names,
            "axis": ["forward", "up", "right"],
            "time": np.arange(n_samples) / rate_hz,
        },
        attrs={"rate_hz": float(rate_hz), "frame": "anatomical", **attributes},
    )
    recording.to_netcdf(path, mode="a", group=GROUP, engine="h5netcdf")


def load_signals(path: Path) -> tuple[dict[str, SegmentSignals], float]:
    """Read the sensors of a run.

    Parameters
    ----------
    path : Path
        File of :func:`save_signals`.

    Returns
    -------
    signals : dict of str to SegmentSignals
        float32; empty if the run was left out.
    rate_hz : float
        Sampling rate; 0 if the run was left out.

    Raises
    ------
    RecordingError
        If the file cannot be read.
    """
    try:
        with h5netcdf.File(path, "r") as file:
            if GROUP not in file.groups:
                return {}, 0.0
            group = file.groups[GROUP]
            names = [_text(name) for name in group.variables["sensor"][...].tolist()]
            acc, gyr = (group.variables[signal] for signal in ("acc", "gyr"))
            signals = {
                name: SegmentSignals(np.asarray(acc[k]), np.asarray(gyr[k]))
                for k, name in enumerate(names)
            }
            return signals, float(group.attrs["rate_hz"])
    except (KeyError, OSError) as error:
        raise RecordingError("not a file of signals", file=path.name, found=str(error)) from error


def _text(name: str | bytes) -> str:
    """Name of a sensor, as text or as the bytes in which HDF5 keeps it."""
    return name.decode("utf-8") if isinstance(name, bytes) else str(name)
