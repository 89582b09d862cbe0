"""What an IMU must be able to do so that the distance error stays within its limit."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd

from swaystride.studies.imu_design.experiments import EXPERIMENTS, ExperimentName
from swaystride.studies.imu_design.plan import SLOPE, ImuDesignPlan

#: How errors are judged: as they are, or by what the limited IMU adds to the baseline.
BASES: Final = ("error", "added_error")

REQUIREMENT_COLUMNS: Final = (
    "experiment",
    "level_needed",
    "loss_limit_percent",
    "loss_limit_is_reached",
    "level_needed_added",
    "loss_limit_added_percent",
    "loss_limit_added_is_reached",
    "level_not_significant",
    "n_beyond_at_baseline",
    "n_trials",
    "largest_error_at_baseline_pct",
    "largest_error_pct",
)


def with_added_error(observations: pd.DataFrame) -> pd.DataFrame:
    """Add ``added_error``: the error less that of the same trial under the baseline condition.

    Parameters
    ----------
    observations : DataFrame
        From :func:`swaystride.studies.imu_design.observations.observations`.

    Examples
    --------
    >>> table = pd.DataFrame({"participant": "P01", "trial": "01", "experiment": "gyro_range",
    ...     "condition": ["baseline_2000dps", "500dps"], "error_pct": [-1.0, -4.0]})
    >>> with_added_error(table)["added_error"].tolist()
    [0.0, -3.0]
    """
    keys = ["participant", "trial", "experiment"]
    base = observations[observations["condition"].str.startswith("baseline_")]
    reference = base.set_index(keys)["error_pct"].rename("reference")
    joined = observations.join(reference, on=keys)
    return joined.assign(
        error=joined["error_pct"], added_error=joined["error_pct"] - joined["reference"]
    ).drop(columns="reference")


def level_needed(rows: pd.DataFrame, column: str, limit_pct: float) -> float:
    """Smallest range or rate from which on every error stays within the limit.

    Parameters
    ----------
    rows : DataFrame
        One experiment: ``level`` and the column of errors.
    column : str
    limit_pct : float

    Returns
    -------
    float
        NaN if even the largest level has an error beyond the limit.

    Examples
    --------
    >>> rows = pd.DataFrame({"level": [50.0, 24.0, 16.0, 16.0], "error": [1.0, -4.0, 2.0, -6.0]})
    >>> level_needed(rows, "error", 5.0)
    24.0
    """
    within = (rows[column].abs() <= limit_pct).groupby(rows["level"]).all().sort_index()
    failing = within.index[~within.to_numpy()]
    passing = within.index[within.index > failing.max()] if len(failing) else within.index
    return float(passing.min()) if len(passing) else float("nan")


def loss_limit(rows: pd.DataFrame, column: str, limit_pct: float) -> tuple[float, bool]:
    """Data loss below which every error stays within the limit.

    Parameters
    ----------
    rows : DataFrame
        One experiment: ``loss_percent`` and the column of errors.
    column : str
    limit_pct : float

    Returns
    -------
    limit : float
        The smallest loss that goes with an error beyond the limit; if there is none, the largest
        loss that was seen. NaN if nothing is truncated by design.
    reached : bool
        Whether an error beyond the limit was seen at all.

    Examples
    --------
    >>> rows = pd.DataFrame({"loss_percent": [0.0, 1.0, 3.0, 4.0], "error": [1.0, 4.0, -7.0, 5.0]})
    >>> loss_limit(rows, "error", 5.0)
    (3.0, True)
    """
    beyond = rows[column].abs() > limit_pct
    losses = rows["loss_percent"].to_numpy(dtype=float)
    if np.isnan(losses).all():
        return float("nan"), bool(beyond.any())
    if beyond.any():
        return float(losses[beyond.to_numpy()].min()), True
    return float(losses.max()), False


def level_not_significant(effects: pd.DataFrame, levels: pd.Series, alpha: float) -> float:
    """Smallest level from which on no condition changes the slope significantly.

    Parameters
    ----------
    effects : DataFrame
        Effects of one experiment and model, the baseline first.
    levels : Series
        Level by condition.
    alpha : float
        Significance level.

    Examples
    --------
    >>> effects = pd.DataFrame({"effect": ["baseline_9g", "5g", "3g", "1g"], "p": [0.01, 0.4, 0.02, 0.3]})
    >>> levels = pd.Series({"baseline_9g": 9.0, "5g": 5.0, "3g": 3.0, "1g": 1.0})
    >>> level_not_significant(effects, levels, 0.05)
    5.0
    """
    others = effects.iloc[1:]
    significant = levels[others.loc[others["p"] < alpha, "effect"]]
    allowed = levels[levels > significant.max()] if len(significant) else levels
    return float(allowed.min())


def requirements(
    observations: pd.DataFrame, effects: pd.DataFrame, plan: ImuDesignPlan
) -> pd.DataFrame:
    """What each experiment asks of an IMU, by the errors and by the models.

    Parameters
    ----------
    observations : DataFrame
    effects : DataFrame
        Of all experiments, from :func:`swaystride.studies.imu_design.models.effects`.
    plan : ImuDesignPlan

    Returns
    -------
    DataFrame
        :data:`REQUIREMENT_COLUMNS`, one row per experiment; columns with ``added`` judge the
        difference from the baseline of the same trial.
    """
    table = with_added_error(observations)
    limit = plan.distance_error_limit_pct
    rows = []
    for experiment in EXPERIMENTS:
        own = table[table["experiment"] == experiment]
        base = own[own["condition"].str.startswith("baseline_")]
        levels = own.drop_duplicates("condition").set_index("condition")["level"]
        chosen = effects[(effects["experiment"] == experiment) & (effects["model"] == plan.model)]
        loss, reached = loss_limit(own, "error", limit)
        loss_added, reached_added = loss_limit(own, "added_error", limit)
        rows.append(
            (
                experiment,
                level_needed(own, "error", limit),
                loss,
                reached,
                level_needed(own, "added_error", limit),
                loss_added,
                reached_added,
                level_not_significant(chosen, levels, plan.significance_level),
                int((base["error"].abs() > limit).sum()),
                len(base),
                float(base["error"].iloc[base["error"].abs().argmax()]),
                float(own["error"].iloc[own["error"].abs().argmax()]),
            )
        )
    return pd.DataFrame(rows, columns=list(REQUIREMENT_COLUMNS))


def slope_of(effects: pd.DataFrame, experiment: ExperimentName, model: str) -> pd.DataFrame:
    """Slopes and p-values of one experiment under one model, by effect.

    Parameters
    ----------
    effects : DataFrame
        Of all experiments.
    experiment : str
    model : str
        A key of :data:`swaystride.studies.imu_design.plan.RANDOM_TERMS`.
    """
    own = effects[(effects["experiment"] == experiment) & (effects["model"] == model)]
    return own.set_index("effect")[[SLOPE, "se", "df", "p", "ci_low", "ci_high"]]
