"""Joint angles and joint centres from markers, by the conventional gait model or by clusters."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from swaystride.findings import findings_from_json, findings_to_json
from swaystride.lower_limb_joints import ANGLES, JOINT_NAMES, SEGMENTS, lower_limb_angles
from swaystride.marker_recording import MarkerRecording
from swaystride.mocap.anthropometrics import Anthropometrics
from swaystride.mocap.joint_axes import JointAxes
from swaystride.mocap.marker_checks import segment_findings
from swaystride.mocap.marker_set import MarkerSet
from swaystride.mocap.static_calibration import (
    OpticalOptions,
    StaticModel,
    required_static,
    static_model,
)
from swaystride.mocap.technical_frames import trio_angles
from swaystride.recording import AXES, QUATERNION_COMPONENTS
from swaystride.rotations import quaternion_from_matrix

Array = NDArray[np.float64]

#: Where the planar angle of a trio is taken: at its first point (proximal joint centre, toe), which
#: is the reading for the printed numbers [N], at its last, or π minus the angle at the middle one.
VERTICES: Final = ("first", "last", "middle")


def optical_joint_angles(
    recording: MarkerRecording,
    static: MarkerRecording | None,
    body: Anthropometrics,
    *,
    markers: MarkerSet,
    options: OpticalOptions,
    axes: JointAxes | None,
    hip_centres_m: ArrayLike | None = None,
) -> xr.Dataset:
    """Joint angles of pelvis, thighs, shanks and feet.

    Parameters
    ----------
    recording : MarkerRecording
        Clean markers (:func:`swaystride.mocap.marker_cleaning.clean_markers`); world axes, z up.
    static : MarkerRecording or None
        Quiet standing.
    body : Anthropometrics
    markers : MarkerSet
    options : OpticalOptions
    axes : JointAxes or None
        Needed for knee and ankle centres by average axes.
    hip_centres_m : array_like, shape (2, 3), optional
        Hip centres in the pelvis frame instead of Hara et al. (2016).

    Returns
    -------
    xarray.Dataset
        ``joint_angle`` (joint, angle, time) in rad, with the definition and the signs of the
        inertial filter (:mod:`swaystride.lower_limb_joints`): flexion, adduction and internal
        rotation positive on both sides; ``joint_centre`` (joint, axis, time) in m;
        ``orientation`` (segment, component, time), ``q_world_from_segment``; for trios
        ``planar_angle`` (trio, vertex, time) in rad. NaN where a marker is missing. Attributes
        ``rate_hz``, ``findings``.

    Raises
    ------
    RecordingError
        If there is no static trial, a marker is missing throughout, or a length cannot be right.
    """
    model = static_model(
        static, markers, body, options=options, axes=axes, hip_centres_m=hip_centres_m
    )
    found = angles_of(recording, model)
    here = segment_findings(recording, required_static(static), markers)
    before = findings_from_json(recording.attrs["findings"])
    found.attrs["findings"] = findings_to_json([*before, *here])
    return found


def angles_of(recording: MarkerRecording, model: StaticModel) -> xr.Dataset:
    """Joint angles of a calibrated person; see :func:`optical_joint_angles`.

    Parameters
    ----------
    recording : MarkerRecording
    model : StaticModel

    Returns
    -------
    xarray.Dataset
    """
    rotations, centres = segment_poses(recording, model)
    data = {
        "joint_angle": (
            ("joint", "angle", "time"),
            lower_limb_angles(rotations).transpose(1, 2, 0),
        ),
        "joint_centre": (
            ("joint", "axis", "time"),
            np.stack([centres[name].T for name in JOINT_NAMES]),
        ),
        "orientation": (
            ("segment", "component", "time"),
            quaternion_from_matrix(rotations).transpose(1, 2, 0),
        ),
    }
    coords: dict[str, object] = {
        "joint": list(JOINT_NAMES),
        "angle": list(ANGLES),
        "segment": list(SEGMENTS),
        "component": list(QUATERNION_COMPONENTS),
        "axis": list(AXES),
        "time": recording["time"].to_numpy(),
    }
    if model.markers.tracking == "trio":
        trios = trio_angles(recording, model.markers, centres)
        data["planar_angle"] = (("trio", "vertex", "time"), np.stack(list(trios.values())))
        coords |= {"trio": list(trios), "vertex": list(VERTICES)}
    attributes = {
        "rate_hz": float(recording.attrs["rate_hz"]),
        "findings": recording.attrs["findings"],
    }
    return xr.Dataset(data, coords=coords, attrs=attributes)


def segment_poses(recording: MarkerRecording, model: StaticModel) -> tuple[Array, dict[str, Array]]:
    """Anatomical orientations and joint centres.

    Parameters
    ----------
    recording : MarkerRecording
    model : StaticModel

    Returns
    -------
    r_world_from_segment : ndarray, shape (n, 7, 3, 3)
        In the order of ``SEGMENTS``.
    centres_m : dict of str to ndarray, shape (n, 3)
        By joint, carried by the upstream segment.
    """
    centres: dict[str, Array] = {}
    poses = model.technical.poses(recording, model.markers, _carried(model, centres))
    rotations = np.stack(
        [
            poses[segment][0] @ model.r_technical_from_anatomical[row]
            for row, segment in enumerate(SEGMENTS)
        ],
        axis=1,
    )
    return rotations, centres


def _carried(model: StaticModel, centres: dict[str, Array]) -> Callable[[str, Array, Array], Array]:
    """Joint centre from the pose upstream; kept in `centres`."""

    def centre_of(joint: str, rotation: Array, origin: Array) -> Array:
        centres[joint] = origin + rotation @ model.centre_m[joint]
        return centres[joint]

    return centre_of
