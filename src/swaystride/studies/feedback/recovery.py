"""Recovery: what the printed models find, over many simulated cohorts, of what was put in."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

import numpy as np
import pandas as pd

from swaystride.studies.feedback.models import FeatureModel, effect_estimates, fit_printed
from swaystride.studies.feedback.plan import FEATURES, ModelPlan

KEYS: Final = ["panel", "feature", "effect"]


def cohort_estimates(
    variables: pd.DataFrame, log_features: pd.DataFrame, plan: ModelPlan
) -> pd.DataFrame:
    """Effects of one cohort at the printed exponents and terms.

    Parameters
    ----------
    variables : DataFrame
        Model variables of every trial.
    log_features : DataFrame
        Logarithm of the six features, rows as in `variables`.
    plan : ModelPlan

    Returns
    -------
    DataFrame
        Contrasts as from :func:`swaystride.studies.feedback.models.effect_estimates`.
    """
    frame = variables.assign(
        **{feature: np.exp(log_features[feature].to_numpy()) for feature in FEATURES}
    )
    tables = []
    for feature in FEATURES:
        model: FeatureModel = fit_printed(frame, feature, plan)
        tables.append(effect_estimates(frame, feature, model, plan).assign(feature=feature))
    return pd.concat(tables, ignore_index=True)


def recovery_table(
    cohorts: Iterable[pd.DataFrame], truth: pd.DataFrame, attainable: pd.DataFrame, variant: str
) -> pd.DataFrame:
    """Bias and coverage of every effect over many cohorts.

    Parameters
    ----------
    cohorts : iterable of DataFrame
        Estimates of each cohort (:func:`cohort_estimates`).
    truth : DataFrame
        True effects (:func:`swaystride.studies.feedback.truth.true_effects`).
    attainable : DataFrame
        Which printed rows can hold together; effects outside Table 2.3 count as not printed.
    variant : str

    Returns
    -------
    DataFrame
        ``variant``, ``quantity``, ``truth``, ``mean``, ``bias``, ``empirical_sd``, ``model_se``,
        ``coverage``, ``n_cohorts``, then ``bias_in_se`` and ``attainable``.
    """
    estimates = pd.concat(list(cohorts), ignore_index=True)
    merged = estimates.merge(truth[[*KEYS, "truth"]], on=KEYS, validate="many_to_one")
    merged["covered"] = merged["truth"].between(merged["ci_low"], merged["ci_high"])
    grouped = merged.groupby(KEYS, sort=False)
    table = grouped.agg(
        truth=("truth", "first"),
        mean=("estimate", "mean"),
        empirical_sd=("estimate", "std"),
        model_se=("se", "mean"),
        coverage=("covered", "mean"),
        n_cohorts=("estimate", "size"),
    ).reset_index()
    table["bias"] = table["mean"] - table["truth"]
    table["bias_in_se"] = table["bias"] / table["model_se"]
    table = table.merge(attainable[[*KEYS, "attainable"]], on=KEYS, how="left")
    table["attainable"] = table["attainable"].map({True: "yes", False: "no"}).fillna("not printed")
    table["variant"] = variant
    table["quantity"] = table["panel"] + " " + table["effect"] + ": " + table["feature"]
    first = ["variant", "quantity", "truth", "mean", "bias", "empirical_sd", "model_se"]
    return table[[*first, "coverage", "n_cohorts", "bias_in_se", "attainable"]]
