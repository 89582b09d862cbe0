"""What is compared: nine joint angles on two sides, from markers and from the filter."""

from __future__ import annotations

from typing import Final, NamedTuple

from swaystride.lower_limb_joints import ANGLES, JOINT_NAMES, JointKind, Side

#: Optical system and inertial filter; the order of every axis ``source``.
SOURCES: Final = ("optic", "erkf")
#: Order of the sides in the printed tables.
SIDES: Final[tuple[Side, Side]] = ("right", "left")


class JointAngle(NamedTuple):
    """One angle of a joint: its ``name`` in the tables, ``joint`` and ``angle`` of the definition."""

    name: str
    joint: JointKind
    angle: str


#: All nine, by joint; signs as in :mod:`swaystride.lower_limb_joints`.
JOINT_ANGLES: Final = (
    JointAngle("hip_flexion", "hip", "flexion"),
    JointAngle("hip_adduction", "hip", "adduction"),
    JointAngle("hip_rotation", "hip", "internal_rotation"),
    JointAngle("knee_flexion", "knee", "flexion"),
    JointAngle("knee_adduction", "knee", "adduction"),
    JointAngle("knee_rotation", "knee", "internal_rotation"),
    JointAngle("ankle_dorsiflexion", "ankle", "flexion"),
    JointAngle("ankle_inversion", "ankle", "adduction"),
    JointAngle("ankle_rotation", "ankle", "internal_rotation"),
)
ANGLE_NAMES: Final = tuple(angle.name for angle in JOINT_ANGLES)

#: Angles of the sagittal plane; all others are frontal or transverse.
SAGITTAL_ANGLES: Final = ("hip_flexion", "knee_flexion", "ankle_dorsiflexion")
#: Angles that markers measure well enough to compare with, in the order of Tables 4.3 and 4.5.
RELIABLE_ANGLES: Final = (
    "hip_flexion",
    "knee_flexion",
    "ankle_dorsiflexion",
    "hip_adduction",
    "knee_adduction",
    "hip_rotation",
)
#: Order of Table 4.4.
RANGE_ANGLES: Final = (
    "hip_flexion",
    "knee_flexion",
    "ankle_dorsiflexion",
    "hip_adduction",
    "knee_adduction",
    "ankle_inversion",
    "hip_rotation",
    "knee_rotation",
    "ankle_rotation",
)
#: Angles that markers of the conventional set measure badly (D§4.4.1, Tables 4.4 and 4.8).
POOR_OPTICAL_ANGLES: Final = ("ankle_inversion", "knee_rotation", "ankle_rotation")

#: Measures of a stride on the ground, in the order of Table 4.7, and the features that hold them.
STRIDE_MEASURES: Final = {"stride_length": "stride_length_m", "stride_width": "stride_width_m"}
#: Peaks and the angle at contact, in the order of Table 4.6.
FEATURES: Final = (
    "hip_peak_flexion",
    "hip_peak_extension",
    "knee_peak_flexion_stance",
    "ankle_peak_dorsiflexion",
    "ankle_peak_plantarflexion",
    "ankle_dorsiflexion_at_initial_contact",
)


def places(angle: JointAngle, side: Side) -> tuple[int, int]:
    """Joint and angle of :func:`swaystride.lower_limb_joints.lower_limb_angles`.

    Parameters
    ----------
    angle : JointAngle
    side : {"right", "left"}

    Returns
    -------
    tuple of int
        Indices into its second and third axis.

    Examples
    --------
    >>> places(JOINT_ANGLES[3], "left")
    (3, 0)
    """
    return JOINT_NAMES.index(f"{side}_{angle.joint}"), ANGLES.index(angle.angle)
