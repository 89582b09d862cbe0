"""Feet of a person."""

from dataclasses import replace

import numpy as np
import pytest

from swaystride.simulate.foot_person import draw_person


def people(runners, n, height_m=1.71):
    return [
        draw_person(
            height_m,
            shape=runners.sole,
            placement=runners.placement,
            scatter=runners.person,
            rng=np.random.default_rng(seed),
        )
        for seed in range(n)
    ]


def test_sole_and_sensor_height_vary_between_people(runners):
    drawn = people(runners, 200)
    low, high = runners.placement.height_m
    heights = np.array([p.feet[0].sensor_m[0, 2] + p.feet[0].sole.ankle_height_m for p in drawn])
    assert low <= heights.min() < 0.065
    assert 0.085 < heights.max() <= high
    ankles = np.array([p.feet[0].sole.ankle_height_m for p in drawn])
    assert 0.02 < ankles.std() / ankles.mean() < 0.04
    assert ankles.mean() == pytest.approx(0.085, abs=0.002)


def test_taller_people_have_longer_feet_and_strides(runners):
    small, tall = (people(runners, 1, height)[0] for height in (1.6, 1.9))
    assert tall.feet[0].sole.ankle_height_m / small.feet[0].sole.ankle_height_m == pytest.approx(
        1.9 / 1.6
    )
    assert tall.stride_time / small.stride_time == pytest.approx(np.sqrt(1.9 / 1.6))


def test_both_sensors_are_strapped_together(runners):
    for person in people(runners, 20):
        for foot in person.feet:
            r = foot.r_sensor_from_foot
            np.testing.assert_allclose(r @ r.T, np.eye(3), atol=1e-12)
            offset = r @ (foot.sensor_m[1] - foot.sensor_m[0])
            np.testing.assert_allclose(offset, runners.placement.second_offset_m, atol=1e-12)


def test_the_sensor_leans_with_the_slope_of_the_dorsum(runners):
    placement = replace(runners.placement, tilt_sd_deg=0.0, heading_sd_deg=0.0)
    person = people(replace(runners, placement=placement), 1)[0]
    up_in_foot = person.feet[0].r_sensor_from_foot.T @ [0.0, 0.0, 1.0]
    slope = np.radians(runners.placement.slope_deg)
    np.testing.assert_allclose(up_in_foot, [np.sin(slope), 0.0, np.cos(slope)], atol=1e-12)


def test_feet_of_one_person_are_more_alike_than_people(runners):
    manner = np.array(
        [[foot.manner.contact_pitch_rad for foot in p.feet] for p in people(runners, 300)]
    )
    within = np.diff(manner, axis=1).std() / np.sqrt(2)
    assert within / manner.mean(axis=1).std() == pytest.approx(0.4, abs=0.08)
