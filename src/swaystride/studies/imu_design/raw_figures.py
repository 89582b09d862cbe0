"""Figures 4 and 8: what truncation takes from a walking and a running trial."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from swaystride.presentation.figure_style import new_figure
from swaystride.recording import AXES
from swaystride.signals.saturation import clip_axes
from swaystride.studies.imu_design.conditions import FloatArray, Signals
from swaystride.studies.imu_design.experiments import (
    ExperimentName,
    ExperimentSettings,
    effect_names,
)
from swaystride.studies.imu_design.figures import condition_colours, level_label
from swaystride.units import DEG_PER_RAD, GRAVITY_M_S2

#: Strides that are drawn, from the middle of the trial.
STRIDES_SHOWN: Final = 2


@dataclass(frozen=True, eq=False)
class SampleTrial:
    """One recording of one foot as an example.

    Parameters
    ----------
    title : str
        Such as ``a  Walking, 1.4 m/s``.
    signals : Signals
        Of IMU 1.
    strides : DataFrame
        Strides of the recording as it is.
    stances : ndarray, shape (n, 2)
        From :func:`swaystride.studies.imu_design.stance.stance_intervals`.
    """

    title: str
    signals: Signals
    strides: pd.DataFrame
    stances: FloatArray


def figure_truncated(
    samples: list[SampleTrial], experiment: ExperimentName, settings: ExperimentSettings
) -> Figure:
    """Three axes of two trials under all truncations, stance shaded.

    Parameters
    ----------
    samples : list of SampleTrial
        Walking and running; one column each.
    experiment : {"accelerometer_range", "gyro_range"}
    settings : ExperimentSettings
    """
    fig = new_figure("double", height_mm=128)
    grid = fig.subplots(len(AXES), len(samples), sharex="col", squeeze=False)
    levels = settings.levels(experiment)
    colours = condition_colours(effect_names(experiment, settings))
    unit = "g" if experiment == "accelerometer_range" else "°/s"
    for column, sample in zip(grid.T, samples, strict=True):
        span, from_s = _span(sample)
        full = _in_units(sample.signals, experiment)[:, span]
        time_s = np.arange(span.start, span.stop) / sample.signals.rate_hz - from_s
        clipped = [clip_axes(full, limit=level) for level in levels]
        for at, axes in enumerate(column):
            _shade(axes, sample, from_s, float(time_s[0]), float(time_s[-1]))
            # the full signal on top: of the smaller ranges only what they cut off is seen
            for rank, (level, colour) in enumerate(zip(levels, colours.values(), strict=True)):
                axes.plot(
                    time_s,
                    clipped[rank][at],
                    color=colour,
                    linewidth=0.9,
                    zorder=10 - rank,
                    label=level_label(experiment, level),
                )
            axes.set_xlim(float(time_s[0]), float(time_s[-1]))
        column[0].set_title(sample.title)
        column[-1].set_xlabel("time (s)")
    for at, axis in enumerate(AXES):
        grid[at, 0].set_ylabel(f"{axis.upper()} ({unit})")
    grid[1, -1].legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
    return fig


def _in_units(signals: Signals, experiment: ExperimentName) -> FloatArray:
    """The truncated signal in g or °/s."""
    if experiment == "accelerometer_range":
        return signals.acc_m_s2 / GRAVITY_M_S2
    return signals.gyr_rad_s * DEG_PER_RAD


def _span(sample: SampleTrial) -> tuple[slice, float]:
    """Samples of the strides in the middle of the trial, and where their time begins."""
    middle = len(sample.strides) // 2
    first = max(middle - STRIDES_SHOWN // 2, 0)
    chosen = sample.strides.iloc[first : first + STRIDES_SHOWN]
    from_s, to_s = float(chosen["start_s"].iloc[0]), float(chosen["stop_s"].iloc[-1])
    margin_s = 0.25 * (to_s - from_s) / STRIDES_SHOWN
    rate_hz = sample.signals.rate_hz
    n_samples = sample.signals.acc_m_s2.shape[1]
    begin = max(round((from_s - margin_s) * rate_hz), 0)
    end = min(round((to_s + margin_s) * rate_hz), n_samples)
    return slice(begin, end), begin / rate_hz


def _shade(axes: Axes, sample: SampleTrial, from_s: float, low: float, high: float) -> None:
    """Grey behind every stance that is in view."""
    for contact_s, toe_off_s in sample.stances - from_s:
        if toe_off_s > low and contact_s < high:
            axes.axvspan(
                max(contact_s, low), min(toe_off_s, high), color="#E8E8E8", linewidth=0, zorder=0
            )
