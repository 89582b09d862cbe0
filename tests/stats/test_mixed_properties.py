"""What must hold for any single, nested or crossed design."""

import numpy as np
import pandas as pd
import pytest
import statsmodels.api as sm
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.stats.crossed_factors import CrossedStructure
from swaystride.stats.mixed_design import design_from_terms
from swaystride.stats.mixed_fit import fit_design, ols_residual
from swaystride.stats.mixed_model import fit_mixed_model
from swaystride.stats.profiled_deviance import profiled

GROUPS = {
    "single": ["p"],
    "nested": ["p", "p:e"],
    "crossed": ["p", "r"],
    "both": ["p", "p:e", "r", "p:r"],
}
KINDS = pytest.mark.parametrize("kind", list(GROUPS))


def _table(seed: int, sd: float = 1.0) -> pd.DataFrame:
    """Incomplete ratings with every kind of random effect."""
    rng = np.random.default_rng(seed)
    cells = [(p, e, r) for p in range(6) for e in range(3) for r in range(4) for _ in range(2)]
    frame = pd.DataFrame(cells, columns=list("per"))
    frame = frame[rng.random(len(frame)) < 0.8].reset_index(drop=True)
    frame["x"], frame["z"] = rng.normal(size=len(frame)), rng.normal(size=6)[frame["p"]]
    frame["y"] = 2.0 + frame["x"] + rng.normal(size=len(frame))
    for names in (["p"], ["p", "e"], ["r"], ["p", "r"]):
        code = frame.groupby(names).ngroup().to_numpy()
        frame["y"] += sd * rng.lognormal(-0.5, 0.5) * rng.normal(size=code.max() + 1)[code]
    return frame


def _formula(kind: str) -> str:
    return " + ".join(["y ~ x + z", *(f"(1|{group})" for group in GROUPS[kind])])


seeds = st.integers(0, 2**31 - 1)


@KINDS
@settings(max_examples=12, deadline=None)
@given(seed=seeds, reml=st.booleans())
def test_order_of_rows_and_names_of_levels_do_not_matter(kind, seed, reml):
    frame = _table(seed)
    fit = fit_mixed_model(_formula(kind), frame, reml=reml)
    rng = np.random.default_rng(seed)
    other = frame.sample(frac=1.0, random_state=seed)
    renamed = {name: rng.permutation(7) for name in "per"}
    for name, labels in renamed.items():
        other[name] = [f"level {labels[code]}" for code in other[name]]
    again = fit_mixed_model(_formula(kind), other, reml=reml)
    assert fit.converged == again.converged
    assert again.loglik == pytest.approx(fit.loglik, abs=1e-8)
    np.testing.assert_allclose(
        again.variance_components, fit.variance_components, rtol=1e-5, atol=1e-7
    )
    np.testing.assert_allclose(again.covariance, fit.covariance, rtol=1e-5, atol=1e-8)
    np.testing.assert_allclose(again.residuals[frame.index], fit.residuals, atol=1e-5)
    effects = fit.random_effects()["p"]
    effects.index = [f"level {renamed['p'][int(level)]}" for level in effects.index]
    np.testing.assert_allclose(again.random_effects()["p"][effects.index], effects, atol=1e-5)


@KINDS
@settings(max_examples=12, deadline=None)
@given(seed=seeds, shift=st.floats(-1e3, 1e3), scale=st.floats(1e-2, 1e2), reml=st.booleans())
def test_shift_and_scale_of_the_outcome(kind, seed, shift, scale, reml):
    frame = _table(seed)
    fit = fit_mixed_model(_formula(kind), frame, reml=reml)
    frame["y"] = shift + scale * frame["y"]
    again = fit_mixed_model(_formula(kind), frame, reml=reml)
    nu = len(frame) - (3 if reml else 0)
    assert again.loglik == pytest.approx(fit.loglik - nu * np.log(scale), abs=1e-6)
    expected = scale**2 * fit.variance_components
    largest = expected.max()
    np.testing.assert_allclose(again.variance_components, expected, rtol=1e-5, atol=1e-7 * largest)
    expected = scale * fit.estimates.beta + [shift, 0.0, 0.0]
    np.testing.assert_allclose(again.estimates.beta, expected, rtol=1e-6, atol=1e-6 * scale)
    se = scale * fit.fixed_effects()["se"]
    np.testing.assert_allclose(again.fixed_effects()["se"], se, rtol=1e-5)


@settings(max_examples=15, deadline=None)
@given(seed=seeds, order=st.permutations(GROUPS["both"]), reml=st.booleans())
def test_order_of_the_random_terms_does_not_matter(seed, order, reml):
    frame = _table(seed)
    y = frame["y"].to_numpy()
    fit = fit_design(design_from_terms(frame, ["x"], GROUPS["both"]), y, reml=reml)
    other = fit_design(design_from_terms(frame, ["x"], order), y, reml=reml)
    assert other.loglik == pytest.approx(fit.loglik, abs=1e-8)
    at = [order.index(name) for name in GROUPS["both"]]
    np.testing.assert_allclose(other.gamma[at], fit.gamma, rtol=1e-5, atol=1e-7)
    np.testing.assert_allclose(other.beta, fit.beta, atol=1e-6)
    for i, j in enumerate(at):
        np.testing.assert_allclose(other.random[j], fit.random[i], atol=1e-5)


@KINDS
@settings(max_examples=12, deadline=None)
@given(seed=seeds)
def test_without_any_variance_it_is_ordinary_least_squares(kind, seed):
    """The outcome has no part in the groups at all, which is less than chance would give it."""
    frame = _table(seed)
    design = design_from_terms(frame, ["x", "z"], GROUPS[kind])
    Z = np.hstack([np.eye(factor.n_levels)[factor.codes] for factor in design.factors])
    everything = np.hstack([design.X, Z])
    noise = np.random.default_rng(seed).normal(size=len(frame))
    noise -= everything @ np.linalg.lstsq(everything, noise, rcond=None)[0]
    y = design.X @ [3.0, -1.0, 0.5] + noise
    ols = sm.OLS(y, design.X).fit()
    reml, ml = (fit_design(design, y, reml=method) for method in (True, False))
    for fit in (reml, ml):
        assert fit.converged
        assert (fit.gamma == 0.0).all()
        np.testing.assert_allclose(fit.beta, ols.params, atol=1e-10)
        assert all((effects == 0.0).all() for effects in fit.random)
    np.testing.assert_allclose(np.sqrt(np.diag(reml.covariance)), ols.bse, rtol=1e-9)
    assert ml.loglik == pytest.approx(ols.llf, abs=1e-9)
    assert ml.sigma2 == pytest.approx(ols.ssr / len(frame), rel=1e-9)


@KINDS
@settings(max_examples=10, deadline=None)
@given(seed=seeds, reml=st.booleans())
def test_blocks_of_unequal_size_give_the_written_out_deviance(kind, twin_deviance, seed, reml):
    frame = _table(seed)
    rng = np.random.default_rng(seed)
    frame = frame[(frame["p"] > 1) | (rng.random(len(frame)) < 0.3)]
    design = design_from_terms(frame, ["x"], GROUPS[kind])
    y, codes = frame["y"].to_numpy(), [factor.codes for factor in design.factors]
    gamma = rng.lognormal(0.0, 1.5, size=len(codes)) * (rng.random(len(codes)) < 0.7)
    bound = CrossedStructure(design).bind(ols_residual(design, y))
    nu = design.n - (design.p if reml else 0)
    value = profiled(bound.parts(gamma, reml=reml), nu)[0]
    value += design.log_det_xtx if reml else 0.0
    assert value == pytest.approx(twin_deviance(design.X, codes, y, gamma, reml=reml), abs=1e-8)


@KINDS
@settings(max_examples=12, deadline=None)
@given(seed=seeds, reml=st.booleans(), sd=st.sampled_from([0.0, 0.2, 1.0, 20.0]))
def test_the_fit_is_a_maximum(kind, twin_deviance, seed, reml, sd):
    """No small change of the ratios, upwards or (where positive) downwards, gains anything."""
    frame = _table(seed, sd)
    design = design_from_terms(frame, ["x", "z"], GROUPS[kind])
    y, codes = frame["y"].to_numpy(), [factor.codes for factor in design.factors]
    fit = fit_design(design, y, reml=reml)
    assert fit.converged
    best = twin_deviance(design.X, codes, y, fit.gamma, reml=reml)
    assert -2.0 * fit.loglik == pytest.approx(best, abs=1e-7)
    for step in 1e-3 * np.vstack([np.eye(len(codes)), -np.eye(len(codes))]):
        near = np.maximum(fit.gamma + step * (1.0 + fit.gamma), 0.0)
        assert twin_deviance(design.X, codes, y, near, reml=reml) >= best - 1e-8
