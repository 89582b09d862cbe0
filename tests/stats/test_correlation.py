"""Correlation: scipy agrees, invariances hold, bad pairs are refused in one line."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy import stats

from swaystride.errors import ModelError
from swaystride.stats.correlation import Correlation, pearson, spearman

values = st.lists(st.integers(-20, 20), min_size=4, max_size=40)


def as_tuple(found: Correlation) -> list[float]:
    return [found.r, found.ci_low, found.ci_high, found.p]


@pytest.mark.parametrize("n", [4, 10, 645])
@pytest.mark.parametrize("level", [0.8, 0.95])
def test_pearson_is_that_of_scipy(n, level):
    rng = np.random.default_rng(n)
    x = rng.normal(size=n)
    y = 0.6 * x + rng.normal(size=n)
    theirs = stats.pearsonr(x, y)
    interval = theirs.confidence_interval(level)
    ours = pearson(x, y, level)
    assert_allclose(
        as_tuple(ours), [theirs.statistic, interval.low, interval.high, theirs.pvalue], rtol=1e-10
    )
    assert ours.n == n


def test_spearman_is_that_of_scipy_with_ties():
    rng = np.random.default_rng(3)
    x = rng.integers(1, 6, size=300)
    y = np.clip(x + rng.integers(-1, 2, size=300), 1, 5)
    theirs = stats.spearmanr(x, y)
    ours = spearman(x, y)
    assert_allclose([ours.r, ours.p], [theirs.statistic, theirs.pvalue], rtol=1e-10)
    half = stats.norm.ppf(0.975) / np.sqrt(297)
    assert_allclose(
        np.arctanh([ours.ci_low, ours.ci_high]), np.arctanh(ours.r) + half * np.array([-1, 1])
    )


def test_interval_printed_for_645_pairs():
    """A Spearman correlation of .769 over 645 pairs is printed with the limits .735 and .799."""
    rng = np.random.default_rng(0)
    a, b = np.linalg.qr(np.column_stack([np.ones(645), rng.normal(size=(645, 2))]))[0][:, 1:].T
    found = pearson(a, 0.769 * a + np.sqrt(1 - 0.769**2) * b)
    assert_allclose(as_tuple(found)[:3], [0.769, 0.735, 0.799], atol=6e-4)


@given(values, st.floats(1e-3, 1e3), st.floats(-1e3, 1e3), st.integers(0, 1000))
def test_scale_shift_order_and_exchange_do_not_matter(x, scale, shift, seed):
    rng = np.random.default_rng(seed)
    x = np.array(x, dtype=float)
    y = x + rng.normal(scale=5, size=len(x))
    if np.ptp(x) == 0:
        x[0] += 1.0
    order = rng.permutation(len(x))
    for function in (pearson, spearman):
        found = function(x, y)
        assert_allclose(as_tuple(function(y, x)), as_tuple(found), rtol=1e-6, atol=1e-9)
        assert function(x[order], y[order]).r == pytest.approx(found.r, abs=1e-9)
        assert -1.0 <= found.ci_low <= found.r <= found.ci_high <= 1.0
        assert 0.0 <= found.p <= 1.0
        against = function(x, -y)
        assert_allclose([-against.r, -against.ci_high], [found.r, found.ci_low], atol=1e-9)
    assert pearson(scale * x + shift, y).r == pytest.approx(pearson(x, y).r, abs=1e-9)


def test_spearman_knows_only_the_order():
    rng = np.random.default_rng(8)
    x, y = rng.normal(size=(2, 30))
    assert spearman(np.exp(x), y**3) == spearman(x, y)


@pytest.mark.parametrize(("sign", "r"), [(1.0, 1.0), (-1.0, -1.0)])
def test_a_perfect_correlation_has_no_width(sign, r):
    x = np.array([1.0, 2.0, 4.0, 8.0, 16.0])
    found = spearman(x, sign * x)
    assert (found.r, found.ci_low, found.ci_high, found.p) == (r, r, r, 0.0)


def test_tiny_and_huge_numbers_keep_their_correlation():
    x, y = np.random.default_rng(1).normal(size=(2, 20))
    assert pearson(1e-200 * x, 1e200 * y).r == pytest.approx(pearson(x, y).r, abs=1e-12)


@pytest.mark.parametrize(
    ("x", "y", "line"),
    [
        ([1, 2, 3, 4], [1, 2, 3], r"needs pairs; .* found shapes \(4,\) and \(3,\)"),
        ([1, 2, 3], [1, 2, 4], "too few pairs .* expected 4 or more; found 3"),
        ([1, np.nan, 3, 4], [1, 2, 3, 4], "first variable is not finite in 1 of 4 pairs"),
        ([1, 2, 3, 4], [1, np.inf, np.nan, 4], "second variable is not finite in 2 of 4 pairs"),
        ([1, 2, 3, 4], [0.1, 0.1, 0.1, 0.1], "second variable is constant; found 0.1"),
        ([[1, 2], [3, 4]], [[1, 2], [3, 5]], "needs pairs"),
    ],
)
def test_what_is_no_list_of_pairs_is_refused(x, y, line):
    for function in (pearson, spearman):
        with pytest.raises(ModelError, match=line):
            function(x, y)


def test_the_level_is_a_probability():
    with pytest.raises(ModelError, match=r"confidence level is no probability; found 95"):
        pearson([1, 2, 3, 4], [1, 3, 2, 4], 95)
