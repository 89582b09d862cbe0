"""A person of rigid segments with markers on bone, whose joint angles are known."""

from __future__ import annotations

import numpy as np

from swaystride.lower_limb_joints import LOWER_LIMB_JOINTS, SEGMENTS
from swaystride.marker_recording import MarkerRecording, make_marker_recording
from swaystride.mocap.anthropometrics import Anthropometrics
from swaystride.rotations import matrix_from_cardan_zxy

Array = np.ndarray
RATE_HZ = 200.0
THIGH_M, SHANK_M = 0.43, 0.42
#: Hip centres from the middle of the anterior spines: forward, up, right.
HIPS_M = np.array([[-0.055, -0.079, 0.085], [-0.055, -0.079, -0.085]])
#: Lateral marker to joint centre.
KNEE_OUT_M, ANKLE_OUT_M = 0.06, 0.045
BODY = Anthropometrics(
    (0.92, 0.92),
    (2 * (KNEE_OUT_M - 0.009),) * 2,
    (2 * (ANKLE_OUT_M - 0.009),) * 2,
    marker_radius_m=0.007,
    base_plate_m=0.002,
)


def places() -> dict[str, tuple[str, Array]]:
    """Segment and point of every marker; origins: middle of the spines, proximal joints, ankle."""
    found = {
        "RASI": ("pelvis", np.array([0.0, 0.0, 0.12])),
        "LASI": ("pelvis", np.array([0.0, 0.0, -0.12])),
        "RPSI": ("pelvis", np.array([-0.16, 0.0, 0.045])),
        "LPSI": ("pelvis", np.array([-0.16, 0.0, -0.045])),
    }
    for letter, side, right in (("R", "right", 1.0), ("L", "left", -1.0)):
        points = {
            "THI": ("thigh", (0.01, -0.5 * THIGH_M, 0.085)),
            "KNE": ("thigh", (0.0, -THIGH_M, KNEE_OUT_M)),
            "KNM": ("thigh", (0.0, -THIGH_M, -KNEE_OUT_M)),
            "TIB": ("shank", (0.02, -0.5 * SHANK_M, 0.075)),
            "ANK": ("shank", (0.0, -SHANK_M, ANKLE_OUT_M)),
            "ANM": ("shank", (0.0, -SHANK_M, -ANKLE_OUT_M)),
            "HEE": ("foot", (-0.06, -0.045, 0.0)),
            "TOE": ("foot", (0.145, -0.045, 0.0)),
            "MT5": ("foot", (0.12, -0.05, 0.045)),
        }
        for name, (segment, point) in points.items():
            place = np.array(point) * [1.0, 1.0, right]
            found[letter + name] = (f"{side}_{segment}", place)
    return found


def chain(angles_rad: Array, r_world_from_pelvis: Array, pelvis_m: Array) -> tuple[Array, Array]:
    """Poses of all segments from raw Cardan angles (n, 6, 3), without the signs of the sides."""
    n = len(angles_rad)
    r = np.empty((n, len(SEGMENTS), 3, 3))
    origin = np.empty((n, len(SEGMENTS), 3))
    r[:, 0], origin[:, 0] = r_world_from_pelvis, pelvis_m
    down = {"thigh": THIGH_M, "shank": SHANK_M}
    for row, (kind, side, proximal, distal) in enumerate(LOWER_LIMB_JOINTS):
        above, below = SEGMENTS.index(proximal), SEGMENTS.index(distal)
        r[:, below] = r[:, above] @ matrix_from_cardan_zxy(angles_rad[:, row])
        lever = (
            HIPS_M[0 if side == "right" else 1]
            if kind == "hip"
            else np.array([0.0, -down[proximal.split("_")[1]], 0.0])
        )
        origin[:, below] = origin[:, above] + r[:, above] @ lever
    return r, origin


#: Anatomical axes (x forward, y up, z right) of somebody who faces along x of the world.
UPRIGHT = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


def film(r: Array, origin: Array, name: str = "run.c3d") -> MarkerRecording:
    """Markers of poses, without any error."""
    where = places()
    position = np.stack(
        [
            (origin[:, SEGMENTS.index(s)] + r[:, SEGMENTS.index(s)] @ point).T
            for s, point in where.values()
        ]
    )
    return make_marker_recording(
        position, markers=list(where), rate_hz=RATE_HZ, rate_source="argument", source_file=name
    )


def standing(n: int = 5, heading_rad: float = 0.0) -> MarkerRecording:
    """Neutral standing: all segments upright, feet forward."""
    c, s = np.cos(heading_rad), np.sin(heading_rad)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ UPRIGHT
    r, origin = chain(
        np.zeros((n, 6, 3)), np.tile(turn, (n, 1, 1)), np.tile([0.2, 0.1, 1.0], (n, 1))
    )
    return film(r, origin, "static.c3d")


def moving(n: int = 400) -> tuple[MarkerRecording, Array]:
    """A brisk motion of all joints, and its signed angles (n, 6, 3)."""
    t = np.arange(n) / RATE_HZ
    raw = np.empty((n, 6, 3))
    size = {"hip": (0.6, 0.15, 0.2), "knee": (0.9, 0.1, 0.15), "ankle": (0.4, 0.15, 0.12)}
    for row, (kind, side, _, _) in enumerate(LOWER_LIMB_JOINTS):
        phase = 0.0 if side == "right" else 2.0
        for a in range(3):
            wave = np.sin(2 * np.pi * (1.4 + 0.1 * a) * t + phase + row + a)
            raw[:, row, a] = size[kind][a] * (wave - (1.0 if (kind, a) == ("knee", 0) else 0.0))
    turn = matrix_from_cardan_zxy(
        np.stack([0.1 * np.sin(9 * t), 0.08 * np.cos(9 * t), 0.1 * np.sin(4.5 * t)], axis=1)
    )
    pelvis = np.stack(
        [0.05 * np.sin(9 * t), 0.02 * np.cos(4.5 * t), 1.0 + 0.04 * np.sin(18 * t)], 1
    )
    r, origin = chain(raw, UPRIGHT @ turn, pelvis)
    signs = np.array(
        [
            [-1.0 if kind == "knee" else 1.0, *([1.0, 1.0] if side == "right" else [-1.0, -1.0])]
            for kind, side, _, _ in LOWER_LIMB_JOINTS
        ]
    )
    return film(r, origin), raw * signs
