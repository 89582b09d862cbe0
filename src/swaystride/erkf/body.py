"""The body as the filter sees it: segments with one sensor each, joints between them, feet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.lower_limb_joints import ANGLE_SIGNS as ANGLE_SIGNS
from swaystride.lower_limb_joints import LOWER_LIMB_JOINTS as LOWER_LIMB_JOINTS
from swaystride.lower_limb_joints import SEGMENTS as SEGMENTS
from swaystride.lower_limb_joints import JointKind, Side

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Joint:
    """A joint between two segments.

    Parameters
    ----------
    kind : {"hip", "knee", "ankle"}
        Chooses the noise of its constraints and the signs of its angles.
    side : {"right", "left"}
    proximal, distal : str
        Names of its segments.
    proximal_centre_m, distal_centre_m : ndarray, shape (3,)
        Joint centre in the frames of both sensors.
    proximal_axis, distal_axis : ndarray, shape (3,), optional
        Unit vector of the joint axis in the frames of both sensors; without it there is no
        constraint on the axis.
    neutral_rad : ndarray, shape (3,), optional
        Signed angles that count as zero (the ankle of quiet standing).
    """

    kind: JointKind
    side: Side
    proximal: str
    distal: str
    proximal_centre_m: Array
    distal_centre_m: Array
    proximal_axis: Array | None = None
    distal_axis: Array | None = None
    neutral_rad: Array | None = None

    @property
    def name(self) -> str:
        """Side and kind, for example ``right_knee``."""
        return f"{self.side}_{self.kind}"

    @property
    def signs(self) -> Array:
        """Factors on the three Cardan angles."""
        return np.array(ANGLE_SIGNS[self.kind, self.side])


@dataclass(frozen=True, eq=False)
class Body:
    """Segments, joints and feet of one person in one session.

    Parameters
    ----------
    segments : tuple of str
        Names, in the order of the states.
    r_anatomical_from_sensor : ndarray, shape (n_segments, 3, 3)
        Mounting of the sensors (anatomical: x forward, y up, z right).
    joints : tuple of Joint
        Any number, between any two segments.
    contact_levers_m : dict of str to ndarray, shape (3,)
        The segments that touch the ground, each with the vector from its sensor to the contact
        point, in the frame of the sensor. Their keys are the feet of `zero_velocity`.
    """

    segments: tuple[str, ...]
    r_anatomical_from_sensor: Array
    joints: tuple[Joint, ...]
    contact_levers_m: dict[str, Array]

    def index(self, segment: str) -> int:
        """Position of a segment.

        Parameters
        ----------
        segment : str
            Its name.

        Raises
        ------
        RecordingError
            If the body has no such segment.
        """
        if segment not in self.segments:
            raise RecordingError(
                "unknown segment", expected=", ".join(self.segments), found=segment
            )
        return self.segments.index(segment)


def lower_limb_body(
    r_anatomical_from_sensor: Array,
    centres_m: dict[str, tuple[Array, Array]],
    contact_levers_m: dict[str, Array],
    *,
    axes: dict[str, tuple[Array, Array]] | None = None,
    neutral_rad: dict[str, Array] | None = None,
) -> Body:
    """Body of seven segments and six joints.

    Parameters
    ----------
    r_anatomical_from_sensor : ndarray, shape (7, 3, 3)
        In the order of :data:`SEGMENTS`.
    centres_m : dict of str to (ndarray, ndarray)
        For ``right_hip``, … the centre in the frames of the proximal and the distal sensor.
    contact_levers_m : dict of str to ndarray
        For ``right_foot`` and ``left_foot``.
    axes : dict of str to (ndarray, ndarray), optional
        Joint axes in both sensor frames. By default, for hips and knees, the anatomical z axis of
        each segment (methods §1.7).
    neutral_rad : dict of str to ndarray, optional
        Signed angles that count as zero.

    Returns
    -------
    Body
    """
    joints = []
    for kind, side, proximal, distal in LOWER_LIMB_JOINTS:
        name = f"{side}_{kind}"
        pair: tuple[Array | None, Array | None] = (None, None)
        if axes is not None:
            pair = axes.get(name, pair)
        elif kind != "ankle":
            # r_anatomical_from_sensor.T @ e_z: the third row
            pair = (
                r_anatomical_from_sensor[SEGMENTS.index(proximal), 2],
                r_anatomical_from_sensor[SEGMENTS.index(distal), 2],
            )
        one, two = centres_m[name]
        neutral = (neutral_rad or {}).get(name)
        joints.append(Joint(kind, side, proximal, distal, one, two, pair[0], pair[1], neutral))
    return Body(SEGMENTS, r_anatomical_from_sensor, tuple(joints), contact_levers_m)


def centres_in_sensors(centre_m: Array, position_m: Array, r_world_from_sensor: Array) -> Array:
    """Vector from a sensor to a joint centre in the frame of the sensor, mean over time.

    Parameters
    ----------
    centre_m : ndarray, shape (n_samples, 3)
        Joint centre in the world.
    position_m : ndarray, shape (n_samples, 3)
        Sensor in the world.
    r_world_from_sensor : ndarray, shape (n_samples, 3, 3)
        Orientation of the sensor.

    Returns
    -------
    ndarray, shape (3,)
        Samples with NaN are left out; NaN if no other is there.
    """
    local = np.einsum("nba,nb->na", r_world_from_sensor, centre_m - position_m)
    known = np.isfinite(local).all(axis=1)
    return np.asarray(local[known].mean(axis=0)) if known.any() else np.full(3, np.nan)
