"""Vector coding: closed forms, invariances, and other ways to compute the same."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import chi2, circstd

from swaystride.errors import RecordingError
from swaystride.gait.segment_signals import lowpassed_parts
from swaystride.gait.spatiotemporal import RUNNING_STRIDES, running_strides
from swaystride.gait.vector_coding import (
    ANGULAR_DEVIATION,
    COUPLES,
    N_INTERVALS,
    PERIODS,
    PREDICTION_ELLIPSE,
    coordination_variability,
    coupling_angles_deg,
    interval_variability,
    segment_increments,
)

SEEDS = st.integers(0, 2**32 - 1)
CIRCULAR_SD = replace(ANGULAR_DEVIATION, method="circular_sd")
ACUTE = replace(ANGULAR_DEVIATION, acute=True)


def cloud(seed, n=40, n_intervals=6):
    """Pairs of increments about a mean direction that differs from interval to interval."""
    rng = np.random.default_rng(seed)
    return 2.0 * rng.standard_normal((2, 1, n_intervals)) + rng.standard_normal((2, n, n_intervals))


def test_uniform_directions_and_one_direction():
    """√2 rad = 81.03° (methods §11, item 8), and 0."""
    around = np.radians(np.arange(0.0, 360.0, 5.0))
    x, y = np.cos(around)[:, None], np.sin(around)[:, None]
    assert interval_variability(x, y, ANGULAR_DEVIATION) == pytest.approx([81.0285], abs=1e-4)
    length = np.linspace(0.1, 5.0, 30)[:, None]
    for angle in (0.3, 1.5, 3.0, 4.4):
        ray = length * np.cos(angle), length * np.sin(angle)
        for coding in (ANGULAR_DEVIATION, CIRCULAR_SD, PREDICTION_ELLIPSE):
            assert interval_variability(*ray, coding) == pytest.approx([0.0], abs=1e-5)


def test_two_opposite_halves():
    """r̄ = |p − q| for shares p and q of two opposite directions: √(2(1 − r̄)), √(−2 ln r̄)."""
    x = np.array([1.0] * 15 + [-1.0] * 5)[:, None]
    deviation = np.degrees(np.sqrt(2.0 * (1.0 - 0.5)))
    sd = np.degrees(np.sqrt(-2.0 * np.log(0.5)))
    assert interval_variability(x, 0.0 * x, ANGULAR_DEVIATION) == pytest.approx([deviation])
    assert interval_variability(x, 0.0 * x, CIRCULAR_SD) == pytest.approx([sd])
    assert interval_variability(x, 0.0 * x, ACUTE) == pytest.approx([0.0], abs=1e-9)


@settings(max_examples=30)
@given(SEEDS)
def test_the_formula_as_it_is_written(seed):
    x, y = cloud(seed)
    angle = np.radians(coupling_angles_deg(x, y))
    resultant = np.hypot(np.cos(angle).mean(axis=0), np.sin(angle).mean(axis=0))
    expected = np.degrees(np.sqrt(2.0 * (1.0 - resultant)))
    assert np.allclose(interval_variability(x, y, ANGULAR_DEVIATION), expected, atol=1e-6)
    assert np.allclose(interval_variability(x, y, CIRCULAR_SD), np.degrees(circstd(angle, axis=0)))
    folded = np.radians(coupling_angles_deg(x, y, acute=True))
    resultant = np.hypot(np.cos(folded).mean(axis=0), np.sin(folded).mean(axis=0))
    expected = np.degrees(np.sqrt(2.0 * (1.0 - resultant)))
    assert np.allclose(interval_variability(x, y, ACUTE), expected, atol=1e-6)


@settings(max_examples=30)
@given(SEEDS, st.floats(0.0, 6.0))
def test_what_does_not_matter(seed, turn):
    """Exchanged segments, reversed signs, a turned plane, longer vectors, the order of strides."""
    x, y = cloud(seed)
    value = interval_variability(x, y, ANGULAR_DEVIATION)
    c, s = np.cos(turn), np.sin(turn)
    lengths = np.random.default_rng(seed).uniform(0.5, 2.0, x.shape)
    for other in (
        (y, x),
        (-x, y),
        (c * x - s * y, s * x + c * y),
        (lengths * x, lengths * y),
        (x[::-1], y[::-1]),
    ):
        assert np.allclose(interval_variability(*other, ANGULAR_DEVIATION), value, atol=1e-7)
    assert np.all((value >= 0.0) & (value <= 81.03))


def test_the_ellipse_of_a_large_sample():
    """Area π χ²(0.95; 2) σ₁ σ₂ √(1 − ρ²), in square degrees."""
    rng = np.random.default_rng(8)
    u, v = rng.standard_normal((2, 200_000, 1))
    x, y = 2.0 * u, 3.0 * (0.6 * u + 0.8 * v)
    area = np.pi * chi2.ppf(0.95, 2) * 2.0 * 3.0 * 0.8
    assert interval_variability(x, y, PREDICTION_ELLIPSE) == pytest.approx([area], rel=0.01)
    assert interval_variability(10 * x, y, PREDICTION_ELLIPSE) == pytest.approx(
        [10 * area], rel=0.01
    )


def test_few_strides_and_short_vectors_give_nothing():
    x, y = cloud(1, n=15)
    assert np.isfinite(interval_variability(x, y, ANGULAR_DEVIATION)).all()
    holed = x.copy()
    holed[3, 2] = np.nan
    assert np.isnan(interval_variability(holed, y, ANGULAR_DEVIATION)).all()
    pair = replace(PREDICTION_ELLIPSE, least_strides=2)
    assert np.isnan(interval_variability(x[:2], y[:2], pair)).all()
    centred = np.random.default_rng(4).standard_normal((2, 30, 3)) * 0.1
    centred[0] += np.array([5.0, 0.0, 5.0])  # the middle one is a reversal
    masked = replace(ANGULAR_DEVIATION, least_vector_share=0.1)
    assert np.isnan(interval_variability(*centred, masked)).tolist() == [False, True, False]


def strides_of(n, stride_s=0.7, contact_s=0.2):
    start = 0.1 + stride_s * np.arange(n)
    return pd.DataFrame(
        {"start_s": start, "toe_off_s": start + contact_s, "stop_s": start + stride_s}
    )


def test_increments_are_rates_and_a_bias_does_not_matter():
    rate = np.radians(30.0) * np.cos(2 * np.pi * np.arange(8000) / 350.0)
    strides = strides_of(20)
    steps = segment_increments(rate, strides, 500.0)
    assert steps.shape == (20, 2 * N_INTERVALS)
    assert np.allclose(steps.sum(axis=1), 0.0, atol=1e-9)
    middle = strides["start_s"].to_numpy()[:, None] + 0.002 * (np.arange(100) + 0.5)
    expected = 30.0 * np.cos(2 * np.pi * middle * 500.0 / 350.0) * 0.002
    assert np.allclose(steps[:, :100], expected, atol=2e-4)
    assert np.allclose(segment_increments(rate + 0.2, strides, 500.0), steps, atol=1e-9)


def test_twelve_values_with_their_periods():
    """A couple that scatters in late stance only has variability there only."""
    rng = np.random.default_rng(6)
    quiet = np.ones((30, 2 * N_INTERVALS))
    loose = quiet.copy()
    loose[:, PERIODS["late_stance"]] = rng.standard_normal((30, 33))
    increments = {"foot": loose, "shank": quiet, "thigh": quiet, "pelvis": quiet}
    values = coordination_variability(increments, ANGULAR_DEVIATION)
    assert list(values) == [f"{d}_{p}_{period}" for d, p in COUPLES for period in PERIODS]
    assert len(values) == 12
    assert values.pop("foot_shank_late_stance") > 20.0
    assert np.allclose(list(values.values()), 0.0, atol=1e-6)


def test_a_missing_thigh_takes_its_couples():
    quiet = np.ones((30, 2 * N_INTERVALS))
    values = coordination_variability(
        {"foot": quiet, "shank": quiet, "pelvis": quiet}, ANGULAR_DEVIATION
    )
    missing = [name for name, value in values.items() if np.isnan(value)]
    assert len(missing) == 8
    assert all("thigh" in name for name in missing)


def test_strides_without_toe_off():
    strides = strides_of(3)
    strides.loc[1, "toe_off_s"] = np.nan
    with pytest.raises(RecordingError, match="1 rows of 3 that differ"):
        segment_increments(np.zeros(2000), strides, 500.0)


def test_sensors_of_a_simulated_run_see_the_variability_of_the_bones(thirteen_imus):
    run = thirteen_imus(14.0)
    strides = running_strides(run.events, RUNNING_STRIDES)
    own = strides[(strides["side"] == "right") & strides["is_valid"]]
    rows = {"foot": 5, "shank": 3, "thigh": 1, "pelvis": 0}
    names = {
        "foot": "foot_right",
        "shank": "shank_right",
        "thigh": "thigh_right",
        "pelvis": "lumbar",
    }
    worn, bone = (
        coordination_variability(
            {
                segment: segment_increments(lowpassed_parts(rate(segment), 15.0, 500.0), own, 500.0)
                for segment in rows
            },
            ANGULAR_DEVIATION,
        )
        for rate in (
            lambda segment: run.signals[names[segment]].gyr_rad_s[2],
            lambda segment: run.rate_z[rows[segment]],
        )
    )
    for name, value in bone.items():
        assert worn[name] == pytest.approx(value, rel=0.15, abs=1.0), name
