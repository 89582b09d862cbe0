"""Skin markers of the conventional gait model on a runner, and what cameras make of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

from swaystride.simulate._running_points import marker_positions
from swaystride.simulate.running_body import RunnerBody
from swaystride.simulate.running_motion import RunningMotion
from swaystride.simulate.running_recording import n_samples
from swaystride.simulate.running_sensors import (
    SensorPlace,
    WornSensors,
    place_point_m,
    read_places,
)
from swaystride.simulate.running_tissue import SkinPoints, TissueSize, skin_points

Array = NDArray[np.float64]

#: Names of the markers on the faces of the sensors of the lower body.
FACE_MARKERS: Final = {
    "lumbar": "IMUP",
    "thigh_right": "RIMT",
    "thigh_left": "LIMT",
    "shank_right": "RIMS",
    "shank_left": "LIMS",
    "foot_right": "RIMF",
    "foot_left": "LIMF",
}


@cache
def marker_places() -> dict[str, SensorPlace]:
    """Places of the 38 markers of the body, from ``running_markers.csv`` in this folder."""
    return read_places("running_markers.csv")


@dataclass(frozen=True)
class CameraErrors:
    """What an optical system adds.

    Parameters
    ----------
    noise_m : float
        Standard deviation of each coordinate.
    gap_share : tuple of float
        Least and largest share of the frames in which a marker is lost.
    gap_frames : float
        Mean length of a gap in frames.
    """

    noise_m: float
    gap_share: tuple[float, float]
    gap_frames: float


#: Spec §9.1: noise 0.3 mm, gaps 1-3 %; a length that gap filling meets in life [N].
USUAL_CAMERAS: Final = CameraErrors(0.3e-3, (0.01, 0.03), 8.0)


@dataclass(frozen=True)
class WornMarkers:
    """Markers on one person for one session.

    Parameters
    ----------
    names : tuple of str
        In the order of all arrays.
    skin : SkinPoints
        Places and soft tissue.
    """

    names: tuple[str, ...]
    skin: SkinPoints


def wear_markers(
    body: RunnerBody,
    sensors: WornSensors,
    *,
    place_sd_m: float,
    tissue: dict[str, TissueSize],
    common: Array,
    rng: np.random.Generator,
) -> WornMarkers:
    """Put the markers on a person, and one on the face of each sensor of the lower body.

    Parameters
    ----------
    body : RunnerBody
        Of the person.
    sensors : WornSensors
        What the person wears; markers on sensors move with them.
    place_sd_m : float
        Scatter of the places along each axis.
    tissue : dict of str to TissueSize
        Soft tissue; empty for markers on bone.
    common : ndarray, shape (13, 5, 3)
        What everything on a segment shares; the same as for the sensors.
    rng : numpy.random.Generator
        Source of all that is random.

    Returns
    -------
    WornMarkers
    """
    places = list(marker_places().values())
    points = np.array([place_point_m(place, body) for place in places])
    points += place_sd_m * rng.standard_normal(points.shape)
    skin = skin_points([p.segment for p in places], points, tissue, common, rng)
    worn = [k for k, name in enumerate(sensors.names) if name in FACE_MARKERS]
    faces = [FACE_MARKERS[sensors.names[k]] for k in worn]
    both = SkinPoints(
        np.concatenate([skin.rows, sensors.skin.rows[worn]]),
        np.concatenate([skin.points_m, sensors.skin.points_m[worn]]),
        np.concatenate([skin.tissue, sensors.skin.tissue[worn]]),
    )
    return WornMarkers((*(p.name for p in places), *faces), both)


@dataclass(frozen=True)
class MarkerChunk:
    """Part of a recording.

    Parameters
    ----------
    first : int
        Index of its first frame in the recording.
    position_m : ndarray, shape (n, n_markers, 3)
        Laboratory coordinates; NaN where a marker is lost.
    """

    first: int
    position_m: Array


def filmed(
    motion: RunningMotion,
    markers: WornMarkers,
    *,
    rate_hz: float,
    errors: CameraErrors,
    rng: np.random.Generator,
    start_s: float = 0.0,
    chunk_s: float = 60.0,
) -> Iterator[MarkerChunk]:
    """Film a motion, part by part.

    On a treadmill the coordinates are those of the laboratory, in which the runner stays.

    Parameters
    ----------
    motion : RunningMotion
        What happens.
    markers : WornMarkers
        What is filmed.
    rate_hz : float
        Frames per second.
    errors : CameraErrors
        Noise and gaps.
    rng : numpy.random.Generator
        Source of both.
    start_s : float
        Time of the first frame in the motion: the cameras may start a little early or late.
    chunk_s : float
        Length of the parts; it decides the order of the random numbers.

    Yields
    ------
    MarkerChunk
    """
    total = n_samples(motion, rate_hz)
    lost = _gaps(total, len(markers.names), errors, rng)
    every = max(1, round(chunk_s * rate_hz))
    for first in range(0, total, every):
        time = start_s + np.arange(first, min(first + every, total)) / rate_hz
        position = true_positions(motion, markers.skin, time)
        position[..., 0] -= motion.belt_way_m(time)[:, None]
        position += errors.noise_m * rng.standard_normal(position.shape)
        position[lost[first : first + every]] = np.nan
        yield MarkerChunk(first, position)


def true_positions(motion: RunningMotion, skin: SkinPoints, time_s: Array) -> Array:
    """Where points on the skin are in the world (on a treadmill: the frame of the belt).

    Parameters
    ----------
    motion : RunningMotion
        What happens.
    skin : SkinPoints
        The points.
    time_s : ndarray, shape (n,)
        Rising times.

    Returns
    -------
    ndarray, shape (n, n_points, 3)
    """
    out = np.empty((len(time_s), len(skin.rows), 3))
    marker_positions(motion.tables, time_s, skin.rows, skin.points_m, skin.tissue, out)
    return out


def _gaps(
    n_frames: int, n_markers: int, errors: CameraErrors, rng: np.random.Generator
) -> NDArray[np.bool_]:
    """Frames in which each marker is lost, in gaps of geometric length."""
    lost = np.zeros((n_frames, n_markers), dtype=bool)
    shares = rng.uniform(*errors.gap_share, n_markers)
    for marker, share in enumerate(shares):
        n = rng.poisson(share * n_frames / errors.gap_frames)
        begins = rng.integers(0, n_frames, n)
        ends = np.minimum(begins + rng.geometric(1.0 / errors.gap_frames, n), n_frames)
        change = np.zeros(n_frames + 1, dtype=np.int64)
        np.add.at(change, begins, 1)
        np.add.at(change, ends, -1)
        lost[:, marker] = np.cumsum(change)[:-1] > 0
    return lost
