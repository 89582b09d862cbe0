"""Truth of a recording of the running body in one file: parameters and events, not poses.

A reader gets the motion back and with it the pose of every segment at any time. Half an hour takes
some megabytes.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from swaystride.errors import RecordingError
from swaystride.simulate._running_kernel import BodyTables
from swaystride.simulate.foot_spline import PiecewiseQuintic
from swaystride.simulate.running_body import RunnerBody
from swaystride.simulate.running_motion import RunningMotion
from swaystride.simulate.running_tissue import SkinPoints
from swaystride.simulate.sole import Sole, SoleEdge

#: Arrays of an ``.npz`` file by their names in it.
Arrays = dict[str, Any]


def write_truth(
    path: Path | str, motion: RunningMotion, points: dict[str, SkinPoints] | None = None
) -> None:
    """Write a motion, and points on the skin such as sensors and markers.

    Parameters
    ----------
    path : path or str
        File to write, ``.npz``.
    motion : RunningMotion
        What happens.
    points : dict of str to SkinPoints, optional
        By a name of one's choice, for example ``sensors`` and ``markers``.
    """
    arrays = motion_arrays(motion) | points_arrays(points or {})
    with Path(path).open("wb") as file:
        np.savez_compressed(file, **arrays)


def read_truth(path: Path | str) -> tuple[RunningMotion, dict[str, SkinPoints]]:
    """Read what :func:`write_truth` wrote.

    Parameters
    ----------
    path : path or str
        File to read.

    Returns
    -------
    motion : RunningMotion
        With tables, without ``feet``.
    points : dict of str to SkinPoints
        Points on the skin.

    Raises
    ------
    RecordingError
        If the file is not such a file.
    """
    with reading_truth(path, "the running body"):
        with np.load(Path(path), allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        motion, points = motion_from_arrays(arrays), points_from_arrays(arrays)
    return motion, points


@contextmanager
def reading_truth(path: Path | str, what: str) -> Iterator[None]:
    """Say in one line that a file is not the truth that is wanted, whatever its fault.

    Parameters
    ----------
    path : path or str
        File that is read.
    what : str
        Truth of what.

    Raises
    ------
    RecordingError
        If something is missing in the file or cannot be decoded.
    """
    try:
        yield
    except (KeyError, ValueError, EOFError, BadZipFile) as error:
        raise RecordingError(
            f"not a file of truth of {what}",
            file=Path(path).name,
            expected="written by write_truth",
            found=str(error),
        ) from error


def motion_arrays(motion: RunningMotion) -> Arrays:
    """Arrays from which :func:`motion_from_arrays` gets a motion back.

    Parameters
    ----------
    motion : RunningMotion
        What happens.
    """
    arrays = {f"tables.{name}": table for name, table in motion.tables._asdict().items()}
    arrays["belt.start_s"] = motion.belt.start_s
    arrays["belt.coefficients"] = motion.belt.coefficients
    numbers = {
        "body": asdict(motion.body),
        "duration_s": motion.duration_s,
        "belt_speed_m_s": motion.belt_speed_m_s,
    }
    arrays["numbers"] = np.array(json.dumps(numbers))
    return arrays


def motion_from_arrays(arrays: Mapping[str, Any]) -> RunningMotion:
    """Return the motion of :func:`motion_arrays`, with tables, without ``feet``.

    Parameters
    ----------
    arrays : mapping of str to ndarray
        At least these arrays.
    """
    numbers = json.loads(str(arrays["numbers"]))
    tables = BodyTables(*(arrays[f"tables.{name}"] for name in BodyTables._fields))
    belt = PiecewiseQuintic(arrays["belt.start_s"], arrays["belt.coefficients"])
    sole = numbers["body"].pop("sole")
    edges = tuple(SoleEdge(**edge) for edge in sole.pop("edges"))
    body = RunnerBody(sole=Sole(edges=edges, **sole), **numbers["body"])
    return RunningMotion(body, numbers["duration_s"], None, tables, belt, numbers["belt_speed_m_s"])


def points_arrays(points: Mapping[str, SkinPoints]) -> Arrays:
    """Arrays from which :func:`points_from_arrays` gets points back.

    Parameters
    ----------
    points : mapping of str to SkinPoints
        By name.
    """
    return {
        f"points.{name}.{field.name}": getattr(skin, field.name)
        for name, skin in points.items()
        for field in fields(SkinPoints)
    }


def points_from_arrays(arrays: Mapping[str, Any]) -> dict[str, SkinPoints]:
    """Return the points of :func:`points_arrays`.

    Parameters
    ----------
    arrays : mapping of str to ndarray
        At least these arrays.
    """
    names = {name.split(".")[1] for name in arrays if name.startswith("points.")}
    return {
        name: SkinPoints(*(arrays[f"points.{name}.{field.name}"] for field in fields(SkinPoints)))
        for name in sorted(names)
    }
