from dataclasses import replace

import numpy as np
import pytest
from closed_form_walk import walk
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from swaystride.errors import RecordingError
from swaystride.gait.foot_methods import PRINTED, RECOMMENDED
from swaystride.gait.stillness import find_rests, find_stances
from swaystride.gait.zero_velocity import (
    energy_threshold,
    find_zero_velocity,
    gyro_energy,
    gyro_minima,
)

WALKS = {
    "walking": {"stride_s": 1.1, "stance_s": 0.45, "roll_rad_s": 0.15},
    "running": {"stride_s": 0.7, "stance_s": 0.2, "stride_m": 2.8, "roll_rad_s": 1.0},
    "sprinting": {"stride_s": 0.46, "stance_s": 0.1, "stride_m": 3.5, "roll_rad_s": 3.0},
}


@given(
    hnp.arrays(float, st.integers(5, 200), elements=st.floats(0, 1e6, width=32)),
    st.integers(1, 4),
)
def test_the_threshold_is_the_exact_order_statistic(energy, n_strides):
    """At least the wanted samples lie below, and no smaller threshold does that."""
    wanted = min(5 * n_strides, energy.size)
    threshold = energy_threshold(energy, wanted)
    assert (energy < threshold).sum() >= wanted
    assert (energy < np.nextafter(threshold, -np.inf)).sum() < wanted


def test_distinct_energies_give_exactly_five_samples_per_stride():
    energy = np.random.default_rng(1).permutation(1000).astype(float)
    assert (energy < energy_threshold(energy, 5 * 17)).sum() == 85


def test_an_impossible_count_is_refused():
    with pytest.raises(RecordingError, match="expected between 1 and 3 samples; found 4"):
        energy_threshold([1.0, 2.0, 3.0], 4)


@given(hnp.arrays(float, (3, 40), elements=st.floats(-30, 30)))
def test_energy_is_the_sum_of_squares_over_the_window(gyr):
    slow = [np.sum(gyr[:, max(k - 2, 0) : k + 3] ** 2) for k in range(40)]
    assert np.allclose(gyro_energy(gyr, 5), slow, atol=1e-9)


@given(hnp.arrays(float, (3, 30), elements=st.floats(-30, 30)), st.integers(0, 29))
def test_the_gyro_minimum_is_the_smallest_rate_within_reach(gyr, centre):
    rate = np.linalg.norm(gyr, axis=0)
    [found] = gyro_minima(gyr, [centre], reach=4)
    assert abs(found - centre) <= 4
    assert rate[found] == rate[max(centre - 4, 0) : centre + 5].min()


@pytest.mark.parametrize("gait", WALKS)
@pytest.mark.parametrize("rule", ["stillness", "gyro_minimum", "gyro_energy"])
@pytest.mark.parametrize("rate_hz", [62.5, 128.0, 1000.0])
def test_every_stance_is_found_once(gait, rule, rate_hz):
    own = walk(n_strides=9, rate_hz=rate_hz, **WALKS[gait])
    method = replace(RECOMMENDED, zero_velocity=rule)
    found = find_zero_velocity(own.acc, own.gyr, rate_hz, method)
    # the first and the last may join the rests in a sprint, in which they last 0.05 s
    late = np.abs(found.stances[:, None] - own.stances[None, :]).min(axis=1) / rate_hz
    assert late.max() < 0.5 * WALKS[gait]["stance_s"] + 0.01
    assert len(own.stances) - 2 <= len(found.stances) <= len(own.stances)
    assert len(found.rests) == 2
    assert found.flags[found.stances].all()


def test_the_energy_rule_keeps_its_average_duration():
    own = walk(n_strides=12, rate_hz=200.0, **WALKS["running"])
    method = replace(PRINTED, zero_velocity="gyro_energy")
    found = find_zero_velocity(own.acc, own.gyr, 200.0, method)
    outside = found.flags.copy()
    for first, stop in found.rests:
        outside[first:stop] = False
    assert outside.sum() >= 5 * len(found.stances)


def test_detection_does_not_depend_on_mounting_heading_or_side():
    turned = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]])
    a = walk(**WALKS["running"])
    b = walk(**WALKS["running"], mounting=turned)
    rests = find_rests(a.acc, a.gyr, 200.0, RECOMMENDED)
    mirror = np.array([[1.0], [-1.0], [1.0]])
    stances = find_stances(a.acc, a.gyr, 200.0, RECOMMENDED, rests)
    assert np.array_equal(stances, find_stances(b.acc, b.gyr, 200.0, RECOMMENDED, rests))
    assert np.array_equal(
        stances, find_stances(mirror * a.acc, -mirror * a.gyr, 200.0, RECOMMENDED, rests)
    )


def test_rests_are_found_to_a_tenth_of_a_second():
    own = walk(rest_s=2.0, rate_hz=200.0)
    rests = find_rests(own.acc, own.gyr, 200.0, RECOMMENDED) / 200.0
    # walking starts and stops with half a stance of 0.2 s that is still
    assert np.allclose(rests, [[0.0, 2.2], [2.0 + 8 * 1.1 - 0.2, 4.0 + 8 * 1.1]], atol=0.1)


def test_turns_of_swings_between_two_stances_are_no_stances():
    """A still-looking turn in the middle of one swing, stiller than half of the stances is not."""
    own = walk(n_strides=10, **WALKS["running"])
    acc, gyr = own.acc.copy(), own.gyr.copy()
    middle = own.stances[4] + 70
    acc[:, middle - 10 : middle + 10] = np.array([[0.0], [0.0], [9.80665]])
    gyr[:, middle - 10 : middle + 10] = np.array([[0.0], [1.5], [0.0]])
    found = find_stances(acc, gyr, 200.0, RECOMMENDED, find_rests(acc, gyr, 200.0, RECOMMENDED))
    assert np.abs(found - middle).min() > 20
