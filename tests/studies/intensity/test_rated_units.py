"""Resampled predictions, ranks and shares against plain computations on the drawn rows."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from swaystride.stats.agreement import exact_agreement, rounded_rating
from swaystride.stats.cluster_bootstrap import cluster_codes, cluster_resamples, cluster_weights
from swaystride.stats.linear_prediction import least_squares_prediction, leave_one_cluster_out
from swaystride.studies.intensity.rated_units import mean_ranks, rated_units


def draw(seed, *, n_patients=5, n_units=12, p=3, discrete=False):
    rng = np.random.default_rng(seed)
    patient = np.repeat([f"P{i}" for i in range(n_patients)], n_units)
    x = rng.normal(size=(n_patients * n_units, p))
    if discrete:
        x = np.clip(np.round(3 + x), 1, 5)
    y = np.clip(np.round(3 + x.sum(axis=1) / p + rng.normal(size=len(x))), 1, 5)
    copies = rng.integers(1, 4, len(x))
    rows = np.repeat(np.arange(len(x)), copies)
    noise = rng.integers(-1, 2, len(rows))
    return patient[rows], x[rows], np.clip(y[rows] + noise, 1, 5)


@pytest.mark.parametrize("discrete", [False, True])
@pytest.mark.parametrize("seed", range(3))
def test_every_resample_equals_the_plain_computation_on_its_rows(seed, discrete):
    patients, x, y = draw(seed, p=1 if discrete else 3, discrete=discrete)
    units = rated_units(patients, x, y)
    weights = cluster_weights(5, 25, seed=seed)
    predicted = units.predict(weights)
    spearman = units.spearman(predicted, weights)
    accuracy = units.accuracy(predicted, weights)
    share = units.share_given(predicted, weights, given=4, then=5)
    for at, rows in enumerate(cluster_resamples(patients, 25, seed=seed)):
        plain = least_squares_prediction(pd.DataFrame(x[rows]), y[rows]).predictions
        np.testing.assert_allclose(predicted[at, units.unit_of_row[rows]], plain, atol=1e-8)
        expected = stats.spearmanr(plain.round(9), y[rows]).statistic
        np.testing.assert_allclose(spearman[at], expected, atol=1e-10)
        rounded = rounded_rating(plain)
        np.testing.assert_allclose(accuracy[at], exact_agreement(rounded, y[rows]), atol=1e-12)
        chosen = rounded == 4
        expected = np.mean(y[rows][chosen] == 5) if chosen.any() else np.nan
        np.testing.assert_allclose(share[at], expected, atol=1e-12)


def test_left_out_predictions_equal_refits_without_the_patient():
    patients, x, y = draw(9)
    units = rated_units(patients, x, y)
    once = units.predict_left_out(np.ones((1, 5)))
    np.testing.assert_allclose(
        once[0, units.unit_of_row],
        leave_one_cluster_out(pd.DataFrame(x), y, patients).predictions,
        atol=1e-8,
    )
    weights = cluster_weights(5, 6, seed=2)
    drawn = units.predict_left_out(weights)
    codes, _ = cluster_codes(patients)
    for at, weight in enumerate(weights):
        rows = np.repeat(np.arange(len(y)), weight[codes])
        for patient in np.flatnonzero(weight):
            rest = rows[codes[rows] != patient]
            fit = least_squares_prediction(pd.DataFrame(x[rest]), y[rest])
            own = np.flatnonzero(codes == patient)
            np.testing.assert_allclose(
                drawn[at, units.unit_of_row[own]], fit.predict(pd.DataFrame(x[own])), atol=1e-8
            )


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.tuples(st.integers(0, 4), st.integers(0, 3)), min_size=2, max_size=12).filter(
        lambda pairs: sum(n for _, n in pairs) > 0
    )
)
def test_mean_ranks_are_those_of_the_repeated_values(pairs):
    values, weights = np.array(pairs, dtype=float).T
    repeated = np.repeat(values, weights.astype(int))
    expected = dict(zip(repeated, stats.rankdata(repeated), strict=True))
    ranks = mean_ranks(values[None], weights[None])[0]
    for value, weight, rank in zip(values, weights, ranks, strict=True):
        if weight:
            assert rank == expected[value]


def test_constant_predictions_have_no_rank_correlation():
    units = rated_units(list("aabb"), np.ones((4, 1)), [1, 2, 3, 4])
    weights = np.ones((1, 2))
    predicted = units.predict(weights)
    np.testing.assert_allclose(predicted, 2.5)
    assert np.isnan(units.spearman(predicted, weights)).all()
