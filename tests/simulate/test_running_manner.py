"""What shapes a runner moves what it should, and a run changes as its profile says."""

import numpy as np
import pytest

from swaystride.errors import ConfigurationError
from swaystride.simulate.running_body import runner_body, usual_shares, usual_shoe
from swaystride.simulate.running_manner import (
    NO_VARIABILITY,
    RunnerManner,
    RunProfile,
    curves,
    fourier,
    manner_anchors,
    steady_run,
)
from swaystride.simulate.running_run import run_motion


@pytest.fixture(scope="module")
def measured(usual_body):
    """Measures of a steady run of a manner: times, ranges, impacts, widths."""

    def of(manner, body=usual_body, speed=3.5):
        motion = run_motion(
            body,
            manner,
            steady_run(6.0, speed),
            duration_s=6.0,
            variability=NO_VARIABILITY,
            rng=np.random.default_rng(1),
        )
        contact, toe_off = motion.contacts_s(0)
        a, b = contact[2], contact[3]
        s = motion.states(np.linspace(a, b, 600))
        angles = {name: np.ptp(v[:, 0]) for name, v in s.joint_angles_rad().items()}
        stances = motion.feet[0].stances
        right = s.r_world_from_segment
        return {
            "stride_time": b - a,
            "duty_factor": (toe_off[toe_off > a][0] - a) / (b - a),
            "impact": stances.impact_down_m_s[3],
            "arrest": stances.arrest_s[3],
            "contact_pitch_rad": stances.contact_pitch_rad[3],
            "toe_out_rad": -stances.heading_rad[3],
            "foot_roll": stances.contact_roll_rad[3] - stances.flat_roll_rad[3],
            "width": motion.feet[1].stances.y_m[3] - stances.y_m[3],
            "ahead": s.position_m[0, 5, 0] - s.position_m[0, 0, 0],
            "hip_height": s.position_m[:, 0, 2].mean(),
            "hip": angles["hip_right"],
            "knee": angles["knee_right"],
            "arm": np.ptp(np.arctan2(right[:, 9, 0, 1], right[:, 9, 2, 1])),
            "lean": np.mean(np.arctan2(right[:, 7, 0, 1], right[:, 7, 2, 1])),
            "tilt": np.mean(np.arctan2(right[:, 0, 0, 1], right[:, 0, 2, 1])),
            "pelvis_yaw": np.ptp(np.arctan2(right[:, 0, 1, 0], right[:, 0, 0, 0])),
            "pelvis_acc": s.acceleration_m_s2[:60, 0, 2].max(),
        }

    return of


@pytest.mark.parametrize(
    ("change", "measure", "expected"),
    [
        ({"stride_time": 1.05}, "stride_time", ("times", 1.05)),
        ({"duty_factor": 0.03}, "duty_factor", ("plus", 0.03)),
        ({"impact": 1.2}, "impact", ("times", 1.2)),
        ({"arrest": 1.2}, "arrest", ("times", 1.2)),
        ({"contact_pitch_rad": -0.1}, "contact_pitch_rad", ("plus", -0.1)),
        ({"toe_out_rad": 0.1}, "toe_out_rad", ("plus", 0.1)),
        ({"foot_roll": 1.5}, "foot_roll", ("times", 1.5)),
        ({"step_width_m": 0.04}, "width", ("plus", 0.04)),
        ({"foot_ahead_m": -0.03}, "ahead", ("less", -0.02)),
        ({"crouch_m": 0.02}, "hip_height", ("less", -0.015)),
        ({"hip_range": 1.15}, "hip", ("more", 0.01)),
        ({"knee_range": 1.1}, "knee", ("more", 0.08)),
        ({"arm_swing": 1.3}, "arm", ("more", 0.1)),
        ({"trunk_lean_rad": 0.1}, "lean", ("plus", 0.1)),
        ({"pelvis_tilt_rad": 0.1}, "tilt", ("plus", 0.1)),
        ({"pelvis_range": 1.3}, "pelvis_yaw", ("times", 1.3)),
        ({"pelvis_transient": 2.0}, "pelvis_acc", ("more", 1.0)),
    ],
    ids=lambda value: next(iter(value)) if isinstance(value, dict) else "",
)
def test_each_part_of_a_manner_moves_its_measure(measured, change, measure, expected):
    usual, changed = measured(RunnerManner())[measure], measured(RunnerManner(**change))[measure]
    how, size = expected
    if how == "times":
        assert changed == pytest.approx(size * usual, rel=0.02)
    elif how == "plus":
        assert changed - usual == pytest.approx(size, abs=0.1 * abs(size))
    elif how == "more":
        assert changed - usual > size
    else:
        assert changed - usual < size


def test_longer_legs_swing_more_slowly(measured):
    tall = runner_body(1.9, 80.0, shares=usual_shares(), shoe=usual_shoe())
    ratio = measured(RunnerManner(), tall)["stride_time"] / measured(RunnerManner())["stride_time"]
    assert ratio == pytest.approx(np.sqrt(1.9 / 1.72), rel=1e-6)


def test_a_run_drifts_as_its_profile_says(usual_body):
    profile = RunProfile(
        np.array([0.0, 60.0]),
        np.array([2.8, 3.2]),
        {"impact": np.array([0.0, 0.2]), "stride_time": np.array([0.0, -0.05])},
    )
    motion = run_motion(
        usual_body,
        RunnerManner(),
        profile,
        duration_s=60.0,
        variability=NO_VARIABILITY,
        rng=np.random.default_rng(1),
    )
    stances = motion.feet[0].stances
    inside = (stances.contact_s > 0) & (stances.contact_s < 60)
    time, stride = stances.contact_s[inside], np.diff(stances.contact_s[inside])
    usual = manner_anchors().at(profile.speed_at(time))
    assert stride[-1] / stride[0] < 0.96
    impact = stances.impact_forward_m_s[inside] / usual["impact_forward_m_s"]
    np.testing.assert_allclose(impact, 1.0 + 0.2 * time / 60.0, rtol=1e-9)
    speed = np.diff(stances.x_m[inside]) / stride
    np.testing.assert_allclose(speed, profile.speed_at(time[:-1] + stride / 2 + 0.1), rtol=0.02)


def test_strides_scatter_and_remember(usual_body, run_variability):
    motion = run_motion(
        usual_body,
        RunnerManner(),
        steady_run(600.0, 3.0),
        duration_s=600.0,
        variability=run_variability,
        rng=np.random.default_rng(5),
    )
    stances = motion.feet[0].stances
    stride = np.diff(stances.contact_s[1:])
    assert np.std(stride) / np.mean(stride) == pytest.approx(run_variability.time_cv, rel=0.15)
    impact = np.log(stances.impact_down_m_s)
    assert np.std(impact) == pytest.approx(run_variability.impact_cv, rel=0.15)
    assert np.corrcoef(impact[:-1], impact[1:])[0, 1] == pytest.approx(0.3, abs=0.1)


def test_an_unknown_change_is_refused():
    with pytest.raises(ConfigurationError, match="cadence"):
        RunProfile(np.array([0.0]), np.array([3.0]), {"cadence": np.array([0.0])})


def test_curves_have_unit_range_and_exact_derivatives():
    phase, step = np.linspace(0.0, 1.0, 300), 1e-6
    for name, coefficients in curves().items():
        value, first, second = fourier(coefficients, phase)
        ahead, behind = (fourier(coefficients, phase + shift) for shift in (step, -step))
        assert np.ptp(value) == pytest.approx(1.0, abs=1e-3), name
        np.testing.assert_allclose((ahead[0] - behind[0]) / (2 * step), first, atol=1e-6)
        np.testing.assert_allclose((ahead[1] - behind[1]) / (2 * step), second, atol=1e-4)
