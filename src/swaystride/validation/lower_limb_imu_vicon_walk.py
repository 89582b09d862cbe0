"""Joint angles of the error-state filter against Vicon, in one walking trial.

Three estimates, each compared after one constant per angle has been removed:

* ``vqf_imu_only`` (the baseline): orientation of every sensor by VQF without magnetometer, mounting
  from quiet standing and the main axis of turning, headings set equal in quiet standing;
* ``erkf_optical``: mounting and joint centres from the whole optical trial (in sample), started at
  its first sample;
* ``erkf_imu_only``: everything from the sensors.

Both filters run as smoothers with a named set of noise and options. No number was fitted to this
trial; the sets differ by degrees in hip and knee adduction, so that a choice among them on it would
be a choice in sample. The recommended set was chosen on the simulated running body. Limits: soft tissue, bad markers on the left thigh, an optical
ankle without inversion, one trial.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from vqf import offlineVQF

from swaystride.erkf.alignment import (
    anatomical_frame,
    main_axis,
    pointing_right,
    standing_vertical,
    straight_samples,
)
from swaystride.erkf.body import (
    LOWER_LIMB_JOINTS,
    SEGMENTS,
    Body,
    lower_limb_body,
)
from swaystride.erkf.joint_centres import joint_centre_of, lever_matrices
from swaystride.erkf.lower_limbs import ANGLES, estimate_lower_limbs
from swaystride.erkf.noise import NoiseSet
from swaystride.erkf.options import FilterOptions
from swaystride.erkf.start import START_AT_REST, START_IN_MOTION, Start
from swaystride.gait.foot_methods import RECOMMENDED
from swaystride.gait.zero_velocity import find_zero_velocity
from swaystride.lower_limb_joints import lower_limb_angles
from swaystride.recording import make_recording
from swaystride.rotations import (
    exp_map,
    matrix_from_quaternion,
    quaternion_from_matrix,
)
from swaystride.units import DEG_PER_RAD, GRAVITY_M_S2
from swaystride.validation.lower_limb_walk_recording import (
    RATE_HZ,
    LimbWalk,
    low_passed,
    read_walk,
)

Array = NDArray[np.float64]

_PAIRS: Final = tuple((SEGMENTS.index(p), SEGMENTS.index(d)) for _, _, p, d in LOWER_LIMB_JOINTS)
_QUIET_SAMPLES: Final = 300
#: Low-passes in Hz: optical accelerations and joint centres, rates for the main axis, turns.
_MOTION_HZ, _RATE_HZ, _TURN_HZ, _TURN_RAD_S = 8.0, 15.0, 0.4, 0.3
#: The pelvis sensor sits on the back with x up and z backwards: its -y points right.
_PELVIS_RIGHT: Final = np.array([0.0, -1.0, 0.0])
#: Rough vectors (m) from sensor to joint centre in anatomical axes, right side, for sensors on the
#: sacrum, in the middle of the lateral thigh and medial shank, and on the instep of an adult.
_ROUGH_CENTRES: Final = {
    "hip": ((0.10, -0.07, 0.08), (-0.05, 0.20, -0.08)),
    "knee": ((-0.05, -0.20, -0.08), (-0.05, 0.17, 0.0)),
    "ankle": ((-0.05, -0.22, 0.0), (-0.08, -0.02, 0.0)),
}
_ROUGH_SD_M, _TISSUE_M_S2 = 0.05, 1.0
_LEVER_M: Final = 0.08


def walking_errors(folder: Path, noise: NoiseSet, options: FilterOptions) -> pd.DataFrame:
    """Errors of the three estimates.

    Parameters
    ----------
    folder : Path
        Folder of the data set.
    noise : NoiseSet
    options : FilterOptions

    Returns
    -------
    DataFrame
        ``estimate``, ``joint``, ``angle``, ``rmsd_deg`` after one constant, ``raw_rmsd_deg``,
        ``r2`` (1 − SSE/SST after one constant), ``rom_deg`` (optical).
    """
    walk = read_walk(folder)
    reference = angles_deg(walk.rotation)
    estimates = {
        "vqf_imu_only": vqf_angles(walk),
        "erkf_optical": optical_angles(walk, noise, options),
        "erkf_imu_only": imu_only_angles(walk, noise, options),
    }
    rows = []
    for name, found in estimates.items():
        for i, (kind, side, _, _) in enumerate(LOWER_LIMB_JOINTS):
            for a, angle in enumerate(ANGLES):
                truth = reference[:, i, a]
                error = found[:, i, a] - truth
                spread, total = float(np.var(error)), float(np.var(truth))
                rows.append(
                    {
                        "estimate": name,
                        "joint": f"{side}_{kind}",
                        "angle": angle,
                        "rmsd_deg": np.sqrt(spread),
                        "raw_rmsd_deg": float(np.sqrt(np.mean(error**2))),
                        "r2": 1.0 - spread / total if total > 1e-6 else np.nan,
                        "rom_deg": float(np.ptp(truth)),
                    }
                )
    return pd.DataFrame(rows)


def angles_deg(r_world_from_anatomical: Array) -> Array:
    """Signed, unwrapped joint angles.

    Parameters
    ----------
    r_world_from_anatomical : ndarray, shape (n, 7, 3, 3)

    Returns
    -------
    ndarray, shape (n, 6, 3)
        Degrees.
    """
    return lower_limb_angles(r_world_from_anatomical) * DEG_PER_RAD


def vqf_orientation(acc_m_s2: Array, gyr_rad_s: Array) -> Array:
    """Orientations of all sensors by VQF, arbitrary headings, (n, 7, 3, 3).

    Parameters
    ----------
    acc_m_s2, gyr_rad_s : ndarray, shape (7, 3, n)
    """
    found = [
        offlineVQF(np.ascontiguousarray(g.T), np.ascontiguousarray(a.T), None, 1.0 / RATE_HZ)
        for a, g in zip(acc_m_s2, gyr_rad_s, strict=True)
    ]
    return np.stack([matrix_from_quaternion(one["quat6D"]) for one in found], axis=1)


def optical_mounting(rotation: Array, r_world_from_sensor: Array) -> Array:
    """Constant mounting and heading that fit a sensor to its optical segment best.

    Parameters
    ----------
    rotation, r_world_from_sensor : ndarray, shape (n, 3, 3)

    Returns
    -------
    ndarray, shape (3, 3)
        ``r_anatomical_from_sensor``.
    """
    best, mounting = -np.inf, np.eye(3)
    for heading in np.radians(np.arange(-180.0, 180.0)):
        turned = exp_map([0.0, 0.0, heading]) @ r_world_from_sensor
        mean = np.mean(np.swapaxes(rotation, 1, 2) @ turned, axis=0)
        u, size, v = np.linalg.svd(mean)
        sign = np.sign(np.linalg.det(u @ v))
        # the trace of the best rotation with the mean is largest where the spread is smallest
        if (fit := size[0] + size[1] + sign * size[2]) > best:
            best, mounting = fit, u @ np.diag([1.0, 1.0, sign]) @ v
    return np.asarray(mounting)


def optical_angles(walk: LimbWalk, noise: NoiseSet, options: FilterOptions) -> Array:
    """Smoother with mounting, joint centres and start from the optical trial.

    Parameters
    ----------
    walk : LimbWalk
    noise : NoiseSet
    options : FilterOptions

    Returns
    -------
    ndarray, shape (n, 6, 3)
        Degrees.
    """
    acc, gyr = walk.acc_m_s2[:, :, walk.walking], walk.gyr_rad_s[:, :, walk.walking]
    by_vqf = vqf_orientation(acc, gyr)
    mounting = np.stack([optical_mounting(walk.rotation[:, j], by_vqf[:, j]) for j in range(7)])
    rotation = walk.rotation @ mounting
    centres = {}
    for (one, two), (kind, side, _, _) in zip(_PAIRS, LOWER_LIMB_JOINTS, strict=True):
        name = f"{side}_{kind}"
        centre = walk.centres_m[name]
        centres[name] = (
            _lever_to(centre, rotation[:, one], acc[one], gyr[one]),
            _lever_to(centre, rotation[:, two], acc[two], gyr[two]),
        )
    position, velocity = np.empty((7, 3)), np.empty((7, 3))
    for j in range(7):
        i = next(i for i, pair in enumerate(_PAIRS) if j in pair)
        kind, side, _, _ = LOWER_LIMB_JOINTS[i]
        name = f"{side}_{kind}"
        path = walk.centres_m[name] - rotation[:, j] @ centres[name][_PAIRS[i].index(j)]
        path = low_passed(path.T, _MOTION_HZ).T
        position[j], velocity[j] = path[0], (path[4] - path[0]) * RATE_HZ / 4.0
    zero, levers = _feet(acc, gyr)
    start = Start(
        position, velocity, quaternion_from_matrix(rotation[0]), np.zeros((7, 3)), START_IN_MOTION
    )
    body = lower_limb_body(mounting, centres, levers)
    return _smoothed(acc, gyr, body, zero, start, noise, options)


def _lever_to(centre: Array, rotation: Array, acc: Array, gyr: Array) -> Array:
    """Vector from a sensor to a joint centre: the one that explains the centre's acceleration."""
    path = low_passed(centre.T, _MOTION_HZ)
    force = np.gradient(np.gradient(path, 1.0 / RATE_HZ, axis=1), 1.0 / RATE_HZ, axis=1)
    force[2] += GRAVITY_M_S2
    seen = low_passed(np.einsum("nba,bn->an", rotation, force), _MOTION_HZ)
    k = lever_matrices(low_passed(gyr, _MOTION_HZ), RATE_HZ)
    gap = (seen - low_passed(acc, _MOTION_HZ)).T
    inner = slice(20, -20)
    found = np.linalg.lstsq(k[inner].reshape(-1, 3), gap[inner].reshape(-1), rcond=None)[0]
    return np.asarray(found)


def _quiet(walk: LimbWalk) -> slice:
    """The quietest three seconds before the walk."""
    moving = np.linalg.norm(walk.gyr_rad_s, axis=1).max(axis=0)[: walk.first]
    starts = range(0, walk.first - _QUIET_SAMPLES, 10)
    begin = min(starts, key=lambda k: float(moving[k : k + _QUIET_SAMPLES].max()))
    return slice(begin, begin + _QUIET_SAMPLES)


def imu_mounting(walk: LimbWalk, gyr_rad_s: Array) -> Array:
    """Mounting of all sensors from standing and walking, (7, 3, 3).

    Parameters
    ----------
    walk : LimbWalk
    gyr_rad_s : ndarray, shape (7, 3, n_all)
        Without bias.
    """
    quiet = _quiet(walk)
    up = [standing_vertical(acc[:, quiet]) for acc in walk.acc_m_s2]
    rate = low_passed(gyr_rad_s, _RATE_HZ)
    straight = straight_samples(
        gyr_rad_s[0], up[0], RATE_HZ, cutoff_hz=_TURN_HZ, limit_rad_s=_TURN_RAD_S
    )
    straight[: walk.walking.start] = straight[walk.walking.stop :] = False
    frames = {0: anatomical_frame(up[0], _PELVIS_RIGHT)}
    for shank, others in ((3, (1, 5)), (4, (2, 6))):
        axis = main_axis(rate[shank], up[shank], straight).axis
        right = pointing_right(axis, rate[shank][:, straight], place=SEGMENTS[shank])
        swing = right @ rate[shank][:, straight]
        frames[shank] = anatomical_frame(up[shank], right)
        for j in others:
            axis = main_axis(rate[j], up[j], straight).axis
            own = pointing_right(axis, rate[j][:, straight], shank_rate=swing, place=SEGMENTS[j])
            frames[j] = anatomical_frame(up[j], own)
    return np.stack([frames[j] for j in range(7)])


def _same_heading(walk: LimbWalk, gyr: Array, mounting: Array) -> Array:
    """Anatomical orientations by VQF, all facing +x in quiet standing."""
    rotation = vqf_orientation(walk.acc_m_s2, gyr) @ np.swapaxes(mounting, 1, 2)
    quiet = _quiet(walk)
    forward = rotation[(quiet.start + quiet.stop) // 2, :, :, 0]
    heading = np.arctan2(forward[:, 1], forward[:, 0])
    return np.asarray(exp_map(np.outer(-heading, [0.0, 0.0, 1.0])) @ rotation)


def _unbiased(walk: LimbWalk) -> Array:
    """Gyroscopes without the mean of quiet standing."""
    mean = walk.gyr_rad_s[:, :, _quiet(walk)].mean(axis=2, keepdims=True)
    return np.asarray(walk.gyr_rad_s - mean)


def vqf_angles(walk: LimbWalk) -> Array:
    """The baseline, from the sensors alone.

    Parameters
    ----------
    walk : LimbWalk

    Returns
    -------
    ndarray, shape (n, 6, 3)
        Degrees.
    """
    gyr = _unbiased(walk)
    rotation = _same_heading(walk, gyr, imu_mounting(walk, gyr))
    return angles_deg(rotation)[walk.walking]


def imu_only_angles(walk: LimbWalk, noise: NoiseSet, options: FilterOptions) -> Array:
    """Smoother with everything from the sensors, started in quiet standing.

    Parameters
    ----------
    walk : LimbWalk
    noise : NoiseSet
    options : FilterOptions

    Returns
    -------
    ndarray, shape (n, 6, 3)
        Degrees.
    """
    gyr = _unbiased(walk)
    mounting = imu_mounting(walk, gyr)
    quiet = _quiet(walk)
    begin = (quiet.start + quiet.stop) // 2
    rotation = _same_heading(walk, gyr, mounting)[begin] @ mounting
    centres, position = {}, np.zeros((7, 3))
    own = walk.walking
    for (one, two), (kind, side, _, _) in zip(_PAIRS, LOWER_LIMB_JOINTS, strict=True):
        mirror = np.array([1.0, 1.0, 1.0 if side == "right" else -1.0])
        rough = [np.array(vector) * mirror for vector in _ROUGH_CENTRES[kind]]
        fit = joint_centre_of(
            (walk.acc_m_s2[one][:, own], gyr[one][:, own]),
            (walk.acc_m_s2[two][:, own], gyr[two][:, own]),
            RATE_HZ,
            cutoff_hz=_MOTION_HZ,
            prior_m=(mounting[one].T @ rough[0], mounting[two].T @ rough[1]),
            prior_sd_m=_ROUGH_SD_M,
            noise_m_s2=_TISSUE_M_S2,
        )
        centres[f"{side}_{kind}"] = (fit.proximal_m, fit.distal_m)
        position[two] = (
            position[one] + rotation[one] @ fit.proximal_m - rotation[two] @ fit.distal_m
        )
    acc, gyr = walk.acc_m_s2[:, :, begin : own.stop], gyr[:, :, begin : own.stop]
    zero, levers = _feet(acc, gyr)
    still = np.zeros((7, 3))
    start = Start(position, still, quaternion_from_matrix(rotation), still, START_AT_REST)
    body = lower_limb_body(mounting, centres, levers)
    return _smoothed(acc, gyr, body, zero, start, noise, options)[own.start - begin :]


def _feet(acc: Array, gyr: Array) -> tuple[NDArray[np.bool_], dict[str, Array]]:
    """Zero-velocity flags of both feet, and levers straight down in their stances."""
    flags, levers = [], {}
    for j, name in ((5, "right_foot"), (6, "left_foot")):
        found = find_zero_velocity(acc[j], gyr[j], RATE_HZ, RECOMMENDED)
        flags.append(found.flags)
        levers[name] = -_LEVER_M * standing_vertical(acc[j][:, found.flags])
    return np.stack(flags), levers


def _smoothed(
    acc: Array,
    gyr: Array,
    body: Body,
    zero_velocity: NDArray[np.bool_],
    start: Start,
    noise: NoiseSet,
    options: FilterOptions,
) -> Array:
    """Joint angles of the smoother in degrees, (n, 6, 3)."""
    recording = make_recording(
        rate_hz=RATE_HZ,
        rate_source="argument",
        sensors=SEGMENTS,
        acc_m_s2=acc,
        gyr_rad_s=gyr,
    )
    found = estimate_lower_limbs(
        recording,
        body,
        zero_velocity,
        noise,
        start=start,
        options=options,
        method="smoother",
    )
    angles = found["joint_angle"].transpose("time", "joint", "angle").to_numpy()
    return np.asarray(angles * DEG_PER_RAD)
