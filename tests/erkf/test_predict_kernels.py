"""Prediction: transition against finite differences, block arithmetic against dense matrices."""

import numpy as np
import pytest
from plain_erkf import Segment, minus, step

from swaystride.erkf._predict_kernels import predict_covariance, predict_segment, retreat

STEP_S = 0.01


def drawn(seed):
    rng = np.random.default_rng(seed)
    state = rng.normal(size=13)
    state[6:10] /= np.linalg.norm(state[6:10])
    return state, *(rng.normal(scale=[5, 5, 5, 4, 4, 4], size=(2, 6)))


def advanced(state, before, after, midpoint):
    state, transition = state.copy(), np.empty((9, 6))
    predict_segment(state, before, after, STEP_S, midpoint, transition)
    return state, transition


def dense(transition):
    f = np.eye(12)
    f[0:3, 3:6] = STEP_S * np.eye(3)
    f[0:9, 6:12] = transition
    return f


@pytest.mark.parametrize("midpoint", [True, False])
@pytest.mark.parametrize("seed", range(5))
def test_transition_is_the_derivative_of_the_step(seed, midpoint):
    state, before, after = drawn(seed)
    moved, transition = advanced(state, before, after, midpoint)
    nominal = Segment.of(moved)
    slopes = np.empty((12, 12))
    for c in range(12):
        ends = []
        for h in (-1e-5, 1e-5):
            start = Segment.of(state).plus(h * np.eye(12)[c]).row()
            end = Segment.of(advanced(start, before, after, midpoint)[0])
            ends.append(minus(end, nominal, 12))
        slopes[:, c] = (ends[1] - ends[0]) / 2e-5
    np.testing.assert_allclose(dense(transition), slopes, atol=1e-6)


@pytest.mark.parametrize("midpoint", [True, False])
def test_step_equals_the_one_written_out(midpoint):
    state, before, after = drawn(7)
    moved, transition = advanced(state, before, after, midpoint)
    expected, f = step(Segment.of(state), before, after, STEP_S, midpoint, 12)
    np.testing.assert_allclose(minus(Segment.of(moved), expected, 12), 0.0, atol=1e-12)
    np.testing.assert_allclose(dense(transition), f, atol=1e-13)


def test_at_rest_nothing_moves():
    state = np.r_[np.zeros(6), 1.0, np.zeros(6)]
    rest = np.array([0.0, 0.0, 9.80665, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(advanced(state, rest, rest, True)[0], state, atol=1e-15)


@pytest.mark.parametrize("d", [9, 12])
@pytest.mark.parametrize("m", [1, 3])
def test_block_products_equal_dense_ones(d, m):
    rng = np.random.default_rng(d + m)
    n = m * d
    transition = rng.normal(size=(m, 9, 6))
    f = np.zeros((n, n))
    for j in range(m):
        f[d * j : d * (j + 1), d * j : d * (j + 1)] = dense(transition[j])[:d, :d]
    factor = rng.normal(size=(n, n))
    start = factor @ factor.T
    noise = rng.uniform(size=d)
    p = np.zeros((n, 48))
    p[:, :n] = start
    predict_covariance(p, transition, STEP_S, noise)
    np.testing.assert_allclose(p[:, :n], f @ start @ f.T + np.diag(np.tile(noise, m)), rtol=1e-11)
    np.testing.assert_array_equal(p[:, :n], p[:, :n].T)
    assert not p[:, n:].any()
    adjoint = rng.normal(size=n)
    back, p[:, :n] = adjoint.copy(), start
    retreat(back, p, transition, STEP_S, d)
    np.testing.assert_allclose(back, f.T @ adjoint, rtol=1e-11)
    np.testing.assert_allclose(p[:, :n], f.T @ start @ f, rtol=1e-10, atol=1e-10)
