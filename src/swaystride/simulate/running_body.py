"""Body of a runner: lengths of the segments and where they are joined.

Segment axes follow the ISB: x anterior, y proximal (up when standing), z to the right on both
sides. The origin of the pelvis is midway between the hip centres; every other segment begins at
its proximal joint.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.errors import ConfigurationError
from swaystride.simulate.foot_person import SoleShape
from swaystride.simulate.sole import Sole

Array = NDArray[np.float64]

#: Segments in the order of all arrays; pairs are right, left.
SEGMENTS: Final = (
    "pelvis",
    "thigh_right",
    "thigh_left",
    "shank_right",
    "shank_left",
    "foot_right",
    "foot_left",
    "trunk",
    "head",
    "upper_arm_right",
    "upper_arm_left",
    "forearm_right",
    "forearm_left",
)


@dataclass(frozen=True)
class BodyShares:
    """Lengths as shares of the stature.

    Parameters
    ----------
    thigh, shank : float
        Hip to knee, knee to ankle.
    hip_distance : float
        Between the hip centres.
    lumbar_joint, trunk, neck : float
        From the hips up to the joint of the trunk, on to the base of the neck, on to the head.
    shoulder_distance, shoulder_drop : float
        Between the shoulder joints, and how far they lie below the base of the neck.
    upper_arm, forearm : float
        Shoulder to elbow, elbow to wrist.
    """

    thigh: float
    shank: float
    hip_distance: float
    lumbar_joint: float
    trunk: float
    neck: float
    shoulder_distance: float
    shoulder_drop: float
    upper_arm: float
    forearm: float


@dataclass(frozen=True)
class RunnerBody:
    """Lengths of one runner in m.

    Parameters
    ----------
    height_m, mass_kg : float
        Stature and mass.
    thigh_m, shank_m, hip_distance_m : float
        Legs; right and left are equal.
    lumbar_joint_m, trunk_m, neck_m, shoulder_distance_m, shoulder_drop_m : float
        Trunk.
    upper_arm_m, forearm_m : float
        Arms.
    foot_length_m : float
        Foot.
    sole : Sole
        Sole of both shoes.
    """

    height_m: float
    mass_kg: float
    thigh_m: float
    shank_m: float
    hip_distance_m: float
    lumbar_joint_m: float
    trunk_m: float
    neck_m: float
    shoulder_distance_m: float
    shoulder_drop_m: float
    upper_arm_m: float
    forearm_m: float
    foot_length_m: float
    sole: Sole

    @property
    def leg_m(self) -> float:
        """Thigh and shank."""
        return self.thigh_m + self.shank_m

    def joints_m(self) -> Array:
        """Proximal joint of each segment in the axes of its parent.

        Returns
        -------
        ndarray, shape (13, 3)
            In the order of :data:`SEGMENTS`; zero for pelvis and feet, which have no parent.
        """
        joints = np.zeros((len(SEGMENTS), 3))
        for side, right in ((0, 1.0), (1, -1.0)):
            joints[1 + side] = 0.0, 0.0, right * self.hip_distance_m / 2.0
            joints[3 + side] = 0.0, -self.thigh_m, 0.0
            shoulder_z = right * self.shoulder_distance_m / 2.0
            joints[9 + side] = 0.0, self.trunk_m - self.shoulder_drop_m, shoulder_z
            joints[11 + side] = 0.0, -self.upper_arm_m, 0.0
        joints[7] = 0.0, self.lumbar_joint_m, 0.0
        joints[8] = 0.0, self.trunk_m + self.neck_m, 0.0
        return joints


def runner_body(
    height_m: float,
    mass_kg: float,
    *,
    shares: BodyShares,
    shoe: SoleShape,
    foot_length_m: float | None = None,
) -> RunnerBody:
    """Body of a stature.

    Parameters
    ----------
    height_m, mass_kg : float
        Stature and mass.
    shares : BodyShares
        Lengths over the stature.
    shoe : SoleShape
        Shape of the shod foot.
    foot_length_m : float, optional
        Foot length; by default the usual share of the stature.

    Returns
    -------
    RunnerBody

    Examples
    --------
    >>> body = runner_body(1.72, 70.0, shares=usual_shares(), shoe=usual_shoe())
    >>> round(body.thigh_m, 3), round(body.hip_distance_m, 3)
    (0.43, 0.17)
    """
    length = shoe.foot_length * height_m if foot_length_m is None else foot_length_m
    lengths = {f"{f.name}_m": getattr(shares, f.name) * height_m for f in fields(BodyShares)}
    return RunnerBody(
        height_m=height_m,
        mass_kg=mass_kg,
        foot_length_m=length,
        sole=shoe.sole(length),
        **lengths,
    )


def usual_shares() -> BodyShares:
    """Shares of the stature from ``running_body.csv`` in this folder."""
    table = _table()
    return BodyShares(**{f.name: table[f.name] for f in fields(BodyShares)})


def usual_shoe() -> SoleShape:
    """Shape of the shod foot from ``running_body.csv``, the same for everybody of one size."""
    names = [f.name for f in fields(SoleShape) if f.name != "length_log_sd"]
    table = _table()
    return SoleShape(length_log_sd=0.0, **{name: table[name] for name in names})


@cache
def _table() -> dict[str, float]:
    path = Path(__file__).with_name("running_body.csv")
    table = pd.read_csv(path, index_col="quantity")
    unsourced = table.index[table["source"].isna()]
    if len(unsourced):
        raise ConfigurationError(
            "a row without a source",
            file=path,
            place=str(unsourced[0]),
            expected="where the value comes from",
            found="nothing",
        )
    return {str(name): float(value) for name, value in table["value"].items()}
