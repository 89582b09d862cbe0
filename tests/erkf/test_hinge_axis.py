"""Axes of hinges: exact ones of the chain, slow ones with gravity, and the knee of a runner."""

from dataclasses import replace

import numpy as np
import pytest
from rigid_chain import RUNNING, chain
from scipy.spatial.transform import Rotation

from swaystride.erkf.hinge_axis import OLSSON_2020, SEEL_2012, hinge_axis_of
from swaystride.erkf.hinge_residuals import HingeSamples, nearest_minimum, residuals
from swaystride.errors import RecordingError
from swaystride.simulate.running_body import runner_body, usual_shares, usual_shoe
from swaystride.simulate.running_manner import USUAL_VARIABILITY, RunnerManner, steady_run
from swaystride.simulate.running_recording import recorded
from swaystride.simulate.running_run import run_motion
from swaystride.simulate.running_sensors import USUAL_MOUNTING, wear_sensors
from swaystride.simulate.running_tissue import common_tissue, usual_tissue
from swaystride.units import GRAVITY_M_S2, RAD_PER_DEG

#: The low-pass mixes axes that turn; a hinge without noise needs none.
UNFILTERED = replace(SEEL_2012, cutoff_hz=45.0)
Z = np.array([0.0, 0.0, 1.0])


@pytest.fixture(scope="module")
def fast_run():
    return chain(RUNNING, duration_s=7.0, rate_hz=200.0)


def angle_deg(one, two):
    return np.degrees(np.arccos(np.clip(one @ two, -1.0, 1.0)))


def knee_of(moving, place, search, gyr=None):
    joint = moving.body.joints[place]
    one, two = moving.body.index(joint.proximal), moving.body.index(joint.distal)
    gyr = moving.gyr if gyr is None else gyr
    found = hinge_axis_of(
        (moving.acc[one], gyr[one]),
        (moving.acc[two], gyr[two]),
        moving.rate_hz,
        right=(joint.proximal_axis, joint.distal_axis),
        search=search,
    )
    errors = (
        angle_deg(found.proximal, joint.proximal_axis),
        angle_deg(found.distal, joint.distal_axis),
    )
    return found, errors


@pytest.mark.parametrize("place", [2, 3])
@pytest.mark.parametrize("manner", ["walk", "fast_run"])
def test_exact_knees_are_found_from_rates(manner, place, request):
    found, errors = knee_of(request.getfixturevalue(manner), place, UNFILTERED)
    assert max(errors) < 0.01
    assert found.rate_residual_rad_s < 1e-3
    assert min(found.share) > 0.8
    assert found.agreeing >= 0.25
    assert np.isnan(found.acc_residual_m_s2)


def test_selected_samples_find_an_exact_knee_too(fast_run):
    found, errors = knee_of(fast_run, 2, replace(UNFILTERED, most_samples=500))
    assert max(errors) < 0.01
    assert found.n_rates == 500


def test_noise_and_tissue_draw_the_axis_off_by_a_few_degrees(fast_run):
    rng = np.random.default_rng(4)
    noise = 1.0 * RAD_PER_DEG * rng.normal(size=fast_run.gyr.shape)
    _, errors = knee_of(fast_run, 2, SEEL_2012, fast_run.gyr + noise)
    assert max(errors) < 0.5
    # the skin swings with the stride, 3° about every axis of every sensor
    time = np.arange(fast_run.gyr.shape[2]) / fast_run.rate_hz
    phase = rng.uniform(0.0, 2 * np.pi, size=(7, 3, 1))
    stride = 2 * np.pi / RUNNING.stride_s
    swing = 3.0 * RAD_PER_DEG * stride * np.cos(stride * time + phase)
    found, errors = knee_of(fast_run, 2, SEEL_2012, fast_run.gyr + noise + swing)
    assert 0.5 < max(errors) < 6.0
    assert found.rate_residual_rad_s > 0.1


def test_deviation_over_repeated_noise_is_the_reported_one(fast_run):
    white = replace(UNFILTERED, cutoff_hz=99.0, independent_s=np.inf)
    short = replace(fast_run, acc=fast_run.acc[:, :, :400], gyr=fast_run.gyr[:, :, :400])
    off, sd = [], []
    side = np.cross(fast_run.body.joints[2].proximal_axis, [1.0, 0.0, 0.0])
    side /= np.linalg.norm(side)
    for seed in range(25):
        noise = 5.0 * RAD_PER_DEG * np.random.default_rng(seed).normal(size=short.gyr.shape)
        found, _ = knee_of(short, 2, replace(white, starts=1), short.gyr + noise)
        off.append(found.proximal @ side)
        sd.append(found.sd_rad[0])
    assert 0.4 < np.std(off) / np.mean(sd) < 2.0


def slow_hinge(rate_hz=100.0, duration_s=14.0, bend=1.2):
    """A hinge that is bent and turned by hand: rates, gravity and axes in both sensors."""
    time = np.arange(round(rate_hz * duration_s)) / rate_hz
    mounting = Rotation.random(2, rng=np.random.default_rng(8))

    def poses(t):
        turns = np.stack([0.8 * np.sin(0.5 * t), 0.9 * np.sin(0.37 * t + 1), 0.3 * t], axis=1)
        one = Rotation.from_euler("XYZ", turns)
        return one, one * Rotation.from_rotvec(np.outer(bend * np.sin(1.1 * t), Z))

    sensors = []
    for j in range(2):
        early, now, late = (poses(time + s)[j] * mounting[j] for s in (-1e-4, 0.0, 1e-4))
        rate = (early.inv() * late).as_rotvec() / 2e-4
        sensors.append((now.inv().apply(GRAVITY_M_S2 * Z).T, rate.T))
    return sensors, [mounting[j].inv().apply(Z) for j in range(2)]


@pytest.mark.parametrize("most", [None, 500])
def test_gravity_tells_the_signs_of_a_slow_hinge_apart(most):
    sensors, axes = slow_hinge()
    search = replace(OLSSON_2020, cutoff_hz=20.0, slow_rad_s=2.0, most_samples=most, starts=4)
    found = hinge_axis_of(*sensors, 100.0, right=tuple(axes), search=search)
    assert angle_deg(found.proximal, axes[0]) < 0.1
    assert angle_deg(found.distal, axes[1]) < 0.1
    assert found.acc_residual_m_s2 < 0.01
    assert found.n_accelerations > 400
    with pytest.raises(RecordingError, match="left_knee: movement and mounting disagree"):
        hinge_axis_of(*sensors, 100.0, right=(axes[0], -axes[1]), search=search, place="left_knee")
    # rates alone cannot tell
    rates = replace(UNFILTERED, starts=4)
    found = hinge_axis_of(*sensors, 100.0, right=(axes[0], -axes[1]), search=rates)
    assert angle_deg(found.distal, -axes[1]) < 0.1


def test_accelerometers_mend_what_a_bias_of_the_rates_spoils():
    sensors, axes = slow_hinge()
    (a1, w1), (a2, w2) = sensors
    noisy = ((a1, w1 + 0.15), (a2, w2 - 0.15))
    both = replace(OLSSON_2020, slow_rad_s=2.0, most_samples=None, starts=4)
    errors = []
    for search in (both, replace(both, slow_rad_s=0.0)):
        found = hinge_axis_of(*noisy, 100.0, right=tuple(axes), search=search)
        errors.append(angle_deg(found.proximal, axes[0]) + angle_deg(found.distal, axes[1]))
    assert errors[0] < 1.0
    assert errors[1] > 5.0


def test_a_single_posture_is_not_used(fast_run):
    """Standing before a run says one thing only: without variety gravity is left out."""
    joint = fast_run.body.joints[2]
    sensors = []
    for j, axis in ((1, joint.proximal_axis), (3, joint.distal_axis)):
        # a slightly bent knee, and segments that lean to the side
        up = np.cross(axis, [0.3, -0.5, 0.8])
        stand = np.repeat((up + 0.1 * axis)[:, None], 300, axis=1) * GRAVITY_M_S2
        acc = np.concatenate([stand, fast_run.acc[j]], axis=1)
        gyr = np.concatenate([np.zeros((3, 300)), fast_run.gyr[j]], axis=1)
        sensors.append((acc, gyr))
    found = hinge_axis_of(
        *sensors, 200.0, right=(joint.proximal_axis, joint.distal_axis), search=OLSSON_2020
    )
    assert found.n_accelerations == 0
    assert np.isnan(found.acc_residual_m_s2)
    assert angle_deg(found.proximal, joint.proximal_axis) < 1.0


def test_slopes_lead_to_the_axis_from_thirty_degrees(fast_run):
    joint = fast_run.body.joints[2]
    rates = fast_run.gyr[1].T, fast_run.gyr[3].T
    samples = HingeSamples(rates, (np.zeros((0, 3)), np.zeros((0, 3))), 1.0, 1.0)
    turned = [
        Rotation.from_rotvec([0.0, 0.5, 0.0]).apply(axis)
        for axis in (joint.proximal_axis, joint.distal_axis)
    ]
    end = nearest_minimum(*turned, samples)
    assert angle_deg(end.proximal, joint.proximal_axis) < 0.01
    assert end.cost == pytest.approx(
        np.sum(residuals(end.proximal, end.distal, *samples[:2])[0] ** 2), rel=1e-6
    )


def test_a_stiff_joint_has_no_axis():
    sensors, axes = slow_hinge(bend=0.0)
    with pytest.raises(RecordingError, match=r"right_knee: .*expected rates that differ by 10 °/s"):
        hinge_axis_of(*sensors, 100.0, right=tuple(axes), search=SEEL_2012, place="right_knee")


def test_knee_of_a_simulated_runner_is_a_hinge_to_some_degrees():
    """It also rotates and abducts; the axis meant is the mediolateral one of each segment."""
    body = runner_body(1.72, 70.0, shares=usual_shares(), shoe=usual_shoe())
    rng = np.random.default_rng(2)
    worn = wear_sensors(
        body,
        ("thigh_left", "shank_left"),
        mounting=USUAL_MOUNTING,
        tissue=usual_tissue(),
        common=common_tissue(rng),
        rng=rng,
    )
    motion = run_motion(
        body,
        RunnerManner(),
        steady_run(10.0, 14.0 / 3.6),
        duration_s=10.0,
        variability=USUAL_VARIABILITY,
        rng=rng,
        treadmill=None,
    )
    (part,) = recorded(motion, worn, rate_hz=200.0, rng=rng)
    axes = [unit.r_sensor_from_body[:, 2] for unit in worn.units]
    sensors = [
        (acc.astype(float), gyr - unit.gyr_bias_rad_s[:, None])
        for acc, gyr, unit in zip(part.acc_m_s2, part.gyr_rad_s, worn.units, strict=True)
    ]
    found = hinge_axis_of(*sensors, 200.0, right=tuple(axes), search=SEEL_2012)
    assert angle_deg(found.proximal, axes[0]) < 8.0
    assert angle_deg(found.distal, axes[1]) < 8.0
    assert min(found.share) > 0.7
