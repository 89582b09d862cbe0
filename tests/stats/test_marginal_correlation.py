"""Marginal correlation: statsmodels agrees, limits and invariances are those of a correlation."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy import stats
from statsmodels.regression.mixed_linear_model import MixedLM

from swaystride.errors import ModelError
from swaystride.stats.marginal_correlation import (
    bootstrap_marginal_correlation,
    marginal_correlation,
)
from swaystride.stats.mixed_model import fit_mixed_model


def grouped(seed=0, beta=0.8, sd=0.7, groups=12, size=9):
    rng = np.random.default_rng(seed)
    who = np.repeat(np.arange(groups), size)[rng.permutation(groups * size)[: groups * size - 7]]
    x = rng.normal(size=len(who)) + 0.5 * rng.normal(size=groups)[who]
    y = 3 + beta * x + sd * rng.normal(size=groups)[who] + rng.normal(size=len(who))
    return y, x, who


@pytest.mark.parametrize("reml", [True, False])
@pytest.mark.parametrize("seed", range(3))
def test_statsmodels_gives_the_same_shares(seed, reml):
    y, x, who = grouped(seed)
    theirs = MixedLM(y, np.column_stack([np.ones(len(x)), x]), groups=who).fit(reml=reml)
    explained = np.var(theirs.fe_params[1] * x, ddof=1)
    group, residual = float(np.asarray(theirs.cov_re)[0, 0]), float(theirs.scale)
    found = marginal_correlation(y, x, who, reml=reml)
    assert found.r_squared == pytest.approx(explained / (explained + group + residual), rel=1e-4)
    assert found.r == pytest.approx(np.sign(theirs.fe_params[1]) * np.sqrt(found.r_squared))
    assert found.beta == pytest.approx(theirs.fe_params[1], rel=1e-4)
    assert_allclose([found.group_variance, found.residual_variance], [group, residual], rtol=1e-3)
    assert (found.n, found.n_groups) == (len(y), 12)


def test_without_differences_of_groups_it_is_the_correlation_of_all_rows():
    """With a component at zero, R² = r²/(r² + (1 - r²)(n - 1)/(n - 2)) and p is that of r."""
    y, x, who = grouped(4, sd=0.0)
    # every group has the same mean of outcome and predictor, so the component is exactly zero
    y, x = (v - pd.Series(v).groupby(who).transform("mean").to_numpy() for v in (y, x))
    found = marginal_correlation(y, x, who, df="residual")
    assert found.group_variance == 0.0
    theirs = stats.pearsonr(x, y)
    r, n = theirs.statistic, len(x)
    shrunk = r**2 / (r**2 + (1 - r**2) * (n - 1) / (n - 2))
    assert found.r == pytest.approx(np.sqrt(shrunk), rel=1e-9)
    assert found.p == pytest.approx(theirs.pvalue, rel=1e-6)


@settings(max_examples=25)
@given(
    st.floats(-1e3, 1e3).filter(lambda value: abs(value) > 1e-3),
    st.floats(1e-3, 1e3),
    st.floats(-100, 100),
    st.integers(0, 1000),
)
def test_scale_shift_and_order_do_not_matter_and_the_sign_is_that_of_the_slope(a, b, shift, seed):
    y, x, who = grouped(seed)
    found = marginal_correlation(y, x, who)
    order = np.random.default_rng(seed).permutation(len(y))
    moved = marginal_correlation((b * y + shift)[order], (a * x + shift)[order], who[order])
    limits = [moved.ci_low, moved.ci_high] if a > 0 else [-moved.ci_high, -moved.ci_low]
    assert_allclose(
        [np.sign(a) * moved.r, *limits, moved.p],
        [found.r, found.ci_low, found.ci_high, found.p],
        rtol=1e-4,
        atol=1e-6,
    )
    assert np.sign(moved.r) == np.sign(moved.beta)


@pytest.mark.parametrize("beta", np.linspace(-0.3, 0.3, 9))
def test_the_interval_holds_zero_exactly_if_the_slope_is_not_significant(beta):
    found = marginal_correlation(*grouped(7, beta=beta), level=0.9)
    assert (found.ci_low <= 0.0 <= found.ci_high) == (found.p >= 0.1)
    assert -1.0 < found.ci_low < found.r < found.ci_high < 1.0


def test_variance_of_groups_lowers_it():
    weak, strong = (marginal_correlation(*grouped(1, sd=sd)).r for sd in (0.1, 4.0))
    assert strong < weak


def test_bootstrap_limits_are_percentiles_of_single_refits():
    y, x, who = grouped(2)
    found = bootstrap_marginal_correlation(y, x, who, n=40, seed=[3, 1], level=0.8)
    table = pd.DataFrame({"y": y, "x": x, "who": who})
    fit = fit_mixed_model("y ~ x + (1|who)", table)
    draws = []
    for response in fit.simulate(40, seed=[3, 1]):
        one = marginal_correlation(response, x, who)
        draws.append(one.r)
    assert_allclose([found.ci_low, found.ci_high], np.quantile(draws, [0.1, 0.9]), rtol=1e-6)
    plain = marginal_correlation(y, x, who, level=0.8)
    assert replace(found, ci_low=plain.ci_low, ci_high=plain.ci_high) == plain


def test_bootstrap_limits_cover_the_truth_as_often_as_they_say():
    """R² of the simulated rows is 1/(1 + 0.5 + 1.5); 200 tables at level 0.9."""
    rng = np.random.default_rng(11)
    who = np.repeat(np.arange(15), 8)
    x = rng.normal(size=120)
    x = (x - x.mean()) / x.std(ddof=1)
    truth, covered = np.sqrt(1.0 / 3.0), 0
    for at in range(200):
        y = x + np.sqrt(0.5) * rng.normal(size=15)[who] + np.sqrt(1.5) * rng.normal(size=120)
        found = bootstrap_marginal_correlation(y, x, who, n=200, seed=[at, 1], level=0.9)
        covered += found.ci_low <= truth <= found.ci_high
    assert 0.83 < covered / 200 < 0.96


@pytest.mark.parametrize(
    ("change", "line"),
    [
        ({"x": [1.0, 2.0]}, r"of the same rows; .* found shapes \(6,\), \(2,\), \(6,\)"),
        ({"y": [1.0, np.nan, 2, 3, 4, np.inf]}, "outcome is not finite in 2 of 6 rows"),
        ({"x": [1.0, np.nan, 2, 3, 4, 5]}, "predictor is not finite in 1 of 6 rows"),
        ({"y": [2.0] * 6}, "outcome is constant; found 2.0"),
        ({"x": [2.0] * 6}, "predictor is constant; found 2.0"),
        ({"groups": ["a"] * 6}, "grouping factor group has 1 level; expected 2 or more"),
        ({"groups": ["a", "a", None, "b", "b", "b"]}, "column group is missing in 1 of 6 rows"),
    ],
)
def test_what_is_no_grouped_table_is_refused(change, line):
    rows = {"y": [1.0, 3, 2, 5, 4, 6], "x": [1.0, 2, 3, 4, 5, 6], "groups": list("aaabbb")}
    with pytest.raises(ModelError, match=line):
        marginal_correlation(**(rows | change))


def test_an_interval_needs_a_level_and_draws():
    rows = ([1.0, 3, 2, 5, 4, 6], [1.0, 2, 3, 5, 4, 6], list("aaabbb"))
    with pytest.raises(ModelError, match="confidence level is no probability"):
        marginal_correlation(*rows, level=95)
    with pytest.raises(ModelError, match=r"too few draws .* expected 2 or more; found 1"):
        bootstrap_marginal_correlation(*rows, n=1, seed=0)
