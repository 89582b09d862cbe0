"""The four experiments by name: their IMU, their levels, and what the printed tables call these."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

from swaystride.studies.imu_design.design import Imu

ExperimentName = Literal["accelerometer_range", "gyro_range", "downsampling", "decimation"]

#: Experiments in the order of Tables A1 to A4: IMU, unit in the names of the conditions.
EXPERIMENTS: Final[dict[ExperimentName, tuple[Imu, str]]] = {
    "accelerometer_range": ("imu_1", "g"),
    "gyro_range": ("imu_1", "dps"),
    "downsampling": ("imu_2", "hz"),
    "decimation": ("imu_2", "hz"),
}


@dataclass(frozen=True)
class ExperimentSettings:
    """Levels of the experiments (config/studies/imu_design.yaml, ``analysis.experiments``).

    Parameters
    ----------
    accelerometer_ranges_g : tuple of float
        Ranges of the accelerometer of IMU 1; the first is the baseline.
    gyro_ranges_deg_s : tuple of float
        Ranges of the gyroscope of IMU 1; the first is the baseline.
    rates_hz : tuple of float
        Sampling rates of IMU 2, by both methods; the first is the baseline.
    decimation_order : int
    decimation_ripple_db : float
    decimation_edge : float
        The filter of the second method, see
        :class:`swaystride.signals.resampling.DecimationFilter`.
    """

    accelerometer_ranges_g: tuple[float, ...]
    gyro_ranges_deg_s: tuple[float, ...]
    rates_hz: tuple[float, ...]
    decimation_order: int
    decimation_ripple_db: float
    decimation_edge: float

    def levels(self, experiment: ExperimentName) -> tuple[float, ...]:
        """Levels of an `experiment`, the baseline first."""
        return {
            "accelerometer_range": self.accelerometer_ranges_g,
            "gyro_range": self.gyro_ranges_deg_s,
            "downsampling": self.rates_hz,
            "decimation": self.rates_hz,
        }[experiment]


def effect_name(experiment: ExperimentName, level: float, *, baseline: bool) -> str:
    """Name of a condition, as the printed tables call it.

    Parameters
    ----------
    experiment : str
    level : float
        Range in g or °/s, or rate in Hz.
    baseline : bool
        Whether it is the one that the others are compared with.

    Examples
    --------
    >>> effect_name("decimation", 62.5, baseline=False)
    '62.5hz'
    >>> effect_name("gyro_range", 2000.0, baseline=True)
    'baseline_2000dps'
    """
    return f"{'baseline_' if baseline else ''}{level:g}{EXPERIMENTS[experiment][1]}"


def effect_names(experiment: ExperimentName, settings: ExperimentSettings) -> list[str]:
    """Names of all conditions of an experiment, the baseline first.

    Parameters
    ----------
    experiment : str
    settings : ExperimentSettings
    """
    levels = settings.levels(experiment)
    return [effect_name(experiment, x, baseline=i == 0) for i, x in enumerate(levels)]
