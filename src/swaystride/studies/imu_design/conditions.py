"""What one sensor of a recording is made to be under a condition (Potter et al. 2019, §2.3)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from swaystride.signals.resampling import DecimationFilter, decimate, keep_every, whole_factor
from swaystride.signals.saturation import clip_axes, data_loss_percent
from swaystride.studies.imu_design.experiments import ExperimentName, ExperimentSettings
from swaystride.units import GRAVITY_M_S2, RAD_PER_DEG

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Signals:
    """What one IMU delivers.

    Parameters
    ----------
    acc_m_s2, gyr_rad_s : ndarray, shape (3, n_samples)
        In the sensor frame, no samples missing.
    rate_hz : float
    """

    acc_m_s2: FloatArray
    gyr_rad_s: FloatArray
    rate_hz: float

    def same_as(self, other: Signals) -> bool:
        """Whether `other` holds the very same numbers: nothing was clipped or left out."""
        return (
            self.rate_hz == other.rate_hz
            and np.array_equal(self.acc_m_s2, other.acc_m_s2)
            and np.array_equal(self.gyr_rad_s, other.gyr_rad_s)
        )


def limited(
    signals: Signals, experiment: ExperimentName, level: float, settings: ExperimentSettings
) -> tuple[Signals, float]:
    """Signals as an IMU of a smaller range or rate would deliver them.

    One sensor is changed at a time: a truncated accelerometer goes with the full gyroscope and the
    other way round.

    Parameters
    ----------
    signals : Signals
        As recorded.
    experiment : str
    level : float
        Range in g or °/s, or rate in Hz.
    settings : ExperimentSettings

    Returns
    -------
    signals : Signals
    loss_percent : float
        Share of the truncated signal that is lost; NaN where nothing is truncated by design.

    Raises
    ------
    RecordingError
        If the recorded rate is no whole multiple of the one wanted.
    """
    acc, gyr, rate_hz = signals.acc_m_s2, signals.gyr_rad_s, signals.rate_hz
    if experiment == "accelerometer_range":
        clipped = clip_axes(acc, limit=level * GRAVITY_M_S2)
        return Signals(clipped, gyr, rate_hz), data_loss_percent(clipped, acc)
    if experiment == "gyro_range":
        clipped = clip_axes(gyr, limit=level * RAD_PER_DEG)
        return Signals(acc, clipped, rate_hz), data_loss_percent(clipped, gyr)
    factor = whole_factor(rate_hz, level)
    if experiment == "downsampling":
        parts = [keep_every(part, factor) for part in (acc, gyr)]
    else:
        lowpass = DecimationFilter(
            settings.decimation_order, settings.decimation_ripple_db, settings.decimation_edge
        )
        parts = [decimate(part, factor, lowpass=lowpass) for part in (acc, gyr)]
    return Signals(parts[0], parts[1], rate_hz / factor), float("nan")
