from dataclasses import replace

import numpy as np
import pytest
from closed_form_walk import walk
from sample_wise_smoother import smooth_every_sample
from scipy.spatial.transform import Rotation

from swaystride.gait._epoch_kernels import filter_epochs
from swaystride.gait.epoch_smoother import (
    _start_covariance,
    contact_lever,
    measured_epochs,
    smoothed_states,
    step_noise,
)
from swaystride.gait.foot_methods import RECOMMENDED
from swaystride.gait.levelling import level_quaternion, mean_directions
from swaystride.gait.stillness import find_rests
from swaystride.gait.zero_velocity import ZeroVelocity, find_zero_velocity


@pytest.fixture
def noisy():
    """A short walk that rolls, with noise, a gyroscope bias and a tilted sensor."""
    tilt = Rotation.from_euler("xyz", [0.3, -0.4, 1.0]).as_matrix()
    own = walk(n_strides=3, roll_rad_s=0.8, rate_hz=100.0, rest_s=1.0, mounting=tilt)
    rng = np.random.default_rng(5)
    acc = own.acc + 0.2 * rng.standard_normal(own.acc.shape)
    gyr = own.gyr + 0.02 * rng.standard_normal(own.gyr.shape) + np.array([[0.01], [-0.02], [0.015]])
    return own.rate_hz, np.ascontiguousarray(acc), np.ascontiguousarray(gyr)


@pytest.mark.parametrize("vertical_sd", [0.02, 0.3])
def test_it_equals_the_sample_wise_smoother(noisy, vertical_sd):
    rate_hz, acc, gyr = noisy
    method = replace(RECOMMENDED, passes=1, gate=np.inf, stance_vertical_sd_m_s=vertical_sd)
    rests = find_rests(acc, gyr, rate_hz, method)
    stances = np.array([210, 320])  # in the middle of both
    found = ZeroVelocity(rests, stances, np.zeros(acc.shape[1], dtype=bool))
    ours = smoothed_states(acc, gyr, rate_hz, found, method)
    epochs, is_rest = measured_epochs(found, rate_hz, method.rest_spacing_s)
    up = mean_directions(acc, epochs, round(0.5 * method.stillness_window_s * rate_hz))
    rotation, velocity, _ = smooth_every_sample(
        acc,
        gyr,
        1.0 / rate_hz,
        epochs,
        is_rest,
        contact_lever(up, is_rest, method.lever_height_m),
        _start_covariance(True, method),
        level_quaternion(up[0]),
        method.bias_walk_rad_s_rts,
        *step_noise(acc, gyr, rate_hz, method),
        [method.stance_velocity_sd_m_s] * 2 + [vertical_sd],
        method.lever_height_sd_m,
        [method.rest_velocity_sd_m_s, method.rest_rate_sd_rad_s],
    )
    span = slice(epochs[0], epochs[-1] + 1)
    matrices = Rotation.from_quat(ours.orientation[span], scalar_first=True).as_matrix()
    assert np.abs(ours.velocity[span] - velocity).max() < 1e-6
    assert np.abs(matrices - rotation).max() < 1e-6
    # the smoother moves the filter by far more than this tolerance
    assert np.abs(velocity).max() > 1.0


def run_filter(acc, gyr, rate_hz, epochs, is_rest, start, bias, lever, velocity0, p0, rest_sd=0.1):
    n = acc.shape[1]
    orientation, velocity, force = np.empty((n, 4)), np.empty((n, 3)), np.empty((n, 3))
    orientation[0], velocity[0] = start, velocity0
    noise = np.full(n - 1, 1e-8)
    out = filter_epochs(
        acc,
        gyr,
        1.0 / rate_hz,
        epochs,
        is_rest,
        lever,
        p0,
        bias,
        noise,
        noise,
        1e-5,
        np.full(3, 0.1),
        0.0,
        np.full(2, rest_sd),
        np.inf,
        np.inf,
        orientation,
        velocity,
        force,
    )
    return out, orientation, velocity


def test_the_accumulated_transition_is_the_derivative_of_the_strapdown(noisy):
    """Perturb velocity, orientation and bias at the start; measurements are worth nothing."""
    rate_hz, acc, gyr = noisy
    acc, gyr = np.ascontiguousarray(acc[:, 80:160]), np.ascontiguousarray(gyr[:, 80:160])
    epochs, is_rest = np.array([0, 79]), np.array([True, True])
    start = Rotation.from_euler("xyz", [0.1, 0.2, 0.3])
    p0 = 1e-16 * np.eye(9)

    def end(x):
        turned = Rotation.from_rotvec(x[3:6]) * start
        quaternion = turned.as_quat(scalar_first=True)
        out, orientation, velocity = run_filter(
            acc,
            gyr,
            rate_hz,
            epochs,
            is_rest,
            quaternion,
            x[6:9].copy(),
            np.zeros(3),
            x[0:3],
            p0,
            rest_sd=1e9,
        )
        return out, Rotation.from_quat(orientation[-1], scalar_first=True), velocity[-1]

    (transitions, *_), middle, _ = end(np.zeros(9))
    step = 1e-4
    for column in range(9):
        x = np.zeros(9)
        x[column] = step
        _, up_rotation, up_velocity = end(x)
        _, down_rotation, down_velocity = end(-x)
        dv = (up_velocity - down_velocity) / (2 * step)
        dtheta = (up_rotation * middle.inv()).as_rotvec() - (
            down_rotation * middle.inv()
        ).as_rotvec()
        expected = transitions[1][:, column]
        assert np.allclose(dv, expected[0:3], atol=1e-6 if column < 6 else 2e-3)
        assert np.allclose(dtheta / (2 * step), expected[3:6], atol=1e-6 if column < 6 else 2e-4)


def test_covariances_stay_symmetric_and_positive(noisy):
    rate_hz, acc, gyr = noisy
    found = find_zero_velocity(acc, gyr, rate_hz, RECOMMENDED)
    epochs, is_rest = measured_epochs(found, rate_hz, 0.1)
    tiled = 40
    n = acc.shape[1]
    epochs = np.concatenate([epochs + n * i for i in range(tiled)])
    is_rest = np.tile(is_rest, tiled)
    (_, covariances, *_), *_ = run_filter(
        np.tile(acc, tiled),
        np.tile(gyr, tiled),
        rate_hz,
        epochs,
        is_rest,
        level_quaternion(acc[:, :50].mean(axis=1)),
        np.zeros(3),
        np.array([0.0, 0.0, -0.1]),
        np.zeros(3),
        _start_covariance(True, RECOMMENDED),
    )
    assert np.array_equal(covariances, covariances.swapaxes(1, 2))
    assert np.linalg.eigvalsh(covariances).min() > 0.0


def test_noise_of_a_step_follows_its_closed_form():
    acc = np.zeros((3, 4))
    acc[0] = [0.0, 3.0, 3.0, 7.0]
    gyr = np.zeros((3, 4))
    method = replace(
        RECOMMENDED, acc_noise_m_s2_rthz=0.2, acc_step_share=0.5, gyr_noise_rad_s_rthz=0.1
    )
    velocity_noise, angle_noise = step_noise(acc, gyr, 100.0, method)
    assert np.allclose(
        velocity_noise, 0.2**2 / 100 + (0.5 * 0.01) ** 2 * np.array([9.0, 0.0, 16.0])
    )
    assert np.allclose(angle_noise, 0.1**2 / 100)


def test_the_lever_points_down_from_the_sensor_in_stance():
    up = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]])
    assert np.allclose(contact_lever(up, np.array([True, False, False]), 0.1), [0.0, 0.0, -0.1])
    assert np.allclose(contact_lever(up[:1], np.array([True]), 0.1), [0.0, -0.1, 0.0])
