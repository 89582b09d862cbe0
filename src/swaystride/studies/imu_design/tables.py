"""Result tables of the study, in the rows and columns of the printed ones (table contract)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np
import pandas as pd

from swaystride.studies.imu_design.design import IMUS, Imu, ImuDesign
from swaystride.studies.imu_design.experiments import EXPERIMENTS, ExperimentName
from swaystride.studies.imu_design.observations import sample_trials
from swaystride.studies.imu_design.plan import SLOPE, ImuDesignPlan
from swaystride.studies.imu_design.sensors import SensorSpecification

_EFFECT_EXTRA: Final = ("se", "df", "n", "n_trials", "n_participants")


def table_1(ranges: pd.DataFrame, sensors: Mapping[Imu, SensorSpecification]) -> pd.DataFrame:
    """The two IMUs: what their maker says, and what the recordings show.

    Parameters
    ----------
    ranges : DataFrame
        Of all participants, from
        :func:`swaystride.studies.imu_design.importing.import_participant`.
    sensors : mapping
        Specification of each IMU.

    Returns
    -------
    DataFrame
        ``imu, model, manufacturer, rate_hz, accelerometer_range_g, gyro_range_deg_s`` as printed
        (the rate is the median of the recordings), then number of recordings, largest readings, and
        how many recordings reach a range.
    """
    rows = []
    for imu in IMUS:
        own = ranges[ranges["imu"] == imu]
        sensor = sensors[imu]
        rows.append(
            {
                "imu": imu.replace("imu_", "IMU "),
                "model": sensor.model,
                "manufacturer": sensor.manufacturer,
                "rate_hz": own["rate_hz"].median(),
                "accelerometer_range_g": sensor.accelerometer_range_g,
                "gyro_range_deg_s": sensor.gyro_range_deg_s,
                "n_recordings": len(own),
                "peak_acc_g": own["peak_acc_g"].max(),
                "peak_gyr_deg_s": own["peak_gyr_deg_s"].max(),
                "n_acc_at_range": int((own["acc_at_range_percent"] > 0).sum()),
                "n_gyr_at_range": int((own["gyr_at_range_percent"] > 0).sum()),
            }
        )
    return pd.DataFrame(rows)


def effect_table(effects: pd.DataFrame, experiment: ExperimentName, model: str) -> pd.DataFrame:
    """One of Tables A1 to A4.

    Parameters
    ----------
    effects : DataFrame
        Of all experiments, from :func:`swaystride.studies.imu_design.models.effects`.
    experiment : str
    model : str
        Which of the two models.

    Returns
    -------
    DataFrame
        ``effect, slope_pct_per_m_s, p, ci_low, ci_high`` as printed, then ``se``, ``df`` and the
        numbers of rows, trials and participants.
    """
    own = effects[(effects["experiment"] == experiment) & (effects["model"] == model)]
    columns = ["effect", SLOPE, "p", "ci_low", "ci_high", *_EFFECT_EXTRA]
    return own[columns].reset_index(drop=True)


def model_comparison(effects: pd.DataFrame) -> pd.DataFrame:
    """Every effect under both models, side by side.

    Parameters
    ----------
    effects : DataFrame
        Of all experiments.

    Returns
    -------
    DataFrame
        ``experiment``, ``effect``, then slope, SE, df and p with a random intercept of the subject
        alone and with one of the trial besides, and the ratio of the two SE.
    """
    keys = ["experiment", "effect"]
    values = [SLOPE, "se", "df", "p"]
    sides = [
        effects[effects["model"] == model].set_index(keys)[values].add_suffix(suffix)
        for model, suffix in (("subject", ""), ("subject_and_trial", "_with_trial"))
    ]
    joined = sides[0].join(sides[1]).reset_index()
    joined["se_ratio"] = joined["se_with_trial"] / joined["se"]
    order = {name: at for at, name in enumerate(EXPERIMENTS)}
    return joined.sort_values(
        "experiment", key=lambda names: names.map(order), kind="stable", ignore_index=True
    )


def imu_design_text(
    observations: pd.DataFrame, requirements: pd.DataFrame, plan: ImuDesignPlan
) -> pd.DataFrame:
    """The numbers of the running text, computed from this cohort by stated rules.

    Parameters
    ----------
    observations : DataFrame
    requirements : DataFrame
        From :func:`swaystride.studies.imu_design.requirements.requirements`.
    plan : ImuDesignPlan

    Returns
    -------
    DataFrame
        ``quantity, value, unit`` as printed, then ``value_added``, the same for what the limited
        IMU adds to the baseline, and ``rule``. A value is missing where no level fulfils its rule.
    """
    needs = requirements.set_index("experiment")
    acc, gyr = needs.loc["accelerometer_range"], needs.loc["gyro_range"]
    samples = sample_trials(observations, plan).set_index("gait")["speed_m_s"]
    truncated = observations[observations["experiment"] == "accelerometer_range"]
    smallest = truncated[truncated["level"] == truncated["level"].min()]
    limit = plan.distance_error_limit_pct
    nan = float("nan")
    rows = [
        ("distance_error_limit", limit, "%", nan, "set beforehand"),
        ("accelerometer_loss_limit", acc["loss_limit_percent"], "%",
         acc["loss_limit_added_percent"], _loss_rule(bool(acc["loss_limit_is_reached"]))),
        ("gyro_loss_limit", gyr["loss_limit_percent"], "%",
         gyr["loss_limit_added_percent"], _loss_rule(bool(gyr["loss_limit_is_reached"]))),
        ("accelerometer_range_needed", acc["level_needed"], "g",
         acc["level_needed_added"], "smallest range from which on all errors are within the limit"),
        ("gyro_range_needed", gyr["level_needed"], "deg/s",
         gyr["level_needed_added"], "smallest range from which on all errors are within the limit"),
        ("fastest_mean_speed", observations["speed_m_s"].max(), "m/s", nan, "of all trials"),
        ("sample_walking_trial_speed", samples["walking"], "m/s", nan,
         f"trial nearest to {plan.sample_walking_speed_m_s:g} m/s"),
        ("sample_running_trial_speed", samples["running"], "m/s", nan,
         f"trial nearest to {plan.sample_running_speed_m_s:g} m/s"),
        ("distance_error_6g_exceeds", smallest["error_pct"].abs().max(), "%", nan,
         "largest error at the smallest range"),
    ]  # fmt: skip
    return pd.DataFrame(rows, columns=["quantity", "value", "unit", "value_added", "rule"])


def cohort_table(design: ImuDesign) -> pd.DataFrame:
    """Who took part.

    Parameters
    ----------
    design : ImuDesign

    Returns
    -------
    DataFrame
        One row: ``n``, ``n_female``, and mean and standard deviation (n − 1) of age, height and
        mass.
    """
    people = design.participants
    row: dict[str, float] = {"n": len(people), "n_female": int((people["sex"] == "F").sum())}
    for name in ("age_years", "height_m", "mass_kg"):
        row[f"{name}_mean"], row[f"{name}_sd"] = people[name].mean(), people[name].std()
    return pd.DataFrame([row])


def speed_table(observations: pd.DataFrame) -> pd.DataFrame:
    """Mean speed and baseline error of each trial number.

    Parameters
    ----------
    observations : DataFrame

    Returns
    -------
    DataFrame
        ``trial``, ``n``, mean, smallest and largest ``speed``, and mean distance error and strides
        per foot of the baseline of each IMU.
    """
    rows = []
    for trial, own in observations.groupby("trial", sort=True):
        people = own.drop_duplicates("participant")
        row: dict[str, object] = {
            "trial": trial,
            "n": len(people),
            "speed_mean_m_s": people["speed_m_s"].mean(),
            "speed_min_m_s": people["speed_m_s"].min(),
            "speed_max_m_s": people["speed_m_s"].max(),
        }
        for imu, experiment in (("imu_1", "accelerometer_range"), ("imu_2", "downsampling")):
            base = own[
                (own["experiment"] == experiment) & own["condition"].str.startswith("baseline_")
            ]
            strides = base["n_strides"] / base["n_feet"]
            row[f"{imu}_error_pct"] = base["error_pct"].mean() if len(base) else np.nan
            row[f"{imu}_strides_per_foot"] = strides.mean() if len(base) else np.nan
        rows.append(row)
    return pd.DataFrame(rows)


def _loss_rule(reached: bool) -> str:
    if reached:
        return "smallest loss that goes with an error beyond the limit"
    return "no error is beyond the limit: the largest loss that occurred"
