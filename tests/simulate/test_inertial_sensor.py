"""Sensor signals: physics of the rigid trunk, and every error of the model by itself."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from swaystride.simulate.inertial_sensor import (
    MTX,
    OPAL_HIGH_RANGE,
    SensorUnit,
    draw_unit,
    measure,
    trunk_signals,
)
from swaystride.simulate.sampling import filter_reach
from swaystride.simulate.standing_body import StandingMotion, lean_angles_deg
from swaystride.sway.angles import trunk_angles
from swaystride.units import GRAVITY_M_S2

RATE = 1000.0
IDEAL = SensorUnit(np.eye(3), np.eye(3), np.eye(3), np.zeros(3), np.zeros(3))
NOISELESS = replace(
    MTX,
    acc_noise_density_m_s2_rthz=0.0,
    gyr_noise_density_deg_s_rthz=0.0,
    acc_adc_bits=32,
    gyr_adc_bits=32,
)


def smooth_motion(duration_s=5.0, amplitude=0.3, rate_hz=RATE):
    """Large, smooth pitch and roll with exact derivatives."""
    t = np.arange(round(duration_s * rate_hz)) / rate_hz
    w = 2 * np.pi * np.array([[0.7], [1.1]])
    phase = w * t + np.array([[0.2], [1.0]])
    return StandingMotion(
        rate_hz,
        amplitude * np.sin(phase),
        amplitude * w * np.cos(phase),
        -amplitude * w**2 * np.sin(phase),
    )


def orientations(motion):
    """r_world_from_trunk = R_y(pitch) R_x(roll)."""
    return Rotation.from_euler("YX", motion.angle_rad.T)


def test_at_rest_acceleration_is_gravity_pointing_up():
    for lean in ([0.0, 0.0], [0.1, 0.0], [0.0, -0.2], [0.3, 0.2]):
        still = StandingMotion(RATE, np.array(lean)[:, None], np.zeros((2, 1)), np.zeros((2, 1)))
        acc, gyr = trunk_signals(still, (-0.1, 0.0, 1.0))
        assert np.linalg.norm(acc) == pytest.approx(GRAVITY_M_S2, rel=1e-14)
        up = orientations(still).apply(acc.T)[0] / GRAVITY_M_S2
        np.testing.assert_allclose(up, [0.0, 0.0, 1.0], atol=1e-14)
        assert not gyr.any()


def test_strapdown_integration_returns_the_orientation():
    motion = smooth_motion()
    _, gyr = trunk_signals(motion, (0.0, 0.0, 1.0))
    steps = Rotation.from_rotvec((gyr[:, :-1] + gyr[:, 1:]).T / 2 / RATE)
    orientation = orientations(motion)[0]
    for step in steps:
        orientation = orientation * step
    error = (orientation.inv() * orientations(motion)[-1]).magnitude()
    assert np.rad2deg(error) < 1e-3


def test_acceleration_is_the_second_derivative_of_the_position():
    motion, position = smooth_motion(), np.array([-0.1, 0.05, 1.05])
    acc, _ = trunk_signals(motion, position)
    path = orientations(motion).apply(position)
    second = (path[2:] - 2 * path[1:-1] + path[:-2]) * RATE**2
    inside = orientations(motion)[1:-1]
    expected = inside.inv().apply(second + np.array([0.0, 0.0, GRAVITY_M_S2])).T
    np.testing.assert_allclose(acc[:, 1:-1], expected, atol=2e-4)


def test_trunk_angles_find_the_lean_of_noise_free_sway():
    motion = smooth_motion(60.0, amplitude=0.02, rate_hz=100.0)
    acc, gyr = trunk_signals(motion, (-0.1, 0.0, 1.0))
    found = np.array(trunk_angles(acc, gyr, 100.0))[:, 1000:]
    truth = lean_angles_deg(motion.angle_rad)[:, 1000:]
    # What remains is the answer of the fusion to true acceleration, not a frame or a sign.
    assert np.corrcoef(found[0], truth[0])[0, 1] > 0.99
    assert np.corrcoef(found[1], truth[1])[0, 1] > 0.99


def report(model, unit, *, n=400, acc=(0.0, 0.0, GRAVITY_M_S2), gyr=(0.0, 0.0, 0.0), seed=0):
    """What the sensor reports of a constant."""
    n_input = (n - 1) * 10 + 1 + 2 * filter_reach(RATE, 100.0)
    return measure(
        model,
        unit,
        acc_m_s2=np.tile(np.array(acc)[:, None], n_input),
        gyr_rad_s=np.tile(np.array(gyr)[:, None], n_input),
        rate_hz=RATE,
        output_rate_hz=100.0,
        rng=np.random.default_rng(seed),
    )


def test_a_perfect_sensor_reports_what_is_there():
    acc, gyr = report(NOISELESS, IDEAL, acc=(1.0, -2.0, 9.0), gyr=(0.1, 0.2, -0.3))
    assert acc.shape == gyr.shape == (3, 400)
    np.testing.assert_allclose(acc, np.tile([[1.0], [-2.0], [9.0]], 400), atol=1e-7)
    np.testing.assert_allclose(gyr, np.tile([[0.1], [0.2], [-0.3]], 400), atol=1e-7)


def test_noise_has_the_stated_density():
    acc, gyr = report(MTX, IDEAL, n=40_000)
    # σ per sample = density √(fs/2); quantisation adds step²/12.
    for values, density, full_scale in (
        (acc, 0.002, 50.0),
        (gyr, np.deg2rad(0.1), np.deg2rad(1200.0)),
    ):
        variance = density**2 * 50.0 + (2 * full_scale / 2**16) ** 2 / 12
        assert values.std(axis=1) == pytest.approx([np.sqrt(variance)] * 3, rel=0.02)
        # White: neighbours are not correlated.
        centred = values - values.mean(axis=1, keepdims=True)
        lag_one = (centred[:, 1:] * centred[:, :-1]).mean(axis=1) / centred.var(axis=1)
        assert np.abs(lag_one).max() < 5 / np.sqrt(40_000)


def test_range_clips():
    acc, gyr = report(MTX, IDEAL, acc=(80.0, -80.0, 0.0), gyr=(30.0, -30.0, 0.0))
    assert acc[0].max() <= 50.0
    assert acc[1].min() >= -50.0
    assert np.rad2deg(gyr[0].max()) <= 1200.0
    assert acc[0].mean() > 49.9


def test_the_element_saturates_before_the_filter():
    # A symmetric overload of one half period each: clipped first, its mean stays zero and its
    # level that of the clipped wave, not of the wave.
    n_input = 3990 + 1 + 2 * filter_reach(RATE, 100.0)
    wave = 100.0 * np.sign(np.sin(2 * np.pi * 5.0 * np.arange(n_input) / RATE + 1e-3))
    acc, _ = measure(
        NOISELESS,
        IDEAL,
        acc_m_s2=np.tile(wave, (3, 1)),
        gyr_rad_s=np.zeros((3, n_input)),
        rate_hz=RATE,
        output_rate_hz=100.0,
        rng=np.random.default_rng(0),
    )
    # Filtered after clipping, a square wave rings below its level somewhere between the edges.
    assert np.abs(acc).max() <= 50.0
    assert np.abs(np.abs(acc) - 50.0).min(axis=1).max() < 1.0
    assert (np.abs(acc) < 49.0).any()


def test_constant_errors_are_drawn_as_stated():
    units = [
        draw_unit(MTX, tilt_sd_deg=2.0, heading_sd_deg=1.0, rng=np.random.default_rng(i))
        for i in range(3000)
    ]
    acc_bias = np.array([unit.acc_bias_m_s2 for unit in units])
    gyr_bias = np.rad2deg([unit.gyr_bias_rad_s for unit in units])
    assert acc_bias.std(axis=0) == pytest.approx([0.02] * 3, rel=0.06)
    assert gyr_bias.std(axis=0) == pytest.approx([0.5] * 3, rel=0.06)
    sense = np.array([unit.gyr_sense for unit in units])
    scale = np.diagonal(sense, axis1=1, axis2=2) - 1.0
    assert np.abs(scale).max() <= 0.005
    assert scale.std() == pytest.approx(0.005 / np.sqrt(3), rel=0.03)
    tilt = sense[:, [0, 0, 1], [1, 2, 0]]
    assert np.rad2deg(tilt.std()) == pytest.approx(0.3, rel=0.04)
    turns = Rotation.from_matrix([unit.r_sensor_from_body for unit in units]).as_rotvec(
        degrees=True
    )
    assert turns.std(axis=0) == pytest.approx([2.0, 2.0, 1.0], rel=0.06)


def test_mounting_turns_the_signals_into_the_sensor_frame():
    quarter = Rotation.from_rotvec([0.0, 0.0, 90.0], degrees=True).as_matrix()
    acc, gyr = report(
        NOISELESS, replace(IDEAL, r_sensor_from_body=quarter), acc=(1.0, 0.0, 9.0), gyr=(0.1, 0, 0)
    )
    np.testing.assert_allclose(acc[:, 0], [0.0, 1.0, 9.0], atol=1e-6)
    np.testing.assert_allclose(gyr[:, 0], [0.0, 0.1, 0.0], atol=1e-6)


def test_bias_scale_and_misalignment_enter_as_stated():
    sense = np.array([[1.01, 0.02, 0.0], [0.0, 0.99, 0.0], [0.0, 0.0, 1.0]])
    unit = replace(IDEAL, gyr_sense=sense, gyr_bias_rad_s=np.array([0.1, 0.0, -0.1]))
    _, gyr = report(NOISELESS, unit, gyr=(1.0, 2.0, 3.0))
    np.testing.assert_allclose(gyr[:, 7], sense @ [1.0, 2.0, 3.0] + [0.1, 0.0, -0.1], atol=1e-6)


def test_a_gyroscope_that_feels_accelerations_shows_them():
    model = replace(
        OPAL_HIGH_RANGE,
        acc_noise_density_m_s2_rthz=0.0,
        gyr_noise_density_deg_s_rthz=0.0,
        acc_adc_bits=32,
        gyr_adc_bits=32,
    )
    sensitivity = np.diag([0.1, 0.2, 0.3])
    felt = replace(IDEAL, gyr_per_acc_s_m=sensitivity)
    acc = np.array([[1.0], [2.0], [3.0]]) * np.ones((1, 4000))
    shown = [
        measure(
            model,
            unit,
            acc_m_s2=acc,
            gyr_rad_s=np.zeros((3, 4000)),
            rate_hz=4096.0,
            output_rate_hz=128.0,
            rng=np.random.default_rng(0),
        )[1]
        for unit in (IDEAL, felt)
    ]
    np.testing.assert_allclose(shown[0], 0.0, atol=1e-6)
    np.testing.assert_allclose(shown[1].T, [[0.1, 0.4, 0.9]] * shown[1].shape[1], atol=1e-6)


def test_g_sensitivity_is_drawn_only_where_there_is_one():
    draw = {"tilt_sd_deg": 0.0, "heading_sd_deg": 0.0}
    assert draw_unit(MTX, **draw, rng=np.random.default_rng(1)).gyr_per_acc_s_m is None
    units = [
        draw_unit(OPAL_HIGH_RANGE, **draw, rng=np.random.default_rng(seed)) for seed in range(300)
    ]
    spread = np.std([u.gyr_per_acc_s_m for u in units]) * GRAVITY_M_S2
    assert np.degrees(spread) == pytest.approx(OPAL_HIGH_RANGE.gyr_g_sensitivity_deg_s_g, rel=0.05)
