"""The population: printed truth, identities between features, scatter, and the full simulation."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from import_graph import REPOSITORY
from swaystride.configuration import load_yaml, plain_values
from swaystride.errors import ConfigurationError
from swaystride.simulate.feedback_cohort import design_rows, design_tables
from swaystride.simulate.feedback_parameters import cohort_from_config
from swaystride.simulate.feedback_population import (
    SIX_FEATURES,
    draw_features,
    draw_trials,
    expected_log_features,
    fixed_part,
)
from swaystride.simulate.seeds import generator
from swaystride.simulate.standing_response import FEATURES
from swaystride.simulate.standing_response_fit import simulate_run
from swaystride.sway.metrics import ELLIPSE_Z

PRINTED = pd.read_csv(REPOSITORY / "data" / "published" / "table_2_3.csv")
TERMS = {
    "phi_rms": ["block", "trial_number", "sex"],
    "ap_rms": ["block", "trial_number", "sex"],
    "ml_rms": [
        "trial_number",
        "block:trial_number",
        "block:order",
        "concurrent_feedback_removed:order",
    ],
    "phi_mv": ["trial_number", "block:trial_number", "terminal_feedback_removed:order"],
    "path_length": ["trial_number", "block:trial_number", "terminal_feedback_removed:order", "age"],
    "ellipse_area": ["block", "trial_number", "sex"],
}
TERMS = {
    name: ["concurrent_feedback_removed", "terminal_feedback_removed", *terms]
    for name, terms in TERMS.items()
}
EXPONENTS = dict(zip(PRINTED["feature"], PRINTED["exponent"], strict=True))


@pytest.fixture(scope="module")
def design(cohort):
    return design_rows(*design_tables(cohort, 5), cohort)


def settings():
    tree = load_yaml(REPOSITORY / "config" / "studies" / "feedback.yaml")
    return plain_values(tree["simulation"])


@pytest.mark.parametrize("feature", FEATURES)
def test_the_truth_is_the_printed_one(cohort, feature):
    rows = PRINTED[PRINTED["feature"] == feature].set_index(["panel", "effect"])
    truth = getattr(cohort.population, feature)
    assert rows["exponent"].unique().tolist() == [truth.exponent]
    printed = rows["estimate"]
    assert truth.concurrent == printed["training", "concurrent"]
    assert truth.terminal_minus_concurrent == printed["training", "terminal_minus_concurrent"]
    assert truth.concurrent_removed == printed["removal", "concurrent"]
    assert truth.terminal_removed == printed["removal", "terminal"]


@pytest.mark.parametrize("feature", FEATURES)
def test_terms_that_the_print_excludes_are_zero(cohort, feature):
    included = pd.read_csv(REPOSITORY / "data" / "published" / "table_2_2.csv").set_index("feature")
    coefficients = getattr(cohort.population, feature).coefficients()
    for term, value in coefficients.items():
        # Block:N^a has a printed effect everywhere, from refits (I-03).
        if term != "block_x_trial_number" and included.loc[feature, term] == "no":
            assert value == 0.0, term
        if included.loc[feature, term] == "yes*":
            assert value != 0.0, term


def test_effects_follow_from_the_coefficients_as_the_spec_says(cohort):
    c = cohort.population.phi_mv.coefficients()
    assert c["trial_number"] + c["block_x_trial_number"] == pytest.approx(0.044)
    assert -c["block_x_trial_number"] == pytest.approx(-0.116)
    assert c["terminal_feedback_removed"] + c["terminal_feedback_removed_x_order"] == pytest.approx(
        -0.027
    )


def test_fixed_part_by_hand(cohort):
    rows = pd.DataFrame(
        {
            "participant": ["a", "a", "b"],
            "order": [0.0, 0.0, 1.0],
            "block": [0.0, 1.0, 1.0],
            "trial_number": [0.0, 9.0, 16.0],
            "concurrent_feedback_removed": [0.0, 1.0, 0.0],
            "terminal_feedback_removed": [0.0, 0.0, 0.0],
            "age": [70.0, 75.0, 60.0],
            "sex": [0.0, 1.0, 0.0],
            "pendulum_height_m": [0.85, 0.85, 0.9],
        }
    )
    ap, ml, mv = fixed_part(rows, cohort.population).T
    assert ap[0] == pytest.approx(np.log(1.24))
    # β_N = −.038 + ½ · .007, β_{Block:N} = −.007
    slope = -0.038 + 0.0035 - 0.007
    assert ap[1] == pytest.approx(np.log(1.24) - 0.1 + slope * 3 + 0.121 + 0.35)
    assert ml[2] == pytest.approx(np.log(1.03) - 0.095 * 16**0.1 - 0.12)
    assert mv[2] == pytest.approx(np.log(1.43) + 0.044 * 16**0.1)


def test_features_obey_their_identities(cohort, design):
    features = draw_features(design, cohort.population, np.random.default_rng(1))
    raw = np.exp(features)
    np.testing.assert_allclose(raw["phi_rms"] ** 2, raw["ap_rms"] ** 2 + raw["ml_rms"] ** 2)
    np.testing.assert_allclose(raw["path_length"], raw["phi_mv"] * 29.99)
    largest = np.pi * ELLIPSE_Z**2 * raw["ap_rms"] * raw["ml_rms"] * 3000 / 2999
    assert np.all(raw["ellipse_area"] <= largest * (1 + 1e-12))
    assert list(features) == list(SIX_FEATURES)
    assert features.index.equals(design.index)


@pytest.fixture(scope="module")
def many(cohort, design):
    """Deviations from the expectation in 150 cohorts: participants' means, and what remains."""
    expected = expected_log_features(design, cohort.population)
    between, within = [], []
    for i in range(150):
        deviation = draw_features(design, cohort.population, generator(9, f"{i}")) - expected
        means = deviation.groupby(design["participant"]).transform("mean")
        counts = design.groupby("participant")["order"].transform("size")
        between.append(means.groupby(design["participant"]).first())
        within.append((deviation - means).mul(np.sqrt(counts / (counts - 1)), axis=0))
    return pd.concat(between), pd.concat(within)


def test_total_scatter_is_the_one_implied_by_the_print(many):
    _, within = many
    # Spec §8.3: ln Phi .23, ln AP .30, ln ML .23, ln MV .16, ln EA .42.
    implied = {"phi_rms": 0.23, "ap_rms": 0.30, "ml_rms": 0.23, "phi_mv": 0.16}
    for name, sd in implied.items():
        assert within[name].std() == pytest.approx(sd, rel=0.04), name
    assert within["path_length"].std() == pytest.approx(0.16, rel=0.04)
    assert within["ellipse_area"].std() == pytest.approx(0.42, rel=0.04)
    correlation = within[list(FEATURES)].corr().to_numpy()[np.triu_indices(3, 1)]
    np.testing.assert_allclose(correlation, [0.28, 0.6, 0.45], atol=0.05)


def test_participants_scatter_as_stated(many):
    between, within = many
    residual = within.var() / 37
    sd = np.sqrt(between.var() - residual)[list(FEATURES)]
    np.testing.assert_allclose(sd, 0.3, rtol=0.05)
    corrected = between[list(FEATURES)].cov() - within[list(FEATURES)].cov() / 37
    correlation = corrected.to_numpy() / np.outer(sd, sd)
    np.testing.assert_allclose(correlation[np.triu_indices(3, 1)], 0.9, atol=0.03)


def test_expectation_is_the_mean_of_the_draws(many):
    between, _ = many
    error = between.std() / np.sqrt(len(between))
    assert np.all(np.abs(between.mean()) < 4 * error)


def test_expected_phi_and_area_by_brute_force(cohort, design):
    population = cohort.population
    expected = expected_log_features(design, population)
    free = fixed_part(design, population)
    np.testing.assert_allclose(expected[list(FEATURES)], free, rtol=1e-12)
    spread = population.spread
    total = (spread.participant_covariance() + spread.residual_covariance())[:2, :2]
    noise = np.random.default_rng(3).multivariate_normal([0, 0], total, size=400_000)
    for row in (0, 100, 500):
        ap, ml = np.exp(free[row, :2] + noise).T
        phi = np.log(np.hypot(ap, ml)).mean()
        assert expected["phi_rms"].iloc[row] == pytest.approx(phi, abs=2e-3)


def test_physical_inputs_give_what_is_wanted(cohort, design):
    trials = draw_trials(design, cohort.population, np.random.default_rng(4))
    inside = trials.inputs.in_range
    assert inside.mean() > 0.99
    wanted = trials.expectation + trials.scatter
    np.testing.assert_allclose(trials.attained[inside], wanted[inside], atol=1e-8)


def test_one_participant_does_not_depend_on_the_others(cohort, design):
    alone = design[design["participant"] == "P03"]
    first = draw_trials(alone, cohort.population, generator(1, "P03"))
    second = draw_trials(alone, cohort.population, generator(1, "P03"))
    np.testing.assert_array_equal(first.attained, second.attained)


def test_full_simulation_and_feature_level_agree(cohort, design):
    """Bodies simulated for a whole cohort scatter about their expectation as the surface says."""
    population = cohort.population
    trials = draw_trials(design, population, generator(31, "trials"))
    inputs = trials.inputs
    points = np.stack(
        [
            inputs.ln_noise_ap,
            inputs.ln_noise_ml,
            inputs.activity,
            design["pendulum_height_m"].to_numpy(),
        ],
        axis=1,
    )
    runs = [
        simulate_run(population.standing, population.trial, point, 1, generator(31, f"{i}"))
        for i, point in enumerate(points)
    ]
    full = np.concatenate([run[0] for run in runs])
    own = full - trials.attained
    response = population.response()
    stated = response.process_covariance(inputs).mean(axis=0)
    sd = np.sqrt(np.diag(stated))
    assert np.all(np.abs(own.mean(axis=0)) < 3 * sd / np.sqrt(len(own)))
    np.testing.assert_allclose(own.std(axis=0), sd, rtol=0.1)
    np.testing.assert_allclose(np.corrcoef(own.T), stated / np.outer(sd, sd), atol=0.12)
    shape = np.array([-np.log(np.cosh(run[1][0])) for run in runs])
    drawn = response.fisher_z_sd(inputs) * generator(31, "z").standard_normal(len(runs))
    assert shape.mean() == pytest.approx(-np.log(np.cosh(drawn)).mean(), abs=0.015)
    # What was put in returns: total scatter and the mean of every feature.
    total = full - trials.expectation
    np.testing.assert_allclose(total.std(axis=0), [0.30, 0.23, 0.16], rtol=0.08)


def test_more_scatter_than_the_body_has_is_added_never_less(cohort, design):
    # Were the total smaller than the body's own scatter, nothing could be taken away.
    quiet = replace(cohort.population.spread, residual_sd_ap=0.01, residual_sd_ml=0.01)
    population = replace(cohort.population, spread=quiet)
    trials = draw_trials(design, population, np.random.default_rng(6))
    assert np.abs(trials.scatter[:, :2]).max() < 0.15


def test_a_design_without_a_column_is_named(cohort, design):
    with pytest.raises(ConfigurationError, match=r"lacks a column; .* found no age"):
        fixed_part(design.drop(columns="age"), cohort.population)


def test_configuration_with_wrong_keys_is_named():
    section = settings()
    section["population"]["spread"]["participant_sdd"] = section["population"]["spread"].pop(
        "participant_sd"
    )
    with pytest.raises(ConfigurationError, match=r"population\.spread: keys do not match"):
        cohort_from_config(section)
    section = settings()
    section["cohort"]["sensor"] = "opal"
    with pytest.raises(
        ConfigurationError, match="unknown sensor; expected one of mtx; found 'opal'"
    ):
        cohort_from_config(section)
    section = settings()
    del section["cohort"]["radio"]
    with pytest.raises(ConfigurationError, match="cohort: keys do not match"):
        cohort_from_config(section)
