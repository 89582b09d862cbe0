"""The plain baseline: its removal of drift, and a walk whose stride lengths are known."""

from itertools import pairwise

import numpy as np
import pytest
from closed_form_walk import walk
from hypothesis import given
from hypothesis import strategies as st

from swaystride.validation.foot_baseline import dedrifted_position, vqf_path


@given(bias=st.tuples(*[st.floats(-1, 1)] * 3), start=st.tuples(*[st.floats(-5, 5)] * 3))
def test_whatever_is_constant_between_epochs_is_removed(bias, start):
    rng = np.random.default_rng(2)
    acc = rng.normal(size=(3, 100))
    epochs = [10, 40, 90]
    moved = dedrifted_position(acc, 50.0, epochs)
    biased = dedrifted_position(acc + np.array(bias)[:, None], 50.0, epochs)
    np.testing.assert_allclose(np.diff(biased[:, epochs]), np.diff(moved[:, epochs]), atol=1e-9)


def test_removal_of_drift_equals_the_sum_over_strides():
    """Stride by stride: integrate from rest, take a straight line from the velocity, sum up."""
    acc = np.random.default_rng(4).normal(size=(3, 61))
    rate_hz, epochs = 100.0, [0, 25, 60]
    found = dedrifted_position(acc, rate_hz, epochs)
    for start, stop in pairwise(epochs):
        own = acc[:, start : stop + 1]
        velocity = np.zeros_like(own)
        for k in range(1, own.shape[1]):
            velocity[:, k] = velocity[:, k - 1] + (own[:, k - 1] + own[:, k]) / 2 / rate_hz
        velocity -= velocity[:, -1:] * np.arange(own.shape[1]) / (own.shape[1] - 1)
        length = ((velocity[:, 1:] + velocity[:, :-1]) / 2 / rate_hz).sum(axis=1)
        np.testing.assert_allclose(found[:, stop] - found[:, start], length, atol=1e-12)


def test_a_walk_in_closed_form_has_its_stride_lengths():
    truth = walk(n_strides=6, stride_m=1.3)
    epochs = np.concatenate([[200], truth.stances, [truth.acc.shape[1] - 200]])
    path = vqf_path(truth.acc, truth.gyr, truth.rate_hz, epochs)
    lengths = np.linalg.norm(np.diff(path[:2, epochs]), axis=0)
    assert lengths[1:-1] == pytest.approx(1.3, rel=0.02)
