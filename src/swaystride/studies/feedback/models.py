"""The statistical analysis of one feature (dissertation §2.3.3; spec §8.3).

The log of the feature is modelled with a random intercept for the participant, twice: with the
exponent and terms that the chapter prints, and with those that our own search chooses. The effects
of Tables 2.3 and 2.4 are weighted sums of fixed effects of these models.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.errors import DesignError, ModelError
from swaystride.stats.mixed_model import MixedModelFit, fit_mixed_model
from swaystride.stats.selection import (
    Elimination,
    ExponentSearch,
    eliminate_terms,
    raise_to_exponent,
    search_exponent,
)
from swaystride.studies.feedback.design import MODEL_VARIABLES, model_variables
from swaystride.studies.feedback.plan import (
    MAXIMAL_TERMS,
    TERMS_OF_INTEREST,
    TRIAL_NUMBER,
    Effect,
    ModelPlan,
    effects,
)

PARTICIPANT = "participant"


@dataclass(frozen=True)
class FeatureModel:
    """One fitted model of one feature.

    Parameters
    ----------
    name : {"printed", "searched"}
    exponent : float
        On the trial number.
    terms : tuple of str
        Fixed effects, intercept aside.
    fit : MixedModelFit
    """

    name: str
    exponent: float
    terms: tuple[str, ...]
    fit: MixedModelFit


def observations(
    participants: pd.DataFrame,
    trials: pd.DataFrame,
    measures: pd.DataFrame,
    exclusions: pd.DataFrame,
    plan: ModelPlan,
) -> pd.DataFrame:
    """Model variables and features of every analysed trial.

    Parameters
    ----------
    participants, trials : DataFrame
        As from :func:`swaystride.studies.feedback.design.read_design`.
    measures : DataFrame
        Sway measures by ``participant`` and ``trial``.
    exclusions : DataFrame
        Excluded trials; with the measures they must account for every trial.
    plan : ModelPlan

    Raises
    ------
    DesignError
        If a trial is neither measured nor excluded.
    """
    variables = model_variables(participants, trials, trial_number_coding=plan.trial_number_coding)
    keys = [PARTICIPANT, "trial"]
    frame = variables.merge(measures, on=keys, how="left", validate="one_to_one")
    missing = frame["duration_s"].isna()
    excluded = set(zip(exclusions[PARTICIPANT], exclusions["trial"], strict=True))
    for row in frame[missing].itertuples(index=False):
        if (row.participant, row.trial) not in excluded:
            raise DesignError(
                "trial is neither measured nor excluded",
                place=f"participant {row.participant}, {row.trial}",
            )
    frame = frame[~missing].reset_index(drop=True)
    frame["ellipse_area"] = frame[plan.ellipse_measure]
    return frame


def analyse_feature(frame: pd.DataFrame, feature: str, plan: ModelPlan) -> dict[str, pd.DataFrame]:
    """Fit both models of a feature and collect what the tables and figures need.

    Parameters
    ----------
    frame : DataFrame
        As from :func:`observations`.
    feature : str
        One of :data:`swaystride.studies.feedback.plan.FEATURES`.
    plan : ModelPlan

    Returns
    -------
    dict of str to DataFrame
        ``fixed_effects``, ``contrasts``, ``exponents`` (log-likelihood on the grid),
        ``elimination`` (path) and ``predictions`` (of the printed model), each with ``feature``.
    """
    exponents, elimination, searched_exponent, searched_terms = _search(frame, feature, plan)
    models = [
        fit_printed(frame, feature, plan),
        _fit(frame, feature, "searched", searched_exponent, searched_terms, plan),
    ]
    tables = {
        "fixed_effects": pd.concat([_fixed_effects(m, plan) for m in models], ignore_index=True),
        "contrasts": pd.concat(
            [effect_estimates(frame, feature, m, plan) for m in models], ignore_index=True
        ),
        "exponents": exponents,
        "elimination": elimination,
        "predictions": _predictions(frame, models[0]),
    }
    for table in tables.values():
        table.insert(0, "feature", feature)
    return tables


def fit_printed(frame: pd.DataFrame, feature: str, plan: ModelPlan) -> FeatureModel:
    """Fit the model of a feature with the exponent and terms of Table 2.2.

    Parameters
    ----------
    frame : DataFrame
        Model variables and features of every trial.
    feature : str
    plan : ModelPlan
    """
    exponent, terms = plan.printed_exponents[feature], plan.printed_terms[feature]
    return _fit(frame, feature, "printed", exponent, terms, plan)


def effect_estimates(
    frame: pd.DataFrame, feature: str, model: FeatureModel, plan: ModelPlan
) -> pd.DataFrame:
    """Effects of Tables 2.3 and 2.4 under one model.

    A term that the model lacks counts as zero. An effect that consists of such a term comes from
    a refit with it; ``refit_with`` then names the term (spec §8.3, "Effects").

    Parameters
    ----------
    frame : DataFrame
        As from :func:`observations`.
    feature : str
        One of the six.
    model : FeatureModel
        Fitted model.
    plan : ModelPlan
        Estimator, degrees of freedom and level.
    """
    rows = []
    for effect in effects(model.exponent, plan.last_training_trial):
        lacking = [term for term in effect.required if term not in model.terms]
        used = model
        if lacking:
            terms = (*model.terms, *lacking)
            used = _fit(frame, feature, model.name, model.exponent, terms, plan)
        rows.append(
            {
                "model": model.name,
                "panel": effect.panel,
                "effect": effect.name,
                "exponent": model.exponent,
                "refit_with": " ".join(lacking),
                **_estimate(effect, used, plan),
                "n": used.fit.n_observations,
                "last_training_trial": plan.last_training_trial,
            }
        )
    return pd.DataFrame(rows)


def model_frame(frame: pd.DataFrame, feature: str, exponent: float) -> pd.DataFrame:
    """Variables of the model: the log of the feature, and N raised to the exponent.

    Parameters
    ----------
    frame : DataFrame
        As from :func:`observations`.
    feature : str
        One of the six.
    exponent : float
        On the trial number.
    """
    variables = frame[[PARTICIPANT, *MODEL_VARIABLES]].assign(log_feature=np.log(frame[feature]))
    return raise_to_exponent(variables, TRIAL_NUMBER, exponent)


def _search(
    frame: pd.DataFrame, feature: str, plan: ModelPlan
) -> tuple[pd.DataFrame, pd.DataFrame, float, tuple[str, ...]]:
    """Exponent by the likelihood of the maximal model, then terms by AIC."""
    n_exponents = round((plan.largest_exponent - plan.smallest_exponent) / plan.exponent_step) + 1
    grid = plan.smallest_exponent + plan.exponent_step * np.arange(n_exponents, dtype=np.float64)
    with _named(f"maximal model of {feature}"):
        search, chosen = _search_maximal(frame, feature, grid)
    exponents = search.loglik.rename_axis("exponent").reset_index()
    return exponents, chosen.path, search.best, chosen.terms


def _search_maximal(
    frame: pd.DataFrame, feature: str, grid: NDArray[np.float64]
) -> tuple[ExponentSearch, Elimination]:
    """Search the exponent, then eliminate terms at the best one."""
    search = search_exponent(
        model_frame(frame, feature, 1.0),
        "log_feature",
        MAXIMAL_TERMS,
        [PARTICIPANT],
        base=TRIAL_NUMBER,
        exponents=[float(a) for a in grid.round(10)],
    )
    chosen = eliminate_terms(
        model_frame(frame, feature, search.best),
        "log_feature",
        MAXIMAL_TERMS,
        [PARTICIPANT],
        protected=TERMS_OF_INTEREST,
    )
    return search, chosen


@contextmanager
def _named(model: str) -> Iterator[None]:
    """Name the model in errors, and what a cohort needs for it."""
    try:
        yield
    except ModelError as error:
        raise ModelError(
            error.problem,
            place=model,
            expected=error.expected or "participants of both orders and both sexes, both blocks",
            found=error.found,
        ) from error


def _fit(
    frame: pd.DataFrame,
    feature: str,
    name: str,
    exponent: float,
    terms: Sequence[str],
    plan: ModelPlan,
) -> FeatureModel:
    """Fit one model by the estimator of the plan."""
    formula = f"log_feature ~ {' + '.join(terms)} + (1|{PARTICIPANT})"
    variables = model_frame(frame, feature, exponent)
    with _named(f"{name} model of {feature}"):
        fit = fit_mixed_model(formula, variables, reml=plan.estimator == "reml")
    return FeatureModel(name, exponent, tuple(terms), fit)


def _estimate(effect: Effect, model: FeatureModel, plan: ModelPlan) -> dict[str, float]:
    """One effect as a contrast of a model."""
    weights = {term: w for term, w in effect.weights.items() if term in model.terms}
    row = model.fit.contrast(weights, df=plan.degrees_of_freedom, level=plan.confidence_level).iloc[
        0
    ]
    return {
        name: float(row[name]) for name in ("estimate", "se", "df", "t", "p", "ci_low", "ci_high")
    }


def _fixed_effects(model: FeatureModel, plan: ModelPlan) -> pd.DataFrame:
    """Fixed effects of a model with its criterion and variance components."""
    table = model.fit.fixed_effects(df=plan.degrees_of_freedom, level=plan.confidence_level)
    table = table.rename_axis("term").reset_index()
    table.insert(0, "model", model.name)
    table.insert(1, "exponent", model.exponent)
    variances = model.fit.variance_components
    return table.assign(
        variance_participant=variances[PARTICIPANT],
        variance_residual=variances["Residual"],
        loglik=model.fit.loglik,
        aic=model.fit.aic,
    )


def _predictions(frame: pd.DataFrame, model: FeatureModel) -> pd.DataFrame:
    """Fitted values, residuals, and the standard error of the three effects of interest alone."""
    names = list(model.fit.fixed_effects(df="residual").index)
    chosen = [names.index(term) for term in TERMS_OF_INTEREST]
    covariance = np.asarray(model.fit.covariance)[np.ix_(chosen, chosen)]
    variables = frame[list(TERMS_OF_INTEREST)].to_numpy(dtype=np.float64).copy()
    variables[:, 0] **= model.exponent
    variance = np.einsum("ij,jk,ik->i", variables, covariance, variables)
    return pd.DataFrame(
        {
            PARTICIPANT: frame[PARTICIPANT],
            "trial": frame["trial"],
            "fitted": np.asarray(model.fit.fitted),
            "residual": np.asarray(model.fit.residuals),
            "interest_se": np.sqrt(variance),
        }
    )
