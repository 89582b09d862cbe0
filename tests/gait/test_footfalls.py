"""Footfalls on straight and curved paths, whose lengths and widths have closed forms."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from swaystride.errors import RecordingError
from swaystride.gait.footfalls import footfalls, stride_lengths, stride_widths

N = 12
RIGHT, LEFT = np.arange(0, 2 * N, 2), np.arange(1, 2 * N + 1, 2)


def straight(width_m=0.05, stride_m=2.7):
    x = 0.5 * stride_m * np.r_[RIGHT, LEFT].reshape(2, N)
    y = np.array([-0.5, 0.5])[:, None] * width_m * np.ones(N)
    return np.stack([x, y, np.zeros_like(x)], axis=2)


def widths(places, right=RIGHT, left=LEFT):
    return (
        stride_widths(places[0], right, places[1], left, side="right"),
        stride_widths(places[1], left, places[0], right, side="left"),
    )


@given(st.floats(-0.3, 0.3))
def test_width_on_a_straight_path(width_m):
    """Crossing feet have a negative width; first and last footfalls are not bracketed."""
    right, left = widths(straight(width_m))
    assert np.allclose(right[1:], width_m, atol=1e-12)
    assert np.allclose(left[:-1], width_m, atol=1e-12)
    assert np.isnan(right[0])
    assert np.isnan(left[-1])


@pytest.mark.parametrize("turn", [1.0, -1.0])
def test_length_and_width_on_a_circle(turn):
    """The chord of the other foot passes inside its circle by radius · (1 − cos of half the angle)."""
    radius, width, step = 20.0, 0.06, 0.07
    own_radius = radius + turn * np.array([0.5, -0.5]) * width
    angle = step * np.stack([RIGHT, LEFT])
    x, y = own_radius[:, None] * np.sin(angle), turn * own_radius[:, None] * (1 - np.cos(angle))
    # both feet start beside each other on the normal
    y += np.array([-0.5, 0.5])[:, None] * width
    places = np.stack([x, y, 0 * x], axis=2)
    for side, radius_m in enumerate(own_radius):
        lengths = stride_lengths(places[side], horizontal=True)
        assert np.allclose(lengths, 2 * radius_m * np.sin(step))
    right, left = widths(places)
    assert np.allclose(right[1:], turn * (own_radius[0] - own_radius[1] * np.cos(step)))
    assert np.allclose(left[:-1], -turn * (own_radius[1] - own_radius[0] * np.cos(step)))


@given(st.floats(-np.pi, np.pi), st.floats(-500, 500), st.floats(-500, 500), st.integers(0, 99))
def test_heading_and_origin_do_not_matter(heading, x, y, seed):
    rng = np.random.default_rng(seed)
    places = straight() + 0.03 * rng.standard_normal((2, N, 3))
    c, s = np.cos(heading), np.sin(heading)
    turned = places @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) + [x, y, 3.0]
    for before, after in zip(widths(places), widths(turned), strict=True):
        assert np.allclose(before, after, atol=1e-9, equal_nan=True)
    for horizontal in (True, False):
        lengths = [stride_lengths(p[0], horizontal=horizontal) for p in (places, turned)]
        assert np.allclose(*lengths, atol=1e-9)


def test_a_slow_drift_of_heading_and_height_does_little():
    """One degree and 5 mm per stride: only the local change enters."""
    places = straight()
    order = np.argsort(np.r_[RIGHT, LEFT])
    both = places.reshape(-1, 3)[order]
    step = np.diff(both, axis=0)
    bend = np.radians(0.5) * np.arange(2 * N - 1)
    c, s = np.cos(bend), np.sin(bend)
    step = np.stack(
        [c * step[:, 0] - s * step[:, 1], s * step[:, 0] + c * step[:, 1], 0.0025 + 0 * c]
    )
    both = np.vstack([both[:1], both[0] + np.cumsum(step.T, axis=0)])
    drifted = np.empty_like(both)
    drifted[order] = both
    drifted = drifted.reshape(2, N, 3)
    assert np.allclose(stride_lengths(drifted[0], horizontal=True), 2.7, atol=1e-3)
    right, left = widths(drifted)
    # the line through two footfalls turns by half a degree against the path
    assert np.allclose(np.r_[right[1:], left[:-1]], 0.05, atol=2.7 / 2 * np.radians(0.5))
    assert np.mean(np.r_[right[1:], left[:-1]]) == pytest.approx(0.05, abs=1e-3)


def test_footfalls_are_means_over_the_still_samples_of_their_stance():
    rng = np.random.default_rng(5)
    path = rng.standard_normal((3, 100)) + 1e3
    still = rng.random(100) < 0.3
    contacts = np.array([10, 40, 60, 61, 90])
    still[61:90] = False
    path[1, 45] = np.nan
    still[45] = True
    found = footfalls(path, still, contacts)
    last = 0.6 * np.median(np.diff(contacts))  # a later sample is of no known stance
    for k, stop in enumerate([40, 60, 61, 90, 100]):
        stance = range(contacts[k], min(stop, int(contacts[k] + last) + 1))
        own = [i for i in stance if still[i] and i != 45]
        expected = path[:, own].mean(axis=1) if own else np.full(3, np.nan)
        assert np.allclose(found[k], expected, atol=1e-9, equal_nan=True)
    assert np.isnan(found[3]).all()


def test_a_stance_without_still_samples_takes_away_only_what_needs_it():
    places = straight()
    places[0, 4] = np.nan
    right, left = widths(places)
    assert np.isnan(stride_lengths(places[0], horizontal=True)).nonzero()[0].tolist() == [3, 4]
    assert np.isnan(right).nonzero()[0].tolist() == [0, 4]
    assert np.isnan(left).nonzero()[0].tolist() == [3, 4, N - 1]


def test_a_contact_that_was_missed_leaves_no_false_width():
    """Two contacts of one foot within one stride of the other: neither is bracketed by it."""
    places = straight()
    right = stride_widths(
        places[0], RIGHT, np.delete(places[1], 5, 0), np.delete(LEFT, 5), side="right"
    )
    assert np.isnan(right).nonzero()[0].tolist() == [0, 5, 6]


def test_shapes_that_do_not_fit():
    with pytest.raises(
        RecordingError, match=r"shapes \(3, n\) and \(n,\); found \(3, 9\) and \(8,\)"
    ):
        footfalls(np.zeros((3, 9)), np.zeros(8, bool), [0])


def test_the_last_stance_ends_although_no_contact_follows():
    x = np.arange(300) / 100.0
    path = np.stack([x, 0 * x, 0 * x])
    still = np.zeros(300, dtype=bool)
    still[[10, 110, 210]] = True
    np.testing.assert_allclose(footfalls(path, still, [0, 100])[:, 0], [0.1, 1.1], atol=1e-12)
