"""Nearest correlations that can hold together, against independent solutions of the same problem."""

import numpy as np
import pytest
from rated_runs import BETWEEN
from scipy.optimize import brentq, minimize

from swaystride.simulate.attainable_correlations import nearest_coefficients


def problem(seed, n_measures=9, n_directions=4, size=0.5):
    """A design, targets that fit no coefficients, and uneven weights."""
    rng = np.random.default_rng(seed)
    design = rng.standard_normal((n_measures, n_directions)) / np.sqrt(n_measures)
    target = rng.uniform(-size, size, (n_measures, 3))
    return design, target, rng.uniform(5.0, 60.0, target.shape)


def objective(coefficients, design, target, weights):
    return 0.5 * np.sum(weights * (design @ coefficients - target) ** 2)


def test_what_is_attainable_is_attained():
    design, _, weights = problem(1)
    wanted = np.random.default_rng(2).uniform(-0.2, 0.2, (4, 3))
    found, _ = nearest_coefficients(design, design @ wanted, weights, BETWEEN, 0.9)
    np.testing.assert_allclose(found, wanted, atol=1e-6)


@pytest.mark.parametrize("most", [0.05, 0.2, 0.4])
def test_scales_that_do_not_limit_each_other_follow_the_secular_equation(most):
    """Then each is a ridge regression whose penalty makes the explained share the largest allowed."""
    design, target, weights = problem(3)
    found, gap = nearest_coefficients(design, target, weights, np.eye(3), most)
    for scale in range(3):
        normal = design.T @ (weights[:, [scale]] * design)
        pull = design.T @ (weights[:, scale] * target[:, scale])

        def ridge(penalty, normal=normal, pull=pull):
            return np.linalg.solve(normal + penalty * np.eye(len(pull)), pull)

        free = ridge(0.0)
        if free @ free > most:
            penalty = brentq(lambda p: np.sum(ridge(p) ** 2) - most, 0.0, 1e6, xtol=1e-12)
            free = ridge(penalty)
        np.testing.assert_allclose(found[:, scale], free, atol=1e-6)
    assert np.linalg.eigvalsh(np.eye(3) - found.T @ found)[0] > 0.1
    assert gap < 1e-7


@pytest.mark.parametrize("seed", range(4))
def test_the_gradient_is_balanced_by_multipliers_where_the_scales_limit_each_other(seed):
    """Stationarity, feasibility and complementary slackness prove the optimum of a convex problem."""
    design, target, weights = problem(seed, size=0.9)
    found, _ = nearest_coefficients(design, target, weights, BETWEEN, 0.95)
    rest = BETWEEN - found.T @ found
    smallest = np.linalg.eigvalsh(rest)[0]
    assert -1e-12 < smallest < 1e-4  # the limit is reached
    gradient = design.T @ (weights * (design @ found - target))
    multiplier = np.linalg.lstsq(found, -gradient, rcond=None)[0]
    scale = np.abs(gradient).max()
    np.testing.assert_allclose(found @ multiplier, -gradient, atol=1e-4 * scale)
    np.testing.assert_allclose(multiplier, multiplier.T, atol=1e-3 * scale)
    assert np.linalg.eigvalsh(0.5 * (multiplier + multiplier.T))[0] > -1e-3 * scale
    slack = np.maximum(0.95 - np.sum(found**2, axis=0), 0.0)
    if slack.min() > 1e-4:
        np.testing.assert_allclose(multiplier @ rest, 0.0, atol=1e-3 * scale)


@pytest.mark.parametrize("seed", range(12))
def test_the_dual_bound_proves_the_gap(seed):
    """No admissible coefficients lie below the minimum of the Lagrangian, whatever the multipliers."""
    rng = np.random.default_rng(seed)
    design, target, weights = problem(seed, rng.integers(3, 38), rng.integers(1, 23), 0.9)
    design = design * np.geomspace(1.0, 10.0 ** -rng.uniform(0.0, 5.0), design.shape[1])
    most = rng.uniform(0.01, 0.999)
    found, gap = nearest_coefficients(design, target, weights, BETWEEN, most)
    at_zero = objective(np.zeros_like(found), design, target, weights)
    rest, slack = BETWEEN - found.T @ found, most - np.sum(found**2, axis=0)
    of_rest, of_slack = 1e-8 * at_zero * np.linalg.inv(rest), 1e-8 * at_zero / slack
    multiplier = 2.0 * (of_rest + np.diag(of_slack))
    hessian = np.kron(np.eye(design.shape[1]), multiplier)
    for scale in range(3):
        hessian[scale::3, scale::3] += design.T @ (weights[:, [scale]] * design)
    least = np.linalg.solve(hessian, (design.T @ (weights * target)).ravel()).reshape(found.shape)
    bound = objective(least, design, target, weights)
    bound -= np.trace(of_rest @ (BETWEEN - least.T @ least))
    bound -= np.sum(of_slack * (most - np.sum(least**2, axis=0)))
    assert 0.0 <= objective(found, design, target, weights) - bound <= 1.1 * gap * at_zero


def test_no_general_solver_finds_a_nearer_one():
    design, target, weights = problem(7, size=0.9)
    between, most = BETWEEN[:2, :2], 0.8
    target, weights = target[:, :2], weights[:, :2]
    found, _ = nearest_coefficients(design, target, weights, between, most)

    def limits(flat):
        b = flat.reshape(found.shape)
        rest = between - b.T @ b
        return np.append(most - np.sum(b**2, axis=0), np.linalg.det(rest))

    best = min(
        minimize(
            lambda flat: objective(flat.reshape(found.shape), design, target, weights),
            start,
            constraints={"type": "ineq", "fun": limits},
            method="SLSQP",
            options={"maxiter": 300, "ftol": 1e-12},
        ).fun
        for start in np.random.default_rng(0).uniform(-0.1, 0.1, (3, found.size))
    )
    assert objective(found, design, target, weights) == pytest.approx(best, rel=1e-5)


def test_nothing_may_be_explained():
    design, target, weights = problem(5)
    found, gap = nearest_coefficients(design, target, weights, BETWEEN, 0.0)
    assert not found.any()
    assert gap == 0.0
