"""Mounting, joint centres and start of the filter from an optical system (methods §1.7, §4.6).

The optical system comes in as plain arrays: orientations of the anatomical segments, joint centres
and a marker on the face of every sensor, at the samples of the sensors.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from swaystride.erkf.alignment import level_mounting
from swaystride.erkf.body import LOWER_LIMB_JOINTS, SEGMENTS, centres_in_sensors
from swaystride.erkf.start import Start, StartUncertainty, start_from_poses
from swaystride.errors import RecordingError
from swaystride.rotations import log_map
from swaystride.signals.filters import butterworth_lowpass

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class OpticalPoses:
    """What the optical system saw; NaN where it did not.

    Parameters
    ----------
    r_world_from_segment : ndarray, shape (n_samples, 7, 3, 3)
        Anatomical orientations in the order of ``SEGMENTS``.
    centres_m : dict of str to ndarray, shape (n_samples, 3)
        Joint centres (``right_hip``, …) in the laboratory.
    sensor_position_m : ndarray, shape (n_samples, 7, 3)
        Markers on the faces of the sensors, in the laboratory.
    rate_hz : float
        Sampling rate, that of the sensors.
    """

    r_world_from_segment: Array
    centres_m: dict[str, Array]
    sensor_position_m: Array
    rate_hz: float


def segment_rates(r_world_from_segment: Array, rate_hz: float) -> Array:
    """Angular velocity of segments in their own axes, by central differences.

    Parameters
    ----------
    r_world_from_segment : ndarray, shape (n_samples, n_segments, 3, 3)
    rate_hz : float
        Sampling rate.

    Returns
    -------
    ndarray, shape (n_segments, 3, n_samples)
        rad/s; NaN at both ends and beside missing samples.

    Examples
    --------
    >>> from swaystride.rotations import exp_map
    >>> turning = exp_map(np.outer(np.arange(4) / 100.0, [0.0, 0.0, 2.0]))[:, None]
    >>> segment_rates(turning, 100.0)[0, :, 1].round(6)
    array([0., 0., 2.])
    """
    n, m = r_world_from_segment.shape[:2]
    found = np.full((n, m, 3), np.nan)
    turn = np.swapaxes(r_world_from_segment[:-2], 2, 3) @ r_world_from_segment[2:]
    known = np.isfinite(turn).all(axis=(2, 3))
    inner = found[1:-1]
    inner[known] = 0.5 * rate_hz * log_map(turn[known])
    return np.ascontiguousarray(found.transpose(1, 2, 0))


def mounting_from_static(
    standing_acc_m_s2: Array,
    running_gyr_rad_s: Array,
    r_world_from_segment_standing: Array,
    *,
    pelvis_right: Array,
    rate_hz: float,
    cutoff_hz: float,
) -> Array:
    """Mounting as the dissertation finds it: gravity and main axis for the sensor, markers for the body.

    In standing, the sensor's own orientation in the laboratory follows from gravity and from its
    main axis of turning in running, which is taken to be the mediolateral axis of the laboratory
    (D§4.3.4.2, Fig. 4.6; methods §4.6).

    Parameters
    ----------
    standing_acc_m_s2 : ndarray, shape (7, 3, n)
        In quiet standing.
    running_gyr_rad_s : ndarray, shape (7, 3, m)
        In running.
    r_world_from_segment_standing : ndarray, shape (7, 3, 3)
        Optical orientations in the same standing; the person faces +x of the laboratory.
    pelvis_right : ndarray, shape (3,)
        Axis of the pelvis sensor that is mounted to point right: it has no main axis.
    rate_hz : float
        Sampling rate.
    cutoff_hz : float
        Low-pass before the main axis is sought.

    Returns
    -------
    ndarray, shape (7, 3, 3)
        ``r_anatomical_from_sensor``.

    Raises
    ------
    RecordingError
        If nothing turns.
    """
    frames = level_mounting(
        standing_acc_m_s2,
        running_gyr_rad_s,
        pelvis_right=pelvis_right,
        rate_hz=rate_hz,
        cutoff_hz=cutoff_hz,
    )
    # x forward, y up, z right are x, z, -y of a laboratory whose x is the direction of running
    r_world_from_level = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    r_world_from_sensor = r_world_from_level @ frames
    return np.asarray(np.swapaxes(r_world_from_segment_standing, 1, 2) @ r_world_from_sensor)


def mounting_from_rates(
    r_world_from_segment: Array, gyr_rad_s: Array, *, rate_hz: float, cutoff_hz: float
) -> Array:
    """Constant mounting that fits the angular velocities of sensors and segments best.

    Wahba's problem of the low-passed rates, by singular values; no world frame and no gravity take
    part, so that drift, heading and bias do not matter. For recordings without standing: where there
    is one, :func:`mounting_from_static` is nearer to the truth (docs/decisions.md).

    Parameters
    ----------
    r_world_from_segment : ndarray, shape (n_samples, 7, 3, 3)
        Optical orientations in movement, at the samples of the sensors.
    gyr_rad_s : ndarray, shape (7, 3, n_samples)
        Without bias.
    rate_hz : float
        Sampling rate.
    cutoff_hz : float
        Low-pass of the sensors, that of the markers: orientations come low-passed.

    Returns
    -------
    ndarray, shape (7, 3, 3)
        ``r_anatomical_from_sensor``.

    Raises
    ------
    RecordingError
        If a segment is never seen turning, or about one axis only.
    """
    optical = segment_rates(r_world_from_segment, rate_hz)
    own = butterworth_lowpass(
        gyr_rad_s, cutoff_hz=cutoff_hz, rate_hz=rate_hz, order=2, direction="zero_lag", pad_s=0.5
    )
    found = []
    for j, (one, two) in enumerate(zip(optical, own, strict=True)):
        known = np.isfinite(one).all(axis=0)
        product = one[:, known] @ two[:, known].T
        u, size, v = np.linalg.svd(product)
        # turning about one axis leaves the turn about it open
        if not size[1] > 1e-9 * size[0]:
            raise RecordingError(
                "no turning to find the mounting in", place=SEGMENTS[j], expected="a moving person"
            )
        found.append(u @ np.diag([1.0, 1.0, np.linalg.det(u @ v)]) @ v)
    return np.stack(found)


def sensor_rotations(poses: OpticalPoses, r_anatomical_from_sensor: Array) -> Array:
    """Orientations of the sensors that follow from segments and mounting.

    Parameters
    ----------
    poses : OpticalPoses
    r_anatomical_from_sensor : ndarray, shape (7, 3, 3)

    Returns
    -------
    ndarray, shape (n_samples, 7, 3, 3)
        ``r_world_from_sensor``.
    """
    return np.asarray(poses.r_world_from_segment @ r_anatomical_from_sensor)


def optical_centres(
    poses: OpticalPoses, r_anatomical_from_sensor: Array
) -> dict[str, tuple[Array, Array]]:
    """Joint centres in the frames of both sensors, means over the trial (methods §1.7).

    Parameters
    ----------
    poses : OpticalPoses
    r_anatomical_from_sensor : ndarray, shape (7, 3, 3)

    Returns
    -------
    dict of str to (ndarray, ndarray)
        For :func:`swaystride.erkf.body.lower_limb_body`.

    Raises
    ------
    RecordingError
        If a centre was never seen together with its sensors.
    """
    rotation = sensor_rotations(poses, r_anatomical_from_sensor)
    found = {}
    for kind, side, proximal, distal in LOWER_LIMB_JOINTS:
        name = f"{side}_{kind}"
        one, two = (
            centres_in_sensors(poses.centres_m[name], poses.sensor_position_m[:, j], rotation[:, j])
            for j in (SEGMENTS.index(proximal), SEGMENTS.index(distal))
        )
        if not np.isfinite([one, two]).all():
            raise RecordingError("joint centre and sensor were never seen together", place=name)
        found[name] = (one, two)
    return found


def optical_start(
    poses: OpticalPoses,
    r_anatomical_from_sensor: Array,
    uncertainty: StartUncertainty,
    *,
    belt_speed_m_s: float,
    gyr_bias_rad_s: Array,
    first: int = 1,
) -> tuple[int, Start]:
    """Start at the first sample at which everything is seen.

    Parameters
    ----------
    poses : OpticalPoses
    r_anatomical_from_sensor : ndarray, shape (7, 3, 3)
    uncertainty : StartUncertainty
    belt_speed_m_s : float
        Of the treadmill, whose belt moves to -x: the filter works in the frame of the belt (methods
        §1.10). 0 overground.
    gyr_bias_rad_s : ndarray, shape (7, 3)
    first : int
        First sample that may be used.

    Returns
    -------
    sample : int
        At which the filter starts.
    start : Start

    Raises
    ------
    RecordingError
        If nothing is seen at three samples in a row.
    """
    rotation = sensor_rotations(poses, r_anatomical_from_sensor)
    seen = np.asarray(
        np.isfinite(rotation).all(axis=(1, 2, 3))
        & np.isfinite(poses.sensor_position_m).all(axis=(1, 2))
    )
    whole = seen[:-2] & seen[1:-1] & seen[2:]
    possible = np.flatnonzero(whole) + 1
    possible = possible[possible >= first]
    if not possible.size:
        raise RecordingError(
            "the optical system sees no start",
            expected="three samples with all segments and sensors",
        )
    sample = int(possible[0])
    start = start_from_poses(
        poses.sensor_position_m,
        rotation,
        poses.rate_hz,
        uncertainty,
        sample=sample,
        frame_velocity_m_s=np.array([belt_speed_m_s, 0.0, 0.0]),
        gyr_bias_rad_s=gyr_bias_rad_s,
    )
    return sample, start
