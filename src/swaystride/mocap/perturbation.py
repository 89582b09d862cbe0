"""What an error of an estimated joint centre does to the joint angles (methods §5.8)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from swaystride.lower_limb_joints import ANGLES, JOINT_NAMES, JointKind
from swaystride.marker_recording import MarkerRecording
from swaystride.mocap.anthropometrics import Anthropometrics
from swaystride.mocap.joint_axes import FALLBACK_SHIFT_M, JointAxes
from swaystride.mocap.marker_set import SIDES, MarkerSet
from swaystride.mocap.optical_angles import angles_of
from swaystride.mocap.static_calibration import OpticalOptions, static_model
from swaystride.units import DEG_PER_RAD

Array = NDArray[np.float64]

#: Directions of a shift: anterior-posterior, craniocaudal, mediolateral; positive is anterior, up,
#: outward.
DIRECTIONS: Final = ("AP", "CC", "ML")
#: The text speaks of hip and knee, Figure 4.8 of knee and ankle (register I-20): all three.
JOINTS: Final[tuple[JointKind, ...]] = ("hip", "knee", "ankle")


@dataclass(frozen=True)
class Person:
    """Everything that calibrates one person.

    Parameters
    ----------
    static : MarkerRecording
    markers : MarkerSet
    body : Anthropometrics
    options : OpticalOptions
    axes : JointAxes or None
    hip_centres_m : array_like, shape (2, 3), optional
    """

    static: MarkerRecording
    markers: MarkerSet
    body: Anthropometrics
    options: OpticalOptions
    axes: JointAxes | None
    hip_centres_m: ArrayLike | None = None


@dataclass(frozen=True, eq=False)
class ShiftedAngles:
    """Joint angles with one kind of joint centre shifted, mirrored on both legs.

    Parameters
    ----------
    shifted : {"hip", "knee", "ankle"}
    direction : {"AP", "CC", "ML"}
    sign : {1, -1}
    shift_m : dict of str to float
        Signed size by side.
    joint_angle_rad : ndarray, shape (6, 3, n)
        In the order of :data:`swaystride.lower_limb_joints.JOINT_NAMES` and ``ANGLES``.
    """

    shifted: JointKind
    direction: str
    sign: int
    shift_m: dict[str, float]
    joint_angle_rad: Array


def shifted_angles(recording: MarkerRecording, person: Person) -> tuple[Array, list[ShiftedAngles]]:
    """Shift each joint centre to both sides along each axis and compute all angles again.

    Both legs are shifted at once, mirrored. The shift is the standard deviation between people; for
    the hip, and where fewer than five people are at hand, 5 mm [N].

    Parameters
    ----------
    recording : MarkerRecording
        Clean markers, for example of some strides.
    person : Person

    Returns
    -------
    reference_rad : ndarray, shape (6, 3, n)
        Without a shift.
    shifted : list of ShiftedAngles
        Eighteen, by joint, direction and sign (positive first).
    """
    found = []
    for kind in JOINTS:
        for d, direction in enumerate(DIRECTIONS):
            for sign in (1, -1):
                sizes: dict[str, float] = {
                    side: sign * size
                    for side, size in zip(SIDES, _sizes(kind, d, person), strict=True)
                }
                shift = {f"{side}_{kind}": size * np.eye(3)[d] for side, size in sizes.items()}
                angles = _angles(recording, person, shift)
                found.append(ShiftedAngles(kind, direction, sign, sizes, angles))
    return _angles(recording, person, {}), found


def perturbed_angles(recording: MarkerRecording, person: Person) -> pd.DataFrame:
    """What shifted joint centres do to the angles: :func:`shifted_angles` in numbers.

    Parameters
    ----------
    recording : MarkerRecording
        Clean markers, for example of some strides.
    person : Person

    Returns
    -------
    DataFrame
        As :func:`perturbation_table`.
    """
    return perturbation_table(*shifted_angles(recording, person))


def perturbation_table(reference_rad: Array, shifted: list[ShiftedAngles]) -> pd.DataFrame:
    """Offset and change of shape of every angle under every shift.

    Parameters
    ----------
    reference_rad : ndarray, shape (6, 3, n)
    shifted : list of ShiftedAngles
        Both as from :func:`shifted_angles`.

    Returns
    -------
    DataFrame
        ``shifted`` (joint kind), ``direction``, ``shift_m`` (signed), ``joint``, ``angle``,
        ``offset_deg`` (mean change) and ``shape_deg`` (root mean square of the change about its
        mean).
    """
    rows = []
    for one in shifted:
        change = (one.joint_angle_rad - reference_rad) * DEG_PER_RAD
        offset = np.nanmean(change, axis=2)
        shape = np.nanstd(change, axis=2)
        for j, joint in enumerate(JOINT_NAMES):
            for a, angle in enumerate(ANGLES):
                rows.append(
                    {
                        "shifted": one.shifted,
                        "direction": one.direction,
                        "shift_m": one.shift_m[joint.split("_")[0]],
                        "joint": joint,
                        "angle": angle,
                        "offset_deg": float(offset[j, a]),
                        "shape_deg": float(shape[j, a]),
                    }
                )
    return pd.DataFrame(rows)


def _sizes(kind: JointKind, direction: int, person: Person) -> tuple[float, float]:
    """Size of a shift on the right and on the left."""
    if kind == "hip" or person.axes is None:
        return FALLBACK_SHIFT_M, FALLBACK_SHIFT_M
    widths = person.body.knee_width_m if kind == "knee" else person.body.ankle_width_m
    beyond = person.body.marker_radius_m + person.body.base_plate_m
    right, left = (
        float(person.axes.centre_shift_m(kind, width / 2.0 + beyond)[direction]) for width in widths
    )
    return right, left


def _angles(recording: MarkerRecording, person: Person, shifts_m: dict[str, Array]) -> Array:
    """Joint angles (joint, angle, time) with shifted centres."""
    model = static_model(
        person.static,
        person.markers,
        person.body,
        options=person.options,
        axes=person.axes,
        hip_centres_m=person.hip_centres_m,
        shifts_m=shifts_m or None,
    )
    return np.asarray(angles_of(recording, model)["joint_angle"].to_numpy())
