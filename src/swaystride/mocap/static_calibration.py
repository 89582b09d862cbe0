"""Static calibration: how anatomical frames and joint centres sit on what is tracked (methods §5.6)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError
from swaystride.lower_limb_joints import JOINT_NAMES, SEGMENTS, Side
from swaystride.marker_recording import MarkerRecording
from swaystride.mocap.anthropometrics import Anthropometrics
from swaystride.mocap.hip_centre import hara_hip_centres
from swaystride.mocap.joint_axes import JointAxes, axis_bases
from swaystride.mocap.marker_set import SIDES, MarkerSet, points
from swaystride.mocap.segment_frames import across, frame_of, mean_rotation, pelvis_frame, unit
from swaystride.mocap.technical_frames import FrameMethod, TechnicalFrames

Array = NDArray[np.float64]

#: Range (5th to 95th percentile) that a marker may have while its owner stands [N].
_STANDING_RANGE_M: Final = 0.08
_UP: Final = (0.0, 0.0, 1.0)


@dataclass(frozen=True)
class OpticalOptions:
    """Choices where the document is silent or others choose differently.

    Parameters
    ----------
    centres : {"average_axes", "medial_markers"}
        Knee and ankle centres by average joint axes (D§4.3.4.1), or midway between the landmarks.
    frames : {"axes", "least_squares"}
        Technical frames by axes through points, or by a rigid fit; clusters need the fit.
    hara_marker_offset : bool
        See :func:`swaystride.mocap.hip_centre.hara_hip_centres`.
    shank_axis : {"malleoli", "knee"}
        Where right is for a shank: from the malleoli (ISB, methods §5.6), or from the knee as for the
        thigh, the untorsioned tibia of the conventional gait model. Between the two lies the torsion
        of the tibia, about 15°, which turns dorsiflexion into inversion.
    """

    centres: Literal["average_axes", "medial_markers"]
    frames: FrameMethod
    hara_marker_offset: bool
    shank_axis: Literal["malleoli", "knee"]


#: Methods §5.4-5.6: average axes, frames through the trios, offset of the markers [N], malleoli.
PRINTED_OPTIONS: Final = OpticalOptions("average_axes", "axes", True, "malleoli")


@dataclass(frozen=True, eq=False)
class StaticModel:
    """What the static trial says about a person.

    Parameters
    ----------
    markers : MarkerSet
    technical : TechnicalFrames
        How segments are tracked.
    r_technical_from_anatomical : ndarray, shape (7, 3, 3)
        In the order of ``SEGMENTS``.
    centre_m : dict of str to ndarray, shape (3,)
        Joint centres in the technical frame of the upstream segment.
    standing_centre_m : dict of str to ndarray, shape (3,)
        Joint centres in the anatomical frame of the upstream segment (the pelvis: from the middle
        of the anterior spines; others from their proximal joint), for the reader.
    """

    markers: MarkerSet
    technical: TechnicalFrames
    r_technical_from_anatomical: Array
    centre_m: dict[str, Array]
    standing_centre_m: dict[str, Array]


def static_model(
    static: MarkerRecording | None,
    markers: MarkerSet,
    body: Anthropometrics,
    *,
    options: OpticalOptions,
    axes: JointAxes | None,
    hip_centres_m: ArrayLike | None = None,
    shifts_m: dict[str, Array] | None = None,
) -> StaticModel:
    """Calibrate a person in quiet standing.

    Parameters
    ----------
    static : MarkerRecording or None
        Standing; world axes with z up. None is an error that says so.
    markers : MarkerSet
    body : Anthropometrics
    options : OpticalOptions
    axes : JointAxes or None
        Needed for ``centres="average_axes"``.
    hip_centres_m : array_like, shape (2, 3), optional
        Right and left in the pelvis frame from elsewhere (imaging, function) instead of Hara et al.
    shifts_m : dict of str to ndarray, shape (3,), optional
        Shift of joint centres (``right_knee``, …) along (anterior, up, outward) of the upstream
        segment. The mediolateral direction of the frames stays that of the landmarks [N].

    Returns
    -------
    StaticModel

    Raises
    ------
    RecordingError
        If there is no static trial, a marker is missing throughout, the person moves, markers of
        both sides are exchanged, or a measure of the person cannot be right.
    """
    body.check()
    seen = _standing(required_static(static), markers, medial=options.centres == "medial_markers")
    anatomical, centres = _anatomical_frames(seen, markers, body, options, axes, hip_centres_m)
    shifted = dict(centres)
    for name, shift in (shifts_m or {}).items():
        shifted[name] = centres[name] + _outward(name, shift, anatomical)
    if shifts_m:
        anatomical = _turned_frames(anatomical, shifted)
    technical = TechnicalFrames.calibrated(seen, markers, options.frames, shifted)
    turn = np.empty((len(SEGMENTS), 3, 3))
    inside: dict[str, Array] = {}
    poses = technical.poses(seen, markers, lambda name, _rotation, _origin: shifted[name])
    for row, segment in enumerate(SEGMENTS):
        rotation, origin = poses[segment]
        turn[row] = mean_rotation(np.swapaxes(rotation, 1, 2) @ anatomical[segment])
        for name in _joints_below(segment):
            local = np.einsum("nba,nb->na", rotation, shifted[name] - origin)
            inside[name] = np.nanmean(local, axis=0)
    return StaticModel(
        markers, technical, turn, inside, _for_reader(seen, shifted, anatomical, markers)
    )


def required_static(static: MarkerRecording | None) -> MarkerRecording:
    """The static trial, or the error that there is none.

    Parameters
    ----------
    static : MarkerRecording or None

    Raises
    ------
    RecordingError
        If it is None.
    """
    if static is None:
        raise RecordingError(
            "static trial missing",
            expected="a recording of quiet standing with all markers",
            found="none",
        )
    return static


def _standing(static: MarkerRecording, markers: MarkerSet, *, medial: bool) -> MarkerRecording:
    """Frames of the static trial in which all markers are seen, if the person stands in them."""
    names = markers.static_markers(medial=medial)
    position = points(static, names)
    whole = np.isfinite(position).all(axis=(0, 2))
    file = static.attrs["source_file"] or None
    if not whole.any():
        raise RecordingError(
            "no frame of the static trial has all markers", file=file, expected="one", found="none"
        )
    low, high = np.percentile(position[:, whole], [5, 95], axis=1)
    widest = int(np.argmax((high - low).max(axis=1)))
    if (high - low)[widest].max() > _STANDING_RANGE_M:
        raise RecordingError(
            "the static trial is not quiet standing",
            file=file,
            place=names[widest],
            expected=f"markers within {_STANDING_RANGE_M:g} m",
            found=f"{(high - low)[widest].max():.3f} m",
        )
    _check_sides(position[:, whole], names, markers, file)
    return static.isel(time=np.flatnonzero(whole))


def _check_sides(
    position: Array, names: tuple[str, ...], markers: MarkerSet, file: str | None
) -> None:
    """Left and right, front and back where they belong."""
    at = {name: position[row] for row, name in enumerate(names)}
    front, back = (np.stack([at[name] for name in pair]) for pair in (markers.front, markers.back))
    r, _ = pelvis_frame(front, back)
    if np.median(r[:, 2, 1]) < 0.5:
        raise RecordingError(
            "the pelvis is upside down",
            file=file,
            place=", ".join(markers.pelvis),
            expected="z up; spines not exchanged",
            found=f"its y axis {np.degrees(np.arccos(np.median(r[:, 2, 1]))):.0f}° from vertical",
        )
    for side in SIDES:
        heel, toe = markers.leg(side).heel, markers.leg(side).toe
        ahead = np.median(np.sum((at[toe] - at[heel]) * r[:, :, 0], axis=1))
        if ahead < 0:
            raise RecordingError(
                "markers of heel and toe are exchanged",
                file=file,
                place=f"{heel}, {toe}",
                expected="the toe ahead of the heel",
                found=f"{ahead:.3f} m",
            )
    for kind in ("knee", "ankle", "heel", "toe"):
        right, left = (getattr(markers.leg(side), kind) for side in SIDES)
        apart = np.median(np.sum((at[right] - at[left]) * r[:, :, 2], axis=1))
        if apart < 0:
            raise RecordingError(
                "markers of left and right are exchanged",
                file=file,
                place=f"{right}, {left}",
                expected="the right one to the right",
                found=f"{apart:.3f} m",
            )


def _anatomical_frames(
    seen: MarkerRecording,
    markers: MarkerSet,
    body: Anthropometrics,
    options: OpticalOptions,
    axes: JointAxes | None,
    hip_centres_m: ArrayLike | None,
) -> tuple[dict[str, Array], dict[str, Array]]:
    """``r_world_from_anatomical`` of every segment and joint centres, frame by frame."""
    pelvis_points = points(seen, (*markers.front, *markers.back))
    pelvis, origin = pelvis_frame(pelvis_points[:2], pelvis_points[2:])
    hips = hara_hip_centres(body, marker_offset=options.hara_marker_offset)
    if hip_centres_m is not None:
        hips = np.asarray(hip_centres_m, dtype=np.float64)
    frames, centres = {"pelvis": pelvis}, {}
    for row, side in enumerate(SIDES):
        leg = markers.leg(side)
        knee, ankle, heel, toe = points(seen, (leg.knee, leg.ankle, leg.heel, leg.toe))
        leg_m = float(np.median(np.linalg.norm(pelvis_points[row] - ankle, axis=1)))
        body.check_leg(side, leg_m, str(seen.attrs["source_file"]))
        hip = origin + pelvis @ hips[row]
        knee_centre, ankle_centre = _distal_centres(seen, markers, side, body, options, axes)
        right = 1.0 if side == "right" else -1.0
        outward = right * (knee - knee_centre)
        frames[f"{side}_thigh"] = _long_frame(hip - knee_centre, outward)
        if options.shank_axis == "malleoli":
            outward = right * (ankle - ankle_centre)
        frames[f"{side}_shank"] = _long_frame(knee_centre - ankle_centre, outward)
        up = np.broadcast_to(np.array(_UP), heel.shape)
        forward = across(toe - heel, up)
        frames[f"{side}_foot"] = frame_of(forward, up, np.cross(forward, up))
        centres[f"{side}_hip"] = hip
        centres[f"{side}_knee"], centres[f"{side}_ankle"] = knee_centre, ankle_centre
    return frames, centres


def _distal_centres(
    seen: MarkerRecording,
    markers: MarkerSet,
    side: Side,
    body: Anthropometrics,
    options: OpticalOptions,
    axes: JointAxes | None,
) -> tuple[Array, Array]:
    """Knee and ankle centre."""
    leg = markers.leg(side)
    knee, ankle = points(seen, (leg.knee, leg.ankle))
    if options.centres == "medial_markers":
        if leg.knee_medial is None or leg.ankle_medial is None:
            raise RecordingError(
                "no medial landmarks in the marker set", expected="names", found="None"
            )
        medial = points(seen, (leg.knee_medial, leg.ankle_medial))
        return (knee + medial[0]) / 2.0, (ankle + medial[1]) / 2.0
    if axes is None:
        raise RecordingError("average joint axes missing", expected="JointAxes", found="None")
    row = SIDES.index(side)
    knee_basis, ankle_basis = axis_bases(seen, markers, side, axes.recipe)
    knee_m = body.knee_width_m[row] / 2.0 + body.marker_radius_m + body.base_plate_m
    ankle_m = body.ankle_width_m[row] / 2.0 + body.marker_radius_m + body.base_plate_m
    return knee + knee_m * (knee_basis @ axes.knee), ankle + ankle_m * (ankle_basis @ axes.ankle)


def _long_frame(upwards: Array, rightwards: Array) -> Array:
    """Anatomical frame of thigh and shank: y along the bone, z to the right."""
    y = unit(upwards)
    z = across(rightwards, y)
    return frame_of(np.cross(y, z), y, z)


def _outward(joint: str, shift_m: Array, anatomical: dict[str, Array]) -> Array:
    """A shift along (anterior, up, outward) of the upstream segment in the world."""
    side, kind = joint.split("_")
    upstream = {"hip": "pelvis", "knee": f"{side}_thigh", "ankle": f"{side}_shank"}[kind]
    sign = np.array([1.0, 1.0, 1.0 if side == "right" else -1.0])
    return np.asarray(anatomical[upstream] @ (sign * np.asarray(shift_m)))


def _turned_frames(anatomical: dict[str, Array], centres: dict[str, Array]) -> dict[str, Array]:
    """Thighs and shanks along the shifted centres, with the mediolateral direction they had."""
    turned = dict(anatomical)
    for side in SIDES:
        for segment, top, bottom in (("thigh", "hip", "knee"), ("shank", "knee", "ankle")):
            along = centres[f"{side}_{top}"] - centres[f"{side}_{bottom}"]
            name = f"{side}_{segment}"
            turned[name] = _long_frame(along, anatomical[name][..., 2])
    return turned


def _joints_below(segment: str) -> list[str]:
    """Joint centres that a segment carries as the upstream one."""
    if segment == "pelvis":
        return ["right_hip", "left_hip"]
    side, kind = segment.split("_")
    return {"thigh": [f"{side}_knee"], "shank": [f"{side}_ankle"], "foot": []}[kind]


def _for_reader(
    seen: MarkerRecording,
    centres: dict[str, Array],
    anatomical: dict[str, Array],
    markers: MarkerSet,
) -> dict[str, Array]:
    """Centres in the anatomical frame upstream, from the joint (or spines) above."""
    front = points(seen, markers.front)
    found = {}
    for name in JOINT_NAMES:
        side, kind = name.split("_")
        above = {"hip": None, "knee": f"{side}_hip", "ankle": f"{side}_knee"}[kind]
        origin = front.mean(axis=0) if above is None else centres[above]
        upstream = {"hip": "pelvis", "knee": f"{side}_thigh", "ankle": f"{side}_shank"}[kind]
        local = np.einsum("nba,nb->na", anatomical[upstream], centres[name] - origin)
        found[name] = np.nanmean(local, axis=0)
    return found
