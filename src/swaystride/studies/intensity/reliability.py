"""Inter-rater reliability of the therapists' ratings (§3.3.4.1; spec §8.4)."""

from __future__ import annotations

from typing import Final

import pandas as pd

from swaystride.stats.cluster_bootstrap import jackknife_clusters, jackknife_interval
from swaystride.stats.grouping_factor import CodeArray
from swaystride.stats.mixed_model import MixedModelFit, fit_mixed_model
from swaystride.stats.reliability import (
    ReliabilityForm,
    bootstrap_icc,
    intraclass_correlation,
    reliability_class,
    reliability_formula,
)
from swaystride.studies.intensity.plan import RATING_LEVELS, IntensityPlan, RatingLevel
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
    own = ratings[ratings["rating_level"] == level]
    formula = reliability_formula(
        form,
        outcome="rating",
        patient="participant",
        exercise="exercise",
        rater="rater",
        trial="trial" if level == "per_trial" else None,
    )
    if level == "per_trial":
        own = own.assign(trial=own["trial"].astype("int64"))
    return fit_mixed_model(formula, own, reml=True)


def reliability(ratings: pd.DataFrame, plan: IntensityPlan) -> dict[str, pd.DataFrame]:
    """ICC of the ratings of trials and of exercises, with both intervals.

    The model's interval is a parametric bootstrap. The participant-level one is a jackknife over
    patients on Fisher's z scale: to resample them a thousand times would take hours.

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
        fits = {
            form: fit_decomposition(ratings, level, form) for form in ("printed", "recommended")
        }
        components += [_components(fit, level, form) for form, fit in fits.items()]
        chosen = fits[plan.icc_form]
        drawn = bootstrap_icc(
            chosen,
            "rater",
            n=plan.icc_bootstrap_n,
            seed=plan.icc_bootstrap_seed,
            level=plan.confidence_level,
            processes=plan.processes,
        )
        own = ratings[ratings["rating_level"] == level]

        def icc_of(
            rows_left: CodeArray, level: RatingLevel = level, own: pd.DataFrame = own
        ) -> float:
            fit = fit_decomposition(own.iloc[rows_left], level, plan.icc_form)
            return float(intraclass_correlation(fit.variance_components, "rater"))

        left_out = jackknife_clusters(icc_of, own["participant"])
        interval = jackknife_interval(
            drawn.icc, left_out, level=plan.confidence_level, scale="fisher_z"
        )
        rows.append(
            result_row(
                f"study3_text/icc_pt_{level}",
                drawn.icc,
                n=len(own),
                ci=(drawn.ci_low, drawn.ci_high),
                participant_ci=interval,
            )
        )
    return {"results": results(rows), "components": pd.concat(components, ignore_index=True)}


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
        icc = float(intraclass_correlation(fit.variance_components, "rater"))
        rows.append(result_row(f"study3_text/icc_pt_{level}", icc, n=fit.n_observations))
    return results(rows)


def _components(fit: MixedModelFit, level: RatingLevel, form: str) -> pd.DataFrame:
    """Every variance component with its share of the sum, and what the ICC makes of them."""
    variances = fit.variance_components
    icc = float(intraclass_correlation(variances, "rater"))
    return pd.DataFrame(
        {
            "rating": level,
            "form": form,
            "component": variances.index.str.replace(":", " × "),
            "variance": variances.to_numpy(),
            "share": variances.to_numpy() / variances.sum(),
            "contains_rater": [
                "yes" if name == "Residual" or "rater" in name.split(":") else "no"
                for name in variances.index
            ],
            "icc": icc,
            "reliability": reliability_class(icc),
            "singular": "yes" if fit.is_singular else "no",
            "converged": "yes" if fit.converged else "no",
        }
    )
