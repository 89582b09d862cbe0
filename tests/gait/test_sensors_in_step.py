"""Pairs of sensors on one clock, and a sensor that is late."""

import numpy as np
import pytest

from swaystride.gait.segment_signals import SegmentSignals
from swaystride.gait.sensors_in_step import StepRule, pair_lags_s

RULE = StepRule(
    cutoff_hz=8.0,
    span_s=15.0,
    n_spans=2,
    accepted_lag_s=0.06,
    lowest_stride_hz=1.0,
    highest_stride_hz=2.0,
)
PAIRS = 7


@pytest.mark.parametrize("speed_km_h", [9.0, 12.0, 16.0])
def test_a_runner_is_symmetric(thirteen_imus, speed_km_h):
    lags = pair_lags_s(thirteen_imus(speed_km_h).signals, 500.0, RULE)
    assert len(lags) == PAIRS
    assert max(map(abs, lags.values())) < RULE.accepted_lag_s


@pytest.mark.parametrize("late", ["shank_left", "foot_right", "wrist_left", "head"])
def test_a_late_sensor_is_found_with_its_lag(thirteen_imus, late):
    run = thirteen_imus(12.0)
    before = pair_lags_s(run.signals, 500.0, RULE)
    moved = dict(run.signals)
    own = run.signals[late]
    moved[late] = SegmentSignals(np.roll(own.acc_m_s2, 50, 1), np.roll(own.gyr_rad_s, 50, 1))
    after = pair_lags_s(moved, 500.0, RULE)
    for pair, lag in after.items():
        sign = {late == pair[0]: -1.0, late == pair[1]: 1.0}.get(True, 0.0)
        assert lag - before[pair] == pytest.approx(0.1 * sign, abs=0.012)


def test_missing_sensors_and_parts_are_passed_over(thirteen_imus):
    run = thirteen_imus(12.0)
    fewer = {name: own for name, own in run.signals.items() if name != "head"}
    acc = fewer["shank_left"].acc_m_s2.copy()
    acc[:, :] = np.nan
    fewer["shank_left"] = SegmentSignals(acc, fewer["shank_left"].gyr_rad_s * np.nan)
    lags = pair_lags_s(fewer, 500.0, RULE)
    assert ("shank_right", "shank_left") not in lags
    assert ("lumbar", "head") not in lags
    assert len(lags) == PAIRS - 2
