"""Recordings in, estimates out: the netCDF files between the stages, one group per trial."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import xarray as xr

from swaystride.errors import RecordingError
from swaystride.recording import list_recordings

#: Variables that are stored as they are; the others as float32.
_EXACT: Final = ("foot_position_m", "zero_velocity")


def usable_trials(path: Path) -> list[str]:
    """Trials in a file of recordings or of estimates, sorted.

    Parameters
    ----------
    path : Path
    """
    return list_recordings(path)


def start_estimates(path: Path) -> None:
    """Make an empty file: a participant may have no usable trial.

    Parameters
    ----------
    path : Path
        Replaced if it exists.
    """
    import h5netcdf

    with h5netcdf.File(path, "w"):
        pass


def add_estimates(path: Path, trial: str, estimates: xr.Dataset) -> None:
    """Append the estimates of one trial.

    Parameters
    ----------
    path : Path
        From :func:`start_estimates`.
    trial : str
        Name of the group.
    estimates : Dataset
        From :func:`swaystride.studies.kinematics.estimation.estimate_trial`.
    """
    encoding = {
        str(name): {"dtype": "float32"} for name in estimates.data_vars if name not in _EXACT
    }
    # flags are bytes in netCDF
    stored = estimates.assign(zero_velocity=estimates["zero_velocity"].astype("int8"))
    stored.to_netcdf(path, mode="a", group=trial, engine="h5netcdf", encoding=encoding)


def load_estimates(path: Path, trial: str) -> xr.Dataset:
    """Estimates of one trial, wholly in memory.

    Parameters
    ----------
    path : Path
        From :func:`add_estimates`.
    trial : str
        Name of the group.

    Returns
    -------
    Dataset

    Raises
    ------
    RecordingError
        If the file has no such trial.
    """
    try:
        with xr.open_dataset(path, group=trial, engine="h5netcdf") as stored:
            loaded = stored.load()
    except (KeyError, OSError) as error:
        raise RecordingError(
            "no estimates of this trial", file=path, place=f"group {trial}", found=str(error)
        ) from error
    return loaded.assign(zero_velocity=loaded["zero_velocity"].astype(bool))
