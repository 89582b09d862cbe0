"""Joint centres and start of the filter from the sensors alone (methods §1.7, §1.13).

Mounting comes from :func:`swaystride.erkf.alignment.level_mounting`. Orientations come from VQF
without magnetometer; their headings are set equal over the samples in which the person stands, or
on average over strides faces, forward. A walker starts at rest; a runner who is recorded in mid-run
starts with one foot on the ground, and the others move as the rigid chain says.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from vqf import offlineVQF

from swaystride.erkf.body import LOWER_LIMB_JOINTS, SEGMENTS, Body
from swaystride.erkf.joint_centres import JointCentreFit, joint_centre_of
from swaystride.erkf.start import Start, StartUncertainty
from swaystride.errors import RecordingError
from swaystride.rotations import exp_map, matrix_from_quaternion, quaternion_from_matrix

Array = NDArray[np.float64]

#: Rough vectors (m) from sensor to joint centre in anatomical axes of the right side: proximal and
#: distal sensor of each joint. An adult; sensors on sacrum, lateral thigh, shank and instep [N].
RoughCentres = dict[str, tuple[tuple[float, float, float], tuple[float, float, float]]]

#: Shank sensors in the middle of the medial shank, as in the public walking trial.
MID_SHANK_CENTRES: Final[RoughCentres] = {
    "hip": ((0.10, -0.07, 0.08), (-0.05, 0.20, -0.08)),
    "knee": ((-0.05, -0.20, -0.08), (-0.05, 0.17, 0.0)),
    "ankle": ((-0.05, -0.22, 0.0), (-0.08, -0.02, 0.0)),
}
#: Proximal thighs and distal shanks, as in the dissertation (D§4.3.2; methods §9.1 names the places).
DISTAL_SHANK_CENTRES: Final[RoughCentres] = {
    "hip": ((0.10, -0.07, 0.08), (0.0, 0.20, -0.08)),
    "knee": ((0.0, -0.23, -0.08), (-0.02, 0.33, 0.03)),
    "ankle": ((-0.02, -0.10, 0.03), (-0.07, 0.02, 0.0)),
}


@dataclass(frozen=True)
class CentreSearch:
    """How joint centres are sought.

    Parameters
    ----------
    cutoff_hz : float
        Low-pass before rates are differentiated.
    rough_sd_m, pelvis_sd_m : float
        Standard deviation of the rough vectors, and of those in the pelvis: it turns so little that
        movement hardly tells where the hips are.
    noise_m_s2 : float
        Expected residual, soft tissue mainly.
    independent_s : float
        About one stride, see :func:`swaystride.erkf.joint_centres.joint_centre_of`.
    """

    cutoff_hz: float
    rough_sd_m: float
    pelvis_sd_m: float
    noise_m_s2: float
    independent_s: float


def imu_centres(
    acc_m_s2: Array,
    gyr_rad_s: Array,
    r_anatomical_from_sensor: Array,
    rate_hz: float,
    *,
    rough: RoughCentres,
    search: CentreSearch,
) -> dict[str, JointCentreFit]:
    """Joint centres in the frames of both sensors, from walking or running.

    Parameters
    ----------
    acc_m_s2, gyr_rad_s : ndarray, shape (7, 3, n_samples)
        In movement, rates without bias.
    r_anatomical_from_sensor : ndarray, shape (7, 3, 3)
    rate_hz : float
        Sampling rate.
    rough : dict
        Rough vectors of the right side; the left ones are mirrored.
    search : CentreSearch

    Returns
    -------
    dict of str to JointCentreFit
        By joint, for example ``right_hip``.
    """
    found = {}
    for kind, side, proximal, distal in LOWER_LIMB_JOINTS:
        one, two = SEGMENTS.index(proximal), SEGMENTS.index(distal)
        mirror = np.array([1.0, 1.0, 1.0 if side == "right" else -1.0])
        prior = [np.array(vector) * mirror for vector in rough[kind]]
        found[f"{side}_{kind}"] = joint_centre_of(
            (acc_m_s2[one], gyr_rad_s[one]),
            (acc_m_s2[two], gyr_rad_s[two]),
            rate_hz,
            cutoff_hz=search.cutoff_hz,
            prior_m=(
                r_anatomical_from_sensor[one].T @ prior[0],
                r_anatomical_from_sensor[two].T @ prior[1],
            ),
            prior_sd_m=(
                search.pelvis_sd_m if kind == "hip" else search.rough_sd_m,
                search.rough_sd_m,
            ),
            noise_m_s2=search.noise_m_s2,
            independent_s=search.independent_s,
        )
    return found


def level_orientations(acc_m_s2: Array, gyr_rad_s: Array, rate_hz: float) -> Array:
    """Orientations of all sensors by VQF, each with a heading of its own.

    Parameters
    ----------
    acc_m_s2, gyr_rad_s : ndarray, shape (n_sensors, 3, n_samples)
    rate_hz : float
        Sampling rate.

    Returns
    -------
    ndarray, shape (n_samples, n_sensors, 3, 3)
        ``r_world_from_sensor``.

    References
    ----------
    Laidig & Seel (2023), Information Fusion 91, 187-204.
    """
    found = [
        offlineVQF(np.ascontiguousarray(g.T), np.ascontiguousarray(a.T), None, 1.0 / rate_hz)
        for a, g in zip(acc_m_s2, gyr_rad_s, strict=True)
    ]
    return np.stack([matrix_from_quaternion(one["quat6D"]) for one in found], axis=1)


def facing_forward(r_world_from_segment: Array, samples: slice) -> Array:
    """Turn every segment about the vertical so that on average it faces +x.

    Parameters
    ----------
    r_world_from_segment : ndarray, shape (n_samples, n_segments, 3, 3)
        Headings of their own.
    samples : slice
        Over which the mean of the mediolateral axes is taken: quiet standing, or whole strides.

    Returns
    -------
    ndarray, shape (n_samples, n_segments, 3, 3)

    Examples
    --------
    >>> turned = exp_map([0.0, 0.0, 1.0]) @ np.array([[1.0, 0, 0], [0, 0, -1.0], [0, 1.0, 0]])
    >>> facing_forward(turned[None, None], slice(None))[0, 0].round(6) + 0.0
    array([[ 1.,  0.,  0.],
           [ 0.,  0., -1.],
           [ 0.,  1.,  0.]])
    """
    right = r_world_from_segment[samples, :, :2, 2].mean(axis=0)
    # right of a person who faces +x is -y
    heading = np.arctan2(right[:, 0], -right[:, 1])
    return np.asarray(exp_map(np.outer(-heading, [0.0, 0.0, 1.0])) @ r_world_from_segment)


def chain_positions(r_world_from_sensor: Array, body: Body) -> Array:
    """Positions of the sensors that put all joints together, the pelvis at the origin.

    Parameters
    ----------
    r_world_from_sensor : ndarray, shape (7, 3, 3)
    body : Body

    Returns
    -------
    ndarray, shape (7, 3)
    """
    position = np.zeros((len(body.segments), 3))
    for joint in body.joints:
        one, two = body.index(joint.proximal), body.index(joint.distal)
        centre = position[one] + r_world_from_sensor[one] @ joint.proximal_centre_m
        position[two] = centre - r_world_from_sensor[two] @ joint.distal_centre_m
    return position


def chain_velocities(r_world_from_sensor: Array, gyr_rad_s: Array, body: Body, foot: str) -> Array:
    """Velocities of the sensors when the contact point of one foot rests.

    Parameters
    ----------
    r_world_from_sensor : ndarray, shape (7, 3, 3)
    gyr_rad_s : ndarray, shape (7, 3)
        At the same sample.
    body : Body
    foot : str
        The foot on the ground.

    Returns
    -------
    ndarray, shape (7, 3)
    """

    def of_point(segment: int, lever_m: Array) -> Array:
        return np.asarray(r_world_from_sensor[segment] @ np.cross(gyr_rad_s[segment], lever_m))

    # relative to the pelvis first: every joint centre has one velocity
    velocity = np.zeros((len(body.segments), 3))
    for joint in body.joints:
        one, two = body.index(joint.proximal), body.index(joint.distal)
        centre = velocity[one] + of_point(one, joint.proximal_centre_m)
        velocity[two] = centre - of_point(two, joint.distal_centre_m)
    ground = body.index(foot)
    at_contact = velocity[ground] + of_point(ground, body.contact_levers_m[foot])
    return np.asarray(velocity - at_contact)


def start_at_rest(
    r_world_from_sensor: Array, body: Body, gyr_bias_rad_s: Array, uncertainty: StartUncertainty
) -> Start:
    """Start in quiet standing.

    Parameters
    ----------
    r_world_from_sensor : ndarray, shape (7, 3, 3)
        At the sample of the start.
    body : Body
    gyr_bias_rad_s : ndarray, shape (7, 3)
    uncertainty : StartUncertainty

    Returns
    -------
    Start
    """
    position = chain_positions(r_world_from_sensor, body)
    return Start(
        position,
        np.zeros_like(position),
        quaternion_from_matrix(r_world_from_sensor),
        gyr_bias_rad_s,
        uncertainty,
    )


def start_in_stance(
    r_world_from_sensor: Array,
    gyr_rad_s: Array,
    zero_velocity: NDArray[np.bool_],
    body: Body,
    gyr_bias_rad_s: Array,
    uncertainty: StartUncertainty,
) -> tuple[int, Start]:
    """Start in the first stance of a recording that begins in mid-run.

    Parameters
    ----------
    r_world_from_sensor : ndarray, shape (n_samples, 7, 3, 3)
        Of the first seconds, with headings set equal.
    gyr_rad_s : ndarray, shape (7, 3, n_samples)
        Without bias.
    zero_velocity : ndarray of bool, shape (2, n_samples)
        When the feet of ``body.contact_levers_m`` stand.
    body : Body
    gyr_bias_rad_s : ndarray, shape (7, 3)
        Of the state; of what is left in the rates.
    uncertainty : StartUncertainty

    Returns
    -------
    sample : int
        At which the filter starts.
    start : Start

    Raises
    ------
    RecordingError
        If no foot stands in these seconds.
    """
    n = min(len(r_world_from_sensor), zero_velocity.shape[1])
    standing = np.argwhere(zero_velocity[:, :n].T)
    if not standing.size:
        raise RecordingError(
            "no foot on the ground to start from", expected="a stance in the first seconds"
        )
    sample, row = (int(value) for value in standing[0])
    rotation = r_world_from_sensor[sample]
    foot = list(body.contact_levers_m)[row]
    start = Start(
        chain_positions(rotation, body),
        chain_velocities(rotation, gyr_rad_s[:, :, sample], body, foot),
        quaternion_from_matrix(rotation),
        gyr_bias_rad_s,
        uncertainty,
    )
    return sample, start
