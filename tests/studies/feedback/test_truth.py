"""True effects: generalised least squares of the expected features, by an explicit twin."""

import numpy as np
import pytest

from swaystride.simulate.feedback_population import expected_log_features, variance_ratios
from swaystride.studies.feedback.truth import true_effects


@pytest.mark.parametrize("feature", ["phi_rms", "ellipse_area"])
def test_true_effects_are_generalised_least_squares(cohort, design, plan, feature):
    """The random intercept is written out as a covariance matrix."""
    rows = design.sort_values(["participant", "session_trial"], ignore_index=True)
    expected = expected_log_features(rows, cohort.population)
    ratios = variance_ratios(cohort.population)
    effects = true_effects(rows, expected, plan, ratios)
    terms = list(plan.printed_terms[feature])
    frame = rows.assign(trial_number=rows["trial_number"] ** plan.printed_exponents[feature])
    X = np.column_stack([np.ones(len(frame)), *(frame[term] for term in terms)])
    people = frame["participant"].to_numpy()
    covariance = ratios[feature] * (people[:, None] == people) + np.eye(len(frame))
    weights = np.linalg.inv(covariance)
    beta = np.linalg.solve(X.T @ weights @ X, X.T @ weights @ expected[feature].to_numpy())
    found = effects[effects["feature"] == feature].set_index(["panel", "effect"])["truth"]
    for key, term in (
        (("training", "concurrent"), "trial_number"),
        (("removal", "concurrent"), "concurrent_feedback_removed"),
        (("removal", "terminal"), "terminal_feedback_removed"),
    ):
        assert found[key] == pytest.approx(beta[1 + terms.index(term)], rel=1e-8)
