"""The one definition of lower-limb joint angles: segments, joints, order and signs.

Everything that turns segment orientations into joint angles (optical markers, inertial filter,
simulated body) uses these, so that angles from different sources differ by what was measured only.
Segment axes follow the ISB: x anterior, y proximal (up when standing), z to the subject's right on
both sides (methods §0.2, §1.8).
"""

from __future__ import annotations

from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from swaystride.rotations import cardan_zxy_from_matrix

Array = NDArray[np.float64]
JointKind = Literal["hip", "knee", "ankle"]
Side = Literal["right", "left"]

#: Order of segments in every array (methods §0.2).
SEGMENTS: Final = (
    "pelvis",
    "right_thigh",
    "left_thigh",
    "right_shank",
    "left_shank",
    "right_foot",
    "left_foot",
)
#: Kind, side, proximal and distal segment of the six joints of the lower limbs.
LOWER_LIMB_JOINTS: Final[tuple[tuple[JointKind, Side, str, str], ...]] = (
    ("hip", "right", "pelvis", "right_thigh"),
    ("hip", "left", "pelvis", "left_thigh"),
    ("knee", "right", "right_thigh", "right_shank"),
    ("knee", "left", "left_thigh", "left_shank"),
    ("ankle", "right", "right_shank", "right_foot"),
    ("ankle", "left", "left_shank", "left_foot"),
)
#: Names of the joints in the same order, for example ``right_hip``.
JOINT_NAMES: Final = tuple(f"{side}_{kind}" for kind, side, _, _ in LOWER_LIMB_JOINTS)
#: Names of the three angles of a joint; at the ankle dorsiflexion, inversion, internal rotation.
ANGLES: Final = ("flexion", "adduction", "internal_rotation")
#: Factors on alpha, beta, gamma of the Cardan sequence Z-X'-Y'' with z to the right on both sides,
#: so that flexion (dorsiflexion), adduction (inversion) and internal rotation are positive
#: (methods §1.8).
ANGLE_SIGNS: Final[dict[tuple[JointKind, Side], tuple[float, float, float]]] = {
    ("hip", "right"): (1.0, 1.0, 1.0),
    ("hip", "left"): (1.0, -1.0, -1.0),
    ("knee", "right"): (-1.0, 1.0, 1.0),
    ("knee", "left"): (-1.0, -1.0, -1.0),
    ("ankle", "right"): (1.0, 1.0, 1.0),
    ("ankle", "left"): (1.0, -1.0, -1.0),
}


def lower_limb_angles(r_world_from_segment: Array) -> Array:
    """Signed joint angles of the lower limbs.

    Parameters
    ----------
    r_world_from_segment : ndarray, shape (n, 7, 3, 3)
        Orientations of the anatomical frames in the order of :data:`SEGMENTS`; NaN where unknown.

    Returns
    -------
    ndarray, shape (n, 6, 3)
        Radians, joints in the order of :data:`LOWER_LIMB_JOINTS`, angles in that of
        :data:`ANGLES`; flexion and internal rotation unwrapped over the known samples, NaN where
        a segment is unknown.

    Examples
    --------
    >>> from swaystride.rotations import exp_map
    >>> upright = np.tile(np.eye(3), (1, 7, 1, 1))
    >>> upright[0, 3] = exp_map([0.0, 0.0, -0.5])
    >>> lower_limb_angles(upright)[0, JOINT_NAMES.index("right_knee")].round(6) + 0.0
    array([0.5, 0. , 0. ])
    """
    out = np.empty((len(r_world_from_segment), len(LOWER_LIMB_JOINTS), 3))
    for row, (kind, side, proximal, distal) in enumerate(LOWER_LIMB_JOINTS):
        one = r_world_from_segment[:, SEGMENTS.index(proximal)]
        two = r_world_from_segment[:, SEGMENTS.index(distal)]
        angles = cardan_zxy_from_matrix(np.swapaxes(one, 1, 2) @ two)
        known = np.isfinite(angles).all(axis=1)
        angles[known] = np.unwrap(angles[known], axis=0)
        out[:, row] = angles * np.array(ANGLE_SIGNS[kind, side])
    return out
