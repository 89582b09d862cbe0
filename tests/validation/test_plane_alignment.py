"""The best turn and shift in the plane: closed form, least squares, and which hand fits."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import least_squares

from swaystride.errors import RecordingError
from swaystride.validation.plane_alignment import align_in_plane

RNG = np.random.default_rng(5)
PATH = RNG.normal(size=(2, 40)).cumsum(axis=1)


def turned(angle, shift, mirrored=False):
    rotation = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return rotation @ np.diag([1.0, -1.0 if mirrored else 1.0]) @ PATH + np.reshape(shift, (2, 1))


@given(
    angle=st.floats(-3.1, 3.1),
    shift=st.tuples(st.floats(-50, 50), st.floats(-50, 50)),
    mirrored=st.booleans(),
)
def test_a_turned_and_shifted_path_is_brought_back(angle, shift, mirrored):
    target = turned(angle, shift, mirrored)
    found = align_in_plane(PATH, target, mirrored=mirrored)
    np.testing.assert_allclose(found.apply(PATH), target, atol=1e-9)
    assert found.rms_m < 1e-9
    assert np.linalg.det(found.r_target_from_source) == pytest.approx(-1.0 if mirrored else 1.0)


def test_the_wrong_hand_leaves_a_distance():
    target = turned(0.7, (3.0, 1.0), mirrored=True)
    assert align_in_plane(PATH, target).rms_m > 1.0
    assert align_in_plane(PATH, target, mirrored=True).rms_m < 1e-9


@pytest.mark.parametrize("mirrored", [False, True])
def test_no_other_turn_and_shift_is_nearer(mirrored):
    """A general optimiser over angle and shift finds the same distance."""
    target = turned(2.0, (1.0, -4.0)) + RNG.normal(scale=0.5, size=PATH.shape)
    hand = np.diag([1.0, -1.0 if mirrored else 1.0])

    def distance(parameters):
        angle, *shift = parameters
        rotation = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        return (rotation @ hand @ PATH + np.reshape(shift, (2, 1)) - target).ravel()

    best = min(2.0 * least_squares(distance, [start, 0.0, 0.0]).cost for start in (0.0, 2.0, 4.0))
    found = align_in_plane(PATH, target, mirrored=mirrored)
    assert found.rms_m == pytest.approx(np.sqrt(best / PATH.shape[1]), rel=1e-7)


def test_paths_of_different_length_are_refused():
    with pytest.raises(RecordingError, match=r"found shapes \(2, 40\) and \(2, 39\)"):
        align_in_plane(PATH, PATH[:, 1:])
