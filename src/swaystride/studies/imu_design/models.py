"""Mixed models of the distance error: how its dependence on speed changes with the IMU (appendix A)."""

from __future__ import annotations

import pandas as pd

from swaystride.errors import ModelError
from swaystride.stats.mixed_model import fit_mixed_model
from swaystride.studies.imu_design.experiments import ExperimentName
from swaystride.studies.imu_design.plan import (
    EFFECT_COLUMNS,
    RANDOM_TERMS,
    SLOPE,
    ImuDesignPlan,
    model_formula,
)

#: Fewest participants between whom the random intercept can be estimated at all.
FEWEST_PARTICIPANTS = 2


def experiment_frame(observations: pd.DataFrame, experiment: ExperimentName) -> pd.DataFrame:
    """Rows of one experiment, its conditions in order with the baseline as reference.

    Parameters
    ----------
    observations : DataFrame
        From :func:`swaystride.studies.imu_design.observations.observations`.
    experiment : str

    Raises
    ------
    ModelError
        If the experiment has no rows, or too few participants.
    """
    frame = observations[observations["experiment"] == experiment].reset_index(drop=True)
    people = sorted(frame["participant"].unique())
    if len(people) < FEWEST_PARTICIPANTS:
        raise ModelError(
            f"the models of {experiment} cannot be fitted",
            expected=f"trials of {FEWEST_PARTICIPANTS} participants or more",
            found=", ".join(people) or "none",
        )
    conditions = list(dict.fromkeys(frame["condition"]))
    return frame.assign(condition=pd.Categorical(frame["condition"], categories=conditions))


def effects(
    observations: pd.DataFrame, experiment: ExperimentName, plan: ImuDesignPlan
) -> pd.DataFrame:
    """Slopes of the distance error over speed: of the baseline, and what each condition adds.

    Both models are fitted by REML. The one that the tables rest on has profile intervals, as
    ``confint`` gives them in lme4, the other one those of Satterthwaite's t.

    Parameters
    ----------
    observations : DataFrame
    experiment : str
    plan : ImuDesignPlan

    Returns
    -------
    DataFrame
        :data:`swaystride.studies.imu_design.plan.EFFECT_COLUMNS`, the baseline first.
    """
    frame = experiment_frame(observations, experiment)
    conditions = list(frame["condition"].cat.categories)
    terms = ["speed_m_s", *(f"speed_m_s:condition[T.{name}]" for name in conditions[1:])]
    tables = []
    for model in RANDOM_TERMS:
        fit = fit_mixed_model(model_formula(model), frame, reml=True)
        table = fit.fixed_effects(df="satterthwaite", level=plan.confidence_level).loc[terms]
        if model == plan.model:
            limits = fit.confint(method="profile", level=plan.confidence_level).loc[terms]
            table = table.assign(ci_low=limits["ci_low"], ci_high=limits["ci_high"])
        tables.append(
            table.assign(
                experiment=experiment,
                model=model,
                effect=conditions,
                n=len(frame),
                n_trials=len(frame[["participant", "trial"]].drop_duplicates()),
                n_participants=frame["participant"].nunique(),
            )
        )
    joined = pd.concat(tables, ignore_index=True).rename(columns={"estimate": SLOPE})
    return joined[list(EFFECT_COLUMNS)]


def variance_components(observations: pd.DataFrame, experiment: ExperimentName) -> pd.DataFrame:
    """Standard deviations of the random parts of both models.

    Parameters
    ----------
    observations : DataFrame
    experiment : str

    Returns
    -------
    DataFrame
        ``experiment``, ``model``, ``component`` (participant, participant:trial, Residual),
        ``sd_pct``.
    """
    frame = experiment_frame(observations, experiment)
    rows = []
    for model in RANDOM_TERMS:
        fit = fit_mixed_model(model_formula(model), frame, reml=True)
        for component, variance in fit.variance_components.items():
            rows.append((experiment, model, str(component), float(variance) ** 0.5))
    return pd.DataFrame(rows, columns=["experiment", "model", "component", "sd_pct"])


def residuals(
    observations: pd.DataFrame, experiment: ExperimentName, plan: ImuDesignPlan
) -> pd.DataFrame:
    """Fitted values and residuals of the model that the tables rest on.

    Parameters
    ----------
    observations : DataFrame
    experiment : str
    plan : ImuDesignPlan

    Returns
    -------
    DataFrame
        ``experiment``, ``condition``, ``fitted``, ``residual``, by observation.
    """
    frame = experiment_frame(observations, experiment)
    fit = fit_mixed_model(model_formula(plan.model), frame, reml=True)
    return pd.DataFrame(
        {
            "experiment": experiment,
            "condition": frame["condition"].astype(str),
            "fitted": fit.fitted,
            "residual": fit.residuals,
        }
    )
