"""Technical frames: poses of segments from the points that track them (methods §5.6).

Segments are visited from the pelvis downwards, because the joint centre that the upstream segment
carries is a point of the next one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.lower_limb_joints import SEGMENTS
from swaystride.marker_recording import MarkerRecording
from swaystride.mocap.marker_set import SIDES, MarkerSet, points
from swaystride.mocap.segment_frames import pelvis_frame, planar_angles, rigid_fit, trio_frame

Array = NDArray[np.float64]
FrameMethod = Literal["axes", "least_squares"]
Pose = tuple[Array, Array]
#: Joint centre by name, from the pose of the upstream segment.
CentreOf = Callable[[str, Array, Array], Array]

#: Joint at the proximal end of each tracked segment, and the segment upstream.
_UPSTREAM = {
    f"{side}_{segment}": (f"{side}_{joint}", f"{side}_{above}" if above != "pelvis" else above)
    for side in SIDES
    for segment, joint, above in (
        ("thigh", "hip", "pelvis"),
        ("shank", "knee", "thigh"),
        ("foot", "ankle", "shank"),
    )
}


@dataclass(frozen=True, eq=False)
class TechnicalFrames:
    """How the segments of a person are tracked.

    Parameters
    ----------
    method : {"axes", "least_squares"}
        ``axes``: the frame of three points, y through the first and the last, origin at the last.
        ``least_squares``: rigid fit of a template.
    templates_m : dict of str to ndarray, shape (n_points, 3)
        For the fit: the points of each segment; empty otherwise.
    """

    method: FrameMethod
    templates_m: dict[str, Array]

    @staticmethod
    def calibrated(
        static: MarkerRecording,
        markers: MarkerSet,
        method: FrameMethod,
        centres_m: dict[str, Array],
    ) -> TechnicalFrames:
        """Frames of a person from the static trial.

        Parameters
        ----------
        static : MarkerRecording
            All markers in all frames.
        markers : MarkerSet
        method : {"axes", "least_squares"}
        centres_m : dict of str to ndarray, shape (n, 3)
            Joint centres in the static trial.

        Raises
        ------
        RecordingError
            If axes are asked of clusters.
        """
        if method == "axes":
            if markers.tracking == "cluster":
                raise RecordingError(
                    "a cluster has no axes", expected="frames by least squares", found="axes"
                )
            return TechnicalFrames(method, {})
        templates = {}
        for segment in SEGMENTS:
            joint, _ = _UPSTREAM.get(segment, ("", ""))
            tracked = tracking_points(static, markers, segment, centres_m.get(joint))
            rotation, origin, _ = rigid_fit(tracked, tracked[:, 0])
            local = np.einsum("nba,mnb->mna", rotation, tracked - origin).mean(axis=1)
            templates[segment] = local - local.mean(axis=0)
        return TechnicalFrames(method, templates)

    def poses(
        self, recording: MarkerRecording, markers: MarkerSet, centre_of: CentreOf
    ) -> dict[str, Pose]:
        """Technical pose of every segment.

        Parameters
        ----------
        recording : MarkerRecording
        markers : MarkerSet
        centre_of : callable
            ``(joint, r_world_from_technical, origin_m)`` of the upstream segment to the joint
            centre, shape (n, 3).

        Returns
        -------
        dict of str to (ndarray, ndarray)
            ``r_world_from_technical``, shape (n, 3, 3), and origin, shape (n, 3).
        """
        found: dict[str, Pose] = {}
        for segment in sorted(SEGMENTS, key=_depth):
            centre = None
            if segment in _UPSTREAM:
                joint, above = _UPSTREAM[segment]
                centre = centre_of(joint, *found[above])
            tracked = tracking_points(recording, markers, segment, centre)
            found[segment] = self.pose(segment, tracked)
        return found

    def pose(self, segment: str, tracked: Array) -> Pose:
        """Technical pose of one segment.

        Parameters
        ----------
        segment : str
        tracked : ndarray, shape (n_points, n, 3)
            From :func:`tracking_points`.
        """
        if self.method == "least_squares":
            rotation, origin, _ = rigid_fit(tracked, self.templates_m[segment])
            return rotation, origin
        if segment == "pelvis":
            return pelvis_frame(tracked[:2], tracked[2:])
        return trio_frame(*tracked), tracked[-1]


def tracking_points(
    recording: MarkerRecording, markers: MarkerSet, segment: str, centre_m: Array | None
) -> Array:
    """Points that track a segment.

    Parameters
    ----------
    recording : MarkerRecording
    markers : MarkerSet
    segment : str
    centre_m : ndarray, shape (n, 3), or None
        Upstream joint centre; the first point of a trio.

    Returns
    -------
    ndarray, shape (n_points, n, 3)
    """
    if segment == "pelvis":
        return points(recording, (*markers.front, *markers.back))
    side, kind = segment.split("_")
    leg = markers.right if side == "right" else markers.left
    names = {"thigh": leg.thigh, "shank": leg.shank, "foot": leg.foot}[kind]
    seen = points(recording, names)
    if markers.tracking == "trio" and centre_m is not None:
        seen = np.concatenate([centre_m[None], seen])
    return seen


def trio_angles(
    recording: MarkerRecording, markers: MarkerSet, centres_m: dict[str, Array]
) -> dict[str, Array]:
    """Planar angles of the trios (methods §5.7).

    Parameters
    ----------
    recording : MarkerRecording
    markers : MarkerSet
        With trios.
    centres_m : dict of str to ndarray, shape (n, 3)

    Returns
    -------
    dict of str to ndarray, shape (3, n)
        By segment, as from :func:`swaystride.mocap.segment_frames.planar_angles`; the first point of
        thigh and shank is the proximal joint centre, of the foot the toe marker [N].
    """
    found = {}
    for segment, (joint, _) in _UPSTREAM.items():
        first, middle, last = tracking_points(recording, markers, segment, centres_m[joint])
        if segment.endswith("foot"):
            # heel, ankle centre and toe: the small angle is at the toe
            first, middle, last = last, first, middle
        found[segment] = planar_angles(first, middle, last)
    return found


def _depth(segment: str) -> int:
    return ("pelvis", "thigh", "shank", "foot").index(segment.split("_")[-1])
