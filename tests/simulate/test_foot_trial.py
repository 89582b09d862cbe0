"""Stances of a trial: times, places, speeds, and what the paper says of its recordings."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.simulate.foot_anchors import gait_anchors
from swaystride.simulate.foot_kinematics import point_signals
from swaystride.simulate.foot_person import draw_person
from swaystride.simulate.foot_pieces import foot_motion
from swaystride.simulate.foot_trial import foot_trial
from swaystride.units import GRAVITY_M_S2


def trial_of(runners, speed, seed):
    rng = np.random.default_rng(seed)
    person = draw_person(
        rng.uniform(1.6, 1.85),
        shape=runners.sole,
        placement=runners.placement,
        scatter=runners.person,
        rng=rng,
    )
    trial = foot_trial(
        person,
        speed,
        course=runners.course,
        scatter=runners.stride,
        anchors=gait_anchors(),
        rng=rng,
    )
    return person, trial


@settings(max_examples=40, deadline=None)
@given(speed=st.floats(1.15, 6.4), seed=st.integers(0, 2**32 - 1))
def test_events_of_each_stance_are_in_order_and_feet_take_turns(runners, speed, seed):
    _, trial = trial_of(runners, speed, seed)
    contacts = []
    for stances in (trial.left, trial.right):
        inner = slice(1, -1)
        contact = stances.contact_s[inner]
        assert (stances.flat_s[inner] > contact + 1e-3).all()
        assert (stances.arrest_s[inner] < stances.flat_s[inner] - contact).all()
        assert (stances.heel_off_s[inner] > stances.flat_s[inner]).all()
        assert (stances.toe_off_s[inner] > stances.heel_off_s[inner]).all()
        assert (stances.contact_s[1:] > stances.toe_off_s[:-1] + 0.1).all()
        assert np.isnan(stances.contact_s[0])
        assert np.isnan(stances.toe_off_s[-1])
        contacts.append(stances.contact_s[1:])
    both = np.sort(np.concatenate(contacts))
    side = np.isin(both, contacts[0])
    assert (side[1:] != side[:-1]).all()
    assert trial.start_s >= 2.0
    assert trial.duration_s - trial.stop_s >= 2.0


@settings(max_examples=40, deadline=None)
@given(speed=st.floats(1.15, 6.4), seed=st.integers(0, 2**32 - 1))
def test_the_mean_speed_is_as_prescribed(runners, speed, seed):
    """From the first rise of a heel to the last flat foot, both feet taken together."""
    _, trial = trial_of(runners, speed, seed)
    begin = min(trial.left.heel_off_s[0], trial.right.heel_off_s[0])
    end = max(trial.left.flat_s[-1], trial.right.flat_s[-1])
    assert runners.course.distance_m / (end - begin) == pytest.approx(speed, rel=1e-9)


@pytest.mark.parametrize("speed", [1.3, 3.0, 6.0])
def test_the_mean_speed_shows_in_significant_accelerations(runners, speed):
    """As a lab would find it: the time from the first to the last significant acceleration."""
    person, trial = trial_of(runners, speed, 5)
    time = np.arange(0.0, trial.duration_s, 0.002)
    moving = np.zeros(len(time), dtype=bool)
    for foot, stances in zip(person.feet, (trial.left, trial.right), strict=True):
        acc, _ = point_signals(foot_motion(foot.sole, stances).pose(time), foot.sensor_m[0])
        moving |= np.abs(np.linalg.norm(acc, axis=0) - GRAVITY_M_S2) > 0.2
    begin, end = time[np.flatnonzero(moving)[[0, -1]]]
    assert 100.0 / (end - begin) == pytest.approx(speed, rel=5e-3)


@pytest.mark.parametrize(("speed", "flies"), [(1.3, False), (1.7, False), (2.4, True), (6.0, True)])
def test_walkers_have_double_support_and_runners_fly(runners, speed, flies):
    _, trial = trial_of(runners, speed, 3)
    n = len(trial.left)
    middle = slice(n // 3, 2 * n // 3)
    off = trial.left.toe_off_s[middle]
    ahead = np.array(
        [np.min(trial.right.contact_s[1:][trial.right.contact_s[1:] > t - 0.3]) for t in off]
    )
    assert ((ahead > off) == flies).all()


def test_a_sprinter_never_puts_the_heel_down(runners):
    _, trial = trial_of(runners, 6.4, 1)
    stances = trial.left
    fast = slice(len(stances) // 2, len(stances) // 2 + 5)
    assert stances.flat_pitch_rad[fast].max() < np.radians(-4.0)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(
    ("speed", "acc_g", "gyr_deg_s"),
    [
        (1.2, 7.0, 900.0),
        (1.4, 8.0, 1000.0),
        (3.0, 30.0, 1100.0),
        (5.8, 100.0, 1500.0),
        (6.4, 130.0, 2000.0),
    ],
)
def test_peaks_are_those_of_the_paper(runners, seed, speed, acc_g, gyr_deg_s):
    """Potter et al. 2019: below 6 g in the slowest trials, rarely above 1000 °/s, never 2000 °/s.

    Before the sensor's filter, so a little more is allowed.
    """
    person, trial = trial_of(runners, speed, seed)
    time = np.arange(0.0, trial.duration_s, 1 / 4000)
    foot = person.feet[0]
    acc, gyr = point_signals(foot_motion(foot.sole, trial.left).pose(time), foot.sensor_m[0])
    assert np.linalg.norm(acc, axis=0).max() / GRAVITY_M_S2 < acc_g
    rate = np.degrees(np.abs(gyr))
    assert rate.max() < gyr_deg_s
    assert rate.max() > 450.0
    assert (rate > 1000.0).any(axis=0).mean() < 0.06


def test_strides_are_not_quite_straight(runners):
    _, trial = trial_of(runners, 3.0, 2)
    steps = np.stack([np.diff(trial.left.x_m), np.diff(trial.left.y_m)])
    assert 0.003 < np.abs(np.diff(np.arctan2(steps[1], steps[0]))).mean() < 0.1
    assert np.degrees(trial.left.heading_rad).mean() > 1.0
    assert np.degrees(trial.right.heading_rad).mean() < -1.0


def test_the_same_seed_gives_the_same_trial(runners):
    one, other, third = (trial_of(runners, 3.0, seed)[1] for seed in (4, 4, 5))
    np.testing.assert_array_equal(one.left.contact_s, other.left.contact_s)
    assert one.left.contact_s[1] != third.left.contact_s[1]
