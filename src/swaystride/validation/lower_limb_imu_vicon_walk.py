"""Joint angles of the error-state filter against Vicon, in one walking trial.

Four estimates, each compared after one constant per angle has been removed:

* ``vqf_optical`` (the baseline): orientation of every sensor by VQF without magnetometer, with the
  constant heading and mounting that fit the optical segment best (in sample);
* ``vqf_imu_only``: orientation of every sensor by VQF without magnetometer, mounting
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

from swaystride.erkf.alignment import level_mounting
from swaystride.erkf.body import (
    LOWER_LIMB_JOINTS,
    SEGMENTS,
    Body,
    lower_limb_body,
)
from swaystride.erkf.imu_initialisation import (
    MID_SHANK_CENTRES,
    CentreSearch,
    facing_forward,
    imu_centres,
    level_orientations,
    start_at_rest,
)
from swaystride.erkf.joint_centres import lever_matrices
from swaystride.erkf.lower_limbs import ANGLES, estimate_lower_limbs
from swaystride.erkf.noise import NoiseSet
from swaystride.erkf.options import FilterOptions
from swaystride.erkf.start import START_AT_REST, START_IN_MOTION, Start
from swaystride.gait.foot_methods import RECOMMENDED
from swaystride.gait.zero_velocity import find_zero_velocity
from swaystride.lower_limb_joints import lower_limb_angles
from swaystride.recording import make_recording
from swaystride.rotations import exp_map, quaternion_from_matrix
from swaystride.signals.segment_alignment import standing_vertical, straight_samples
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
#: As in the running study (docs/decisions.md), with a stride of walking.
_SEARCH: Final = CentreSearch(
    cutoff_hz=_MOTION_HZ, rough_sd_m=0.05, pelvis_sd_m=0.02, noise_m_s2=2.0, independent_s=1.1
)
_LEVER_M: Final = 0.08


def walking_errors(
    folder: Path, noise: NoiseSet, options: FilterOptions, *, baselines: bool
) -> pd.DataFrame:
    """Errors of the four estimates.

    Parameters
    ----------
    folder : Path
        Folder of the data set.
    noise : NoiseSet
    options : FilterOptions
    baselines : bool
        Whether VQF, which knows neither noise nor options, is among them.

    Returns
    -------
    DataFrame
        ``estimate``, ``joint``, ``angle``, ``rmsd_deg`` after one constant, ``raw_rmsd_deg``,
        ``r2`` (1 − SSE/SST after one constant), ``rom_deg`` (optical).
    """
    walk = read_walk(folder)
    reference = angles_deg(walk.rotation)
    estimates: dict[str, Array] = {}
    if baselines:
        estimates |= {
            "vqf_optical": vqf_optical_angles(walk),
            "vqf_imu_only": vqf_angles(walk),
        }
    estimates |= {
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


def optical_mounting(rotation: Array, r_world_from_sensor: Array) -> tuple[float, Array]:
    """Constant heading and mounting that fit a sensor to its optical segment best.

    Parameters
    ----------
    rotation, r_world_from_sensor : ndarray, shape (n, 3, 3)

    Returns
    -------
    heading_rad : float
        About the vertical, in front of `r_world_from_sensor`.
    r_anatomical_from_sensor : ndarray, shape (3, 3)
    """
    best, mounting, found_rad = -np.inf, np.eye(3), 0.0
    for heading in np.radians(np.arange(-180.0, 180.0)):
        turned = exp_map([0.0, 0.0, heading]) @ r_world_from_sensor
        mean = np.mean(np.swapaxes(rotation, 1, 2) @ turned, axis=0)
        u, size, v = np.linalg.svd(mean)
        sign = np.sign(np.linalg.det(u @ v))
        # the trace of the best rotation with the mean is largest where the spread is smallest
        if (fit := size[0] + size[1] + sign * size[2]) > best:
            best, found_rad = fit, float(heading)
            mounting = u @ np.diag([1.0, 1.0, sign]) @ v
    return found_rad, np.asarray(mounting)


def vqf_optical_angles(walk: LimbWalk) -> Array:
    """Orientations by VQF alone, each with its best constant heading and mounting (in sample).

    Parameters
    ----------
    walk : LimbWalk

    Returns
    -------
    ndarray, shape (n, 6, 3)
        Degrees.
    """
    by_vqf = level_orientations(walk.acc_m_s2, _unbiased(walk), RATE_HZ)[walk.walking]
    rotation = np.empty_like(by_vqf)
    for j in range(7):
        heading, mounting = optical_mounting(walk.rotation[:, j], by_vqf[:, j])
        rotation[:, j] = exp_map([0.0, 0.0, heading]) @ by_vqf[:, j] @ mounting.T
    return angles_deg(rotation)


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
    by_vqf = level_orientations(acc, gyr, RATE_HZ)
    mounting = np.stack([optical_mounting(walk.rotation[:, j], by_vqf[:, j])[1] for j in range(7)])
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
    standing = walk.acc_m_s2[:, :, _quiet(walk)]
    straight = straight_samples(
        gyr_rad_s[0],
        standing_vertical(standing[0]),
        RATE_HZ,
        cutoff_hz=_TURN_HZ,
        limit_rad_s=_TURN_RAD_S,
    )
    straight[: walk.walking.start] = straight[walk.walking.stop :] = False
    return level_mounting(
        standing,
        gyr_rad_s,
        pelvis_right=_PELVIS_RIGHT,
        rate_hz=RATE_HZ,
        cutoff_hz=_RATE_HZ,
        keep=straight,
    )


def _same_heading(walk: LimbWalk, gyr: Array, mounting: Array) -> Array:
    """Anatomical orientations by VQF, all facing +x in quiet standing."""
    orientation = level_orientations(walk.acc_m_s2, gyr, RATE_HZ)
    return facing_forward(orientation @ np.swapaxes(mounting, 1, 2), _quiet(walk))


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
    own = walk.walking
    fits = imu_centres(
        walk.acc_m_s2[:, :, own],
        gyr[:, :, own],
        mounting,
        RATE_HZ,
        rough=MID_SHANK_CENTRES,
        search=_SEARCH,
    )
    centres = {name: (fit.proximal_m, fit.distal_m) for name, fit in fits.items()}
    acc, gyr = walk.acc_m_s2[:, :, begin : own.stop], gyr[:, :, begin : own.stop]
    zero, levers = _feet(acc, gyr)
    body = lower_limb_body(mounting, centres, levers)
    start = start_at_rest(rotation, body, np.zeros((7, 3)), START_AT_REST)
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
