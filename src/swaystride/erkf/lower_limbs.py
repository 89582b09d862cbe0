"""From the recording of body-worn sensors to segment orientations and joint angles with their error.

An error-state Kalman filter runs a strapdown solution for every sensor and ties them together: a
foot in contact stands still, two segments share a joint centre and, at a hinge, a joint axis
(methods §1; the constraints stand in :mod:`swaystride.erkf.constraints`).
"""

from __future__ import annotations

from typing import Literal

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from swaystride.erkf.body import Body
from swaystride.erkf.constraints import Constraint, constraints_of
from swaystride.erkf.noise import NoiseSet
from swaystride.erkf.options import FilterOptions
from swaystride.erkf.passes import Estimate, kernel_model, run_passes
from swaystride.erkf.start import Start
from swaystride.errors import RecordingError
from swaystride.lower_limb_joints import ANGLES as ANGLES
from swaystride.recording import AXES, QUATERNION_COMPONENTS, Recording
from swaystride.rotations import quaternion_from_matrix

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


def estimate_lower_limbs(
    recording: Recording,
    body: Body,
    zero_velocity: Flags,
    noise: NoiseSet,
    *,
    start: Start,
    options: FilterOptions,
    method: Literal["filter", "smoother"] = "filter",
    still: Flags | None = None,
) -> xr.Dataset:
    """Orientation of every segment and all joint angles, with their standard deviations.

    Parameters
    ----------
    recording : Recording
        Sensors in the order of ``body.segments``, without missing samples.
    body : Body
    zero_velocity : ndarray of bool, shape (n_feet, n_samples)
        When each foot of ``body.contact_levers_m`` stands still.
    noise : NoiseSet
    start : Start
        State at the first sample.
    options : FilterOptions
    method : {"filter", "smoother"}
        The filter knows the past only, the smoother the whole recording.
    still : ndarray of bool, shape (n_segments, n_samples), optional
        When the accelerometer of a segment shows gravity alone (walking, standing).

    Returns
    -------
    xarray.Dataset
        ``joint_angle`` and ``joint_angle_sd`` (joint, angle, time) in rad, flexion, adduction and
        internal rotation positive on both sides, unwrapped; ``orientation`` (segment, component,
        time), ``q_world_from_segment`` of the anatomical frame; ``sensor_orientation``,
        ``q_world_from_sensor``; ``position`` and ``velocity`` (segment, axis, time) of the sensors;
        ``gyr_bias`` (segment, axis, time) in rad/s; ``due`` and ``refused`` (constraint), the
        samples at which a constraint was there to be used, and those of them at which it did not
        pass the gate. Attributes ``rate_hz``, ``method``.

    Raises
    ------
    RecordingError
        If sensors and segments differ in number, a sample is missing, or flags do not fit.
    """
    rate_hz = float(recording.attrs["rate_hz"])
    signals = _signals(recording, body)
    _check_flags(zero_velocity, len(body.contact_levers_m), signals.shape[0], "zero_velocity")
    if still is not None:
        _check_flags(still, len(body.segments), signals.shape[0], "still")
    constraints, active = constraints_of(body, noise, options, rate_hz, zero_velocity, still)
    model = kernel_model(signals, rate_hz, body, noise, options, constraints, active)
    estimate = run_passes(model, start, options, method)
    due = active.sum(axis=0)
    return _dataset(body, constraints, due, recording, method, estimate)


def _signals(recording: Recording, body: Body) -> Array:
    """Signals sample by sample; a missing one is an error."""
    if recording.sizes["sensor"] != len(body.segments):
        raise RecordingError(
            "one sensor per segment is needed",
            file=recording.attrs.get("source_file") or None,
            expected=", ".join(body.segments),
            found=", ".join(str(name) for name in recording["sensor"].to_numpy()),
        )
    both = np.concatenate([recording["acc"].to_numpy(), recording["gyr"].to_numpy()], axis=1)
    missing = ~np.isfinite(both).all(axis=1)
    if missing.any():
        sensor, sample = np.argwhere(missing)[0]
        raise RecordingError(
            "missing samples",
            file=recording.attrs.get("source_file") or None,
            place=f"sensor {recording['sensor'].to_numpy()[sensor]}, "
            f"t = {sample / recording.attrs['rate_hz']:.2f} s",
            expected="gaps filled, or a part of the recording without gaps",
            found=f"{int(missing[sensor].sum())} missing",
        )
    return np.ascontiguousarray(both.transpose(2, 0, 1))


def _check_flags(flags: Flags, n_rows: int, n_samples: int, name: str) -> None:
    """One row per foot (or segment), one column per sample."""
    if flags.shape != (n_rows, n_samples) or flags.dtype != np.bool_:
        raise RecordingError(
            f"{name} does not fit the recording",
            expected=f"bool ({n_rows}, {n_samples})",
            found=f"{flags.dtype} {flags.shape}",
        )


def _dataset(
    body: Body,
    constraints: list[Constraint],
    due: NDArray[np.int64],
    recording: Recording,
    method: str,
    estimate: Estimate,
) -> xr.Dataset:
    """Signed, unwrapped angles and everything else with names."""
    states, angles = estimate.states, estimate.angles
    for i, joint in enumerate(body.joints):
        angles[:, i, ::2] = np.unwrap(angles[:, i, ::2], axis=0)
        angles[:, i] *= joint.signs
        if joint.neutral_rad is not None:
            angles[:, i] -= joint.neutral_rad
    q_sensor = np.ascontiguousarray(states[:, :, 6:10])
    q_segment = _product(q_sensor, _conjugates(body.r_anatomical_from_sensor))
    labels = [
        f"{type(c).__name__}: {' - '.join(body.segments[j] for j in c.segments)}"
        for c in constraints
    ]
    sd = np.sqrt(np.maximum(estimate.variances, 0.0))
    return xr.Dataset(
        {
            "joint_angle": (("joint", "angle", "time"), angles.transpose(1, 2, 0)),
            "joint_angle_sd": (("joint", "angle", "time"), sd.transpose(1, 2, 0)),
            "orientation": (("segment", "component", "time"), q_segment.transpose(1, 2, 0)),
            "sensor_orientation": (("segment", "component", "time"), q_sensor.transpose(1, 2, 0)),
            "position": (("segment", "axis", "time"), states[:, :, 0:3].transpose(1, 2, 0)),
            "velocity": (("segment", "axis", "time"), states[:, :, 3:6].transpose(1, 2, 0)),
            "gyr_bias": (("segment", "axis", "time"), states[:, :, 10:13].transpose(1, 2, 0)),
            "due": (("constraint",), due),
            "refused": (("constraint",), estimate.refused),
        },
        coords={
            "joint": [joint.name for joint in body.joints],
            "angle": list(ANGLES),
            "segment": list(body.segments),
            "component": list(QUATERNION_COMPONENTS),
            "axis": list(AXES),
            "constraint": labels,
            "time": recording["time"].to_numpy(),
        },
        attrs={"rate_hz": float(recording.attrs["rate_hz"]), "method": method},
    )


def _conjugates(rotations: Array) -> Array:
    """Quaternions of the inverse rotations."""
    return quaternion_from_matrix(rotations) * [1.0, -1.0, -1.0, -1.0]


def _product(left: Array, right: Array) -> Array:
    """Hamilton product along the last axis (hundreds of thousands of them at once)."""
    a, b, c, d = np.moveaxis(left, -1, 0)
    e, f, g, h = np.moveaxis(right, -1, 0)
    parts = (
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    )
    return np.stack(parts, axis=-1)
