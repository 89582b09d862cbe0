"""Parts of a run that count: warm-up, turns and lost data are left out."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.errors import RecordingError
from swaystride.gait.steady_parts import PRINTED_STEADY, exclusions, is_steady, turns

RATE_HZ = 50.0
NO_WARM_UP = replace(PRINTED_STEADY, warm_up_s=0.0)


def yaw_of(duration_s, turns_at, angle_deg=180.0, turn_s=4.0, swing_deg=6.0):
    """Turning rate of a pelvis that swings with each stride and turns about now and then."""
    time = np.arange(round(duration_s * RATE_HZ)) / RATE_HZ
    swing = 2 * np.pi / 0.7
    rate = np.radians(swing_deg) * swing * np.cos(swing * time)
    for at in turns_at:
        rate[(time >= at) & (time < at + turn_s)] += np.radians(angle_deg) / turn_s
    return rate


@settings(max_examples=20)
@given(st.floats(40.0, 250.0), st.floats(70.0, 200.0), st.sampled_from([-1.0, 1.0]))
def test_a_turn_is_left_out_with_its_margins(at_s, angle_deg, sign):
    """10 s before and after it at least, and at most a window of 10 s more to either side."""
    yaw = sign * yaw_of(300.0, [at_s], angle_deg)
    ((begin, end),) = turns(yaw, RATE_HZ, PRINTED_STEADY)
    assert at_s - 20.5 <= begin <= at_s - 10.0
    assert min(at_s + 14.0, 300.0) <= end <= min(at_s + 24.5, 300.0)


def test_the_swing_of_the_pelvis_and_bends_of_the_path_are_no_turn():
    assert turns(yaw_of(200.0, []), RATE_HZ, PRINTED_STEADY) == []
    assert turns(yaw_of(200.0, [100.0], angle_deg=45.0), RATE_HZ, PRINTED_STEADY) == []
    # 180° over 40 s, along the bank of a lake
    assert turns(yaw_of(200.0, [100.0], turn_s=40.0), RATE_HZ, PRINTED_STEADY) == []


def test_two_turns_close_together_are_one():
    apart = turns(yaw_of(300.0, [60.0, 200.0]), RATE_HZ, PRINTED_STEADY)
    near = turns(yaw_of(300.0, [60.0, 75.0]), RATE_HZ, PRINTED_STEADY)
    assert len(apart) == 2
    assert len(near) == 1
    assert near[0][1] - near[0][0] > 35.0


def test_all_reasons():
    yaw = yaw_of(1800.0, [900.0])
    yaw[round(1200 * RATE_HZ) : round(1207 * RATE_HZ)] = np.nan
    excluded = exclusions(yaw, RATE_HZ, PRINTED_STEADY)
    assert excluded["reason"].tolist() == ["warm_up", "turn", "lost_data"]
    assert excluded.iloc[0, :2].tolist() == [0.0, 600.0]
    assert excluded.iloc[2, :2].tolist() == [1200.0, 1207.0]
    steady = is_steady(
        [599.9, 600.0, 880.0, 905.0, 940.0, 1199.0, 1199.5, 1206.0, 1207.0],
        [600.6, 600.7, 880.7, 905.7, 940.7, 1199.7, 1200.2, 1206.7, 1207.7],
        excluded,
    )
    assert steady.tolist() == [False, True, True, False, True, True, False, False, True]


def test_lost_samples_of_other_sensors():
    missing = np.zeros(round(60 * RATE_HZ), dtype=bool)
    missing[:100] = missing[-50:] = True
    excluded = exclusions(yaw_of(60.0, []), RATE_HZ, NO_WARM_UP, missing=missing)
    assert excluded["reason"].tolist() == ["lost_data", "lost_data"]
    assert excluded[["start_s", "stop_s"]].to_numpy().tolist() == [[0.0, 2.0], [59.0, 60.0]]


def test_nothing_left_out():
    excluded = exclusions(yaw_of(60.0, []), RATE_HZ, NO_WARM_UP)
    assert excluded.empty
    assert is_steady([0.0, 50.0], [1.0, 51.0], excluded).all()


def test_a_run_shorter_than_the_warm_up():
    with pytest.raises(RecordingError, match=r"more than 600 s; found 590\.0 s"):
        exclusions(yaw_of(590.0, []), RATE_HZ, PRINTED_STEADY)
