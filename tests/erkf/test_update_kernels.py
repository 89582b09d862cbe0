"""Update: one block after another equals the stacked update; reset and gate."""

import numpy as np
import pytest
from plain_erkf import skew

from swaystride.erkf._update_kernels import apply_constraint, reset

SIZE, D, SEGMENTS, WIDTH = 36, 12, 3, 48


def random_blocks(rng, count):
    for _ in range(count):
        first, second = rng.permutation(SEGMENTS)[:2]
        yield int(first), int(second), rng.normal(size=3), rng.normal(size=(2, 3, 12)), 0.1


def covariance(rng):
    factor = rng.normal(size=(SIZE, SIZE))
    p = np.zeros((SIZE, WIDTH))
    p[:, :SIZE] = factor @ factor.T
    return p


def apply(p, mean, block, gate=np.inf):
    first, second, residual, jacobian, variance = block
    space = np.empty((3, WIDTH)), np.empty(3), np.empty((3, 3))
    return apply_constraint(p, mean, first, second, D, residual, jacobian, variance, gate, *space)


def dense(block):
    h = np.zeros((3, SIZE))
    for side in range(2):
        place = block[side]
        h[:, D * place : D * (place + 1)] = block[3][side]
    return h


@pytest.mark.parametrize("seed", range(3))
def test_sequential_equals_stacked(seed):
    rng = np.random.default_rng(seed)
    p = covariance(rng)
    start, mean = p[:, :SIZE].copy(), np.zeros(SIZE)
    blocks = list(random_blocks(rng, 6))
    for block in blocks:
        assert apply(p, mean, block)
    h = np.concatenate([dense(block) for block in blocks])
    y = np.concatenate([block[2] for block in blocks])
    s = h @ start @ h.T + 0.1 * np.eye(len(h))
    gain = np.linalg.solve(s, h @ start).T
    np.testing.assert_allclose(mean, gain @ y, atol=1e-9)
    np.testing.assert_allclose(p[:, :SIZE], start - gain @ s @ gain.T, atol=1e-9)
    assert not p[:, SIZE:].any()


def test_order_of_blocks_does_not_matter():
    rng = np.random.default_rng(5)
    p = covariance(rng)
    q, blocks = p.copy(), list(random_blocks(rng, 5))
    one, two = np.zeros(SIZE), np.zeros(SIZE)
    for block in blocks:
        apply(p, one, block)
    for block in reversed(blocks):
        apply(q, two, block)
    np.testing.assert_allclose(one, two, atol=1e-9)
    np.testing.assert_allclose(p, q, atol=1e-9)


def test_beyond_the_gate_nothing_changes():
    rng = np.random.default_rng(2)
    p, mean = covariance(rng), np.zeros(SIZE)
    before = p.copy()
    block = next(random_blocks(rng, 1))
    h = dense(block)
    s = h @ p[:, :SIZE] @ h.T + 0.1 * np.eye(3)
    square = block[2] @ np.linalg.solve(s, block[2])
    assert not apply(p, mean, block, gate=0.999 * square)
    np.testing.assert_array_equal(p, before)
    assert not mean.any()
    assert apply(p, mean, block, gate=1.001 * square)


@pytest.mark.parametrize("transposed", [False, True])
def test_reset_equals_its_dense_matrix(transposed):
    rng = np.random.default_rng(3)
    p, error = covariance(rng), 0.1 * rng.normal(size=SIZE)
    start, g = p[:, :SIZE].copy(), np.eye(SIZE)
    for o in range(6, SIZE, D):
        g[o : o + 3, o : o + 3] -= 0.5 * skew(error[o : o + 3])
    g = g.T if transposed else g
    reset(p, error, D, transposed)
    np.testing.assert_allclose(p[:, :SIZE], g @ start @ g.T, rtol=1e-11, atol=1e-11)
