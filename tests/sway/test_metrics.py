"""Sway measures: closed forms, invariances, and what the ellipses enclose."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from swaystride.errors import RecordingError
from swaystride.stats.prediction_ellipse import prediction_factor
from swaystride.sway.metrics import ELLIPSE_Z, sway_metrics

SEEDS = st.integers(0, 2**32 - 1)
LENGTHS = {"phi_rms", "ap_rms", "ml_rms", "phi_mv", "ap_mv", "ml_mv", "path_length"}
AREAS = {"ellipse_area", "ellipse_area_prediction"}


def walk(seed, n=200):
    return np.random.default_rng(seed).normal(size=(2, n)).cumsum(axis=1)


def test_a_circle_has_its_closed_form():
    """A full turn of radius r: RMS r/√2 per axis, path 2πr, ellipse area π·z²·r²/2."""
    n, radius, rate_hz = 20001, 1.7, 100.0
    angle = np.linspace(0.0, 2 * np.pi, n)[:-1]
    measures = sway_metrics(radius * np.cos(angle), radius * np.sin(angle), rate_hz)
    assert measures["ap_rms"] == pytest.approx(radius / np.sqrt(2), rel=1e-9)
    assert measures["phi_rms"] == pytest.approx(radius, rel=1e-9)
    assert measures["path_length"] == pytest.approx(2 * np.pi * radius, rel=1e-4)
    assert measures["ellipse_area"] == pytest.approx(np.pi * ELLIPSE_Z**2 * radius**2 / 2, rel=1e-3)
    assert measures["ap_mv"] == pytest.approx(4 * radius / ((n - 2) / rate_hz), rel=1e-3)


@given(SEEDS)
def test_measures_are_bound_by_their_identities(seed):
    ap, ml = walk(seed)
    measures = sway_metrics(ap, ml, 100.0)
    duration_s = (ap.size - 1) / 100.0
    assert measures["phi_rms"] ** 2 == pytest.approx(
        measures["ap_rms"] ** 2 + measures["ml_rms"] ** 2
    )
    assert measures["path_length"] == pytest.approx(measures["phi_mv"] * duration_s)
    correlation = np.corrcoef(ap, ml)[0, 1]
    area = np.pi * ELLIPSE_Z**2 * measures["ap_rms"] * measures["ml_rms"]
    area *= np.sqrt(1 - correlation**2) * ap.size / (ap.size - 1)
    assert measures["ellipse_area"] == pytest.approx(area)


@given(SEEDS, st.floats(-50, 50), st.floats(0.01, 100))
def test_shift_changes_nothing_and_scale_goes_as_length_or_area(seed, shift, scale):
    ap, ml = walk(seed)
    original = sway_metrics(ap, ml, 50.0)
    changed = sway_metrics(scale * (ap + shift), scale * (ml - shift), 50.0)
    for name in LENGTHS:
        assert changed[name] == pytest.approx(scale * original[name], rel=1e-7)
    for name in AREAS:
        assert changed[name] == pytest.approx(scale**2 * original[name], rel=1e-6)


@given(SEEDS, st.floats(0, 2 * np.pi))
def test_turning_the_axes_leaves_the_planar_measures(seed, angle):
    ap, ml = walk(seed)
    c, s = np.cos(angle), np.sin(angle)
    original, turned = (
        sway_metrics(ap, ml, 50.0),
        sway_metrics(c * ap - s * ml, s * ap + c * ml, 50.0),
    )
    for name in ("phi_rms", "phi_mv", "path_length", *AREAS):
        assert turned[name] == pytest.approx(original[name], rel=1e-7)


@given(SEEDS)
def test_swapping_the_directions_swaps_their_measures(seed):
    ap, ml = walk(seed)
    original, swapped = sway_metrics(ap, ml, 50.0), sway_metrics(ml, ap, 50.0)
    assert swapped["ap_rms"] == original["ml_rms"]
    assert swapped["ml_mv"] == original["ap_mv"]
    assert swapped["ellipse_area"] == pytest.approx(original["ellipse_area"])


def test_the_printed_ellipse_holds_85_percent_and_the_prediction_ellipse_95():
    """Methods §8.2: the printed constant is not a 95 % ellipse."""
    points = np.random.default_rng(7).multivariate_normal([0, 0], [[2.0, 0.6], [0.6, 1.0]], 200_000)
    distance = np.einsum("ij,jk,ik->i", points, np.linalg.inv(np.cov(points.T)), points)
    assert np.mean(distance < ELLIPSE_Z**2) == pytest.approx(
        1 - np.exp(-(ELLIPSE_Z**2) / 2), abs=0.003
    )
    assert np.mean(distance < ELLIPSE_Z**2) == pytest.approx(0.853, abs=0.003)
    assert np.mean(distance < prediction_factor(points.shape[0])) == pytest.approx(0.95, abs=0.003)


def test_the_prediction_ellipse_holds_95_percent_of_new_points_even_for_few_samples():
    """Exactness for small n: the point of the F-based factor."""
    rng = np.random.default_rng(11)
    n, repetitions = 6, 40_000
    samples = rng.normal(size=(repetitions, n, 2))
    new = rng.normal(size=(repetitions, 2)) - samples.mean(axis=1)
    centred = samples - samples.mean(axis=1, keepdims=True)
    covariance = np.einsum("rni,rnj->rij", centred, centred) / (n - 1)
    distance = np.einsum("ri,rij,rj->r", new, np.linalg.inv(covariance), new)
    assert np.mean(distance < prediction_factor(n)) == pytest.approx(0.95, abs=0.004)


@pytest.mark.parametrize(
    ("ap", "ml", "line"),
    [
        ([0.0, 1.0, 2.0], [0.0, 1.0, 2.0], "at least 4 samples"),
        ([0.0] * 5, [0.0] * 4, r"shapes \(5,\) and \(4,\)"),
        ([0.0, np.nan, 1.0, 2.0], [0.0] * 4, "missing samples; expected none; found 1"),
    ],
)
def test_unusable_coordinates_are_refused(ap, ml, line):
    with pytest.raises(RecordingError, match=line):
        sway_metrics(ap, ml, 100.0)
