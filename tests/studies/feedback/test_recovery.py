"""Small version of the recovery study: known effects come back without bias."""

import numpy as np
import pytest

from swaystride.simulate.feedback_population import (
    draw_features,
    expected_log_features,
    variance_ratios,
)
from swaystride.studies.feedback.identities import attainability
from swaystride.studies.feedback.recovery import cohort_estimates, recovery_table
from swaystride.studies.feedback.truth import true_effects

N_COHORTS = 12


@pytest.fixture(scope="module")
def ordered(design, variables):
    """Design rows in the order of the model variables."""
    rows = design.sort_values(["participant", "session_trial"])
    assert (rows["participant"].to_numpy() == variables["participant"].to_numpy()).all()
    return rows


@pytest.fixture(scope="module")
def truth(ordered, variables, cohort, plan):
    expected = expected_log_features(ordered, cohort.population)
    return true_effects(variables, expected, plan, variance_ratios(cohort.population))


def test_the_truth_of_the_free_features_is_the_printed_table(truth, printed):
    """AP RMS, ML RMS and MV: what the printed models see without scatter is what is printed.

    Half a printed standard error is allowed: the printed AP model lacks Block:N^a, which its own
    refit shows not to be zero, so that its other effects absorb a little of it.
    """
    keys = ["panel", "feature", "effect"]
    both = printed.merge(truth[[*keys, "truth"]], on=keys)
    free = both[both["feature"].isin(["ap_rms", "ml_rms", "phi_mv"])]
    printed_se = (free["ci_high"] - free["ci_low"]) / (2 * 1.96)
    assert len(free) == 12
    assert ((free["truth"] - free["estimate"]).abs() < 0.5 * printed_se).all()
    exact = free[free["feature"] != "ap_rms"]
    np.testing.assert_allclose(exact["truth"], exact["estimate"], atol=1e-9)


def test_printed_models_recover_the_truth(ordered, variables, cohort, plan, truth, printed):
    """Mean bias within what the number of cohorts allows; intervals cover most of the time."""
    estimates = [
        cohort_estimates(
            variables,
            draw_features(ordered, cohort.population, np.random.default_rng([71, number])),
            plan,
        )
        for number in range(N_COHORTS)
    ]
    table = recovery_table(estimates, truth, attainability(printed, 15), "printed")
    assert (table["n_cohorts"] == N_COHORTS).all()
    # 4 standard errors of a mean of N_COHORTS estimates, for 42 correlated quantities: the small
    # version catches a wrong sign or coding; make recovery holds 200 cohorts to 0.25
    assert (table["bias_in_se"].abs() < 4.0 / np.sqrt(N_COHORTS)).all()
    assert table["coverage"].mean() > 0.88
    assert (table["attainable"] == "yes").sum() == 13
