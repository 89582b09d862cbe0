"""Truth of a recording of the running body in one file: parameters and events, not poses.

A reader gets the motion back and with it the pose of every segment at any time. Half an hour takes
some megabytes.
"""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import numpy as np

from swaystride.errors import RecordingError
from swaystride.simulate._running_kernel import BodyTables
from swaystride.simulate.foot_spline import PiecewiseQuintic
from swaystride.simulate.running_body import RunnerBody
from swaystride.simulate.running_motion import RunningMotion
from swaystride.simulate.running_tissue import SkinPoints
from swaystride.simulate.sole import Sole, SoleEdge


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
    arrays = {f"tables.{name}": table for name, table in motion.tables._asdict().items()}
    for name, skin in (points or {}).items():
        arrays |= {
            f"points.{name}.rows": skin.rows,
            f"points.{name}.points_m": skin.points_m,
            f"points.{name}.tissue": skin.tissue,
        }
    arrays["belt.start_s"] = motion.belt.start_s
    arrays["belt.coefficients"] = motion.belt.coefficients
    numbers = {
        "body": asdict(motion.body),
        "duration_s": motion.duration_s,
        "belt_speed_m_s": motion.belt_speed_m_s,
    }
    arrays["numbers"] = np.array(json.dumps(numbers))
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
    try:
        with np.load(Path(path), allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        numbers = json.loads(str(arrays["numbers"]))
        tables = BodyTables(*(arrays[f"tables.{name}"] for name in BodyTables._fields))
        belt = PiecewiseQuintic(arrays["belt.start_s"], arrays["belt.coefficients"])
    except (KeyError, ValueError, EOFError) as error:
        raise RecordingError(
            "not a file of truth of the running body",
            file=Path(path).name,
            expected="written by write_truth",
            found=str(error),
        ) from error
    sole = numbers["body"].pop("sole")
    edges = tuple(SoleEdge(**edge) for edge in sole.pop("edges"))
    body = RunnerBody(sole=Sole(edges=edges, **sole), **numbers["body"])
    names = {name.split(".")[1] for name in arrays if name.startswith("points.")}
    points = {
        name: SkinPoints(
            arrays[f"points.{name}.rows"],
            arrays[f"points.{name}.points_m"],
            arrays[f"points.{name}.tissue"],
        )
        for name in sorted(names)
    }
    motion = RunningMotion(
        body, numbers["duration_s"], None, tables, belt, numbers["belt_speed_m_s"]
    )
    return motion, points
