"""A rigid chain of seven segments that walks or runs in closed form.

The feet stand still in stance and follow smooth curves in swing, the pelvis moves along sines, and
the knees are where the cosine rule puts them: hinges between thigh and shank, balls at hip and
ankle. Everything is a smooth function of time, so velocities, accelerations and angular rates are
exact to about 1e-9 by central differences of eighth order.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation
from scipy.special import betainc

from swaystride.erkf.body import Body, lower_limb_body
from swaystride.erkf.start import Start, StartUncertainty
from swaystride.recording import make_recording
from swaystride.units import GRAVITY_M_S2

THIGH_M, SHANK_M, ANKLE_HEIGHT_M = 0.46, 0.45, 0.08
#: Columns: anatomical x (forward), y (up), z (right) in a world with x forward, y left, z up.
STANDING = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
FIRST = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0, 4 / 5, -1 / 5, 4 / 105, -1 / 280])
SECOND = np.array([-1 / 560, 8 / 315, -1 / 5, 8 / 5, -205 / 72, 8 / 5, -1 / 5, 8 / 315, -1 / 560])
OFFSET_S = 1e-3


@dataclass(frozen=True)
class Manner:
    """How the chain moves."""

    stride_s: float
    speed_m_s: float
    duty: float
    hip_height_m: float
    bounce_m: float
    lift_m: float


WALKING = Manner(1.15, 1.0, 0.6, 0.84, 0.015, 0.07)
RUNNING = Manner(0.70, 2.5, 0.32, 0.78, 0.035, 0.22)


@dataclass(frozen=True)
class Chain:
    """Signals of seven sensors and the truth about them; the first axis of truth is time."""

    rate_hz: float
    acc: np.ndarray
    gyr: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    rotation: np.ndarray
    angles: np.ndarray
    stance: np.ndarray
    body: Body

    def recording(self):
        return make_recording(
            rate_hz=self.rate_hz,
            rate_source="argument",
            sensors=self.body.segments,
            acc_m_s2=self.acc,
            gyr_rad_s=self.gyr,
        )

    def start(self, uncertainty: StartUncertainty, error_rad=0.0, seed=0, bias=None):
        """True start, turned by random axes of the given angle."""
        axis = np.random.default_rng(seed).normal(size=(7, 3))
        axis *= error_rad / np.linalg.norm(axis, axis=1, keepdims=True)
        turned = Rotation.from_matrix(self.rotation[0]) * Rotation.from_rotvec(axis)
        return Start(
            self.position[0],
            self.velocity[0],
            turned.as_quat(scalar_first=True),
            np.zeros((7, 3)) if bias is None else bias,
            uncertainty,
        )


def foot(time, phase, side, manner):
    """Ankle centre and orientation of a foot, and whether it stands."""
    cycle = time / manner.stride_s + phase
    number, within = np.floor(cycle), cycle - np.floor(cycle)
    u = np.clip((within - manner.duty) / (1.0 - manner.duty), 0.0, 1.0)
    progress = betainc(6.0, 6.0, u)
    stride_m = manner.speed_m_s * manner.stride_s
    bump = (4.0 * u * (1.0 - u)) ** 6
    x = stride_m * (number + progress - phase + 0.5 * manner.duty)
    y = -side * (0.09 - 0.02 * bump)
    z = ANKLE_HEIGHT_M + manner.lift_m * (bump + 0.4 * (4.0 * u * (1.0 - u)) ** 6 * (1 - 2 * u))
    pitch = -(0.9 * bump * (1.0 - u) - 0.5 * bump * u)
    roll, yaw = 0.1 * side * bump, -0.12 * side + 0.15 * side * bump
    turned = Rotation.from_euler("ZXY", np.stack([pitch, roll, -yaw], axis=1)).as_matrix()
    return np.stack([x, y, z], axis=1), STANDING @ turned, within < manner.duty


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def poses(time, manner):
    """Origins (n, 7, 3) and orientations (n, 7, 3, 3) of all segments, stances (2, n)."""
    w = 2.0 * np.pi / manner.stride_s * time
    pelvis = np.stack(
        [
            manner.speed_m_s * time + 0.015 * np.sin(2 * w + 0.7),
            0.02 * np.sin(w + 0.3),
            manner.hip_height_m + 0.08 + manner.bounce_m * np.cos(2 * w + 0.4),
        ],
        axis=1,
    )
    sway = np.stack([0.08 + 0.02 * np.sin(2 * w), 0.07 * np.sin(w + 1), 0.1 * np.sin(w)], axis=1)
    r_pelvis = STANDING @ Rotation.from_euler("ZXY", sway).as_matrix()
    origins, rotations, stances = [pelvis], [r_pelvis], []
    legs = []
    for side, phase in ((1.0, 0.0), (-1.0, 0.5)):
        hip = pelvis + r_pelvis @ np.array([0.0, -0.08, 0.09 * side])
        ankle, r_foot, stance = foot(time, phase, side, manner)
        line = hip - ankle
        reach = np.linalg.norm(line, axis=1, keepdims=True)
        assert (reach < 0.995 * (THIGH_M + SHANK_M)).all(), reach.max()
        up = line / reach
        rotation = 0.1 * side * np.sin(w + phase) + 0.05 * np.sin(2 * w)
        right = r_pelvis @ Rotation.from_euler("Y", rotation[:, None]).as_matrix()
        right = right[:, :, 2]
        z = unit(right - up * np.sum(right * up, axis=1, keepdims=True))
        along = (reach**2 + SHANK_M**2 - THIGH_M**2) / (2.0 * reach)
        knee = ankle + up * along + np.cross(up, z) * np.sqrt(SHANK_M**2 - along**2)
        legs.append((hip, knee, ankle, segment(hip - knee, z), segment(knee - ankle, z), r_foot))
        stances.append(stance)
    for place in range(3):
        origins += [legs[0][place], legs[1][place]]
        rotations += [legs[0][3 + place], legs[1][3 + place]]
    return np.stack(origins, axis=1), np.stack(rotations, axis=1), np.stack(stances)


def segment(y, z):
    y = unit(y)
    return np.stack([np.cross(y, z), y, z], axis=2)


def chain(manner=WALKING, *, duration_s=20.0, rate_hz=100.0, seed=1):
    """Exact signals of the moving chain; `seed` draws where the sensors sit."""
    rng = np.random.default_rng(seed)
    mounting = Rotation.from_rotvec(rng.normal(scale=0.8, size=(7, 3))).as_matrix()
    place = rng.normal(scale=0.03, size=(7, 3))
    place += np.array([[-0.1, 0.05, 0.0]] + [[0.05, -0.2, 0.0]] * 4 + [[0.1, -0.02, 0.0]] * 2)
    time = 0.01 + np.arange(round(duration_s * rate_hz)) / rate_hz

    def sensors(offset):
        origin, r, _ = poses(time + offset, manner)
        return origin + np.einsum("njab,jb->nja", r, place), r @ mounting

    shifts = OFFSET_S * np.arange(-4, 5)
    around = [sensors(shift) for shift in shifts]
    position, rotation = around[4]
    velocity = sum(c * p for c, (p, _) in zip(FIRST, around, strict=True)) / OFFSET_S
    force = sum(c * p for c, (p, _) in zip(SECOND, around, strict=True)) / OFFSET_S**2
    force[..., 2] += GRAVITY_M_S2
    turning = sum(c * r for c, (_, r) in zip(FIRST, around, strict=True)) / OFFSET_S
    skew = np.swapaxes(rotation, 2, 3) @ turning
    gyr = np.stack([skew[..., 2, 1], skew[..., 0, 2], skew[..., 1, 0]], axis=-1)
    acc = np.einsum("njba,njb->nja", rotation, force)
    origin, r_world, stance = poses(time, manner)
    return Chain(
        rate_hz,
        np.ascontiguousarray(acc.transpose(1, 2, 0)),
        np.ascontiguousarray(gyr.transpose(1, 2, 0)),
        position,
        velocity,
        rotation,
        true_angles(r_world),
        stance,
        body_of(origin, r_world, position, rotation, mounting, place),
    )


def true_angles(r):
    """Flexion, adduction and internal rotation of hips, knees and ankles, (n, 6, 3)."""
    pairs = ((0, 1), (0, 2), (1, 3), (2, 4), (3, 5), (4, 6))
    out = []
    for number, (one, two) in enumerate(pairs):
        between = np.swapaxes(r[:, one], 1, 2) @ r[:, two]
        angles = Rotation.from_matrix(between).as_euler("ZXY")
        angles[:, 0] *= -1.0 if number in (2, 3) else 1.0
        angles[:, 1:] *= -1.0 if number % 2 else 1.0
        out.append(angles)
    return np.unwrap(np.stack(out, axis=1), axis=0)


def body_of(origin, r, position, rotation, mounting, place):
    """The body that the filter is told: constants of the chain, seen from its sensors."""
    names = ("right_hip", "left_hip", "right_knee", "left_knee", "right_ankle", "left_ankle")
    pairs = ((0, 1), (0, 2), (1, 3), (2, 4), (3, 5), (4, 6))
    centres = {}
    for name, (one, two) in zip(names, pairs, strict=True):
        centre = origin[0, two]
        centres[name] = tuple(rotation[0, j].T @ (centre - position[0, j]) for j in (one, two))
    axes = {
        name: (mounting[one].T[:, 2], mounting[two].T[:, 2])
        for name, (one, two) in zip(names[2:4], pairs[2:4], strict=True)
    }
    down = {
        foot: mounting[j].T @ (np.array([0.0, -ANKLE_HEIGHT_M, 0.0]) - [0.0, place[j, 1], 0.0])
        for foot, j in (("right_foot", 5), ("left_foot", 6))
    }
    return lower_limb_body(mounting, centres, down, axes=axes)
