"""Smoothest quintic pieces."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.simulate._piece_kernel import evaluate_pieces
from swaystride.simulate.foot_spline import joined, least_jerk

FREE = np.nan


def jerk_cost(time: np.ndarray, coefficients: np.ndarray) -> float:
    """Integrated squared jerk by quadrature, independent of the closed form."""
    total = 0.0
    nodes, weights = np.polynomial.legendre.leggauss(6)
    for duration, c in zip(np.diff(time), coefficients, strict=True):
        u = duration * (nodes + 1) / 2
        jerk = 6 * c[3] + 24 * c[4] * u + 60 * c[5] * u**2
        total += float(weights @ jerk**2) * duration / 2
    return total


@settings(max_examples=50, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), n_knots=st.integers(2, 5))
def test_prescribed_states_are_met_and_joins_are_smooth(seed: int, n_knots: int) -> None:
    rng = np.random.default_rng(seed)
    time = np.cumsum(rng.uniform(0.05, 1.0, size=(3, n_knots)), axis=1)
    states = rng.normal(size=(3, n_knots, 3))
    free = rng.random((n_knots, 3)) < 0.4
    free[:, 0] = False
    states[:, free] = FREE
    coefficients = least_jerk(time, states)
    for row in range(3):
        function = joined(time[row, :-1], coefficients[row])
        found = function(time[row]).T
        known = ~np.isnan(states[row])
        np.testing.assert_allclose(found[known], states[row][known], rtol=1e-6, atol=1e-6)
        scale = 1.0 + np.abs(found).max()
        for knot in time[row, 1:-1]:
            left, right = function([knot - 1e-9])[:, 0], function([knot + 1e-9])[:, 0]
            np.testing.assert_allclose(left, right, atol=1e-4 * scale)


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_no_other_choice_of_the_free_derivatives_has_less_jerk(seed: int) -> None:
    rng = np.random.default_rng(seed)
    time = np.cumsum(rng.uniform(0.1, 0.5, size=(1, 4)), axis=1)
    states = rng.normal(size=(1, 4, 3))
    states[:, 1:3, 1:] = FREE
    best = least_jerk(time, states)
    solved = joined(time[0, :-1], best[0])(time[0]).T
    least = jerk_cost(time[0], best[0])
    for _ in range(10):
        other = solved[None].copy()
        other[:, 1:3, 1:] += rng.normal(size=(1, 2, 2))
        assert jerk_cost(time[0], least_jerk(time, other)[0]) >= least * (1 - 1e-9)


def test_a_cubic_is_left_as_it_is() -> None:
    time = np.array([[0.0, 0.4, 1.0]])
    cubic = np.polynomial.Polynomial([1.0, -2.0, 0.5, 3.0])
    states = np.stack([cubic(time), cubic.deriv()(time), cubic.deriv(2)(time)], axis=-1)
    states[:, 1, 1:] = FREE
    function = joined(time[0, :-1], least_jerk(time, states)[0])
    where = np.linspace(0.0, 1.0, 50)
    np.testing.assert_allclose(function(where)[0], cubic(where), atol=1e-12)


def test_value_and_derivatives_belong_together() -> None:
    rng = np.random.default_rng(1)
    function = joined([0.0, 1.0], rng.normal(size=(2, 6)))
    where = np.linspace(0.1, 0.9, 9)
    for order in range(2):
        slope = (function(where + 1e-6)[order] - function(where - 1e-6)[order]) / 2e-6
        np.testing.assert_allclose(slope, function(where)[order + 1], atol=1e-6)


def test_the_ends_go_on_for_ever() -> None:
    function = joined([0.0], [[2.0, 0.0, 0.0, 0.0, 0.0, 0.0]])
    assert function([-1e6, 1e6])[0].tolist() == [2.0, 2.0]


def test_pieces_are_put_in_order() -> None:
    function = joined([1.0, 0.0], [[5.0] + [0.0] * 5, [3.0] + [0.0] * 5])
    assert function([0.5, 1.5])[0].tolist() == pytest.approx([3.0, 5.0])


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), n_pieces=st.integers(1, 6), rising=st.booleans())
def test_the_kernel_does_what_its_plain_twin_does(seed: int, n_pieces: int, rising: bool) -> None:
    rng = np.random.default_rng(seed)
    start = np.cumsum(rng.uniform(0.1, 1.0, n_pieces))
    coefficients = rng.normal(size=(n_pieces, 6))
    time = np.append(rng.uniform(-1.0, 7.0, 50), start)
    if rising:
        time = np.sort(time)
    piece = np.maximum(np.searchsorted(start, time, side="right") - 1, 0)
    slow = np.empty((3, len(time)))
    for i, (row, u) in enumerate(zip(coefficients[piece], time - start[piece], strict=True)):
        polynomial = np.polynomial.Polynomial(row)
        slow[:, i] = [polynomial(u), polynomial.deriv()(u), polynomial.deriv(2)(u)]
    fast = evaluate_pieces(start, coefficients, time)
    np.testing.assert_allclose(fast, slow, rtol=1e-10, atol=1e-10)
