from dataclasses import replace

import numpy as np
import pytest
from closed_form_walk import walk
from scipy.spatial.transform import Rotation

from swaystride.errors import RecordingError
from swaystride.findings import findings_from_json
from swaystride.gait.foot_methods import PRINTED, RECOMMENDED
from swaystride.gait.strides import distance_m, stride_table
from swaystride.gait.trajectory import foot_trajectory

METHODS = {"printed": PRINTED, "recommended": RECOMMENDED}
RUNNING = {"stride_s": 0.7, "stance_s": 0.2, "stride_m": 2.8, "roll_rad_s": 1.0}


def checks(trajectory):
    return [finding.check for finding in findings_from_json(trajectory.attrs["findings"])]


def whole(strides):
    return strides.loc[~strides["is_half"], "length_m"].to_numpy()


@pytest.mark.parametrize("name", METHODS)
def test_a_foot_that_stands_flat_is_tracked_to_a_millimetre(name):
    own = walk(rate_hz=500.0)
    trajectory = foot_trajectory(own.acc, own.gyr, own.rate_hz, METHODS[name])
    assert np.abs(trajectory["position"].to_numpy() - own.position).max() < 1e-3
    assert distance_m(stride_table(trajectory)) == pytest.approx(8 * 1.4, abs=1e-3)
    assert trajectory.attrs["motion_start_s"] == pytest.approx(1.7, abs=0.1)
    assert trajectory.attrs["motion_stop_s"] == pytest.approx(1.5 + 8 * 1.1 - 0.2, abs=0.1)


def test_a_rolling_foot_shortens_the_printed_stride_by_its_speed_at_the_epoch():
    """v = ω h is taken for zero: each stride loses ω h T (methods §1.11)."""
    own = walk(rate_hz=500.0, height_m=0.08, **RUNNING)
    printed = foot_trajectory(own.acc, own.gyr, own.rate_hz, PRINTED)
    assert np.allclose(whole(stride_table(printed)), 2.8 - 1.0 * 0.08 * 0.7, atol=3e-3)


def test_the_contact_lever_removes_exactly_that():
    own = walk(rate_hz=500.0, height_m=0.08, **RUNNING)
    method = replace(RECOMMENDED, lever_height_m=0.08)
    trajectory = foot_trajectory(own.acc, own.gyr, own.rate_hz, method)
    assert np.allclose(whole(stride_table(trajectory)), 2.8, atol=1e-3)


@pytest.mark.parametrize("name", METHODS)
def test_mounting_and_heading_change_no_stride(name):
    turned = Rotation.from_euler("xyz", [3.0, -0.5, 1.2]).as_matrix()
    lengths = [
        stride_table(foot_trajectory(own.acc, own.gyr, own.rate_hz, METHODS[name]))["length_m"]
        for own in (walk(**RUNNING), walk(**RUNNING, mounting=turned))
    ]
    assert np.allclose(*lengths, atol=1e-6)


@pytest.mark.parametrize("name", METHODS)
def test_a_turning_path_has_its_true_stride_angles(name):
    own = walk(rate_hz=500.0, turn_rad_s=0.3)
    strides = stride_table(foot_trajectory(own.acc, own.gyr, own.rate_hz, METHODS[name]))
    assert np.allclose(strides["angle_rad"][1:-2], 0.3 * 1.1, atol=np.deg2rad(0.5))


def noisy(own, bias_deg_s=0.0, seed=1):
    rng = np.random.default_rng(seed)
    acc = own.acc + 0.02 * rng.standard_normal(own.acc.shape)
    gyr = own.gyr + 0.002 * rng.standard_normal(own.gyr.shape) + np.deg2rad(bias_deg_s)
    return acc, gyr


@pytest.mark.parametrize("gait", [{}, RUNNING], ids=["walking", "running"])
def test_the_error_grows_neither_with_the_length_nor_with_a_bias(gait):
    """Without the rest at the start the bias must be found on the way."""

    def mean_length(n_strides, bias_deg_s):
        own = walk(n_strides=n_strides, **gait)
        acc, gyr = noisy(own, bias_deg_s)
        cut = own.stances[0]
        trajectory = foot_trajectory(acc[:, cut:], gyr[:, cut:], own.rate_hz, RECOMMENDED)
        return whole(stride_table(trajectory)).mean()

    true_m = gait.get("stride_m", 1.4)
    short, long = mean_length(30, 0.0), mean_length(300, 0.0)
    assert abs(long - short) < 0.002 * true_m
    assert abs(mean_length(30, 0.1) - short) < 0.002 * true_m


def test_an_upside_down_sensor_gives_the_same_result():
    own = walk(mounting=np.diag([1.0, -1.0, -1.0]))
    trajectory = foot_trajectory(own.acc, own.gyr, own.rate_hz, RECOMMENDED)
    assert distance_m(stride_table(trajectory)) == pytest.approx(8 * 1.4, abs=5e-3)


def test_a_recording_without_rest_says_so_and_gives_its_strides():
    own = walk(n_strides=12, **RUNNING)
    cut = slice(own.stances[1] - 30, own.stances[-2] + 30)
    trajectory = foot_trajectory(own.acc[:, cut], own.gyr[:, cut], own.rate_hz, RECOMMENDED)
    assert checks(trajectory)[:2] == ["no_rest_at_start", "no_rest_at_end"]
    strides = stride_table(trajectory)
    assert len(strides) == 8
    assert not strides["is_half"].any()
    assert np.allclose(strides["length_m"], 2.8, atol=0.03)
    assert np.isnan(trajectory.attrs["motion_start_s"])


def test_a_recording_without_a_stride_says_so():
    still = np.tile([[0.0], [0.0], [9.80665]], 800)
    trajectory = foot_trajectory(still, 0 * still, 200.0, RECOMMENDED)
    assert checks(trajectory) == ["no_strides"]
    assert len(stride_table(trajectory)) == 0


def test_a_recording_that_is_never_still_says_so():
    time = np.arange(2000) / 200.0
    gyr = np.stack([5.0 + np.sin(9 * time), np.cos(9 * time), 0 * time])
    acc = np.tile([[0.0], [30.0], [9.80665]], 2000)
    trajectory = foot_trajectory(acc, gyr, 200.0, RECOMMENDED)
    assert checks(trajectory) == ["no_zero_velocity"]
    assert np.isnan(trajectory["position"]).all()


@pytest.mark.parametrize("name", METHODS)
def test_two_missing_seconds_cut_the_recording_and_no_stride_spans_them(name):
    own = walk(n_strides=16)
    acc, gyr = own.acc.copy(), own.gyr.copy()
    gap = slice(own.stances[5] - 60, own.stances[5] - 60 + 400)
    acc[:, gap] = gyr[:, gap] = np.nan
    trajectory = foot_trajectory(acc, gyr, own.rate_hz, METHODS[name])
    [seen] = [f for f in findings_from_json(trajectory.attrs["findings"]) if f.check == "gap"]
    assert seen.place == f"at {gap.start / 200:.2f} s"
    assert seen.found == "2.00 s missing: no stride spans it"
    strides = stride_table(trajectory)
    assert len(strides) in (12, 13)
    assert np.allclose(whole(strides), 1.4, atol=0.02)
    assert np.isnan(trajectory["position"].to_numpy()[:, gap]).all()


def test_single_lost_samples_are_filled():
    own = walk()
    acc, gyr = own.acc.copy(), own.gyr.copy()
    acc[:, 500:502] = np.nan
    trajectory = foot_trajectory(acc, gyr, own.rate_hz, RECOMMENDED)
    assert checks(trajectory) == checks(foot_trajectory(own.acc, own.gyr, own.rate_hz, RECOMMENDED))
    assert distance_m(stride_table(trajectory)) == pytest.approx(8 * 1.4, abs=0.01)


@pytest.mark.parametrize("name", METHODS)
def test_signals_clipped_for_a_third_of_each_stride_are_named(name):
    own = walk(**RUNNING)
    limit = np.quantile(np.abs(own.gyr[1]), 0.72)
    gyr = np.clip(own.gyr, -limit, limit)
    clipped = (np.abs(own.gyr[1]) >= limit)[own.stances[0] : own.stances[-1]].mean()
    assert clipped > 0.3
    trajectory = foot_trajectory(own.acc, gyr, own.rate_hz, METHODS[name])
    assert "angular_rate_flattened" in checks(trajectory)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"rate_hz": 40.0},
            "rate_hz: the sampling rate is too low for a foot; expected at least 50 Hz; found 40 Hz",
        ),
        (
            {"gyr": 180.0 / np.pi},
            "gyr_rad_s: no foot turns that fast: is the angular rate in degrees?",
        ),
        (
            {"acc": 1.0 / 9.80665},
            "acc_m_s2: the acceleration of the still foot is not gravity: wrong unit or scale?; expected 9.81 ± 5 m/s²; found 1.00",
        ),
    ],
)
def test_signals_that_cannot_be_right_are_refused(change, message):
    own = walk()
    with pytest.raises(RecordingError) as error:
        foot_trajectory(
            own.acc * change.get("acc", 1.0),
            own.gyr * change.get("gyr", 1.0),
            change.get("rate_hz", own.rate_hz),
            PRINTED,
        )
    assert message in str(error.value)


def test_signals_of_the_wrong_shape_are_refused():
    with pytest.raises(RecordingError, match=r"shape \(3, n_samples\); found \(100, 3\)"):
        foot_trajectory(np.zeros((100, 3)), np.zeros((100, 3)), 100.0, PRINTED)
