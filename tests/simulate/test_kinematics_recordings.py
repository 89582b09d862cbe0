"""Raw files of a participant of the kinematics study against the truth kept beside them."""

from dataclasses import replace

import h5py
import numpy as np
import pytest

from swaystride.errors import RecordingError
from swaystride.io.c3d import read_c3d
from swaystride.io.reading import read_recording
from swaystride.recording import findings_of
from swaystride.rotations import log_map
from swaystride.simulate.kinematics_cohort import kinematics_tables
from swaystride.simulate.kinematics_recordings import (
    SENSOR_LABELS,
    dressed,
    motion_of,
    write_participant,
)
from swaystride.simulate.kinematics_truth import PHASES, read_truth
from swaystride.simulate.running_body import SEGMENTS
from swaystride.simulate.running_markers import FACE_MARKERS, marker_places
from swaystride.units import GRAVITY_M_S2

SEED, RATE_HZ, RUNNING_S, STANDING_S = 11, 200.0, 6.0, 3.0
TRIALS = ("01", "02")
#: What is worn with a marker on its face, by label.
FACES = {SENSOR_LABELS[name]: marker for name, marker in FACE_MARKERS.items()}


@pytest.fixture(scope="module")
def small(treadmill_runners):
    """Two trials of six seconds; the optics of the second fail, and those of nobody who is there."""
    protocol = replace(
        treadmill_runners.protocol,
        n_participants=2,
        duration_s=RUNNING_S,
        standing_s=STANDING_S,
        failed_optics=("P02/02", "P09/01"),
    )
    return replace(treadmill_runners, protocol=protocol)


@pytest.fixture(scope="module")
def raw(small, tmp_path_factory):
    """Folder of participant P02, the truth as read, and the truth as returned."""
    folder = tmp_path_factory.mktemp("kinematics")
    truth = write_participant(
        "P02",
        tables=kinematics_tables(small, SEED),
        cohort=small,
        seed=SEED,
        folder=folder,
        truth_file=folder / "truth" / "P02.npz",
    )
    return folder, read_truth(folder / "truth" / "P02.npz"), truth


@pytest.fixture(scope="module")
def imus(raw):
    return {
        (trial, phase): read_recording(raw[0] / "P02" / f"P02_{trial}_{phase}.h5")
        for trial in TRIALS
        for phase in PHASES
    }


@pytest.fixture(scope="module")
def films(raw):
    return {
        (trial, phase): read_c3d(raw[0] / "P02" / f"P02_{trial}_{phase}.c3d")
        for trial in TRIALS
        for phase in PHASES
    }


@pytest.fixture(params=[(trial, phase) for trial in TRIALS for phase in PHASES])
def which(request):
    """Trial and phase of a recording."""
    return request.param


def test_every_file_of_the_table_is_written_and_says_that_it_is_simulated(small, raw):
    table = kinematics_tables(small, SEED).trials
    files = table.loc[table["participant"] == "P02", "file"]
    for file in files:
        path = raw[0] / file
        if path.suffix == ".h5":
            with h5py.File(path) as content:
                told = bytes(content.attrs["Note"])
        else:
            told = path.read_bytes()[:20000]
        assert b"simulated by swaystride, not a measurement" in told
    assert len(list((raw[0] / "P02").iterdir())) == len(files) == 8


def test_imus_have_the_promised_labels_rate_and_length(imus, which):
    found = imus[which]
    seconds = RUNNING_S if which[1] == "running" else STANDING_S
    assert found["sensor"].values.tolist() == list(SENSOR_LABELS.values())
    assert found.attrs["rate_hz"] == RATE_HZ
    assert found.sizes["time"] == seconds * RATE_HZ
    assert findings_of(found) == []
    assert np.isfinite(found["acc"].values).all()
    assert np.isfinite(found["gyr"].values).all()


def test_markers_have_the_promised_labels_unit_rate_and_length(films, which):
    found = films[which]
    seconds = RUNNING_S if which[1] == "running" else STANDING_S
    assert found["marker"].values.tolist() == [*marker_places(), *FACES.values()]
    assert found.sizes["marker"] == 45
    assert found.attrs["file_unit"] == "mm"
    assert found.attrs["rate_hz"] == RATE_HZ
    assert found.attrs["subject"] == "P02"
    assert found.sizes["time"] == seconds * RATE_HZ


def test_the_truth_rebuilds_what_was_simulated(raw, which):
    _, known, simulated = raw
    ours, theirs = known.recording(*which), simulated.recording(*which)
    time = np.linspace(0.0, ours.motion.duration_s, 200)
    for name in ("sensor_position_m", "marker_position_m", "r_world_from_sensor"):
        np.testing.assert_array_equal(getattr(ours, name)(time), getattr(theirs, name)(time))
    for name, angles in theirs.motion.states(time).joint_angles_rad().items():
        np.testing.assert_array_equal(ours.motion.states(time).joint_angles_rad()[name], angles)
    for side in range(2):
        for found, expected in zip(
            ours.motion.contacts_s(side), theirs.motion.contacts_s(side), strict=True
        ):
            np.testing.assert_array_equal(found, expected)
    assert ours.marker_start_s == theirs.marker_start_s
    assert (known.participant, known.trials) == ("P02", list(TRIALS))


def test_markers_are_those_of_the_truth_in_the_laboratory(raw, films, small, which):
    """Cameras start up to 2 ms early or late, which is 1 cm at the speed of a swinging foot."""
    truth, film = raw[1].recording(*which), films[which]["position"].values
    time = truth.marker_start_s + films[which]["time"].values
    expected = truth.marker_position_m(time)
    expected[..., 0] -= truth.motion.belt_way_m(time)[:, None]
    error = np.moveaxis(film, -1, 0) - expected
    assert np.nanstd(error) == pytest.approx(small.cameras.noise_m, rel=0.03)
    assert np.nanmax(np.abs(error)) < 6.0 * small.cameras.noise_m
    assert 0.0 < abs(truth.marker_start_s) < 0.002


def test_cameras_are_early_or_late_by_another_time_in_each_recording(raw):
    offsets = {
        raw[1].recording(trial, phase).marker_start_s for trial in TRIALS for phase in PHASES
    }
    assert len(offsets) == 4


def test_angular_rates_are_those_of_the_true_sensors(raw, imus):
    truth, found = raw[1].recording("01"), imus["01", "running"]
    time = found["time"].values
    r = truth.r_world_from_sensor(time)
    turn = log_map(np.swapaxes(r[:-1], -1, -2) @ r[1:]) * RATE_HZ
    seen = np.moveaxis(found["gyr"].values, -1, 0)
    error = turn - (seen[1:] + seen[:-1]) / 2.0
    assert np.degrees(np.abs(np.median(error, axis=0))).max() < 2.0
    assert np.degrees(np.median(np.abs(error))) < 6.0
    for k in range(7):
        assert np.corrcoef(turn[:, k].ravel(), seen[1:, k].ravel())[0, 1] > 0.97


def test_accelerations_are_those_of_the_true_sensors(raw, imus):
    """Second differences over 20 ms of the true ways, less those of the belt under them."""
    truth, found = raw[1].recording("01"), imus["01", "running"]
    time = found["time"].values
    r = truth.r_world_from_sensor(time)
    pull = np.einsum("nkij,kjn->nki", r, found["acc"].values) - [0.0, 0.0, GRAVITY_M_S2]
    pull[..., 0] += truth.motion.states(time).belt_m_s2[:, None]
    step = 0.02
    later, now, before = (truth.sensor_position_m(time + s) for s in (step, 0.0, -step))
    expected = (later - 2.0 * now + before) / step**2
    hat = np.convolve(np.ones(4), np.ones(4)) / 16.0
    for k, label in enumerate(SENSOR_LABELS.values()):
        for axis in range(3):
            seen = np.convolve(pull[:, k, axis], hat, mode="same")
            error = (seen - expected[:, k, axis])[10:-10]
            assert np.std(error) < 0.03 * np.std(expected[..., k, axis]) + 0.3, label


def test_a_standing_person_is_still(raw, imus, films):
    for trial in TRIALS:
        found = imus[trial, "standing"]
        size = np.linalg.norm(found["acc"].values, axis=1)
        assert np.abs(size.mean(axis=1) / GRAVITY_M_S2 - 1.0).max() < 0.08
        assert np.degrees(np.abs(found["gyr"].values).mean()) < 1.5
        place = films[trial, "standing"]["position"].values
        assert np.nanmax(np.nanstd(place, axis=2)) < 0.01
        angles = raw[1].recording(trial, "standing").motion.states([0.0, STANDING_S])
        for values in angles.joint_angles_rad().values():
            assert np.degrees(np.abs(np.diff(values, axis=0))).max() < 2.0


def test_sensors_sit_alike_in_both_trials(raw, imus):
    """Gravity in the axes of the sensors, through one mounting and the posture of each trial."""
    for trial in TRIALS:
        truth = raw[1].recording(trial, "standing")
        assert truth.worn is raw[1].worn
        r = truth.r_world_from_sensor(imus[trial, "standing"]["time"].values)
        expected = GRAVITY_M_S2 * r[:, :, 2].mean(axis=0)
        seen = imus[trial, "standing"]["acc"].values.mean(axis=2)
        assert np.abs(seen - expected).max() < 0.9
    np.testing.assert_allclose(
        np.linalg.det(raw[1].worn.r_sensor_from_segment), np.ones(7), atol=1e-12
    )


def test_the_runner_keeps_up_with_the_belt_and_stays_in_the_laboratory(small, raw, films):
    speed = small.protocol.belt_speed_m_s
    for trial in TRIALS:
        motion = raw[1].recording(trial).motion
        contact, _ = motion.contacts_s(0)
        pelvis = motion.states(contact[[0, -1]]).position_m[:, 0, 0]
        mean = (pelvis[1] - pelvis[0]) / (contact[-1] - contact[0])
        assert mean == pytest.approx(speed, rel=0.005)
        back = films[trial, "running"]["position"].sel(marker="LPSI", axis="x").values
        assert np.nanmax(np.abs(back)) < 0.4


def test_strides_are_as_long_as_the_belt_demands(small, raw):
    """14 km/h and 0.697 s make 2.71 m; people differ by some per cent."""
    motion = raw[1].recording("01").motion
    for side, foot in enumerate(("Right Foot", "Left Foot")):
        contact, toe_off = motion.contacts_s(side)
        middle = contact[contact < toe_off[-1]] + 0.1
        place = raw[1].recording("01").sensor_position_m(middle)
        length = np.diff(place[:, list(SENSOR_LABELS.values()).index(foot), 0])
        expected = small.protocol.belt_speed_m_s * np.diff(contact).mean()
        assert length.mean() == pytest.approx(expected, abs=0.04)
        assert length.mean() == pytest.approx(2.71, abs=0.3)


def test_optics_fail_there_and_only_there(raw, films, small, which):
    position = films[which]["position"]
    seen = np.isfinite(position.values).all(axis=1).mean(axis=1)
    lost = [str(name) for name in position["marker"].values[seen == 0.0]]
    if which == ("02", "running"):
        assert len(lost) == 1
        assert lost[0] in small.protocol.failed_markers
    else:
        assert lost == []
    assert ((seen == 0.0) | (seen > 0.9)).all()


@pytest.mark.parametrize(("side", "foot"), [(0, "Right Foot"), (1, "Left Foot")])
def test_a_foot_is_quiet_in_stances_of_its_own_side(raw, imus, films, side, foot):
    found, motion = imus["01", "running"], raw[1].recording("01").motion
    size = np.linalg.norm(found["gyr"].sel(sensor=foot).values, axis=0)
    time = found["time"].values

    def in_stances(of):
        contact, toe_off = motion.contacts_s(of)
        starts = contact[contact < toe_off[-1]]
        ends = toe_off[np.searchsorted(toe_off, starts)]
        middle = np.abs(time[:, None] - (starts + ends) / 2.0) < 0.02
        return size[middle.any(axis=1)].mean()

    assert 2.0 * in_stances(side) < in_stances(1 - side)
    letter = foot[0]
    across = films["01", "standing"]["position"].sel(axis="y").mean("time")
    right = [f"{letter}{name}" for name in ("ASI", "KNE", "TOE", "IMF")]
    assert (across.sel(marker=right).values * (1 if side else -1) > 0.0).all()


def test_sensors_are_on_the_segment_of_their_name(raw):
    rows = raw[1].worn.sensor_points.rows[:, 0]
    for label, row in zip(raw[1].worn.sensors, rows, strict=True):
        segment = SEGMENTS[row]
        if label == "Lumbar":
            assert segment == "pelvis"
        else:
            side, part = label.lower().split()
            assert segment == f"{part}_{side}"
    time = np.linspace(0.0, 2.0, 50)
    truth = raw[1].recording("01")
    marker = [raw[1].worn.markers.index(FACES[label]) for label in raw[1].worn.sensors]
    np.testing.assert_array_equal(
        truth.marker_position_m(time)[:, marker], truth.sensor_position_m(time)
    )


def test_the_belt_dips_differently_in_each_trial(small, raw):
    dips = []
    for trial in TRIALS:
        motion = raw[1].recording(trial).motion
        way = motion.belt_way_m(np.arange(0.0, RUNNING_S, 0.002))
        speed = np.diff(way) / 0.002
        dips.append((speed.max() - speed.min()) / small.protocol.belt_speed_m_s)
    assert dips[0] != dips[1]
    low, high = small.protocol.belt_dip
    assert all(0.95 * low < dip < 1.2 * high for dip in dips)


def test_files_do_not_depend_on_the_size_of_the_cohort(small, raw, tmp_path):
    larger = replace(small, protocol=replace(small.protocol, n_participants=4))
    write_participant(
        "P02",
        tables=kinematics_tables(larger, SEED),
        cohort=larger,
        seed=SEED,
        folder=tmp_path,
        truth_file=tmp_path / "truth" / "P02.npz",
    )
    for path in [*sorted(raw[0].rglob("P02_*")), raw[0] / "truth" / "P02.npz"]:
        other = tmp_path / path.relative_to(raw[0])
        if path.suffix == ".h5":
            ours, theirs = read_recording(path), read_recording(other)
            for name in ("acc", "gyr"):
                np.testing.assert_array_equal(ours[name].values, theirs[name].values)
        else:
            assert path.read_bytes() == other.read_bytes()


def test_people_and_trials_have_motions_of_their_own(small, raw):
    tables = kinematics_tables(small, SEED)
    height, mass = tables.participants.loc[0, ["height_m", "mass_kg"]]
    runner = dressed("P01", raw[1].recording("01").motion.body, small, SEED)
    assert height > 1.0
    assert mass > 30.0
    motions = [motion_of(runner, trial, "running", small, SEED) for trial in TRIALS]
    motions += [raw[1].recording(trial).motion for trial in TRIALS]
    firsts = {motion.contacts_s(0)[0][0] for motion in motions}
    assert len(firsts) == 4
    ours, theirs = runner.worn.r_sensor_from_segment, raw[1].worn.r_sensor_from_segment
    assert np.abs(ours - theirs).max(axis=(1, 2)).min() > 1e-3


def test_another_file_is_not_taken_for_the_truth(tmp_path):
    path = tmp_path / "P02.npz"
    np.savez(path, something=np.zeros(3))
    with pytest.raises(RecordingError, match=r"P02\.npz: not a file of truth of the kinematics"):
        read_truth(path)
