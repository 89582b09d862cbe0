"""Sway measures of one standing trial: gaps, alignment, fusion, filter, measures."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.recording import Recording, list_recordings, load_recording, six_axis_signals
from swaystride.signals.filters import Direction, butterworth_lowpass
from swaystride.signals.gaps import fill_short_gaps, missing_runs
from swaystride.signals.orientation import FusionMethod, remap_axes
from swaystride.sway.angles import trunk_angles
from swaystride.sway.metrics import SWAY_MEASURE_UNITS, sway_metrics
from swaystride.sway.trial_checks import check_standing_signals


@dataclass(frozen=True)
class MeasurementMethod:
    """How sway is measured on a usable trial.

    Parameters
    ----------
    sensor_forward, sensor_left, sensor_up : str
        Sensor axes that point there when the participant stands (assumed alignment).
    fusion, tau_acc_s, level_sensor
        See :func:`swaystride.sway.angles.trunk_angles`.
    remove_mean_rate : bool
        Subtract each axis' mean angular rate: over a standing trial the net rotation is nil, so
        that the mean is the gyroscope's bias.
    filter_order, cutoff_hz, filter_direction, pad_s
        See :func:`swaystride.signals.filters.butterworth_lowpass`.
    """

    sensor_forward: str
    sensor_left: str
    sensor_up: str
    fusion: FusionMethod
    tau_acc_s: float
    level_sensor: bool
    remove_mean_rate: bool
    filter_order: int
    cutoff_hz: float
    filter_direction: Direction
    pad_s: float


#: What :func:`measure_trial` returns.
TRIAL_MEASURES: Final = ("duration_s", "samples_filled", *SWAY_MEASURE_UNITS)


def filtered_sway(
    recording: Recording, method: MeasurementMethod
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Trunk angles of one trial as they are analysed: aligned, fused, filtered.

    Parameters
    ----------
    recording : Recording
        One usable trial.
    method : MeasurementMethod
        How sway is measured.

    Returns
    -------
    ap_deg, ml_deg : ndarray, shape (n_samples,)
        Forward and right lean positive.
    """
    rate_hz = recording.attrs["rate_hz"]
    # the import has excluded what may not be filled
    signals = six_axis_signals(recording)
    acc, gyr = fill_short_gaps(signals, longest_gap=signals.shape[1]).reshape(2, 3, -1)
    axes = {
        "forward": method.sensor_forward,
        "left": method.sensor_left,
        "up": method.sensor_up,
    }
    acc, gyr = remap_axes(acc, **axes), remap_axes(gyr, **axes)
    check_standing_signals(acc, gyr, file=recording.attrs["source_file"])
    if method.remove_mean_rate:
        gyr = gyr - gyr.mean(axis=1, keepdims=True)
    angles = trunk_angles(
        acc,
        gyr,
        rate_hz,
        tau_acc_s=method.tau_acc_s,
        method=method.fusion,
        level=method.level_sensor,
    )
    ap_deg, ml_deg = butterworth_lowpass(
        angles,
        cutoff_hz=method.cutoff_hz,
        rate_hz=rate_hz,
        order=method.filter_order,
        direction=method.filter_direction,
        pad_s=method.pad_s,
    )
    return ap_deg, ml_deg


def measure_trial(recording: Recording, method: MeasurementMethod) -> dict[str, float]:
    """Sway measures of one trial, with its duration in s and number of filled samples.

    Parameters
    ----------
    recording : Recording
        One usable trial.
    method : MeasurementMethod
        How sway is measured.
    """
    rate_hz = recording.attrs["rate_hz"]
    ap_deg, ml_deg = filtered_sway(recording, method)
    return {
        "duration_s": (recording.sizes["time"] - 1) / rate_hz,
        "samples_filled": int(missing_runs(six_axis_signals(recording))["length"].sum()),
        **sway_metrics(ap_deg, ml_deg, rate_hz),
    }


def measure_participant(participant: str, file: Path, method: MeasurementMethod) -> pd.DataFrame:
    """Sway measures of every usable trial of one participant.

    Parameters
    ----------
    participant : str
        Name, written into every row.
    file : Path
        The participant's recordings, one trial in memory at a time.
    method : MeasurementMethod
        How sway is measured.

    Returns
    -------
    DataFrame
        ``participant``, ``trial`` (name of the recording) and :data:`TRIAL_MEASURES`, sorted by
        trial; no rows if no trial is usable.
    """
    rows = [
        {
            "participant": participant,
            "trial": trial,
            **measure_trial(load_recording(file, trial), method),
        }
        for trial in list_recordings(file)
    ]
    return pd.DataFrame(rows, columns=["participant", "trial", *TRIAL_MEASURES])
