"""Signals that sensors would have given on the real runners of ``running_markers_grf``, from markers.

Nothing is measured by an IMU here: accelerations are second derivatives of marker positions plus
gravity, rates come from the orientation of marker clusters. Skin, shoe and the 150 frames per second
are in them; the noise of an accelerometer and its range are not.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

from swaystride.gait.segment_signals import SegmentSignals
from swaystride.lower_limb_joints import SEGMENTS
from swaystride.marker_recording import MarkerRecording
from swaystride.mocap.marker_cleaning import Cleaning, clean_markers
from swaystride.mocap.marker_gaps import PRINTED_LIMITS
from swaystride.mocap.marker_set import SIDES, points
from swaystride.mocap.optical_angles import segment_poses
from swaystride.mocap.static_calibration import StaticModel, static_model
from swaystride.rotations import log_map
from swaystride.units import GRAVITY_M_S2
from swaystride.validation.running_optical import MEDIAL
from swaystride.validation.running_optical_recording import (
    CLUSTERS,
    RUNS,
    RealRun,
    measured,
    read_markers,
    relabelled,
    runner_file,
)

Array = NDArray[np.float64]

#: Sampling rate of the sensors of the document (§5.3.2).
SENSOR_RATE_HZ: Final = 500.0
#: The markers get the low-pass that the document gives its accelerations (§5.3.4.1), before they are
#: differentiated.
MARKER_CUTOFF_HZ: Final = 60.0
#: The other cut-off that is looked at: that of the contacts from markers alone.
SMOOTH_CUTOFF_HZ: Final = 30.0
#: A quintic spline has a smooth second derivative.
_DEGREE: Final = 5


@dataclass(frozen=True, eq=False)
class MarkerSensors:
    """What sensors on a runner would have recorded, as far as markers tell.

    Parameters
    ----------
    run : RealRun
    segments : dict of str to SegmentSignals
        ``right_foot`` and so on, and ``pelvis``; anatomical axes.
    pitch_rad : dict of str to ndarray, shape (n_samples,)
        Angle of the forward axis of each segment to the ground, up positive: what a camera from the
        side sees, without any integration.
    rate_hz : float
        Samples per second.
    """

    run: RealRun
    segments: dict[str, SegmentSignals]
    pitch_rad: dict[str, Array]
    rate_hz: float


@cache
def marker_sensors(folder: Path, cutoff_hz: float) -> tuple[MarkerSensors, ...]:
    """Sensors on all real runners.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.
    cutoff_hz : float
        Low-pass of the markers.
    """
    return tuple(_sensors(folder, run, cutoff_hz) for run in RUNS)


def _sensors(folder: Path, run: RealRun, cutoff_hz: float) -> MarkerSensors:
    static = read_markers(runner_file(folder, run.static))
    raw = relabelled(read_markers(runner_file(folder, run.markers)), run.exchanged)
    cleaning = Cleaning(PRINTED_LIMITS, cutoff_hz, "fourth_order_twice")
    clean = clean_markers(raw, CLUSTERS, cleaning)
    model = static_model(static, CLUSTERS, measured(static), options=MEDIAL, axes=None)
    return sensors_on(run, clean, model, SENSOR_RATE_HZ)


def sensors_on(
    run: RealRun, recording: MarkerRecording, model: StaticModel, rate_hz: float
) -> MarkerSensors:
    """Sensors in the middle of the markers of every segment, at the sacrum for the pelvis.

    Parameters
    ----------
    run : RealRun
    recording : MarkerRecording
        Clean markers; world axes, z up.
    model : StaticModel
        Of this person.
    rate_hz : float
        Of the sensors.

    Returns
    -------
    MarkerSensors
    """
    frames_hz = float(recording.attrs["rate_hz"])
    rotations, _ = segment_poses(recording, model)
    places: dict[str, tuple[str, ...]] = {"pelvis": model.markers.back}
    for side in SIDES:
        leg = model.markers.leg(side)
        places |= {f"{side}_thigh": leg.thigh, f"{side}_shank": leg.shank, f"{side}_foot": leg.foot}
    segments, pitch = {}, {}
    for row, name in enumerate(SEGMENTS):
        place = points(recording, places[name]).mean(axis=0)
        segments[name] = sensor_signals(place, rotations[:, row], frames_hz, rate_hz)
        pitch[name] = sagittal_angle(rotations[:, row], frames_hz, rate_hz)
    return MarkerSensors(run, segments, pitch, rate_hz)


def sensor_signals(
    position_m: Array, r_world_from_segment: Array, frames_hz: float, rate_hz: float
) -> SegmentSignals:
    """Proper acceleration of a point and angular rate of its segment, in axes of the segment.

    Parameters
    ----------
    position_m : ndarray, shape (n_frames, 3)
        World axes, z up; no gaps.
    r_world_from_segment : ndarray, shape (n_frames, 3, 3)
    frames_hz, rate_hz : float
        Frames per second of the markers, samples per second of the sensor.

    Returns
    -------
    SegmentSignals
        From the first to the last frame; quintic splines join the frames.

    Examples
    --------
    >>> still = sensor_signals(np.zeros((30, 3)), np.tile(np.eye(3), (30, 1, 1)), 150.0, 300.0)
    >>> still.acc_m_s2[:, 0].round(5).tolist(), still.gyr_rad_s.shape
    ([0.0, 0.0, 9.80665], (3, 59))
    """
    frame, time = _times(len(position_m), frames_hz, rate_hz)
    acc = make_interp_spline(frame, position_m, k=_DEGREE)(time, nu=2)
    acc[:, 2] += GRAVITY_M_S2
    turns = np.swapaxes(r_world_from_segment[:-1], 1, 2) @ r_world_from_segment[1:]
    # the mean rate between two frames is that of their middle
    rate = make_interp_spline((frame[1:] + frame[:-1]) / 2.0, log_map(turns) * frames_hz, k=_DEGREE)
    inside = np.clip(time, frame[:2].mean(), frame[-2:].mean())
    attitude = make_interp_spline(frame, r_world_from_segment.reshape(-1, 9), k=_DEGREE)(time)
    in_segment = np.einsum("nij,ni->jn", attitude.reshape(-1, 3, 3), acc)
    return SegmentSignals(in_segment, np.ascontiguousarray(rate(inside).T))


def sagittal_angle(r_world_from_segment: Array, frames_hz: float, rate_hz: float) -> Array:
    """Angle of the forward axis of a segment to the ground, seen from the right side.

    Parameters
    ----------
    r_world_from_segment : ndarray, shape (n_frames, 3, 3)
        Axes of the world: x forward, z up.
    frames_hz, rate_hz : float
        Frames per second of the markers, samples per second of the sensor.

    Returns
    -------
    ndarray, shape (n_samples,)
        rad, unwrapped; up is positive, and so is its rate about the axis to the right.

    Examples
    --------
    >>> turn = np.linspace(0.0, 3.0, 31)
    >>> up = np.zeros((31, 3, 3))
    >>> up[:, 0, 0], up[:, 2, 0] = np.cos(turn), np.sin(turn)
    >>> sagittal_angle(up, 150.0, 300.0)[[0, 1, 60]].round(3).tolist()
    [0.0, 0.05, 3.0]
    """
    frame, time = _times(len(r_world_from_segment), frames_hz, rate_hz)
    angle = np.unwrap(np.arctan2(r_world_from_segment[:, 2, 0], r_world_from_segment[:, 0, 0]))
    return np.asarray(make_interp_spline(frame, angle, k=_DEGREE)(time))


def _times(n_frames: int, frames_hz: float, rate_hz: float) -> tuple[Array, Array]:
    """Times of the frames, and of the samples between the first and the last of them."""
    last = (n_frames - 1) / frames_hz
    return np.arange(n_frames) / frames_hz, np.arange(int(last * rate_hz + 1e-9) + 1) / rate_hz
