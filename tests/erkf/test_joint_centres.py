"""Joint centres of the chain from accelerations alone."""

from dataclasses import replace

import numpy as np
import pytest
from rigid_chain import chain

from swaystride.erkf.joint_centres import joint_centre_of, lever_matrices


@pytest.fixture(scope="module")
def fast_walk():
    return chain(duration_s=8.0, rate_hz=400.0)


def fitted(moving, place, *, offset_m=0.03, **options):
    joint = moving.body.joints[place]
    one, two = moving.body.index(joint.proximal), moving.body.index(joint.distal)
    shift = np.array([offset_m, -offset_m, offset_m])
    settings = {"prior_sd_m": np.inf, "noise_m_s2": 0.1, "independent_s": np.inf} | options
    found = joint_centre_of(
        (moving.acc[one], moving.gyr[one]),
        (moving.acc[two], moving.gyr[two]),
        moving.rate_hz,
        cutoff_hz=80.0,
        prior_m=(joint.proximal_centre_m + shift, joint.distal_centre_m - shift),
        **settings,
    )
    return found, joint


@pytest.mark.parametrize("place", [4, 5])
def test_ankle_centres_are_found(fast_walk, place):
    found, joint = fitted(fast_walk, place)
    np.testing.assert_allclose(found.proximal_m, joint.proximal_centre_m, atol=2e-3)
    np.testing.assert_allclose(found.distal_m, joint.distal_centre_m, atol=2e-3)
    assert found.residual_m_s2 < 0.05


@pytest.mark.parametrize("place", [2, 3])
def test_hinge_centres_are_found_up_to_the_axis(fast_walk, place):
    """Along the axis of a hinge nothing is measured: the prior decides, or the axis is taken off."""
    axes = (fast_walk.body.joints[place].proximal_axis, fast_walk.body.joints[place].distal_axis)
    found, joint = fitted(fast_walk, place, prior_sd_m=0.1)
    for vector, truth, axis in (
        (found.proximal_m, joint.proximal_centre_m, axes[0]),
        (found.distal_m, joint.distal_centre_m, axes[1]),
    ):
        gap = vector - truth
        assert np.linalg.norm(gap - (gap @ axis) * axis) < 0.01
    found, joint = fitted(fast_walk, place, prior_sd_m=0.1, axes=axes)
    assert found.proximal_m @ axes[0] + found.distal_m @ axes[1] == pytest.approx(0.0, abs=1e-12)


def test_a_tight_prior_stays(fast_walk):
    found, joint = fitted(fast_walk, 0, prior_sd_m=1e-6, offset_m=0.02)
    shift = np.array([0.02, -0.02, 0.02])
    np.testing.assert_allclose(found.proximal_m, joint.proximal_centre_m + shift, atol=1e-4)


def test_lever_matrix_is_the_acceleration_about_the_centre():
    rate, acceleration = np.array([0.3, -1.2, 2.0]), np.array([4.0, 1.0, -3.0])
    time = np.arange(-5, 6) / 1000.0
    gyr = rate[:, None] + acceleration[:, None] * time
    r = np.array([0.1, 0.2, -0.3])
    found = lever_matrices(gyr, 1000.0)[5] @ r
    expected = np.cross(acceleration, r) + np.cross(rate, np.cross(rate, r))
    np.testing.assert_allclose(found, expected, atol=1e-9)


def test_each_side_has_a_prior_of_its_own(fast_walk):
    """A sure proximal vector stays; movement moves the distal one where it can."""
    found, joint = fitted(fast_walk, 4, prior_sd_m=(1e-6, 0.1), offset_m=0.02)
    shift = np.array([0.02, -0.02, 0.02])
    np.testing.assert_allclose(found.proximal_m, joint.proximal_centre_m + shift, atol=1e-4)
    assert np.linalg.norm(found.distal_m - (joint.distal_centre_m - shift)) > 0.01
    both, _ = fitted(fast_walk, 4, prior_sd_m=(0.1, 0.1))
    same, _ = fitted(fast_walk, 4, prior_sd_m=0.1)
    np.testing.assert_array_equal(both.proximal_m, same.proximal_m)
    np.testing.assert_array_equal(both.distal_m, same.distal_m)


def test_strides_that_are_alike_weigh_as_much_as_one(fast_walk):
    """Twice the recording moves the estimate off its prior only if it says something new."""
    repeated = replace(
        fast_walk, acc=np.tile(fast_walk.acc, (1, 1, 3)), gyr=np.tile(fast_walk.gyr, (1, 1, 3))
    )
    settings = {"prior_sd_m": 0.005, "noise_m_s2": 5.0, "offset_m": 0.02}
    results = {
        (name, span): fitted(moving, 5, independent_s=span, **settings)[0]
        for name, moving in (("once", fast_walk), ("thrice", repeated))
        for span in (1.0, np.inf)
    }
    gap = {key: fit.distal_m - results["once", 1.0].distal_m for key, fit in results.items()}
    assert np.linalg.norm(gap["thrice", 1.0]) < 3e-4
    assert np.linalg.norm(gap["once", np.inf]) > 1e-3
    assert np.linalg.norm(gap["thrice", np.inf]) > np.linalg.norm(gap["once", np.inf])


def test_deviations_shrink_with_what_is_new(fast_walk):
    """Without prior: a quarter of the independent time, twice the standard deviation."""
    short, long = (fitted(fast_walk, 4, independent_s=span)[0] for span in (1.0, 4.0))
    np.testing.assert_allclose(short.sd_m, 2.0 * long.sd_m, rtol=1e-4)
    np.testing.assert_allclose(short.proximal_m, long.proximal_m, atol=1e-5)
    assert short.residual_m_s2 == pytest.approx(long.residual_m_s2, rel=1e-4)
