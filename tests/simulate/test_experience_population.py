"""The population of ratings: what can hold together, and what is nearest to the print."""

import numpy as np
import pytest
from rated_runs import BETWEEN, NAMES, measures, printed_like, rating_model

from swaystride.errors import ModelError
from swaystride.simulate.experience_population import (
    attainable_population,
    covariance_functionals,
    distance,
    population_correlations,
)

KEYS = [f"measure_{k}" for k in range(37)]
RUNS = measures(KEYS).to_numpy()


def wanted(seed=0, size=0.5):
    return np.random.default_rng(seed).uniform(-size, size, (len(KEYS), 3))


def association(**values):
    return rating_model(**values).association


@pytest.mark.parametrize("distance_in", ["standard_errors", "plain"])
@pytest.mark.parametrize("share", [0.01, 0.5, 0.8])
def test_all_correlations_hold_together(share, distance_in):
    found = attainable_population(
        RUNS, printed_like(wanted()), association(unexplained_share=share, distance=distance_in)
    )
    joint = np.block(
        [
            [np.corrcoef(RUNS.T), found.correlation],
            [found.correlation.T, BETWEEN],
        ]
    )
    assert np.linalg.eigvalsh(joint)[0] > -1e-8
    assert np.linalg.eigvalsh(found.residual)[0] > -1e-12
    assert np.diag(found.residual).min() > share - 1e-9
    np.testing.assert_allclose(np.cov(found.signal.T) + found.residual, BETWEEN, atol=1e-10)
    standard = (RUNS - RUNS.mean(axis=0)) / RUNS.std(axis=0, ddof=1)
    np.testing.assert_allclose(standard @ found.measure_weights, found.signal, atol=1e-8)


def test_an_attainable_print_is_attained():
    known = RUNS.copy()
    known[[3, 11], 9] = np.nan
    signal = 0.1 * RUNS[:, [2, 5, 7]] + 0.05 * RUNS[:, [8, 9, 12]]
    signal -= signal.mean(axis=0)
    residual = 1.0 - signal.var(axis=0, ddof=1)
    target = population_correlations(signal, residual, RUNS)
    found = attainable_population(RUNS, printed_like(target), association(unexplained_share=0.3))
    assert distance(found.correlation, printed_like(target)).rms < 1e-6
    # A row that lacks two runs is fitted by its covariance, the variance over all runs assumed.
    lacking = population_correlations(signal, residual, known)
    close = attainable_population(known, printed_like(lacking), association(unexplained_share=0.3))
    assert distance(close.correlation, printed_like(lacking)).rms < 0.01


def test_no_other_signal_is_nearer():
    printed, chosen = printed_like(wanted(1)), association(unexplained_share=0.6)
    found = attainable_population(RUNS, printed, chosen)

    def far(signal):
        deviation = covariance_functionals(RUNS).T @ signal - printed.correlation
        return np.sum(printed.weights(chosen) * deviation**2)

    rng = np.random.default_rng(3)
    for size in (0.003, 0.03, 0.3):
        for _ in range(100):
            other = found.signal + size * rng.standard_normal(found.signal.shape)
            other -= other.mean(axis=0)
            explained = np.cov(other.T)
            # Back into what is allowed: all signals smaller, until shares and residual are.
            shrink = min(
                np.sqrt(0.4 / np.diag(explained).max()),
                1.0 / np.sqrt(np.linalg.eigvals(np.linalg.solve(BETWEEN, explained)).real.max()),
                1.0,
            )
            assert far(shrink * other) >= far(found.signal) * (1.0 - 1e-6)


def test_a_larger_unexplained_share_is_further_from_the_print():
    printed = printed_like(wanted(2))
    away = [
        attainable_population(RUNS, printed, association(unexplained_share=share))
        for share in (0.2, 0.5, 0.8, 1.0)
    ]
    errors = [distance(found.correlation, printed).rms_standard_errors for found in away]
    assert errors == sorted(errors)
    assert not away[-1].signal.any()
    np.testing.assert_allclose(away[-1].residual, BETWEEN)


def test_units_and_order_of_the_runs_do_not_matter():
    printed, chosen = printed_like(wanted(4)), association()
    found = attainable_population(RUNS, printed, chosen)
    order = np.random.default_rng(0).permutation(len(RUNS))
    scale = np.geomspace(1e-3, 1e3, len(KEYS))
    other = attainable_population((5.0 + RUNS * scale)[order], printed, chosen)
    np.testing.assert_allclose(other.correlation, found.correlation, atol=1e-6)
    np.testing.assert_allclose(other.signal, found.signal[order], atol=1e-6)


def test_rows_rest_on_the_runs_that_they_have():
    known = RUNS.copy()
    known[[0, 4], 2] = np.nan
    signal = np.random.default_rng(0).standard_normal((len(NAMES), 3)) * 0.3
    signal -= signal.mean(axis=0)
    residual = np.array([0.9, 0.8, 0.7])
    found = population_correlations(signal, residual, known)
    kept = np.isfinite(known[:, 2])
    for scale in range(3):
        covariance = np.cov(known[kept, 2], signal[kept, scale])
        expected = covariance[0, 1] / np.sqrt(
            covariance[0, 0] * (covariance[1, 1] + residual[scale])
        )
        assert found[2, scale] == pytest.approx(expected)


def test_correlations_are_those_of_many_ratings():
    rng = np.random.default_rng(8)
    found = attainable_population(RUNS, printed_like(wanted(5)), association(unexplained_share=0.3))
    root = np.linalg.cholesky(found.residual)
    drawn = found.signal + rng.standard_normal((20000, len(RUNS), 3)) @ root.T
    standard = (RUNS - RUNS.mean(axis=0)) / RUNS.std(axis=0, ddof=1)
    covariance = np.einsum("nrs,rm->ms", drawn, standard) / len(drawn) / (len(RUNS) - 1)
    variance = drawn.var(axis=1, ddof=1).mean(axis=0)
    np.testing.assert_allclose(found.correlation, covariance / np.sqrt(variance), atol=0.01)


def test_a_measure_that_says_nothing_has_no_correlation():
    known = RUNS.copy()
    known[:, 4] = 7.0
    known[2:, 5] = np.nan
    found = attainable_population(known, printed_like(wanted()), association())
    assert np.isnan(found.correlation[4:6]).all()
    assert np.isfinite(np.delete(found.correlation, [4, 5], axis=0)).all()
    assert np.isfinite(distance(found.correlation, printed_like(wanted())).rms)


def test_a_strong_correlation_weighs_more():
    printed = printed_like([[0.0, 0.6, -0.6]])
    weights = printed.weights(association())
    np.testing.assert_allclose(weights, [[20.0, 20.0 / 0.64**2, 20.0 / 0.64**2]])
    assert np.all(printed.weights(association(distance="plain")) == 1.0)


def test_impossible_populations_are_refused():
    with pytest.raises(ModelError, match="too few runs for a population; expected 3; found 2"):
        attainable_population(RUNS[:2], printed_like(wanted()), association())
    impossible = printed_like(wanted())
    impossible.between_scales[:] = [[1.0, 0.9, -0.9], [0.9, 1.0, 0.9], [-0.9, 0.9, 1.0]]
    with pytest.raises(ModelError, match="the correlations of the scales exclude each other"):
        attainable_population(RUNS, impossible, association())
