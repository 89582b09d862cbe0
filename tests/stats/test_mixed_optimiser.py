from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize

from swaystride.stats.mixed_design import design_from_terms
from swaystride.stats.mixed_fit import fit_design
from swaystride.stats.mixed_optimiser import minimise_over_ratios


def _bowl(target, H):
    def objective(gamma):
        d = gamma - target
        return float(0.5 * d @ H @ d), H @ d, H

    return objective


@pytest.mark.parametrize("seed", range(8))
def test_convex_quadratics_with_bounds_match_scipy(seed):
    rng = np.random.default_rng(seed)
    A = rng.normal(size=(4, 4))
    H, target = A @ A.T + 0.1 * np.eye(4), rng.normal(size=4)
    objective = _bowl(target, H)
    found = minimise_over_ratios(objective, np.full(4, 3.0), np.ones(4))
    expected = minimize(
        lambda g: objective(g)[0],
        np.ones(4),
        jac=lambda g: objective(g)[1],
        bounds=[(0, None)] * 4,
        options={"ftol": 1e-15, "gtol": 1e-12},
    )
    assert found.converged
    np.testing.assert_allclose(found.gamma, expected.x, atol=1e-5)
    assert found.value <= expected.fun + 1e-12


def test_a_start_at_the_boundary_is_left_when_the_slope_says_so():
    found = minimise_over_ratios(_bowl(np.array([2.0]), np.eye(1)), np.ones(1), np.zeros(1))
    assert found.gamma == pytest.approx([2.0], abs=1e-9)


def test_an_unbounded_ratio_is_reported_not_hidden():
    def objective(gamma):
        return -float(np.log1p(gamma[0])), -1 / (1 + gamma), np.diag(1 / (1 + gamma) ** 2)

    found = minimise_over_ratios(objective, np.ones(1), np.ones(1))
    assert not found.converged
    assert "without bound" in found.message


def test_the_end_does_not_depend_on_the_start(crossed):
    frame = crossed()
    design = design_from_terms(frame, ["x"], ["p", "r", "p:e", "p:r", "r:t"])
    y = frame["y"].to_numpy()
    fits = [fit_design(design, y, start=np.full(5, start)) for start in (1e-4, 0.05, 1.0, 30.0)]
    for fit in fits:
        assert fit.converged
        np.testing.assert_allclose(fit.gamma, fits[0].gamma, atol=1e-9)


class _Split:
    """A bowl plus a curved part whose Hessian is held back; counts how often it is asked for."""

    def __init__(self, target, H, weight):
        self.bowl, self.weight, self.asked = _bowl(target, H), weight, 0

    def sketch(self, gamma):
        value, gradient, hessian = self.bowl(gamma)
        value += float((self.weight * np.log1p(gamma)).sum() ** 2)
        total = (self.weight * np.log1p(gamma)).sum()
        slope = 2.0 * total * self.weight / (1.0 + gamma)
        return (value, gradient + slope, hessian), slope

    def costly_hessian(self, gamma):
        self.asked += 1
        each = self.weight / (1.0 + gamma)
        total = (self.weight * np.log1p(gamma)).sum()
        return 2.0 * np.outer(each, each) - np.diag(2.0 * total * each / (1.0 + gamma))

    def whole(self, gamma):
        (value, gradient, hessian), _ = self.sketch(gamma)
        return value, gradient, hessian + self.costly_hessian(gamma)


@pytest.mark.parametrize("seed", range(8))
def test_secants_lead_to_the_same_minimum_as_exact_hessians(seed):
    rng = np.random.default_rng(seed)
    A = rng.normal(size=(5, 5))
    split = _Split(3.0 * rng.normal(size=5), A @ A.T + 0.5 * np.eye(5), rng.random(5))
    size = rng.uniform(1.0, 9.0, size=5)
    whole = minimise_over_ratios(split.whole, size, np.ones(5))
    split.asked = 0
    found = minimise_over_ratios(split, size, np.ones(5))
    assert found.converged == whole.converged is True
    assert found.value == pytest.approx(whole.value, abs=1e-10)
    np.testing.assert_allclose(found.gamma, whole.gamma, atol=1e-8)
    assert split.asked < found.evaluations


def test_a_search_that_leads_to_a_known_minimum_ends_there():
    objective = _bowl(np.array([2.0, -1.0]), np.array([[2.0, 0.3], [0.3, 1.0]]))
    first = minimise_over_ratios(objective, np.ones(2), np.ones(2))
    again = minimise_over_ratios(objective, np.ones(2), np.full(2, 30.0), first)
    assert again.gamma.tolist() == first.gamma.tolist()
    assert again.evaluations > first.evaluations


def test_a_search_goes_past_a_known_point_that_is_no_minimum():
    objective = _bowl(np.array([2.0]), np.eye(1))
    false = replace(minimise_over_ratios(objective, np.ones(1), np.ones(1)), gamma=np.array([2.1]))
    false = replace(false, value=objective(false.gamma)[0])
    found = minimise_over_ratios(objective, np.ones(1), np.full(1, 30.0), false)
    assert found.gamma == pytest.approx([2.0], abs=1e-9)
