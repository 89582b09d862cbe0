import warnings

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from swaystride.errors import ModelError
from swaystride.stats.mixed_design import MixedDesign, design_from_terms
from swaystride.stats.mixed_fit import fit_design
from swaystride.stats.mixed_model import fit_mixed_model


@pytest.mark.parametrize("sd", [0.0, 0.3, 1.0, 10.0])
@pytest.mark.parametrize("seed", range(4))
def test_balanced_one_way_reml_is_the_anova_estimator(one_way, sd, seed):
    frame = one_way(groups=7, size=6, sd=sd, seed=seed)
    fit = fit_design(design_from_terms(frame, [], ["who"]), frame["y"].to_numpy())
    means = frame.groupby("who")["y"].mean()
    between = 6 * means.var()
    within = frame.groupby("who")["y"].var().mean()
    inside = [(between - within) / 6, within]
    expected = inside if between > within else [0.0, frame["y"].var()]
    np.testing.assert_allclose(fit.variances, expected, rtol=1e-9)
    assert fit.is_singular == (between <= within)
    assert fit.beta[0] == pytest.approx(frame["y"].mean(), rel=1e-12)
    shrink = fit.gamma[0] * 6 / (1 + fit.gamma[0] * 6)
    np.testing.assert_allclose(fit.random[0], shrink * (means - means.mean()), atol=1e-10)


@pytest.mark.parametrize("groups", [["who"], ["who", "day"]])
def test_without_group_variance_it_is_ordinary_least_squares(groups):
    rng = np.random.default_rng(8)
    frame = pd.DataFrame({"who": np.repeat(range(6), 8), "day": np.tile(range(8), 6)})
    frame["x"], noise = rng.normal(size=48), rng.normal(size=48)
    for name in ("who", "day"):  # the groups have equal means: less than chance allows
        noise -= pd.Series(noise).groupby(frame[name]).transform("mean").to_numpy()
    x = frame["x"].to_numpy()
    y = 2 + 3 * x + noise
    fit = fit_design(design_from_terms(frame, ["x"], groups), y)
    X = np.column_stack([np.ones(48), x])
    beta, (rss,), *_ = np.linalg.lstsq(X, y, rcond=None)
    assert (fit.gamma == 0.0).all()
    assert fit.is_singular
    assert fit.converged
    np.testing.assert_allclose(fit.beta, beta, rtol=1e-12)
    assert fit.sigma2 == pytest.approx(rss / 46, rel=1e-12)
    np.testing.assert_allclose(fit.covariance, rss / 46 * np.linalg.inv(X.T @ X), rtol=1e-10)
    assert all((effects == 0.0).all() for effects in fit.random)


@pytest.mark.parametrize("reml", [True, False])
@pytest.mark.parametrize("groups", [["p"], ["p:e", "r"], ["p", "r", "p:r", "p:e"]], ids="+".join)
def test_maximum_against_a_general_optimiser_on_the_written_out_likelihood(
    crossed, twin_deviance, groups, reml
):
    frame = crossed(seed=1)
    y = frame["y"].to_numpy()
    design = design_from_terms(frame, ["x"], groups)
    codes = [factor.codes for factor in design.factors]
    fit = fit_design(design, y, reml=reml)
    found = minimize(
        lambda g: twin_deviance(design.X, codes, y, g, reml=reml),
        np.full(len(groups), 0.3),
        bounds=[(0, None)] * len(groups),
    )
    assert -2 * fit.loglik == pytest.approx(
        twin_deviance(design.X, codes, y, fit.gamma, reml=reml), abs=1e-9
    )
    assert -2 * fit.loglik <= found.fun + 1e-9
    np.testing.assert_allclose(fit.gamma, found.x, rtol=2e-3, atol=2e-4)


def test_statsmodels_agrees(one_way):
    import statsmodels.formula.api as smf

    frame = one_way(groups=15, size=9, seed=5)
    for reml in (True, False):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            other = smf.mixedlm("y ~ x + z", frame, groups=frame["who"]).fit(reml=reml)
        fit = fit_mixed_model("y ~ x + z + (1|who)", frame, reml=reml)
        np.testing.assert_allclose(fit.estimates.beta, other.fe_params, rtol=1e-4)
        np.testing.assert_allclose(fit.fixed_effects()["se"], other.bse_fe, rtol=1e-3)
        assert fit.variance_components["who"] == pytest.approx(other.cov_re.iloc[0, 0], rel=1e-2)
        assert fit.variance_components["Residual"] == pytest.approx(other.scale, rel=1e-2)
        if not reml:  # the REML constants differ
            assert fit.loglik == pytest.approx(other.llf, abs=1e-4)


@pytest.mark.parametrize("groups", [["p:e"], ["p", "p:e", "r"]], ids="+".join)
@settings(max_examples=15, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    shift=st.floats(-1e4, 1e4),
    scale=st.floats(1e-3, 1e3),
    reml=st.booleans(),
)
def test_row_order_labels_shift_and_scale_do_not_matter(groups, seed, shift, scale, reml):
    rng = np.random.default_rng(0)
    frame = pd.DataFrame(
        [(p, e, r) for p in range(5) for e in range(4) for r in range(3)], columns=list("per")
    )
    frame["x"] = rng.normal(size=60)
    frame["y"] = rng.normal(size=5)[frame["p"]] + rng.normal(size=3)[frame["r"]]
    frame["y"] += rng.normal(size=60)
    fit = fit_design(design_from_terms(frame, ["x"], groups), frame["y"].to_numpy(), reml=reml)
    rng = np.random.default_rng(seed)
    other = frame.sample(frac=1.0, random_state=seed % 2**31)
    for name in "per":
        labels = rng.permutation([f"level {at}" for at in range(6)])
        other[name] = labels[other[name]]
    y = shift + scale * other["y"].to_numpy()
    again = fit_design(design_from_terms(other, ["x"], groups), y, reml=reml)
    np.testing.assert_allclose(again.gamma, fit.gamma, rtol=1e-5, atol=1e-7)
    np.testing.assert_allclose(again.variances, scale**2 * fit.variances, rtol=1e-5, atol=1e-7)
    np.testing.assert_allclose(again.beta[1], scale * fit.beta[1], rtol=1e-5, atol=1e-9)
    np.testing.assert_allclose(
        again.beta[0], shift + scale * fit.beta[0], rtol=1e-6, atol=1e-6 * (1 + scale)
    )
    nu = fit.nu
    assert again.loglik == pytest.approx(fit.loglik - nu * np.log(scale), abs=1e-5)


def test_the_basis_of_the_fixed_effects_changes_only_the_reml_constant(crossed):
    frame = crossed(seed=3)
    y = frame["y"].to_numpy()
    design = design_from_terms(frame, ["x", "t"], ["p", "r"])
    T = np.array([[1.0, 2.0, 0.0], [0.0, 3.0, 1.0], [0.0, 0.0, -2.0]])
    turned = MixedDesign(design.X @ T, ("a", "b", "c"), design.factors)
    fit, other = fit_design(design, y), fit_design(turned, y)
    np.testing.assert_allclose(T @ other.beta, fit.beta, atol=1e-10)
    np.testing.assert_allclose(T @ other.covariance @ T.T, fit.covariance, atol=1e-10)
    assert other.loglik == pytest.approx(fit.loglik - np.log(6.0), abs=1e-9)
    fit, other = (fit_design(d, y, reml=False) for d in (design, turned))
    assert other.loglik == pytest.approx(fit.loglik, abs=1e-9)


def test_many_levels_take_the_block_form_and_agree_with_the_closed_form():
    from swaystride.stats.crossed_factors import CrossedStructure
    from swaystride.stats.mixed_fit import structure_of

    rng = np.random.default_rng(2)
    frame = pd.DataFrame({"who": np.repeat(np.arange(600), 2), "x": rng.normal(size=1200)})
    frame["y"] = rng.normal(size=600)[frame["who"]] + rng.normal(size=1200)
    design = design_from_terms(frame, ["x"], ["who"])
    assert isinstance(structure_of(design), CrossedStructure)
    fit = fit_design(design, frame["y"].to_numpy())
    # pairs: the sum and the difference of two rows separate the model into two regressions
    assert fit.converged
    first, second = (frame.iloc[at::2].reset_index(drop=True) for at in (0, 1))
    total = (first["y"] + second["y"]) / np.sqrt(2)
    delta = (first["y"] - second["y"]) / np.sqrt(2)
    x_total, x_delta = (first["x"] + second["x"]), (first["x"] - second["x"])
    w = 1 / (1 + 2 * fit.gamma[0])
    X = np.vstack(
        [
            np.column_stack([np.full(600, np.sqrt(2)), x_total / np.sqrt(2)]) * np.sqrt(w),
            np.column_stack([np.zeros(600), x_delta / np.sqrt(2)]),
        ]
    )
    y = np.concatenate([total * np.sqrt(w), delta])
    np.testing.assert_allclose(fit.beta, np.linalg.lstsq(X, y, rcond=None)[0], rtol=1e-9)


@pytest.mark.parametrize(
    ("change", "line"),
    [
        (lambda y, who: np.full_like(y, 3.5), "the outcome is constant; found 3.5 in all 40 rows"),
        (
            lambda y, who: 2.0 * np.tile(np.arange(5.0), 8),
            "the fixed effects reproduce the outcome",
        ),
        (lambda y, who: who**2.0, "the groups reproduce the outcome: no residual variance is left"),
        (lambda y, who: np.where(who == 1, np.nan, y), "the outcome is not finite"),
    ],
)
def test_outcomes_without_residual_variance_are_refused(one_way, change, line):
    frame = one_way()
    design = design_from_terms(frame, ["x"], ["who"])
    y = change(frame["y"].to_numpy(), frame["who"].to_numpy())
    with pytest.raises(ModelError) as error:
        fit_design(design, y)
    assert line in str(error.value)


def test_crossed_groups_that_reproduce_the_outcome_are_refused():
    frame = pd.DataFrame([(a, b) for a in range(5) for b in range(6)] * 2, columns=["a", "b"])
    y = (frame["a"] ** 2 - frame["b"]).to_numpy(dtype=float)
    with pytest.raises(ModelError, match="the groups reproduce the outcome"):
        fit_design(design_from_terms(frame, [], ["a", "b"]), y)


@pytest.mark.parametrize("ratio", [1e2, 1e4, 1e6])
def test_groups_far_apart_keep_their_digits(ratio):
    rng = np.random.default_rng(5)
    who = np.repeat(np.arange(10), 20)
    y = ratio * rng.normal(size=10)[who] + rng.normal(size=200)
    fit = fit_design(design_from_terms(pd.DataFrame({"who": who}), [], ["who"]), y)
    groups = pd.Series(y).groupby(who)
    within = groups.var().mean()
    expected = [groups.mean().var() - within / 20, within]
    assert fit.converged
    np.testing.assert_allclose(fit.variances, expected, rtol=1e-9)


@pytest.mark.parametrize("seed", range(12))
def test_the_better_of_several_hills_is_found_for_crossed_factors(twin_deviance, seed):
    rng = np.random.default_rng(seed)
    frame = pd.DataFrame({name: rng.integers(0, 4, 30) for name in "abc"})
    groups = ["c", "b", "a:c"]
    design = design_from_terms(frame, [], groups)
    y = rng.normal(size=30) + 2 * rng.normal(size=4)[frame["b"]]
    fit = fit_design(design, y)
    codes = [factor.codes for factor in design.factors]
    assert fit.converged
    for start in (0.01, 1.0, 50.0):
        found = minimize(
            lambda u: twin_deviance(design.X, codes, y, np.exp(u), reml=True),
            np.log([start] * 3),
            method="L-BFGS-B",
            bounds=[(-16, 12)] * 3,
        )
        assert -2 * fit.loglik <= found.fun + 1e-5
