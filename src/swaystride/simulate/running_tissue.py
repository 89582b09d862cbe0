"""Soft tissue between bone and skin: what sensors and markers do beyond their segment.

A point moves with the flexion of the neighbouring joints and wobbles after each impact. Half of it
is common to everything on a segment, half is its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.simulate.running_body import SEGMENTS
from swaystride.units import RAD_PER_DEG

Array = NDArray[np.float64]

#: Channels of the kernel that move the tissue of each segment: two joint angles and a wobble.
#: 0-3 hip and knee right, hip and knee left; 4-7 wobbles of thighs and shanks; 8 of the pelvis.
CHANNELS: Final = (
    (0, 2, 8),
    (0, 1, 4),
    (2, 3, 5),
    (0, 1, 6),
    (2, 3, 7),
    (0, 1, 6),
    (2, 3, 7),
    (0, 2, 8),
    (0, 2, 8),
    (2, 0, 8),
    (0, 2, 8),
    (2, 0, 8),
    (0, 2, 8),
)
#: Mean and range of hip flexion, knee flexion and wobble over a usual stride of a runner, to which
#: the sizes belong: rad, rad, and m/s (a wobble of 1 per m/s of velocity at first touch). [N]
_MEAN: Final = {0: 0.45, 1: 0.9, 2: 0.45, 3: 0.9}
_RANGE: Final = {0: 0.95, 1: 1.8, 2: 0.95, 3: 1.8}
_WOBBLE_RANGE: Final = 2.0


@dataclass(frozen=True)
class TissueSize:
    """How far soft tissue goes on one kind of segment.

    Parameters
    ----------
    displacement_m, rotation_rad : float
        Peak to peak over a stride of a usual runner.
    wobble_share : float
        Share that impacts excite.
    """

    displacement_m: float
    rotation_rad: float
    wobble_share: float


@cache
def usual_tissue() -> dict[str, TissueSize]:
    """Sizes by kind of segment, from ``running_tissue.csv`` in this folder."""
    table = pd.read_csv(Path(__file__).with_name("running_tissue.csv"), index_col="segment")
    return {
        str(name): TissueSize(
            float(row["displacement_mm"]) * 1e-3,
            float(row["rotation_deg"]) * RAD_PER_DEG,
            float(row["wobble_share"]),
        )
        for name, row in table.iterrows()
    }


@dataclass(frozen=True)
class SkinPoints:
    """Points on the skin as the kernel wants them.

    Parameters
    ----------
    rows : ndarray of int, shape (n, 4)
        Segment, and three channels that the tissue follows.
    points_m : ndarray, shape (n, 3)
        Places in axes of the segment.
    tissue : ndarray, shape (n, 6, 3)
        Displacements along x, y, z and rotation per unit of each channel (rows 0-3), axis of the
        rotation (row 4), reference of the channels (row 5).
    """

    rows: NDArray[np.int64]
    points_m: Array
    tissue: Array


def skin_points(
    segments: list[int],
    points_m: Array,
    sizes: dict[str, TissueSize],
    common: Array,
    rng: np.random.Generator,
) -> SkinPoints:
    """Points with tissue of their own.

    Parameters
    ----------
    segments : list of int
        Segment of each point.
    points_m : ndarray, shape (n, 3)
        Places in axes of the segments.
    sizes : dict of str to TissueSize
        By kind of segment; an empty dict for points on bone.
    common : ndarray, shape (13, 5, 3)
        What everything on a segment shares, from :func:`common_tissue`.
    rng : numpy.random.Generator
        Source of what is a point's own.

    Returns
    -------
    SkinPoints
    """
    rows = np.array([(s, *CHANNELS[s]) for s in segments], dtype=np.int64)
    tissue = np.zeros((len(segments), 6, 3))
    for tissues, own, segment in zip(
        tissue, rng.standard_normal((len(segments), 5, 3)), segments, strict=True
    ):
        # Equal parts of variance: half the movement is shared.
        mixed = (common[segment] + own) / np.sqrt(2.0)
        tissues[4] = mixed[4] / np.linalg.norm(mixed[4])
        kind = SEGMENTS[segment].removesuffix("_right").removesuffix("_left")
        if kind not in sizes:
            continue
        size = sizes[kind]
        shares = np.array([1 - size.wobble_share, 1 - size.wobble_share, size.wobble_share])
        for column, channel in enumerate(CHANNELS[segment]):
            # Two angles share the slow part; their swings seldom peak together.
            spread = _RANGE.get(channel, _WOBBLE_RANGE) * (1.6 if column < 2 else 1.0)
            direction = mixed[:3, column] / np.linalg.norm(mixed[:3, column])
            tissues[:3, column] = size.displacement_m * shares[column] / spread * direction
            turning = np.tanh(mixed[3, column])
            tissues[3, column] = size.rotation_rad * shares[column] / spread * turning
            tissues[5, column] = _MEAN.get(channel, 0.0)
    return SkinPoints(rows, np.asarray(points_m, dtype=np.float64), tissue)


def common_tissue(rng: np.random.Generator) -> Array:
    """Draw what everything on a segment of one person shares, shape (13, 5, 3).

    Parameters
    ----------
    rng : numpy.random.Generator
        Source.
    """
    return rng.standard_normal((len(SEGMENTS), 5, 3))
