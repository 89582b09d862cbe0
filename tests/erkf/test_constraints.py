"""Constraints: derivatives against finite differences, models against an independent writing."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plain_erkf import Segment, measured

from swaystride.erkf.constraints import (
    ContactPoint,
    JointAxis,
    JointCentre,
    Tilt,
    ZeroVelocity,
    as_row,
    constraints_of,
    linearised,
)
from swaystride.erkf.noise import RUNNING_SWAPPED
from swaystride.erkf.options import PRINTED_OPTIONS, RECOMMENDED_OPTIONS

V1, V2 = np.array([0.1, -0.3, 0.05]), np.array([-0.2, 0.1, 0.4])
CONSTRAINTS = [
    ZeroVelocity(1, 0.1),
    ContactPoint(0, V1, 0.02, 0.03, 0.04),
    Tilt(1, 0.03),
    JointCentre((0, 1), (V1, V2), 0.01),
    JointAxis((1, 0), (V1 / np.linalg.norm(V1), V2 / np.linalg.norm(V2)), 0.02),
]


def drawn(seed):
    rng = np.random.default_rng(seed)
    states = rng.normal(size=(2, 13))
    states[:, 6:10] /= np.linalg.norm(states[:, 6:10], axis=1, keepdims=True)
    return states, rng.normal(scale=3.0, size=(2, 6))


@pytest.mark.parametrize("constraint", CONSTRAINTS, ids=lambda c: type(c).__name__)
@given(st.integers(0, 10**6))
def test_jacobian_is_the_derivative_of_the_prediction(constraint, seed):
    states, signals = drawn(seed)
    found = linearised(constraint, states, signals)
    for side, place in enumerate(constraint.segments):
        for c in range(12):
            residuals = []
            for h in (-1e-5, 1e-5):
                moved = states.copy()
                moved[place] = Segment.of(states[place]).plus(h * np.eye(12)[c]).row()
                residuals.append(linearised(constraint, moved, signals).residual)
            # the residual is minus the prediction
            slope = -(residuals[1] - residuals[0]) / 2e-5
            np.testing.assert_allclose(found.jacobian[side, :, c], slope, atol=1e-6)
    assert not found.jacobian[len(constraint.segments) :].any()


@pytest.mark.parametrize("constraint", CONSTRAINTS, ids=lambda c: type(c).__name__)
@given(st.integers(0, 10**6))
def test_kernel_equals_the_model_written_out(constraint, seed):
    states, signals = drawn(seed)
    found = linearised(constraint, states, signals)
    residual, jacobian, variance = measured(constraint, [Segment.of(r) for r in states], signals)
    np.testing.assert_allclose(found.residual, residual, atol=1e-12)
    np.testing.assert_allclose(found.jacobian, jacobian, atol=1e-12)
    assert found.variance == pytest.approx(variance, rel=1e-12)


def test_a_constraint_of_one_segment_has_no_second():
    assert as_row(CONSTRAINTS[0])[1:3] == (1, -1)
    assert as_row(CONSTRAINTS[4])[1:3] == (1, 0)


def kinds(constraints):
    return [type(c).__name__ for c in constraints]


def test_printed_model_measures_all_joints_at_every_sample(walk):
    found, active = constraints_of(
        walk.body, RUNNING_SWAPPED, PRINTED_OPTIONS, 200.0, walk.stance, None
    )
    # the chain has axes at the knees only
    assert (
        kinds(found)
        == ["ZeroVelocity"] * 2
        + ["JointCentre"] * 2
        + [
            "JointCentre",
            "JointAxis",
        ]
        * 2
        + ["JointCentre"] * 2
    )
    np.testing.assert_array_equal(active[:, :2], walk.stance.T)
    assert active[:, 2:].all()


def test_recommended_model_measures_joints_at_their_rate_with_larger_noise(walk):
    still = np.zeros((7, walk.stance.shape[1]), bool)
    still[3, 5:9] = True
    found, active = constraints_of(
        walk.body, RUNNING_SWAPPED, RECOMMENDED_OPTIONS, 200.0, walk.stance, still
    )
    assert kinds(found)[:3] == ["ContactPoint", "ContactPoint", "Tilt"]
    np.testing.assert_array_equal(np.flatnonzero(active[:, 2]), np.arange(5, 9))
    np.testing.assert_array_equal(np.flatnonzero(active[:50, 3]), np.arange(0, 50, 4))
    assert found[3].distance_sd_m == pytest.approx(2.0 * 0.01)


def test_a_rate_above_that_of_the_recording_means_every_sample(walk):
    _, active = constraints_of(
        walk.body, RUNNING_SWAPPED, RECOMMENDED_OPTIONS, 40.0, walk.stance, None
    )
    assert active[:, 2:].all()
