from itertools import product

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import bootstrap, t

from swaystride.errors import ModelError
from swaystride.stats.cluster_bootstrap import (
    bootstrap_interval,
    cluster_bootstrap,
    cluster_codes,
    cluster_resamples,
    cluster_weights,
    jackknife_clusters,
    jackknife_interval,
    percentile_interval,
)

CLUSTERS = np.array(list("cabacabbca"))
VALUES = np.random.default_rng(5).normal(size=10)


def draws_of(seed: int, center: float, spread: float, n: int = 40) -> np.ndarray:
    return center + spread * np.random.default_rng(seed).normal(size=n)


def test_weights_are_multinomial():
    weights = cluster_weights(6, 40000, seed=2)
    assert (weights.sum(axis=1) == 6).all()
    np.testing.assert_allclose(weights.mean(axis=0), 1.0, atol=0.03)  # SE 0.005
    np.testing.assert_allclose(np.cov(weights.T), np.eye(6) - 1 / 6, atol=0.03)


def test_resamples_hold_whole_clusters_as_often_as_drawn():
    weights = cluster_weights(3, 50, seed=4)
    for weight, rows in zip(weights, cluster_resamples(CLUSTERS, 50, seed=4), strict=True):
        times = np.bincount(rows, minlength=10)
        assert times.tolist() == [weight["abc".index(label)] for label in CLUSTERS]


def test_order_of_rows_does_not_show():
    shuffle = np.random.default_rng(0).permutation(10)
    first = cluster_bootstrap(lambda rows: VALUES[rows].mean(), CLUSTERS, n=30, seed=1)
    other = cluster_bootstrap(
        lambda rows: VALUES[shuffle][rows].mean(), CLUSTERS[shuffle], n=30, seed=1
    )
    np.testing.assert_allclose(first, other, rtol=1e-12)
    assert len(np.unique(first.round(12))) > 5


def test_statistic_may_be_an_array():
    both = cluster_bootstrap(lambda rows: [VALUES[rows].mean(), len(rows)], CLUSTERS, n=8, seed=1)
    assert both.shape == (8, 2)
    assert (both[:, 1] == cluster_weights(3, 8, seed=1) @ [4, 3, 3]).all()
    assert jackknife_clusters(lambda rows: VALUES[rows][:3], CLUSTERS).shape == (3, 3)


def test_mean_of_clusters_has_the_usual_standard_error():
    """All m^m resamples: the variance is (m-1)/m of s^2/m, which the factor makes good."""
    y = np.array([1.0, 2.5, 7.0, 3.0])
    draws = np.array([y[list(rows)].mean() for rows in product(range(4), repeat=4)])
    np.testing.assert_allclose(draws.var(), 3 / 4 * y.var(ddof=1) / 4, rtol=1e-12)
    low, high = bootstrap_interval(y.mean(), draws, n_clusters=4, level=0.9, scale="identity")
    usual = t.interval(0.9, 3, y.mean(), y.std(ddof=1) / 2)
    rounds = np.sqrt(256 / 255)  # the spread of 256 draws is taken with divisor 255
    np.testing.assert_allclose((high - low) / rounds, usual[1] - usual[0], rtol=1e-12)
    np.testing.assert_allclose((high + low) / 2, y.mean(), rtol=1e-12)


def test_jackknife_of_a_mean_is_the_t_interval():
    y = np.random.default_rng(3).normal(size=7)
    left_out = jackknife_clusters(lambda rows: y[rows].mean(), np.arange(7))
    limits = jackknife_interval(y.mean(), left_out, level=0.95, scale="identity")
    np.testing.assert_allclose(limits, t.interval(0.95, 6, y.mean(), y.std(ddof=1) / np.sqrt(7)))


def test_interval_of_ten_normal_clusters_covers_the_truth():
    rng = np.random.default_rng(12)
    n, truth = 3000, 2.0
    samples = truth + rng.normal(size=(n, 10))
    weights = cluster_weights(10, 400, seed=8)
    draws = samples @ weights.T / 10.0
    t_limits, percentile = (
        np.array(limits)
        for limits in (
            [
                bootstrap_interval(y.mean(), d, n_clusters=10, level=0.95, scale="identity")
                for y, d in zip(samples, draws, strict=True)
            ],
            [percentile_interval(d, 0.95) for d in draws],
        )
    )
    covered, plain = (
        ((limits[:, 0] <= truth) & (truth <= limits[:, 1])).mean()
        for limits in (t_limits, percentile)
    )
    assert abs(covered - 0.95) < 3 * np.sqrt(0.95 * 0.05 / n)
    assert plain < 0.92  # why the plain limits are not used


def test_percentile_limits_agree_with_scipy():
    y = VALUES
    limits = bootstrap(
        (y,), np.mean, n_resamples=20000, method="percentile", rng=np.random.default_rng(1)
    ).confidence_interval
    draws = cluster_weights(10, 20000, seed=2) @ y / 10
    np.testing.assert_allclose(percentile_interval(draws, 0.95), limits, atol=0.02)


@given(st.floats(-50, 50), st.floats(0.01, 100), st.integers(0, 99))
def test_identity_scale_moves_with_the_units(shift, scale, seed):
    draws = draws_of(seed, 1.0, 0.3)
    limits = np.array(bootstrap_interval(1.0, draws, n_clusters=10, level=0.95, scale="identity"))
    moved = bootstrap_interval(
        shift + scale, shift + scale * draws, n_clusters=10, level=0.95, scale="identity"
    )
    np.testing.assert_allclose(moved, shift + scale * limits, rtol=1e-9, atol=1e-9)


@given(st.floats(-0.999, 0.999), st.floats(0.01, 3), st.integers(0, 99))
def test_correlations_stay_within_one_and_follow_their_sign(r, spread, seed):
    draws = np.tanh(draws_of(seed, np.arctanh(r), spread))
    low, high = bootstrap_interval(r, draws, n_clusters=5, level=0.95, scale="fisher_z")
    assert -1.0 <= low < r < high <= 1.0
    turned = bootstrap_interval(-r, -draws, n_clusters=5, level=0.95, scale="fisher_z")
    np.testing.assert_allclose(turned, (-high, -low), rtol=1e-6, atol=1e-12)
    low, high = jackknife_interval(r, draws[:5], level=0.95, scale="fisher_z")
    assert -1.0 <= low < r < high <= 1.0


@given(st.floats(0.001, 0.999), st.floats(0.01, 3), st.integers(0, 99))
def test_shares_stay_within_zero_and_one_and_mirror(share, spread, seed):
    logits = draws_of(seed, np.log(share / (1 - share)), spread)
    draws = 1.0 / (1.0 + np.exp(-logits))
    low, high = bootstrap_interval(share, draws, n_clusters=5, level=0.95, scale="logit")
    assert 0.0 <= low < share < high <= 1.0
    mirror = bootstrap_interval(1 - share, 1 - draws, n_clusters=5, level=0.95, scale="logit")
    np.testing.assert_allclose(mirror, (1 - high, 1 - low), rtol=1e-6, atol=1e-9)


def test_scales_are_those_of_the_textbook():
    z = draws_of(1, 0.5, 0.2)
    on_z = bootstrap_interval(0.5, z, n_clusters=8, level=0.9, scale="identity")
    r = bootstrap_interval(np.tanh(0.5), np.tanh(z), n_clusters=8, level=0.9, scale="fisher_z")
    np.testing.assert_allclose(np.arctanh(r), on_z, rtol=1e-12)
    share = bootstrap_interval(
        1 / (1 + np.exp(-0.5)), 1 / (1 + np.exp(-z)), n_clusters=8, level=0.9, scale="logit"
    )
    np.testing.assert_allclose(np.log(share) - np.log1p(-np.array(share)), on_z, rtol=1e-12)


def test_draws_at_the_end_count_as_the_most_extreme_inside():
    draws = np.array([0.7, 0.8, 0.9, 0.95, 1.0, 1.0 + 1e-12])
    limits = bootstrap_interval(0.9, draws, n_clusters=10, level=0.95, scale="logit")
    moved = np.minimum(draws, 0.95)
    assert limits == bootstrap_interval(0.9, moved, n_clusters=10, level=0.95, scale="logit")
    assert 0.0 < limits.low < 0.9 < limits.high < 1.0


@pytest.mark.parametrize(("end", "scale"), [(0.0, "logit"), (1.0, "logit"), (-1.0, "fisher_z")])
def test_estimate_at_the_end_has_no_limits(end, scale):
    limits = bootstrap_interval(end, np.full(20, end), n_clusters=10, level=0.95, scale=scale)
    assert np.isnan(limits).all()
    assert np.isnan(jackknife_interval(end, np.full(5, end), level=0.95, scale=scale)).all()


def test_codes_follow_the_sorted_labels():
    codes, labels = cluster_codes(pd.Series(["P2", "P10", "P2"], dtype="category"))
    assert (codes.tolist(), list(labels)) == ([1, 0, 1], ["P10", "P2"])


def test_unfit_input_is_refused():
    with pytest.raises(ModelError, match="the cluster is missing in 1 of 3 rows"):
        cluster_codes(["a", np.nan, "b"])
    with pytest.raises(
        ModelError, match=r"clusters are no column; expected one per row; found \(2"
    ):
        cluster_codes(np.zeros((2, 2)))
    for lone in (
        lambda: cluster_codes(["a", "a"]),
        lambda: cluster_weights(1, 5, seed=0),
        lambda: bootstrap_interval(0, [0, 1], n_clusters=1, level=0.95, scale="identity"),
    ):
        with pytest.raises(ModelError, match="too few clusters to resample; expected 2 or more"):
            lone()

    def interval(estimate=0.5, draws=(0.4, 0.6), level=0.95, scale="logit"):
        return bootstrap_interval(estimate, draws, n_clusters=10, level=level, scale=scale)

    with pytest.raises(ModelError, match="1 of 2 draws are not finite"):
        interval(draws=[0.1, np.nan])
    with pytest.raises(ModelError, match="the estimate is not finite"):
        interval(estimate=np.nan)
    with pytest.raises(ModelError, match=r"expected 2 or more in one row; found \(2, 2\)"):
        interval(draws=np.ones((2, 2)))
    with pytest.raises(ModelError, match=r"expected identity or fisher_z or logit; found log$"):
        interval(scale="log")
    with pytest.raises(ModelError, match="level is no probability; found 95"):
        interval(level=95)
    with pytest.raises(ModelError, match="level is no probability; found 95"):
        percentile_interval([0.0, 1.0], 95)
    with pytest.raises(ModelError, match=r"does not suit the draws; expected values from 0 to 1"):
        interval(draws=[0.1, 1.2])
