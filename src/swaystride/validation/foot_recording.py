"""What the public foot recordings have in common: signals, given instants, optical reference."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class FootRecording:
    """One foot of one trial.

    Parameters
    ----------
    dataset, trial, gait : str
        Data set; trial (or foot, where one trial has both); ``run``, ``walk`` or ``other``.
    rate_hz : float
        Sampling rate of the sensor.
    acc_m_s2, gyr_rad_s : array, shape (3, n_samples)
        Proper acceleration and angular rate, sensor z upwards.
    instants_s : array, shape (n_strides + 1,)
        Stance instants that came with the data, in seconds from the first sample.
    reference_m : array, shape (n_strides,)
        Horizontal displacement between these instants by the optical system.
    path_s : array, shape (n_frames,)
        Times of the optical frames, in seconds from the first sample of the sensor.
    path_m : array, shape (2, n_frames)
        Optical path seen from above.
    stored_path_m : array of shape (2, n_samples) or None
        Path that came with the data, seen from above.
    other_references_m : mapping
        Displacements of other markers, by name.
    """

    dataset: str
    trial: str
    gait: str
    rate_hz: float
    acc_m_s2: FloatArray
    gyr_rad_s: FloatArray
    instants_s: FloatArray
    reference_m: FloatArray
    path_s: FloatArray
    path_m: FloatArray
    stored_path_m: FloatArray | None = None
    other_references_m: Mapping[str, FloatArray] = field(default_factory=dict)


def displacements(path_m: ArrayLike, path_s: ArrayLike, instants_s: ArrayLike) -> FloatArray:
    """Straight distance that a point moved between successive instants.

    Parameters
    ----------
    path_m : array_like, shape (n_axes, n_frames)
        Positions; between frames they are interpolated linearly.
    path_s : array_like, shape (n_frames,)
        Times of the frames.
    instants_s : array_like, shape (k,)
        Times, within those of the frames.

    Returns
    -------
    array, shape (k - 1,)

    Examples
    --------
    >>> displacements([[0.0, 3.0, 3.0], [0.0, 4.0, 4.0]], [0.0, 1.0, 2.0], [0.0, 0.5, 2.0])
    array([2.5, 2.5])
    """
    at, frames = (np.asarray(times, dtype=np.float64) for times in (instants_s, path_s))
    path = np.asarray(path_m, dtype=np.float64)
    there = np.stack([np.interp(at, frames, axis) for axis in path])
    return np.asarray(np.linalg.norm(np.diff(there, axis=1), axis=0))


def from_z_down(vectors: ArrayLike) -> FloatArray:
    """Half a turn about x: a frame with z down becomes one with z up, both right-handed.

    Parameters
    ----------
    vectors : array_like, shape (3, n) or (2, n)
        Components along x, y (and z) of the frame with z down.

    Examples
    --------
    >>> from_z_down([[1.0], [2.0], [-9.8]]).ravel().tolist()
    [1.0, -2.0, 9.8]
    """
    turned = np.array(vectors, dtype=np.float64)
    turned[1:] *= -1.0
    return turned


def check_foot_signals(recording: FootRecording, *, file: str) -> None:
    """Refuse signals that no later step could use.

    Parameters
    ----------
    recording : FootRecording
    file : str
        Name for the error line.

    Raises
    ------
    RecordingError
        If a value is missing, an instant lies outside or out of order, or gravity at rest (the
        samples before the first instant) does not point up along the sensor's z within 60°.
    """
    for name, values in (
        ("acceleration", recording.acc_m_s2),
        ("angular rate", recording.gyr_rad_s),
        ("optical reference", recording.reference_m),
    ):
        if not np.all(np.isfinite(values)):
            raise RecordingError(
                "missing values", file=file, place=name, expected="finite numbers", found="NaN"
            )
    instants, duration_s = recording.instants_s, recording.acc_m_s2.shape[1] / recording.rate_hz
    if len(instants) < 2 or np.any(np.diff(instants) <= 0) or instants[0] < 0:
        raise RecordingError(
            "stride instants out of order",
            file=file,
            expected="at least two, increasing, none before the start",
            found=f"{len(instants)} instants",
        )
    if instants[-1] >= duration_s:
        raise RecordingError(
            "a stride instant lies after the end",
            file=file,
            expected=f"below {duration_s:.2f} s",
            found=f"{instants[-1]:.2f} s",
        )
    n_rest = max(1, int(instants[0] * recording.rate_hz))
    up = np.median(recording.acc_m_s2[:, :n_rest], axis=1)
    if up[2] < 0.5 * np.linalg.norm(up):
        raise RecordingError(
            "acceleration at rest does not point up",
            file=file,
            place="before the first stride",
            expected="along +z within 60°",
            found="(" + ", ".join(f"{value:.1f}" for value in up) + ") m/s²",
        )
