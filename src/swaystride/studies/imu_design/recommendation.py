"""The engineering recommendation of the study, put into words from its results."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from swaystride.studies.imu_design.plan import ImuDesignPlan

_SENSORS = {"accelerometer_range": ("accelerometer", "g"), "gyro_range": ("gyroscope", "°/s")}
_RATES = {"downsampling": "samples left out", "decimation": "low-pass filter and decimation"}


def recommendation_table(
    requirements: pd.DataFrame, fastest_m_s: float, plan: ImuDesignPlan
) -> pd.DataFrame:
    """Sentences on ranges, data loss and rates.

    Parameters
    ----------
    requirements : DataFrame
        From :func:`swaystride.studies.imu_design.requirements.requirements`.
    fastest_m_s : float
        Largest mean speed of a trial.
    plan : ImuDesignPlan

    Returns
    -------
    DataFrame
        ``basis`` and ``recommendation``.
    """
    rows: dict[str, Mapping[str, Any]] = {
        str(row["experiment"]): {str(name): value for name, value in row.items()}
        for row in requirements.to_dict("records")
    }
    limit = f"±{plan.distance_error_limit_pct:g} %"
    sensors: Sensors = [
        (name, unit, rows[experiment]) for experiment, (name, unit) in _SENSORS.items()
    ]
    sentences = [
        ("distance error", _by_error(sensors, limit, fastest_m_s)),
        ("change from the baseline", _by_added_error(sensors, limit, fastest_m_s)),
        ("data loss", _by_loss(sensors, limit)),
        ("mixed models", _by_models(sensors, rows, plan.significance_level)),
        ("sampling rate", _by_rate(rows, limit, fastest_m_s)),
    ]
    return pd.DataFrame(sentences, columns=["basis", "recommendation"])


Sensors = list[tuple[str, str, Mapping[str, Any]]]


def _by_error(sensors: Sensors, limit: str, fastest_m_s: float) -> str:
    """Ranges from which on all errors are within the limit, or why there are none."""
    if any(np.isnan(row["level_needed"]) for _, _, row in sensors):
        row = sensors[0][2]
        n_beyond = row["n_beyond_at_baseline"]
        return (
            f"No range keeps all distance errors within {limit} up to {fastest_m_s:.1f} m/s: with "
            f"the full range {n_beyond} of {row['n_trials']} trials {'is' if n_beyond == 1 else 'are'} "
            f"beyond it, the largest error being {_signed(row['largest_error_at_baseline_pct'])} %."
        )
    needed = " and ".join(
        f"{_article(name)} of at least ±{row['level_needed']:g} {unit}"
        for name, unit, row in sensors
    )
    return (
        f"To keep the distance error within {limit} at mean speeds up to {fastest_m_s:.1f} m/s, "
        f"take {needed}."
    )


def _by_added_error(sensors: Sensors, limit: str, fastest_m_s: float) -> str:
    """Ranges that change no trial by more than the limit."""
    parts = " and ".join(
        f"±{row['level_needed_added']:g} {unit} ({name})" for name, unit, row in sensors
    )
    return (
        f"Up to {fastest_m_s:.1f} m/s, ranges from {parts} on change the distance of no trial by "
        f"more than {limit}."
    )


def _by_loss(sensors: Sensors, limit: str) -> str:
    """How much of a signal may be lost."""
    sentences = []
    for name, _, row in sensors:
        loss = row["loss_limit_percent"]
        if not row["loss_limit_is_reached"]:
            sentences.append(
                f"Up to the {loss:.1f} % of the {name} signal that were lost at most, no distance "
                f"error is beyond {limit}."
            )
        elif loss == 0.0:
            sentences.append(
                f"Errors beyond {limit} occur without any loss of the {name} signal: no limit of "
                "the loss can be given."
            )
        else:
            sentences.append(
                f"Distance errors stay within {limit} while less than {loss:.1f} % of the {name} "
                "signal is lost."
            )
    return " ".join(sentences)


def _by_models(sensors: Sensors, rows: Mapping[str, Mapping[str, Any]], alpha: float) -> str:
    """Levels down to which the slope over speed does not change significantly."""
    parts = [f"±{row['level_not_significant']:g} {unit}" for _, unit, row in sensors]
    rates = [
        f"{rows[name]['level_not_significant']:g} Hz ({words})" for name, words in _RATES.items()
    ]
    return (
        "The dependence of the error on speed is not significantly different from the baseline "
        f"(p ≥ {alpha:g}) down to {parts[0]}, {parts[1]}, {rates[0]} and {rates[1]}."
    )


def _by_rate(rows: Mapping[str, Mapping[str, Any]], limit: str, fastest_m_s: float) -> str:
    """Rates that change no trial by more than the limit."""
    parts = [f"{rows[name]['level_needed_added']:g} Hz ({words})" for name, words in _RATES.items()]
    return (
        f"Up to {fastest_m_s:.1f} m/s, sampling rates from {parts[0]} and from {parts[1]} on change "
        f"the distance of no trial by more than {limit}."
    )


def _article(name: str) -> str:
    return f"{'an' if name[0] in 'aeiou' else 'a'} {name}"


def _signed(value: float) -> str:
    return f"{value:+.1f}".replace("-", "−")
