"""Speed of the body and instants of the steps."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.simulate.foot_anchors import gait_anchors
from swaystride.simulate.foot_course import course_of, longest_push_s, step_times
from swaystride.simulate.foot_spline import joined, least_jerk


@settings(max_examples=30, deadline=None)
@given(speed=st.floats(1.1, 6.5))
def test_the_way_is_the_integral_of_the_speed_and_ends_at_the_line(runners, speed: float) -> None:
    course = course_of(runners.course, speed, 100.0 / speed)
    time = np.linspace(0.0, 100.0 / speed, 20001)
    way = course.way_m(time)
    middle = (time[1:] + time[:-1]) / 2
    np.testing.assert_allclose(np.diff(way), course.speed_m_s(middle) * time[1], atol=1e-6)
    assert float(way[-1]) == pytest.approx(runners.course.distance_m, abs=1e-9)
    assert course.speed_m_s([-1.0, 0.0, time[-1], time[-1] + 1]).max() < 1e-12
    assert (np.diff(way) >= 0).all()


def test_a_sprint_of_6_4_m_s_has_a_plateau_of_about_8_m_s(runners) -> None:
    speed = course_of(runners.course, 6.4, 100.0 / 6.4).speed_m_s(np.linspace(0, 15, 100)).max()
    assert 7.4 < speed < 8.2


@settings(max_examples=40, deadline=None)
@given(speed=st.floats(1.15, 6.4), seed=st.integers(0, 2**32 - 1))
def test_steps_fill_the_time_of_the_trial(runners, speed: float, seed: int) -> None:
    steps = step_times(
        runners.course,
        gait_anchors(),
        speed,
        stride_time_scale=1.0,
        stride_time_cv=runners.stride.time_cv,
        rng=np.random.default_rng(seed),
    )
    anchors = gait_anchors()
    flat_s = anchors.at(runners.course.slow_gait * speed)["flat_delay_s"]
    total_s = runners.course.distance_m / speed
    assert steps.contact_s[-1] + flat_s == pytest.approx(total_s, abs=1e-9)
    assert 0 < steps.first_push_s < steps.contact_s[0]
    intervals = np.diff(steps.contact_s)
    usual = anchors.at(steps.course.plateau_m_s)["stride_time_s"] / 2
    assert float(np.median(intervals)) == pytest.approx(float(usual), rel=0.05)
    assert intervals.min() > 0.8 * usual


def test_a_heel_that_rises_in_the_longest_push_never_dips() -> None:
    for turn, rate in ((0.8, 8.0), (0.9, 11.0)):
        for share, dips in ((1.0, False), (1.3, True)):
            duration = share * float(longest_push_s(turn, rate))
            states = [[[0.0, 0.0, 0.0], [turn, rate, 0.0]]]
            rise = joined([0.0], least_jerk([[0.0, duration]], states)[0])
            lowest = float(rise(np.linspace(0, duration, 500))[0].min())
            assert (lowest < -1e-6) is dips
