"""Estimates of a running trial in closed form: contacts, angles, footfalls and planar angles known."""

import numpy as np
import xarray as xr

from swaystride.studies.kinematics.plan import ANGLE_NAMES, SIDES, SOURCES

RATE_HZ = 200.0
#: Samples of a stride, and of the first contact of the right foot; the left one is half a stride late.
STRIDE, FIRST = 140, 60
STRIDE_M, WIDTH_M = 2.8, 0.06
#: Toe-off and the middle of the still samples, in shares of the stride.
TOE_OFF, STILL = 0.3, 0.15
TRIOS = tuple(f"{side}_{part}" for part in ("thigh", "shank", "foot") for side in SIDES)


def phases(n_samples):
    """Phase of both feet in strides from their first contact, shape (2, n)."""
    since = np.arange(n_samples) - FIRST
    return np.stack([since, since - STRIDE / 2]) / STRIDE


def foot_signals(phase):
    """Size of acceleration and rate and the pitch rate of a foot with impacts at whole phases."""
    share = phase % 1.0
    to_impact = np.minimum(share, 1.0 - share)
    acc = 15.0 + 100.0 * np.exp(-((to_impact / 0.012) ** 2))
    gyr = 6.0 - 5.5 * np.cos(2 * np.pi * (share - STILL))
    pitch = -8.0 * np.exp(-(((share - TOE_OFF) / 0.06) ** 2))
    return acc, gyr, pitch


def foot_path(phase, side):
    """Path of a foot over the ground that stands from 0 to 0.35 of each stride, shape (3, n)."""
    air = np.clip((phase % 1.0 - 0.35) / 0.6, 0.0, 1.0)
    x = STRIDE_M * (np.floor(phase) + air**2 * (3.0 - 2.0 * air))
    x += 0.0 if side == "right" else 0.5 * STRIDE_M
    y = np.full_like(x, -WIDTH_M / 2 if side == "right" else WIDTH_M / 2)
    return np.stack([x, y, 0.1 * np.sin(np.pi * air)])


def wave_deg(phase, angle, side):
    """An angle: a wave of its own amplitude, offset and phase."""
    a = ANGLE_NAMES.index(angle)
    shift = 0.1 * a + (0.05 if side == "left" else 0.0)
    return 3.0 * a - 5.0 + (10.0 + 5.0 * a) * np.sin(2 * np.pi * (phase + shift))


def estimates(n_strides=20, error=None):
    """A trial; `error` gives what the filter adds, from (phase, angle, side), in degrees."""
    n = FIRST + STRIDE * n_strides + STRIDE
    phase = phases(n)
    acc, gyr, pitch = foot_signals(phase)
    shape = (len(SOURCES), len(SIDES), len(ANGLE_NAMES), n)
    angle_deg = np.empty(shape, dtype=np.float32)
    for s, side in enumerate(SIDES):
        for a, angle in enumerate(ANGLE_NAMES):
            truth = wave_deg(phase[s], angle, side)
            angle_deg[0, s, a] = truth
            angle_deg[1, s, a] = truth if error is None else truth + error(phase[s], angle, side)
    paths = np.stack([foot_path(phase[s], side) for s, side in enumerate(SIDES)])
    share = phase % 1.0
    planar = np.stack([np.full(n, 10.0 + k) for k in range(len(TRIOS))])
    return xr.Dataset(
        {
            "angle_deg": (("source", "side", "angle", "time"), angle_deg),
            "foot_position_m": (
                ("source", "side", "axis", "time"),
                np.stack([paths, paths]).astype(np.float32),
            ),
            "zero_velocity": (("side", "time"), np.abs(share - STILL) <= 2.5 / STRIDE),
            "foot_acc_m_s2": (("side", "time"), acc.astype(np.float32)),
            "foot_gyr_rad_s": (("side", "time"), gyr.astype(np.float32)),
            "foot_pitch_rate_rad_s": (("side", "time"), pitch.astype(np.float32)),
            "planar_angle_deg": (("trio", "time"), planar.astype(np.float32)),
        },
        coords={
            "source": list(SOURCES),
            "side": list(SIDES),
            "angle": list(ANGLE_NAMES),
            "axis": ["x", "y", "z"],
            "trio": list(TRIOS),
            "time": np.arange(n) / RATE_HZ,
        },
        attrs={"rate_hz": RATE_HZ, "belt_speed_m_s": 4.0, "first_usable_s": 0.0},
    )
