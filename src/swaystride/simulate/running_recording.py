"""What the inertial sensors of a runner record, part by part."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from swaystride.simulate._running_points import sensor_signals
from swaystride.simulate.inertial_sensor import measure
from swaystride.simulate.running_motion import RunningMotion
from swaystride.simulate.running_sensors import WornSensors
from swaystride.simulate.running_tissue import SkinPoints
from swaystride.simulate.sampling import decimation_factor, filter_reach
from swaystride.units import GRAVITY_M_S2, RAD_PER_DEG

Array = NDArray[np.float64]

#: Rate of the simulation: the elements vibrate long before they are sampled (at least 2 kHz).
SIMULATION_RATE_HZ: Final = 2000.0
#: Rate at which an element clips (spec §9.1: at least 4 kHz), wherever it can.
CLIPPING_RATE_HZ: Final = 4000.0
#: Share of the range from which on it might: between two samples at 2 kHz a signal exceeds both by
#: less than 2 % (arrests last 19 ms and more), and scale and bias of a unit add 1 % [N].
NEAR_RANGE: Final = 0.95


@dataclass(frozen=True)
class SensorChunk:
    """Part of a recording.

    Parameters
    ----------
    first : int
        Index of its first sample in the recording.
    acc_m_s2, gyr_rad_s : ndarray, shape (n_sensors, 3, n)
        As the sensors report.
    ideal : ndarray, shape (n_sensors, 6, n), or None
        What perfect sensors in axes of their segment would report at the same instants, if it was
        asked for: see :func:`ideal_signals`.
    """

    first: int
    acc_m_s2: NDArray[np.float32]
    gyr_rad_s: NDArray[np.float32]
    ideal: NDArray[np.float32] | None = None


def n_samples(motion: RunningMotion, rate_hz: float) -> int:
    """Samples of a recording of a motion.

    Parameters
    ----------
    motion : RunningMotion
        What is recorded.
    rate_hz : float
        Sampling rate.
    """
    return int(np.floor(motion.duration_s * rate_hz + 1e-9))


def recorded(
    motion: RunningMotion,
    sensors: WornSensors,
    *,
    rate_hz: float,
    rng: np.random.Generator,
    chunk_s: float = 20.0,
    with_ideal: bool = False,
) -> Iterator[SensorChunk]:
    """Record a motion, part by part, so that the memory does not grow with its length.

    Signals are exact at 2 kHz. Where a sensor comes near its range, they are interpolated to 4 kHz, at
    which it clips; where none does, nothing can clip, and the rate makes no difference.

    Parameters
    ----------
    motion : RunningMotion
        What happens.
    sensors : WornSensors
        What records it.
    rate_hz : float
        Output rate; the simulation runs at 2 kHz, of which it is an integer part.
    rng : numpy.random.Generator
        Source of the noise.
    chunk_s : float
        Length of the parts; it decides the order of the random numbers.
    with_ideal : bool
        Whether to hand out the signals of perfect sensors as well; all else stays the same.

    Yields
    ------
    SensorChunk
    """
    factor = decimation_factor(SIMULATION_RATE_HZ, rate_hz)
    reach = filter_reach(SIMULATION_RATE_HZ, rate_hz)
    total = n_samples(motion, rate_hz)
    every = max(1, round(chunk_s * rate_hz))
    for first in range(0, total, every):
        n = min(every, total - first)
        fine = (n - 1) * factor + 1 + 2 * reach
        ideal = ideal_signals(
            motion, sensors.skin, SIMULATION_RATE_HZ, first * factor - reach, fine
        )
        near = near_range(sensors, ideal)
        acc = np.empty((len(sensors.names), 3, n), dtype=np.float32)
        gyr = np.empty_like(acc)
        for k, (model, unit) in enumerate(zip(sensors.models, sensors.units, strict=True)):
            signals = with_midpoints(ideal[k]) if near[k] else ideal[k]
            acc[k], gyr[k] = measure(
                model,
                unit,
                acc_m_s2=signals[:3],
                gyr_rad_s=signals[3:],
                rate_hz=CLIPPING_RATE_HZ if near[k] else SIMULATION_RATE_HZ,
                output_rate_hz=rate_hz,
                rng=rng,
            )
        kept = ideal[..., reach::factor][..., :n].astype(np.float32) if with_ideal else None
        yield SensorChunk(first, acc, gyr, kept)


def with_midpoints(signals: Array) -> Array:
    """Signals at twice their rate: cubic interpolation through four samples.

    Parameters
    ----------
    signals : ndarray, shape (..., n)
        At least four samples.

    Returns
    -------
    ndarray, shape (..., 2 n - 1)

    Examples
    --------
    >>> with_midpoints(np.arange(4.0) ** 3).tolist()
    [0.0, 0.125, 1.0, 3.375, 8.0, 15.625, 27.0]
    """
    fine = np.empty((*signals.shape[:-1], 2 * signals.shape[-1] - 1))
    fine[..., ::2] = signals
    a, b, c, d = (signals[..., k : signals.shape[-1] - 3 + k] for k in range(4))
    fine[..., 3:-3:2] = (9.0 * (b + c) - a - d) / 16.0
    for end, side in ((1, signals[..., :4]), (-2, signals[..., :-5:-1])):
        fine[..., end] = side @ np.array([5.0, 15.0, -5.0, 1.0]) / 16.0
    return fine


def near_range(sensors: WornSensors, ideal: Array) -> NDArray[np.bool_]:
    """Which sensors come so near the end of a range that they might clip.

    Parameters
    ----------
    sensors : WornSensors
        What records.
    ideal : ndarray, shape (n_sensors, 6, n)
        From :func:`ideal_signals`.

    Returns
    -------
    ndarray of bool, shape (n_sensors,)
    """
    near = []
    for model, unit, signals in zip(sensors.models, sensors.units, ideal, strict=True):
        acc, gyr = (unit.r_sensor_from_body @ part for part in (signals[:3], signals[3:]))
        share = max(
            np.abs(acc).max() / model.acc_range_m_s2,
            np.abs(gyr).max() / (model.gyr_range_deg_s * RAD_PER_DEG),
        )
        near.append(share > NEAR_RANGE)
    return np.array(near)


def ideal_signals(
    motion: RunningMotion, skin: SkinPoints, rate_hz: float, first: int, n: int
) -> Array:
    """Signals of perfect sensors in axes of their segment (turned with the soft tissue).

    Parameters
    ----------
    motion : RunningMotion
        What happens.
    skin : SkinPoints
        Where the sensors are.
    rate_hz : float
        Sampling rate; sample 0 is at the begin of the recording.
    first, n : int
        First sample and number of samples.

    Returns
    -------
    ndarray, shape (n_sensors, 6, n)
        Proper acceleration (m/s²) and angular velocity (rad/s).
    """
    out = np.empty((len(skin.rows), 6, n))
    sensor_signals(
        motion.tables,
        0.0,
        rate_hz,
        first,
        n,
        skin.rows,
        skin.points_m,
        skin.tissue,
        GRAVITY_M_S2,
        out,
    )
    return out
