"""Inter-rater reliability of the therapists' ratings (§3.3.4.1; spec §8.4)."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd

from swaystride.stats.cluster_bootstrap import jackknife_clusters, jackknife_interval
from swaystride.stats.formula_design import design_from_formula
from swaystride.stats.grouping_factor import CodeArray
from swaystride.stats.mixed_fit import fit_design
from swaystride.stats.mixed_formula import parse_mixed_formula
from swaystride.stats.mixed_model import MixedModelFit, fit_mixed_model
from swaystride.stats.reliability import (
    ReliabilityForm,
    bootstrap_icc,
    intraclass_correlation,
    reliability_class,
    reliability_formula,
)
from swaystride.studies.intensity.plan import (
    EXERCISE,
    PARTICIPANT,
    RATER,
    RATING_LEVELS,
    TRIAL,
    IntensityPlan,
    RatingLevel,
)
from swaystride.studies.intensity.results import result_row, results

#: Both readings of the decomposition.
FORMS: Final[tuple[ReliabilityForm, ...]] = ("printed", "recommended")


def fit_decomposition(
    ratings: pd.DataFrame, level: RatingLevel, form: ReliabilityForm
) -> MixedModelFit:
    """Decompose the variance of the ratings, by REML.

    Parameters
    ----------
    ratings : DataFrame
        As from :func:`swaystride.studies.intensity.observations.analysed_ratings`.
    level : {"per_trial", "per_exercise"}
    form : {"printed", "recommended"}
    """
    formula = reliability_formula(
        form,
        outcome="rating",
        patient=PARTICIPANT,
        exercise=EXERCISE,
        rater=RATER,
        trial=TRIAL if level == "per_trial" else None,
    )
    own = _with_whole_trials(ratings[ratings["rating_level"] == level], level)
    return fit_mixed_model(formula, own, reml=True)


def reliability(ratings: pd.DataFrame, plan: IntensityPlan) -> dict[str, pd.DataFrame]:
    """ICC of the ratings of trials and of exercises, with both intervals.

    The model's interval is a parametric bootstrap. The participant-level one is a jackknife over
    patients on Fisher's z scale, with t of m − 1 degrees of freedom: resampling the patients
    thousands of times, with a fit of thirteen components each, would take hours.

    Parameters
    ----------
    ratings : DataFrame
        As from :func:`swaystride.studies.intensity.observations.analysed_ratings`.
    plan : IntensityPlan

    Returns
    -------
    dict of str to DataFrame
        ``results``; ``components``: every variance with its share, for both forms.
    """
    rows, components = [], []
    for level in RATING_LEVELS:
        fits = {form: fit_decomposition(ratings, level, form) for form in FORMS}
        components += [_components(fit, level, form) for form, fit in fits.items()]
        chosen = fits[plan.icc_form]
        drawn = bootstrap_icc(
            chosen,
            RATER,
            n=plan.icc_bootstrap_n,
            seed=plan.icc_bootstrap_seed,
            level=plan.confidence_level,
            processes=plan.processes,
        )
        interval = _jackknife(chosen, ratings[ratings["rating_level"] == level], level, plan)
        rows.append(
            result_row(
                f"study3_text/icc_pt_{level}",
                drawn.icc,
                n=chosen.n_observations,
                ci=(drawn.ci_low, drawn.ci_high),
                participant_ci=interval,
            )
        )
    return {"results": results(rows), "components": pd.concat(components, ignore_index=True)}


def _jackknife(
    fit: MixedModelFit, own: pd.DataFrame, level: RatingLevel, plan: IntensityPlan
) -> tuple[float, float]:
    """Interval of the ICC from refits without each patient, each starting at the whole fit."""
    formula = parse_mixed_formula(fit.formula)
    start = np.asarray(fit.estimates.gamma)
    own = _with_whole_trials(own, level)

    def icc_of(rows: CodeArray) -> float:
        design, y = design_from_formula(formula, own.iloc[rows])
        variances = fit_design(design, y, reml=True, start=start).variances
        components = pd.Series(variances, index=fit.variance_components.index)
        return float(intraclass_correlation(components, RATER))

    icc = float(intraclass_correlation(fit.variance_components, RATER))
    left_out = jackknife_clusters(icc_of, own[PARTICIPANT])
    low, high = jackknife_interval(icc, left_out, level=plan.confidence_level, scale="fisher_z")
    return low, high


def _with_whole_trials(own: pd.DataFrame, level: RatingLevel) -> pd.DataFrame:
    """Trial numbers as plain integers, which the formula can read."""
    return own.assign(trial=own[TRIAL].astype("int64")) if level == "per_trial" else own


def quick_icc(ratings: pd.DataFrame, plan: IntensityPlan) -> pd.DataFrame:
    """The two ICC without intervals.

    Parameters
    ----------
    ratings : DataFrame
        As for :func:`reliability`.
    plan : IntensityPlan
    """
    rows = []
    for level in RATING_LEVELS:
        fit = fit_decomposition(ratings, level, plan.icc_form)
        icc = float(intraclass_correlation(fit.variance_components, RATER))
        rows.append(result_row(f"study3_text/icc_pt_{level}", icc, n=fit.n_observations))
    return results(rows)


def _components(fit: MixedModelFit, level: RatingLevel, form: str) -> pd.DataFrame:
    """Every variance component with its share of the sum, and what the ICC makes of them."""
    variances = fit.variance_components
    icc = float(intraclass_correlation(variances, RATER))
    return pd.DataFrame(
        {
            "rating": level,
            "form": form,
            "component": variances.index.str.replace(":", " × "),
            "variance": variances.to_numpy(),
            "share": variances.to_numpy() / variances.sum(),
            "contains_rater": [
                "yes" if name == "Residual" or RATER in name.split(":") else "no"
                for name in variances.index
            ],
            "icc": icc,
            "reliability": reliability_class(icc),
            "singular": "yes" if fit.is_singular else "no",
            "converged": "yes" if fit.converged else "no",
        }
    )
