"""Inertial sensors: ideal signals on the trunk, and what a real sensor makes of them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.rotations import exp_map
from swaystride.simulate.sampling import anti_alias, quantise
from swaystride.simulate.standing_body import StandingMotion
from swaystride.units import GRAVITY_M_S2, RAD_PER_DEG

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SensorModel:
    """Error model of one type of inertial sensor.

    Parameters
    ----------
    acc_range_m_s2, gyr_range_deg_s : float
        Full scale, ±.
    acc_noise_density_m_s2_rthz, gyr_noise_density_deg_s_rthz : float
        White noise per √Hz; one sample has ``density · √(rate / 2)``.
    acc_bias_sd_m_s2, gyr_bias_sd_deg_s : float
        Standard deviation of the turn-on bias of each axis.
    scale_error : float
        Bound of the (uniform) relative scale error of each axis.
    misalignment_sd_deg : float
        Standard deviation of each axis' tilt towards each of the other two.
    acc_adc_bits, gyr_adc_bits : int
        Bits over the full range.
    bandwidth_hz : float, optional
        Where the anti-alias filter is down by 6 dB; by default half the output rate.
    gyr_g_sensitivity_deg_s_g : float
        Standard deviation of what each axis of the gyroscope shows per g along each axis.
    """

    acc_range_m_s2: float
    gyr_range_deg_s: float
    acc_noise_density_m_s2_rthz: float
    gyr_noise_density_deg_s_rthz: float
    acc_bias_sd_m_s2: float
    gyr_bias_sd_deg_s: float
    scale_error: float
    misalignment_sd_deg: float
    acc_adc_bits: int
    gyr_adc_bits: int
    bandwidth_hz: float | None = None
    gyr_g_sensitivity_deg_s_g: float = 0.0


#: Xsens MTx as in spec §9.1, table "Sensor errors". Ranges, gyro noise and the converter are from
#: the manual [R]; accelerometer noise, biases, scale and misalignment are priors [M].
MTX: Final = SensorModel(
    acc_range_m_s2=50.0,
    gyr_range_deg_s=1200.0,
    acc_noise_density_m_s2_rthz=0.002,
    gyr_noise_density_deg_s_rthz=0.1,
    acc_bias_sd_m_s2=0.02,
    gyr_bias_sd_deg_s=0.5,
    scale_error=0.005,
    misalignment_sd_deg=0.3,
    acc_adc_bits=16,
    gyr_adc_bits=16,
)

#: APDM Opal with its high-range accelerometer, spec §9.1, table "Sensor errors": ranges of Potter et
#: al. 2019, Table 1; the rest are priors [M]. The bandwidth, half the sampling rate, is [N].
OPAL_HIGH_RANGE: Final = SensorModel(
    acc_range_m_s2=200.0 * GRAVITY_M_S2,
    gyr_range_deg_s=2000.0,
    acc_noise_density_m_s2_rthz=5e-3 * GRAVITY_M_S2,
    gyr_noise_density_deg_s_rthz=0.025,
    acc_bias_sd_m_s2=20e-3 * GRAVITY_M_S2,
    gyr_bias_sd_deg_s=0.3,
    scale_error=0.005,
    misalignment_sd_deg=0.3,
    acc_adc_bits=14,
    gyr_adc_bits=16,
    gyr_g_sensitivity_deg_s_g=0.05,
)

#: The custom sensor of Potter et al. 2019, Table 1: ranges. Noise as usual in parts of these ranges
#: [M]; biases, scale, misalignment and g-sensitivity as for the Opal; the bandwidth a quarter of
#: the sampling rate, as such parts filter at their highest output rate [N].
FAST_FOOT_SENSOR: Final = SensorModel(
    acc_range_m_s2=32.0 * GRAVITY_M_S2,
    gyr_range_deg_s=4000.0,
    acc_noise_density_m_s2_rthz=0.3e-3 * GRAVITY_M_S2,
    gyr_noise_density_deg_s_rthz=0.02,
    acc_bias_sd_m_s2=20e-3 * GRAVITY_M_S2,
    gyr_bias_sd_deg_s=0.3,
    scale_error=0.005,
    misalignment_sd_deg=0.3,
    acc_adc_bits=16,
    gyr_adc_bits=16,
    bandwidth_hz=250.0,
    gyr_g_sensitivity_deg_s_g=0.05,
)


#: Sensor models by the name that a configuration gives.
SENSOR_MODELS: Final = {"mtx": MTX}

#: Models of sensors for feet, likewise.
FOOT_SENSOR_MODELS: Final = {
    "opal_high_range": OPAL_HIGH_RANGE,
    "fast_foot_sensor": FAST_FOOT_SENSOR,
}


@dataclass(frozen=True)
class SensorUnit:
    """Constant errors of one sensor on one person for one session.

    Parameters
    ----------
    r_sensor_from_body : ndarray, shape (3, 3)
        Mounting rotation.
    acc_sense, gyr_sense : ndarray, shape (3, 3)
        Scale and misalignment: what the axes sense of a vector in the sensor frame.
    acc_bias_m_s2, gyr_bias_rad_s : ndarray, shape (3,)
        Turn-on biases.
    gyr_per_acc_s_m : ndarray, shape (3, 3), optional
        What the gyroscope shows (rad/s) per acceleration (m/s²) in the sensor frame.
    """

    r_sensor_from_body: Array
    acc_sense: Array
    gyr_sense: Array
    acc_bias_m_s2: Array
    gyr_bias_rad_s: Array
    gyr_per_acc_s_m: Array | None = None


def trunk_signals(motion: StandingMotion, position_m: ArrayLike) -> tuple[Array, Array]:
    """Ideal signals of a sensor fixed to the trunk, in trunk axes (x forward, y left, z up).

    The trunk turns about the ankle as a rigid body, ``r_world_from_trunk = R_y(pitch) R_x(roll)``,
    and the sensor at r moves with it: ``ω = (r', p' cos r, −p' sin r)`` with pitch p and roll r,
    ``a = ω̇ × r + ω × (ω × r) + g u``, where u is the vertical seen from the trunk.

    Parameters
    ----------
    motion : StandingMotion
        Pitch and roll with their derivatives.
    position_m : array_like, shape (3,)
        Position of the sensor from the ankle, in trunk axes.

    Returns
    -------
    acc_m_s2, gyr_rad_s : ndarray, shape (3, n_samples)
        Proper acceleration (at rest up, of size g) and angular velocity.

    Examples
    --------
    >>> still = StandingMotion(100.0, np.zeros((2, 1)), np.zeros((2, 1)), np.zeros((2, 1)))
    >>> acc, gyr = trunk_signals(still, (-0.1, 0.0, 1.0))
    >>> acc.ravel().tolist(), bool(gyr.any())
    ([0.0, 0.0, 9.80665], False)
    """
    pitch, roll = motion.angle_rad
    pitch_rate, roll_rate = motion.velocity_rad_s
    pitch_acc, roll_acc = motion.acceleration_rad_s2
    sine, cosine = np.sin(roll), np.cos(roll)
    gyr = np.stack([roll_rate, pitch_rate * cosine, -pitch_rate * sine])
    turning = np.stack(
        [
            roll_acc,
            pitch_acc * cosine - pitch_rate * roll_rate * sine,
            -pitch_acc * sine - pitch_rate * roll_rate * cosine,
        ]
    )
    up = np.stack([-np.sin(pitch), sine * np.cos(pitch), cosine * np.cos(pitch)])
    position = np.asarray(position_m, dtype=np.float64)[:, None]
    centripetal = gyr * np.sum(gyr * position, axis=0) - position * np.sum(gyr * gyr, axis=0)
    return _cross(turning, position) + centripetal + GRAVITY_M_S2 * up, gyr


def draw_unit(
    model: SensorModel,
    *,
    tilt_sd_deg: float,
    heading_sd_deg: float,
    rng: np.random.Generator,
) -> SensorUnit:
    """Draw the constant errors of one sensor and how it was strapped on.

    Parameters
    ----------
    model : SensorModel
        Sizes of the errors.
    tilt_sd_deg, heading_sd_deg : float
        Standard deviations of the mounting rotation about each horizontal axis, and about the
        vertical.
    rng : numpy.random.Generator
        Source of the numbers.

    Returns
    -------
    SensorUnit

    Examples
    --------
    >>> unit = draw_unit(MTX, tilt_sd_deg=2.0, heading_sd_deg=1.0, rng=np.random.default_rng(1))
    >>> bool(np.allclose(unit.r_sensor_from_body @ unit.r_sensor_from_body.T, np.eye(3)))
    True
    """
    mounting_deg = rng.standard_normal(3) * [tilt_sd_deg, tilt_sd_deg, heading_sd_deg]
    senses = []
    for _ in range(2):
        tilt = model.misalignment_sd_deg * RAD_PER_DEG * rng.standard_normal((3, 3))
        np.fill_diagonal(tilt, 0.0)
        scale = 1.0 + model.scale_error * rng.uniform(-1.0, 1.0, size=3)
        senses.append(scale[:, None] * (np.eye(3) + tilt))
    unit = SensorUnit(
        r_sensor_from_body=exp_map(mounting_deg * RAD_PER_DEG),
        acc_sense=senses[0],
        gyr_sense=senses[1],
        acc_bias_m_s2=model.acc_bias_sd_m_s2 * rng.standard_normal(3),
        gyr_bias_rad_s=model.gyr_bias_sd_deg_s * RAD_PER_DEG * rng.standard_normal(3),
    )
    if model.gyr_g_sensitivity_deg_s_g == 0.0:
        return unit
    per_g = model.gyr_g_sensitivity_deg_s_g * RAD_PER_DEG * rng.standard_normal((3, 3))
    return replace(unit, gyr_per_acc_s_m=per_g / GRAVITY_M_S2)


def measure(
    model: SensorModel,
    unit: SensorUnit,
    *,
    acc_m_s2: ArrayLike,
    gyr_rad_s: ArrayLike,
    rate_hz: float,
    output_rate_hz: float,
    rng: np.random.Generator,
) -> tuple[Array, Array]:
    """What the sensor reports: mounting, scale, misalignment, bias, range, filter, noise, bits.

    Parameters
    ----------
    model : SensorModel
        Range, noise and converter.
    unit : SensorUnit
        Constant errors.
    acc_m_s2, gyr_rad_s : array_like, shape (3, n_samples)
        Ideal signals in body axes; they begin and end :func:`~swaystride.simulate.sampling.filter_reach` samples beyond the
        wanted ones.
    rate_hz, output_rate_hz : float
        Rate of the ideal signals and of the output; an integer ratio.
    rng : numpy.random.Generator
        Source of the noise.

    Returns
    -------
    acc_m_s2, gyr_rad_s : ndarray, shape (3, n_output)
        Multiples of the converter's step, within the range.
    """
    noise_factor = np.sqrt(output_rate_hz / 2.0)
    sensitivity = unit.gyr_per_acc_s_m
    channels = (
        (
            acc_m_s2,
            unit.acc_sense,
            unit.acc_bias_m_s2,
            model.acc_range_m_s2,
            model.acc_noise_density_m_s2_rthz,
            model.acc_adc_bits,
        ),
        (
            gyr_rad_s,
            unit.gyr_sense,
            unit.gyr_bias_rad_s,
            model.gyr_range_deg_s * RAD_PER_DEG,
            model.gyr_noise_density_deg_s_rthz * RAD_PER_DEG,
            model.gyr_adc_bits,
        ),
    )
    outputs = []
    for ideal, sense, bias, full_scale, density, bits in channels:
        sensed = (sense @ unit.r_sensor_from_body) @ np.asarray(ideal) + bias[:, None]
        if ideal is gyr_rad_s and sensitivity is not None:
            sensed += (sensitivity @ unit.r_sensor_from_body) @ np.asarray(acc_m_s2)
        # The element saturates before its signal is filtered and sampled.
        np.clip(sensed, -full_scale, full_scale, out=sensed)
        sampled = anti_alias(
            sensed,
            rate_hz=rate_hz,
            output_rate_hz=output_rate_hz,
            bandwidth_hz=model.bandwidth_hz,
        )
        sampled += density * noise_factor * rng.standard_normal(sampled.shape)
        outputs.append(quantise(sampled, full_scale=full_scale, bits=bits))
    return outputs[0], outputs[1]


def _cross(a: Array, b: Array) -> Array:
    """Cross product along the first axis (much faster than ``np.cross`` on long signals)."""
    return np.stack(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )
