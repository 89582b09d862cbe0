"""State at the first sample and how well it is known."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.rotations import matrix_from_quaternion, quaternion_from_matrix
from swaystride.units import RAD_PER_DEG

Array = NDArray[np.float64]


@dataclass(frozen=True)
class StartUncertainty:
    """Standard deviations of the state at the first sample.

    Parameters
    ----------
    position_m, velocity_m_s : float
        Of each component.
    tilt_rad, heading_rad : float
        Of the rotation about each horizontal axis and about the vertical.
    gyr_bias_rad_s : float
        Of each component (twelve states only).
    """

    position_m: float
    velocity_m_s: float
    tilt_rad: float
    heading_rad: float
    gyr_bias_rad_s: float


#: Methods §1.7 (not printed in the dissertation; start in motion: velocity 0.5 m/s) and §1.12.
START_AT_REST: Final = StartUncertainty(
    position_m=0.02,
    velocity_m_s=0.10,
    tilt_rad=3.0 * RAD_PER_DEG,
    heading_rad=5.0 * RAD_PER_DEG,
    gyr_bias_rad_s=0.5 * RAD_PER_DEG,
)
#: As above for a start in mid-run.
START_IN_MOTION: Final = StartUncertainty(
    position_m=0.02,
    velocity_m_s=0.5,
    tilt_rad=3.0 * RAD_PER_DEG,
    heading_rad=5.0 * RAD_PER_DEG,
    gyr_bias_rad_s=0.5 * RAD_PER_DEG,
)


@dataclass(frozen=True, eq=False)
class Start:
    """State of every segment at the first sample.

    Parameters
    ----------
    position_m, velocity_m_s : ndarray, shape (n_segments, 3)
        In the world; on a treadmill in the frame of the belt (methods §1.10).
    q_world_from_sensor : ndarray, shape (n_segments, 4)
        Unit quaternions.
    gyr_bias_rad_s : ndarray, shape (n_segments, 3)
        Subtracted from the gyroscopes; estimated from there on if there are twelve states.
    uncertainty : StartUncertainty
    """

    position_m: Array
    velocity_m_s: Array
    q_world_from_sensor: Array
    gyr_bias_rad_s: Array
    uncertainty: StartUncertainty

    def states(self) -> Array:
        """Nominal states, one row of 13 per segment.

        Raises
        ------
        RecordingError
            If a number is missing or a quaternion has no unit length.
        """
        parts = (
            self.position_m,
            self.velocity_m_s,
            self.q_world_from_sensor,
            self.gyr_bias_rad_s,
        )
        found = np.concatenate(parts, axis=1).astype(np.float64)
        size = np.linalg.norm(self.q_world_from_sensor, axis=1)
        if not np.isfinite(found).all() or not np.allclose(size, 1.0, atol=1e-6):
            raise RecordingError(
                "the start of the filter is incomplete",
                place="first sample",
                expected="finite positions, velocities and unit quaternions",
                found=f"lengths {size.round(6).tolist()}",
            )
        found[:, 6:10] /= size[:, None]
        return found

    def covariance(self, *, with_bias: bool) -> Array:
        """Covariance of the error at the first sample.

        Tilt and heading are about world axes, the error is about sensor axes.

        Parameters
        ----------
        with_bias : bool
            Twelve states per segment instead of nine.
        """
        size = 12 if with_bias else 9
        n = len(self.position_m)
        found = np.zeros((n * size, n * size))
        sd = self.uncertainty
        world = np.diag(np.square([sd.tilt_rad, sd.tilt_rad, sd.heading_rad]))
        rotation = matrix_from_quaternion(self.q_world_from_sensor)
        for j, r in enumerate(rotation):
            own = np.zeros((size, size))
            own[0:3, 0:3] = sd.position_m**2 * np.eye(3)
            own[3:6, 3:6] = sd.velocity_m_s**2 * np.eye(3)
            turned = r.T @ world @ r
            own[6:9, 6:9] = 0.5 * (turned + turned.T)
            if with_bias:
                own[9:12, 9:12] = sd.gyr_bias_rad_s**2 * np.eye(3)
            found[j * size : (j + 1) * size, j * size : (j + 1) * size] = own
        return found


def start_from_poses(
    position_m: Array,
    r_world_from_sensor: Array,
    rate_hz: float,
    uncertainty: StartUncertainty,
    *,
    sample: int = 1,
    frame_velocity_m_s: Array | None = None,
    gyr_bias_rad_s: Array | None = None,
) -> Start:
    """Start from poses that something else measured (an optical system, a simulator).

    Parameters
    ----------
    position_m : ndarray, shape (n_samples, n_segments, 3)
        Sensors in the laboratory, low-passed as needed for the velocity.
    r_world_from_sensor : ndarray, shape (n_samples, n_segments, 3, 3)
        Orientation of the sensors.
    rate_hz : float
        Rate of the poses.
    uncertainty : StartUncertainty
    sample : int
        Sample at which the filter starts; its velocity is the central difference.
    frame_velocity_m_s : ndarray, shape (3,), optional
        Velocity of the laboratory in the frame of the filter: of a treadmill, the belt speed along
        +x (methods §1.10).
    gyr_bias_rad_s : ndarray, shape (n_segments, 3), optional
        By default nil.

    Returns
    -------
    Start

    Raises
    ------
    RecordingError
        If there is no sample to either side.
    """
    if not 0 < sample < len(position_m) - 1:
        raise RecordingError(
            "no central difference at the start",
            expected=f"a sample between 1 and {len(position_m) - 2}",
            found=str(sample),
        )
    velocity = 0.5 * rate_hz * (position_m[sample + 1] - position_m[sample - 1])
    if frame_velocity_m_s is not None:
        velocity = velocity + frame_velocity_m_s
    bias = np.zeros_like(velocity) if gyr_bias_rad_s is None else gyr_bias_rad_s
    return Start(
        position_m[sample],
        velocity,
        quaternion_from_matrix(r_world_from_sensor[sample]),
        bias,
        uncertainty,
    )
