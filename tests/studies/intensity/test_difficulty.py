"""Difficulty of the exercise: statsmodels, exact effects, and what the two intervals mean."""

import numpy as np
import pandas as pd
import pytest
import statsmodels.formula.api as smf

from swaystride.stats.cluster_bootstrap import bootstrap_interval, cluster_resamples
from swaystride.studies.intensity.difficulty import difficulty, fit_difficulty, residuals
from swaystride.studies.intensity.results import patient_weights


def row(table, quantity):
    return table.set_index("quantity").loc[f"table_3_2/{quantity}"].astype(float)


def test_the_printed_model_is_that_of_statsmodels(ratings, plan):
    """Crossed random intercepts by maximum likelihood, df = rows minus fixed effects."""
    own = ratings[ratings["rating_level"] == "per_exercise"].assign(everything=1)
    model = smf.mixedlm(
        "rating ~ stance",
        own,
        groups="everything",
        re_formula="0",
        vc_formula={"participant": "0 + C(participant)", "rater": "0 + C(rater)"},
    )
    theirs = model.fit(reml=False, method="lbfgs", start_params=None)
    ours = row(difficulty(ratings, plan), "stance/per_exercise")
    np.testing.assert_allclose(ours["estimate"], theirs.params["stance"], atol=2e-4)
    np.testing.assert_allclose(ours["se"], theirs.bse["stance"], rtol=5e-3)
    assert ours["df"] == len(own) - 2


def test_effects_of_noise_free_ratings_are_exact(ratings, plan):
    noise = np.random.default_rng(1).normal(0, 1e-6, len(ratings))
    exact = ratings.assign(rating=1.0 + 0.7 * ratings["stance"] + noise)
    found = row(difficulty(exact, plan), "stance/per_trial")
    np.testing.assert_allclose(found["estimate"], 0.7, atol=1e-5)
    limits = found[["participant_ci_low", "participant_ci_high"]]
    np.testing.assert_allclose(limits, 0.7, atol=1e-5)


def test_ratings_given_again_narrow_the_interval_of_the_model_only(ratings, plan):
    """The same patients and exercises with every rating copied thrice carry no more information."""
    copies = pd.concat([ratings] * 3, ignore_index=True)
    once, thrice = (row(difficulty(t, plan), "stance/per_exercise") for t in (ratings, copies))
    model = [r["ci_high"] - r["ci_low"] for r in (once, thrice)]
    patients = [r["participant_ci_high"] - r["participant_ci_low"] for r in (once, thrice)]
    assert model[1] < 0.7 * model[0]
    assert patients[1] == pytest.approx(patients[0], rel=0.1)


def test_the_participant_interval_comes_from_refits_of_whole_patients(ratings, plan_with):
    """Generalised least squares at the same variance ratios barely differs from refitting."""
    plan = plan_with(cluster_bootstrap_n=40)
    own = ratings[ratings["rating_level"] == "per_exercise"].reset_index(drop=True)
    fit = fit_difficulty(ratings, "stance", "per_exercise", plan)
    estimate = float(fit.fixed_effects("residual").loc["stance", "estimate"])
    draws = []
    resamples = cluster_resamples(own["participant"], 40, plan.cluster_bootstrap_seed)
    for rows in resamples:
        drawn = own.iloc[rows].copy()
        copy = drawn.groupby(drawn.index).cumcount().astype(str)
        drawn["participant"] = drawn["participant"] + "/" + copy
        refit = fit_difficulty(drawn, "stance", "per_exercise", plan)
        draws.append(float(refit.fixed_effects("residual").loc["stance", "estimate"]))
    expected = bootstrap_interval(estimate, draws, n_clusters=6, level=0.95, scale="identity")
    found = row(difficulty(ratings, plan), "stance/per_exercise")
    width = expected.high - expected.low
    assert found["participant_ci_low"] == pytest.approx(expected.low, abs=0.1 * width)
    assert found["participant_ci_high"] == pytest.approx(expected.high, abs=0.1 * width)


def test_the_recommended_model_has_an_intercept_of_the_exercise(ratings, plan_with):
    plan = plan_with(exercise_within_patient=True, estimator="reml")
    fit = fit_difficulty(ratings, "surface", "per_trial", plan)
    assert fit.reml
    assert list(fit.n_groups) == ["participant", "participant:exercise", "rater"]
    printed = fit_difficulty(ratings, "surface", "per_trial", plan_with())
    assert list(printed.n_groups) == ["participant", "rater"]
    assert not printed.reml


def test_residuals_and_fits_add_up_to_the_ratings(ratings, plan):
    table = residuals(ratings, plan)
    assert len(table) == 4 * len(ratings)
    own = table[(table["rating"] == "per_trial") & (table["dimension"] == "surface")]
    wanted = ratings.loc[ratings["rating_level"] == "per_trial", "rating"]
    np.testing.assert_allclose(own["fitted"] + own["residual"], wanted)


def test_resamples_of_one_patient_alone_are_left_out(plan_with):
    plan = plan_with(cluster_bootstrap_n=500)
    weights = patient_weights(2, plan)
    assert (weights == 1).all()
    assert 200 < len(weights) < 300
    assert patient_weights(10, plan).shape == (500, 10)
