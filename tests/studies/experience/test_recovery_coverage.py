"""How often intervals cover when only ratings are drawn anew, against drawing them."""

import numpy as np
import pytest
from rated_runs import RUNNERS

from swaystride.stats.cluster_bootstrap import bootstrap_interval, cluster_bootstrap
from swaystride.stats.correlation import pearson
from swaystride.studies.experience.recovery_coverage import cluster_coverage, expected_coverage

PEOPLE = np.array(RUNNERS)


def fixed_runs(rho, other, seed):
    """A measure of which the runners have most, and a signal that follows it and something else."""
    rng = np.random.default_rng(seed)
    _, code = np.unique(PEOPLE, return_inverse=True)
    measure = rng.standard_normal(12)[code] + 0.5 * rng.standard_normal(len(PEOPLE))
    beside = rng.standard_normal(len(PEOPLE))
    directions = np.linalg.qr(np.stack([np.ones_like(measure), measure, beside], axis=1))[0]
    x, h = (np.sqrt(len(PEOPLE) - 1.0) * directions[:, 1:]).T
    return x, rho * x + np.sqrt(other) * h


@pytest.mark.parametrize(
    ("rho", "other", "share"),
    [(0.0, 0.0, 0.0), (0.6, 0.0, 0.0), (0.3, 0.4, 0.0), (0.0, 0.0, 0.5), (0.2, 0.15, 0.3)],
)
def test_expected_coverage_is_that_of_drawn_ratings(rho, other, share):
    x, signal = fixed_runs(rho, other, 4)
    residual = 1.0 - rho**2 - other
    rng = np.random.default_rng(1)
    _, code = np.unique(PEOPLE, return_inverse=True)
    own, common = rng.standard_normal((20000, len(x))), rng.standard_normal((20000, 12))[:, code]
    scores = signal + np.sqrt(residual) * (np.sqrt(1.0 - share) * own + np.sqrt(share) * common)
    centred = scores - scores.mean(axis=1, keepdims=True)
    r = centred @ x / np.linalg.norm(x) / np.linalg.norm(centred, axis=1)
    inside = np.abs(np.arctanh(r) - np.arctanh(rho)) <= 1.96 / np.sqrt(len(x) - 3)
    expected = expected_coverage(signal, residual, x, PEOPLE, runner_share=share, level=0.95)
    assert expected == pytest.approx(inside.mean(), abs=0.006)


def test_what_a_measure_does_not_explain_lengthens_the_interval_too_much():
    """Half of a scale explained by other measures: intervals cover nearly always."""
    x, signal = fixed_runs(0.0, 0.5, 2)
    share = expected_coverage(signal, 0.5, x, PEOPLE, runner_share=0.0, level=0.95)
    assert share == pytest.approx(0.9944, abs=0.0005)


def test_resampled_runners_are_those_of_the_cluster_bootstrap():
    x, signal = fixed_runs(0.5, 0.0, 3)
    scores = signal + np.random.default_rng(0).standard_normal((3, len(x)))
    r = np.array([pearson(x, one).r for one in scores])
    covered = {}
    for target in (0.0, 0.5, r[0]):
        covered[target] = cluster_coverage(
            x, scores, r, target, PEOPLE, level=0.9, n_resamples=100, seed=5
        )
        inside = []
        for one, estimate in zip(scores, r, strict=True):
            draws = cluster_bootstrap(
                lambda rows, one=one: pearson(x[rows], one[rows]).r, PEOPLE, n=100, seed=5
            )
            limits = bootstrap_interval(estimate, draws, n_clusters=12, level=0.9, scale="fisher_z")
            inside.append(limits.low <= target <= limits.high)
        assert covered[target] == np.mean(inside)
    assert covered[r[0]] > 0.0
