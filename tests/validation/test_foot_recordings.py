"""Public foot recordings: frames, markers, units, and the error lines of damaged files."""

import numpy as np
import pandas as pd
import pytest
from closed_form_walk import walk
from scipy.io import savemat
from scipy.spatial.transform import Rotation

from swaystride.errors import RecordingError
from swaystride.validation import foot_imu_mocap_walk, foot_imu_vicon, manifest
from swaystride.validation.foot_recording import displacements, from_z_down

TRIAL = "2017-01-02-03-04-05"
TURNING = walk(n_strides=6, turn_rad_s=0.4)


def instants_of(truth):
    """Stance samples, from the last rest sample before the movement to the end."""
    return np.concatenate([[200], truth.stances, [truth.acc.shape[1] - 1]])


def write_trial(folder, truth=TURNING, **changes):
    """A trial as the redistributor has it: z down, indices from 0; arrays can be exchanged."""
    n = truth.acc.shape[1]
    content = {
        "imu_data": np.concatenate([from_z_down(truth.acc), from_z_down(truth.gyr)]).T,
        "timestamps_all": 0.005 + np.arange(n)[None] / truth.rate_hz,
        "gt": from_z_down(truth.position[:2]).T,
        "strideIndex": instants_of(truth)[None].astype(np.int64),
        "pyshoeTrajectory": 0.98 * from_z_down(truth.position[:2]).T,
    }
    content |= changes
    path = folder / f"{TRIAL}_LLIO.mat"
    savemat(path, {name: value for name, value in content.items() if value is not None})
    return path


def test_a_trial_is_turned_to_z_up_and_nothing_is_negated(tmp_path):
    recording = foot_imu_vicon.read_vicon_trial(write_trial(tmp_path))
    np.testing.assert_allclose(recording.acc_m_s2, TURNING.acc, atol=1e-12)
    np.testing.assert_allclose(recording.gyr_rad_s, TURNING.gyr, atol=1e-12)
    np.testing.assert_allclose(recording.path_m, TURNING.position[:2], atol=1e-12)
    assert recording.trial == TRIAL
    assert recording.rate_hz == pytest.approx(200.0)
    at = TURNING.position[:2, instants_of(TURNING)]
    np.testing.assert_allclose(recording.reference_m, np.linalg.norm(np.diff(at), axis=0))
    stored = displacements(
        recording.stored_path_m, np.arange(TURNING.acc.shape[1]) / 200.0, recording.instants_s
    )
    np.testing.assert_allclose(stored, 0.98 * recording.reference_m)


@pytest.mark.parametrize(
    ("stride_s", "length_m", "gait"),
    [(0.75, 0.4, "run"), (1.2, 1.2, "walk"), (1.7, 0.72, "other"), (0.89, 2.0, "run")],
)
def test_gait_follows_from_stride_time_then_length(stride_s, length_m, gait):
    instants = stride_s * np.arange(9)
    assert foot_imu_vicon.gait_label(instants, np.full(8, length_m)) == gait


def test_half_a_turn_is_a_rotation_and_its_own_inverse():
    turn = from_z_down(np.eye(3))
    assert np.linalg.det(turn) == pytest.approx(1.0)
    np.testing.assert_array_equal(from_z_down(turn), np.eye(3))


def test_the_frame_of_a_file_is_told_from_its_own_navigation_acceleration(tmp_path):
    rng = np.random.default_rng(3)
    euler, acc = (
        rng.uniform(-1.5, 1.5, (80, 3)),
        rng.normal(size=(80, 3)) - np.array([0.0, 0.0, 9.8]),
    )
    turned = Rotation.from_euler("xyz", euler).apply(acc)
    signals = np.concatenate([acc, np.zeros((80, 3))], axis=1)
    for gravity, difference in ((9.8, 0.0), (-9.8, 19.6)):
        path = tmp_path / "trial.mat"
        acc_n = turned + np.array([0.0, 0.0, gravity])
        savemat(path, {"imu_data": signals, "euler_angles": euler, "acc_n": acc_n})
        found = foot_imu_vicon.sensor_frame_residual(path)
        assert found["difference_m_s2"] == pytest.approx(difference, abs=1e-9)
        assert found["rest_z_m_s2"] < -9.0


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"gt": None}, r"LLIO.mat: an array is missing; expected .*gt.*; found no gt"),
        (
            {"gt": TURNING.position[:, :-9].T},
            r"LLIO.mat: gt: wrong shape; expected 1921 × 2; found 1912 × 3",
        ),
        (
            {"strideIndex": np.array([[200, 1921]])},
            r"strideIndex: a stride index lies outside of the trial; expected 0 to 1920; found 200 to 1921",
        ),
        (
            {"strideIndex": np.array([[700, 200]])},
            r"stride instants out of order; expected at least two, increasing, none before the start; found 2 instants",
        ),
        (
            {"timestamps_all": np.delete(np.arange(1941) / 200.0, range(900, 920))[None]},
            r"timestamps_all: time stamps are not regular; expected no sample lost or doubled; found \d+\.\d samples",
        ),
        (
            {"imu_data": np.concatenate([TURNING.acc, TURNING.gyr]).T},
            r"before the first stride: acceleration at rest does not point up; expected along \+z within 60°; found \(-?0\.0, -?0\.0, -9\.8\) m/s²",
        ),
        (
            {"imu_data": np.full((1921, 6), np.nan)},
            r"acceleration: missing values; expected finite numbers; found NaN",
        ),
        (
            {"gt": np.full((1921, 2), np.nan)},
            r"optical reference: missing values; expected finite numbers; found NaN",
        ),
    ],
)
def test_a_damaged_trial_gives_its_error_line(tmp_path, changes, line):
    with pytest.raises(RecordingError, match=line):
        foot_imu_vicon.read_vicon_trial(write_trial(tmp_path, **changes))


def test_a_file_that_is_no_matlab_file_is_refused(tmp_path):
    path = tmp_path / "trial.mat"
    path.write_bytes(b"no MATLAB file at all" * 20)
    with pytest.raises(RecordingError, match=r"trial.mat: not readable as a MATLAB file; found"):
        foot_imu_vicon.read_vicon_trial(path)


WALK = walk(n_strides=5, rate_hz=204.8)
LEVER_M = 0.15


def write_walk(folder, *, drop=None, events=None):
    """The three files of the walk with markers: the right foot walks 1 % further than the left.

    FCC is the walking point; TOE lies `LEVER_M` ahead of it and FM5 beside it.
    """
    signals, positions = {}, {}
    frames = np.arange(0.0, WALK.acc.shape[1] / 204.8, 0.01)
    at = np.arange(WALK.acc.shape[1]) / 204.8
    for foot, factor in (("left", 1.0), ("right", 1.01)):
        for kind, values, unit in (("acc", WALK.acc, 1.0), ("gyr", WALK.gyr, 180.0 / np.pi)):
            for name, axis in zip("xyz", unit * values, strict=True):
                signals[(f"{foot}_sensor", f"{kind}_{name}")] = axis
        path = np.stack([np.interp(frames, at, axis) for axis in factor * WALK.position])
        for marker, offset in (("FCC", (0, 0)), ("TOE", (LEVER_M, 0)), ("FM5", (0, LEVER_M))):
            for name, axis, shift in zip("xyz", path, (*offset, 0), strict=True):
                positions[(f"{foot[0].upper()}_{marker}", name)] = 1000.0 * (axis + shift)
    files = [folder / name for name in ("imu.csv", "mocap.csv", "events.csv")]
    pd.DataFrame(signals).drop(columns=drop or []).to_csv(files[0])
    pd.DataFrame(positions).drop(columns=drop or [], errors="ignore").to_csv(files[1])
    if events is None:
        rows = [
            (foot, start, stop)
            for foot in ("left", "right")
            for start, stop in zip(WALK.stances[:-1], WALK.stances[1:], strict=True)
        ]
        events = pd.DataFrame(rows, columns=["foot", "start", "end"])
    events.to_csv(files[2], index_label="s_id")
    return files


def test_both_feet_come_in_si_with_the_heel_as_reference(tmp_path):
    left, right = foot_imu_mocap_walk.read_mocap_walk(*write_walk(tmp_path))
    assert (left.trial, right.trial) == ("left", "right")
    for recording, factor in ((left, 1.0), (right, 1.01)):
        np.testing.assert_allclose(recording.acc_m_s2, WALK.acc, atol=1e-9)
        np.testing.assert_allclose(recording.gyr_rad_s, WALK.gyr, atol=1e-9)
        np.testing.assert_allclose(recording.reference_m, factor * 1.4, rtol=1e-6)
        np.testing.assert_allclose(recording.instants_s, WALK.stances / 204.8)
        assert set(recording.other_references_m) == {"TOE", "FM5"}


def test_markers_of_a_foot_that_turns_move_differently(tmp_path):
    """Half a turn about the heel: the toe moves by twice its lever, the heel stays."""
    files = write_walk(tmp_path)
    positions = pd.read_csv(files[1], header=[0, 1], index_col=0)
    late = positions.index >= len(positions) // 2
    heel = positions["L_FCC"].iloc[0]
    for name in "xy":
        positions[("L_FCC", name)] = heel[name]
        positions[("L_TOE", name)] = heel[name]
    positions[("L_TOE", "x")] += np.where(late, -1000.0, 1000.0) * LEVER_M
    positions.to_csv(files[1])
    left, _ = foot_imu_mocap_walk.read_mocap_walk(*files)
    assert left.reference_m.sum() == pytest.approx(0.0)
    assert left.other_references_m["TOE"].sum() == pytest.approx(2.0 * LEVER_M)


def test_damaged_tables_of_the_walk_give_their_error_lines(tmp_path):
    files = write_walk(tmp_path, drop=[("left_sensor", "gyr_y")])
    line = r"imu.csv: columns are missing; .*; found no left_sensor gyr_y"
    with pytest.raises(RecordingError, match=line):
        foot_imu_mocap_walk.read_mocap_walk(*files)
    files = write_walk(tmp_path)
    cut = pd.read_csv(files[1], header=[0, 1], index_col=0).iloc[:300]
    cut.to_csv(files[1])
    line = r"mocap.csv: markers end before the last stride; expected at least 5.90 s; found 2.99 s"
    with pytest.raises(RecordingError, match=line):
        foot_imu_mocap_walk.read_mocap_walk(*files)


@pytest.mark.parametrize(
    ("rows", "line"),
    [
        (
            {"foot": ["left", "left"], "start": [400, 650], "end": [625, 850]},
            r"events.csv: left foot, stride 2: strides do not follow each other; expected start at 625, where the one before ends; found 650",
        ),
        (
            {"foot": ["right"], "start": [400], "end": [625]},
            r"events.csv: no strides; expected rows of the left foot",
        ),
        (
            {"foot": ["left"], "start": [400]},
            r"events.csv: columns are missing; expected foot, start, end; found no end",
        ),
    ],
)
def test_damaged_events_give_their_error_lines(tmp_path, rows, line):
    files = write_walk(tmp_path, events=pd.DataFrame(rows))
    with pytest.raises(RecordingError, match=line):
        foot_imu_mocap_walk.read_mocap_walk(*files)


@pytest.mark.parametrize(
    ("dataset", "n_files"), [(foot_imu_vicon.DATASET, 22), (foot_imu_mocap_walk.DATASET, 3)]
)
def test_the_manifest_names_every_foot_recording(dataset, n_files):
    files = manifest.load_manifest(dataset)
    assert len(files) == n_files
    assert files["file"].is_unique
    assert files["sha256"].str.fullmatch("[0-9a-f]{64}").all()
    assert files[["source", "licence"]].notna().all(axis=None)
