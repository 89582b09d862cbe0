"""Walking from rest to rest, and quiet standing in a posture of one's own."""

from dataclasses import replace

import numpy as np
import pytest

from swaystride.simulate.running_manner import RunnerManner
from swaystride.simulate.running_recording import ideal_signals
from swaystride.simulate.running_sensors import (
    USUAL_MOUNTING,
    sensor_places,
    wear_sensors,
)
from swaystride.simulate.running_standing import StandingManner, standing_motion
from swaystride.simulate.running_tissue import common_tissue
from swaystride.simulate.running_walk import walk_motion
from swaystride.units import GRAVITY_M_S2


@pytest.fixture(scope="module")
def walk(runners, usual_body):
    return walk_motion(
        usual_body,
        RunnerManner(),
        1.1,
        course=replace(runners.course, distance_m=20.0),
        scatter=runners.stride,
        rng=np.random.default_rng(3),
    )


@pytest.fixture(scope="module")
def stand(usual_body):
    def of(seed, sd_deg=4.0):
        manner = StandingManner(
            segment_sd_rad=np.radians(sd_deg),
            feet_apart_m=0.2,
            feet_sd_m=0.02,
            toe_out_rad=np.radians(7.0),
            toe_out_sd_rad=np.radians(3.0),
            knee_rad=np.radians(7.0),
            knee_sd_rad=np.radians(3.0),
            elbow_rad=np.radians(12.0),
            sway_m=0.003,
        )
        return standing_motion(usual_body, manner, duration_s=8.0, rng=np.random.default_rng(seed))

    return of


def bare(body):
    rng = np.random.default_rng(0)
    return wear_sensors(
        body,
        tuple(sensor_places()),
        mounting=USUAL_MOUNTING,
        tissue={},
        common=common_tissue(rng),
        rng=rng,
    )


def test_a_walk_begins_and_ends_at_rest(walk, usual_body):
    s = walk.states(np.array([0.1, walk.duration_s - 0.1]))
    assert np.abs(s.velocity_m_s).max() < 1e-9
    assert np.abs(s.omega_rad_s).max() < 1e-9
    way = np.diff(s.position_m[:, 0], axis=0)[0]
    np.testing.assert_allclose(way, [20.0, 0.0, 0.0], atol=1e-9)
    signals = ideal_signals(walk, bare(usual_body).skin, 2000.0, 100, 50)
    np.testing.assert_allclose(np.linalg.norm(signals[:, :3], axis=1), GRAVITY_M_S2, atol=1e-6)


def test_a_walk_is_exact_and_walks(walk):
    time = np.random.default_rng(1).uniform(0.5, walk.duration_s - 0.5, 1500)
    step = 2e-6
    now, after, before = (walk.states(time + shift) for shift in (0.0, step, -step))
    slope = (after.velocity_m_s - before.velocity_m_s) / (2 * step)
    error = np.abs(slope - now.acceleration_m_s2) / (1.0 + np.abs(now.acceleration_m_s2))
    assert error.max() < 1e-2
    assert np.median(error) < 1e-6
    ankle = now.point_m(3, [0.0, -walk.body.shank_m, 0.0])
    assert np.abs(ankle - now.position_m[:, 5]).max() < 1e-11
    middle = np.linspace(7.0, 11.0, 2000)
    s = walk.states(middle)
    angles = s.joint_angles_rad()
    assert 35 < np.degrees(np.ptp(angles["hip_right"][:, 0])) < 75
    assert 45 < np.degrees(np.ptp(angles["knee_right"][:, 0])) < 85
    assert 0.02 < np.ptp(s.position_m[:, 0, 2]) < 0.07
    # A walker's leg is nearly straight in stance, and the hips are a little lower than in standing.
    knee = np.degrees(angles["knee_right"][:, 0])
    assert knee.min() < 18.0
    assert knee.max() < 80.0
    start = walk.states(np.array([0.1])).position_m[0, 0, 2]
    assert 0.02 < start - s.position_m[:, 0, 2].mean() < 0.09
    # The leg turns about its medio-lateral axis above all: that is what walking calibrates.
    for segment in (1, 3, 5):
        scatter = s.omega_rad_s[:, segment].T @ s.omega_rad_s[:, segment]
        values, vectors = np.linalg.eigh(scatter)
        assert values[-1] / values.sum() > 0.8
        assert abs(vectors[2, -1]) > np.cos(np.radians(20.0))


def test_people_stand_still_and_each_in_a_posture(stand):
    shank, trunk, knees = [], [], []
    for seed in range(40):
        motion = stand(seed)
        s = motion.states(np.linspace(0.0, 8.0, 100))
        assert np.isfinite(s.acceleration_m_s2).all()
        assert np.abs(s.velocity_m_s[:, 5:7]).max() == 0.0
        assert np.abs(s.velocity_m_s).max() < 0.06
        up = s.r_world_from_segment[0, :, :, 1]
        shank.append(np.degrees(np.arctan2(up[3, 0], up[3, 2])))
        trunk.append(np.degrees(np.arctan2(up[7, 0], up[7, 2])))
        knees.append(np.degrees(s.joint_angles_rad()["knee_right"][0, 0]))
    assert 2.0 < np.std(shank) < 7.0
    # The trunk stands on a tilted pelvis: two independent angles.
    assert 3.5 < np.std(trunk) < 8.0
    assert min(knees) > 3.0


def test_standing_sensors_feel_gravity(stand, usual_body):
    signals = ideal_signals(stand(3), bare(usual_body).skin, 2000.0, 0, 8000)
    size = np.linalg.norm(signals[:, :3], axis=1)
    assert np.abs(size - GRAVITY_M_S2).max() < 0.25
    assert np.abs(size.mean(axis=1) - GRAVITY_M_S2).max() < 0.02
