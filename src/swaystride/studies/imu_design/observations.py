"""From measures of single feet to what the models see: one row per trial and condition."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd

from swaystride.errors import RecordingError
from swaystride.studies.imu_design.design import KEYS
from swaystride.studies.imu_design.experiments import EXPERIMENTS
from swaystride.studies.imu_design.plan import ImuDesignPlan
from swaystride.studies.imu_design.stride_differences import pooled_sd

#: What names an observation.
TRIAL_KEYS: Final = ["participant", "trial"]

OBSERVATION_COLUMNS: Final = (
    "participant",
    "trial",
    "experiment",
    "condition",
    "level",
    "speed_m_s",
    "error_pct",
    "loss_percent",
    "length_difference_sd_m",
    "angle_difference_sd_deg",
    "n_feet",
    "n_strides",
)


def recording_verdicts(metrics: pd.DataFrame) -> pd.DataFrame:
    """Which recordings cannot say how far a foot went.

    The known distance is that from rest to rest: without a rest at either end, or without a
    stride, the sum of the strides is another distance.

    Parameters
    ----------
    metrics : DataFrame
        Of all participants, as from
        :func:`swaystride.studies.imu_design.metrics.measure_participant`.

    Returns
    -------
    DataFrame
        ``participant``, ``trial``, ``foot``, ``imu`` and ``reason``, empty where the recording is
        used.
    """
    table = metrics.assign(imu=[EXPERIMENTS[name][0] for name in metrics["experiment"]])
    base = table.drop_duplicates(list(KEYS)).reset_index(drop=True)
    reason = np.select(
        [base["motion_start_s"].isna(), base["motion_stop_s"].isna(), base["n_strides"].eq(0)],
        ["no rest at the start", "no rest at the end", "no stride"],
        "",
    )
    return base[list(KEYS)].assign(reason=reason)


def usable_metrics(metrics: pd.DataFrame) -> pd.DataFrame:
    """Measures of the recordings that :func:`recording_verdicts` leaves in.

    Parameters
    ----------
    metrics : DataFrame
        Of all participants.

    Raises
    ------
    RecordingError
        If no recording is usable.
    """
    verdicts = recording_verdicts(metrics)
    kept = set(
        verdicts.loc[verdicts["reason"] == "", list(KEYS)].itertuples(index=False, name=None)
    )
    imu = [EXPERIMENTS[name][0] for name in metrics["experiment"]]
    rows = zip(metrics["participant"], metrics["trial"], metrics["foot"], imu, strict=True)
    usable = metrics[[row in kept for row in rows]].reset_index(drop=True)
    if usable.empty:
        raise RecordingError(
            "no recording of the cohort is usable",
            expected="recordings that begin and end at rest, with strides between",
        )
    return usable


def mean_speeds(metrics: pd.DataFrame) -> pd.DataFrame:
    """Mean speed of every trial: the known distance over the time from first start to last stop.

    Start and stop come from IMU 1, as in the paper; from IMU 2 where a trial has no other.

    Parameters
    ----------
    metrics : DataFrame
        Of all participants, unusable recordings left out.

    Returns
    -------
    DataFrame
        ``participant``, ``trial``, ``speed_m_s``.

    Examples
    --------
    >>> metrics = pd.DataFrame({"participant": "P01", "trial": "01", "known_distance_m": 100.0,
    ...     "experiment": "gyro_range", "motion_start_s": [2.0, 2.5], "motion_stop_s": [51.0, 52.0]})
    >>> mean_speeds(metrics)["speed_m_s"].tolist()
    [2.0]
    """
    first = metrics["experiment"].isin(["accelerometer_range", "gyro_range"])
    has_first = first.groupby([metrics[key] for key in TRIAL_KEYS]).transform("any")
    timed = metrics[first | ~has_first].groupby(TRIAL_KEYS, sort=True)
    table = timed.agg(
        distance=("known_distance_m", "first"),
        start=("motion_start_s", "min"),
        stop=("motion_stop_s", "max"),
    )
    table["speed_m_s"] = table["distance"] / (table["stop"] - table["start"])
    return table[["speed_m_s"]].reset_index()


def observations(metrics: pd.DataFrame) -> pd.DataFrame:
    """One row per trial and condition.

    Parameters
    ----------
    metrics : DataFrame
        Of all participants, unusable recordings left out (:func:`usable_metrics`).

    Returns
    -------
    DataFrame
        :data:`OBSERVATION_COLUMNS`. ``error_pct`` compares the mean over the feet of the summed
        stride lengths with the known distance; ``loss_percent`` is the mean over the feet; the
        standard deviations are over the matched strides of both feet. Rows without a distance are
        left out. The order is that of the conditions within an experiment.

    Examples
    --------
    >>> metrics = pd.DataFrame({"participant": "P01", "trial": "01", "foot": ["left", "right"],
    ...     "experiment": "gyro_range", "condition": "baseline_2000dps", "level": 2000.0,
    ...     "known_distance_m": 100.0, "motion_start_s": 2.0, "motion_stop_s": 52.0,
    ...     "distance_m": [99.0, 97.0], "n_strides": 80, "loss_percent": 0.0, "n_matched": 2,
    ...     "length_difference_mean_m": 0.0, "length_difference_sd_m": 0.0, "n_angles": 2,
    ...     "angle_difference_mean_deg": 0.0, "angle_difference_sd_deg": 0.0})
    >>> observations(metrics)[["speed_m_s", "error_pct"]].round(6).values.tolist()
    [[2.0, -2.0]]
    """
    order = metrics.drop_duplicates(["experiment", "condition"])[["experiment", "condition"]]
    rank = {pair: at for at, pair in enumerate(order.itertuples(index=False, name=None))}
    complete = metrics.dropna(subset="distance_m")
    rows = []
    keys = [*TRIAL_KEYS, "experiment", "condition"]
    for key, feet in complete.groupby(keys, sort=False):
        distance = feet["distance_m"].mean()
        rows.append(
            {
                **dict(zip(keys, key, strict=True)),
                "level": feet["level"].iloc[0],
                "error_pct": 100.0 * (distance / feet["known_distance_m"].iloc[0] - 1.0),
                "loss_percent": feet["loss_percent"].mean(),
                "length_difference_sd_m": _pooled(feet, "n_matched", "length_difference", "m"),
                "angle_difference_sd_deg": _pooled(feet, "n_angles", "angle_difference", "deg"),
                "n_feet": len(feet),
                "n_strides": int(feet["n_strides"].sum()),
            }
        )
    table = pd.DataFrame(rows).merge(mean_speeds(metrics), on=TRIAL_KEYS)
    pairs = zip(table["experiment"], table["condition"], strict=True)
    table["rank"] = [rank[pair] for pair in pairs]
    table = table.sort_values(["rank", *TRIAL_KEYS], kind="stable", ignore_index=True)
    return table[list(OBSERVATION_COLUMNS)]


def sample_trials(observations: pd.DataFrame, plan: ImuDesignPlan) -> pd.DataFrame:
    """The two trials whose mean speeds are nearest to those that the paper shows.

    Parameters
    ----------
    observations : DataFrame
        From :func:`swaystride.studies.imu_design.observations.observations`.
    plan : ImuDesignPlan

    Returns
    -------
    DataFrame
        ``gait`` (walking, running), ``participant``, ``trial``, ``speed_m_s``.

    Raises
    ------
    IndexError
        If there is no trial at all.
    """
    own = observations[observations["experiment"] == "accelerometer_range"]
    trials = own.drop_duplicates(["participant", "trial"]).reset_index(drop=True)
    wanted = {
        "walking": plan.sample_walking_speed_m_s,
        "running": plan.sample_running_speed_m_s,
    }
    at = [int((trials["speed_m_s"] - speed).abs().argmin()) for speed in wanted.values()]
    chosen = trials.iloc[at][["participant", "trial", "speed_m_s"]].reset_index(drop=True)
    chosen.insert(0, "gait", list(wanted))
    return chosen


def _pooled(feet: pd.DataFrame, count: str, difference: str, unit: str) -> float:
    """Standard deviation of the differences of both feet together."""
    parts = (feet[count], feet[f"{difference}_mean_{unit}"], feet[f"{difference}_sd_{unit}"])
    return pooled_sd(*(np.asarray(part, dtype=np.float64) for part in parts))
