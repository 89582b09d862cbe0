"""Raw files of a run of the experience study against the truth kept beside them."""

import json
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from import_graph import REPOSITORY
from swaystride.gait.impact_peaks import IMPACT_WINDOW
from swaystride.gait.run_measures import MEASURES, MeasureRules
from swaystride.gait.segment_ranges import EARLY_STANCE
from swaystride.gait.segment_signals import PRINTED_FILTERS
from swaystride.gait.sensor_alignment import PELVIS
from swaystride.gait.steady_parts import PRINTED_STEADY, turns
from swaystride.gait.vector_coding import ANGULAR_DEVIATION
from swaystride.io.polar_ecg import read_ecg
from swaystride.io.reading import read_recording
from swaystride.presentation.table_files import read_table
from swaystride.recording import findings_of
from swaystride.signals.heart_rate import heart_rate
from swaystride.simulate.experience_cohort import experience_tables
from swaystride.simulate.experience_plans import planned_run
from swaystride.simulate.experience_recordings import (
    SENSOR_LABELS,
    calibration_motion,
    recording,
    running_motion,
    worn_run,
)
from swaystride.simulate.experience_runs import events_of, write_run
from swaystride.simulate.experience_truth import read_run_truth, true_strides
from swaystride.simulate.running_recording import ideal_signals, recorded
from swaystride.units import GRAVITY_M_S2

SEED, RATE_HZ, DURATION_S, WARM_UP_S, TURN_S = 4, 500.0, 44.0, 6.0, 20.0
RUN, SHAKY = "P01_01", "P01_02"
RULES = MeasureRules(
    PRINTED_FILTERS, IMPACT_WINDOW, EARLY_STANCE, ANGULAR_DEVIATION, 15.0, "upper_arm", True, False
)


@pytest.fixture(scope="module")
def small(path_runners):
    """Two runs of 44 s with a turn; in the second the head's sensor is lost."""
    protocol = replace(
        path_runners.protocol,
        runs_per_participant=(2,),
        duration_s=DURATION_S,
        warm_up_s=WARM_UP_S,
        standing_s=5.0,
    )
    course = replace(
        path_runners.course,
        turn_s=TURN_S,
        turn_sd_s=0.2,
        turn_lasts_s=(6.0, 7.0),
        turn_ramp_s=2.0,
        turn_margin_s=2.0,
        warm_up_time_s=5.0,
        bend_rad=0.0,
        slow_time_s=20.0,
    )
    losses = replace(
        path_runners.losses,
        heart_rate_runs=(SHAKY, "P07_01"),
        head_lost_runs=(SHAKY,),
        ratings_runs=(SHAKY,),
        ratings_lost_s=10.0,
    )
    heart = replace(path_runners.heart, rise_time_s=4.0)
    return replace(path_runners, protocol=protocol, course=course, losses=losses, heart=heart)


@pytest.fixture(scope="module")
def tables(small):
    people = read_table(REPOSITORY / "data" / "published" / "table_5_1.csv")
    return experience_tables(small, people, SEED)


@pytest.fixture(scope="module")
def raw(small, tables, tmp_path_factory):
    """Folder of the first run, and the true values as returned."""
    folder = tmp_path_factory.mktemp("experience")
    return folder, written(RUN, small, tables, folder)


def written(run, cohort, tables, folder):
    return write_run(
        run,
        tables=tables,
        cohort=cohort,
        rules=RULES,
        seed=SEED,
        folder=folder,
        truth_folder=folder / "truth",
    )


@pytest.fixture(scope="module")
def plan(small, tables):
    return planned_run(RUN, tables, small, SEED)


@pytest.fixture(scope="module")
def imu(raw):
    return read_recording(raw[0] / "P01" / f"{RUN}.h5")


@pytest.fixture(scope="module")
def strides(raw):
    return pd.read_parquet(raw[0] / "truth" / f"{RUN}_strides.parquet")


def test_the_files_of_the_table_are_written_but_the_ratings(raw, tables):
    row = tables.runs.iloc[0]
    named = {str(row[kind]) for kind in ("imu", "standing", "walking", "ecg", "events")}
    found = {str(path.relative_to(raw[0])) for path in (raw[0] / "P01").iterdir()}
    assert found == named
    assert {path.name for path in (raw[0] / "truth").iterdir()} == {
        f"{RUN}.npz",
        f"{RUN}.json",
        f"{RUN}_strides.parquet",
    }
    assert json.loads((raw[0] / "truth" / f"{RUN}.json").read_text())["run"] == RUN


@pytest.mark.parametrize("phase", ["", "_standing", "_walking"])
def test_recordings_have_the_promised_labels_and_rate(raw, phase):
    found = read_recording(raw[0] / "P01" / f"{RUN}{phase}.h5")
    assert found["sensor"].values.tolist() == list(SENSOR_LABELS.values())
    assert found.attrs["rate_hz"] == RATE_HZ
    assert findings_of(found) == []
    if not phase:
        assert found.sizes["time"] == DURATION_S * RATE_HZ


def test_pattern_and_duty_factor_are_those_that_were_drawn(small, raw, strides, plan):
    values = raw[1]
    assert values["pattern"] == plan.pattern == "aerial"
    assert values["measures"]["duty_factor"] == pytest.approx(plan.duty_factor, abs=1e-6)
    steady = strides[strides["is_steady"]]
    by_side = steady.groupby("side")["duty_factor"].mean()
    assert by_side.mean() == pytest.approx(plan.duty_factor, abs=1e-6)
    assert values["n_strides"] == len(steady)


def test_a_terrestrial_run_stays_longer_on_the_ground(small, tables, strides):
    other = planned_run(SHAKY, tables, small, SEED)
    motion = running_motion(other, small, SEED)
    theirs = true_strides(motion, other.excluded)
    mean = theirs.loc[theirs["is_steady"]].groupby("side")["duty_factor"].mean().mean()
    assert other.pattern == "terrestrial"
    assert mean == pytest.approx(other.duty_factor, abs=1e-6)
    assert theirs["contact_time_s"].median() > 1.1 * strides["contact_time_s"].median()
    assert theirs["contact_time_s"].between(0.12, 0.3).all()


def test_the_turn_is_where_the_events_say(raw, imu, plan):
    """The heading of the pelvis, from the sensor's rate about the vertical."""
    events = pd.read_csv(raw[0] / "P01" / f"{RUN}_events.tsv", sep="\t", keep_default_na=False)
    assert events["event"].tolist() == ["turn"]
    start, stop = events.loc[0, ["start_s", "stop_s"]]
    assert (start, stop) == pytest.approx(plan.turn_s, abs=0.051)
    k = list(SENSOR_LABELS).index(PELVIS)
    r = np.array(raw[1]["alignment"][PELVIS]).reshape(3, 3)
    yaw = (r @ imu["gyr"].values[k])[1]
    heading = np.cumsum(yaw) / RATE_HZ
    before, after = (heading[round(t * RATE_HZ)] for t in (start - 1.0, stop + 1.0))
    assert np.degrees(after - before) == pytest.approx(180.0, abs=25.0)
    rule = replace(PRINTED_STEADY, turn_window_s=4.0, turn_margin_s=0.0)
    ((begin, end),) = turns(yaw, RATE_HZ, rule)
    assert begin < (start + stop) / 2.0 < end
    assert (end - begin) < 3.0 * (stop - start)


def test_true_lengths_speeds_and_times_agree(strides, plan):
    ratio = strides["stride_length_m"] / strides["stride_time_s"]
    np.testing.assert_allclose(strides["speed_m_s"], ratio, rtol=1e-12)
    steady = strides[strides["is_steady"]]
    assert steady["speed_m_s"].mean() == pytest.approx(plan.speed_m_s, rel=0.005)
    np.testing.assert_allclose(
        steady["flight_time_s"] + steady["contact_time_s"], steady["step_time_s"], rtol=1e-9
    )
    edges = plan.excluded.to_numpy()
    for begin, end, _ in edges:
        assert not ((steady["start_s"] < end) & (steady["stop_s"] > begin)).any()


def test_true_measures_are_in_the_range_of_runners(raw):
    values = raw[1]["measures"]
    assert set(values) == {*MEASURES, "heart_rate_bpm"}
    assert np.isfinite(list(values.values())).all()
    assert 5.0 < values["peak_tibial_g"] < 20.0
    assert 1.5 < values["peak_head_g"] < values["peak_pelvic_g"] + 1.0 < 6.0
    assert 35.0 < values["hip_range_deg"] < 85.0
    assert 70.0 < values["knee_range_deg"] < 125.0


def test_the_truth_rebuilds_the_signals(raw, imu, small, plan):
    """Sensors, mounting and motion from the file give what the file of the IMUs holds."""
    truth = read_run_truth(raw[0] / "truth" / f"{RUN}.npz")
    assert truth.sensors == tuple(SENSOR_LABELS)
    first, n = round(10.0 * 2000), 8000
    ideal = ideal_signals(truth.motion, truth.points, 2000.0, first, n)[..., ::4]
    seen = imu.isel(time=slice(5000, 7000))
    for k, r in enumerate(truth.r_sensor_from_segment):
        for name, rows, allowed in (("acc", slice(0, 3), 0.05), ("gyr", slice(3, 6), 0.03)):
            expected = r @ ideal[k, rows]
            error = seen[name].values[k] - expected
            assert np.std(error) < allowed * np.std(expected) + 0.5


def test_anatomical_axes_point_up_in_standing_and_to_the_right_of_the_segment(raw):
    """Up by what the sensors record of gravity; soft tissue turns them by a degree or two."""
    standing = read_recording(raw[0] / "P01" / f"{RUN}_standing.h5")["acc"].values.mean(axis=2)
    truth = read_run_truth(raw[0] / "truth" / f"{RUN}.npz")
    for k, name in enumerate(truth.sensors):
        r_anatomical_from_sensor = np.reshape(raw[1]["alignment"][name], (3, 3))
        np.testing.assert_allclose(
            r_anatomical_from_sensor @ r_anatomical_from_sensor.T, np.eye(3), atol=1e-9
        )
        felt = r_anatomical_from_sensor @ standing[k]
        assert np.degrees(np.arccos(felt[1] / np.linalg.norm(felt))) < 4.0
        to_segment = r_anatomical_from_sensor @ truth.r_sensor_from_segment[k]
        assert to_segment[2, 2] > np.cos(np.radians(15.0))
        assert abs(to_segment[0, 2]) < 1e-9


def test_ideal_samples_are_handed_out_without_changing_the_recording(small, plan):
    motion = running_motion(plan, small, SEED)
    motion = replace(motion, duration_s=3.0)
    sensors = worn_run(plan, small, SEED).sensors
    plain, with_ideal = (
        list(
            recorded(
                motion,
                sensors,
                rate_hz=RATE_HZ,
                rng=np.random.default_rng(1),
                chunk_s=2.0,
                with_ideal=wanted,
            )
        )
        for wanted in (False, True)
    )
    for ours, theirs in zip(plain, with_ideal, strict=True):
        assert ours.ideal is None
        np.testing.assert_array_equal(ours.acc_m_s2, theirs.acc_m_s2)
        np.testing.assert_array_equal(ours.gyr_rad_s, theirs.gyr_rad_s)
    joined = np.concatenate([chunk.ideal for chunk in with_ideal], axis=-1)
    expected = ideal_signals(motion, sensors.skin, RATE_HZ, 0, 1500)
    assert joined.dtype == np.float32
    np.testing.assert_allclose(joined, expected, rtol=1e-5, atol=1e-4)


def test_the_heart_beats_as_the_truth_says_from_the_first_sample_on(raw, imu, plan):
    ecg = read_ecg(raw[0] / "P01" / f"{RUN}_ecg.csv")
    assert ecg.attrs["rate_hz"] == pytest.approx(130.0, abs=1e-4)
    assert ecg.attrs["start_ns"] == 1000 * imu.attrs["start_unix_us"]
    found = heart_rate(ecg["ecg"].values, ecg.attrs["rate_hz"])
    inside = np.zeros(len(found.rr_s), dtype=bool)
    for begin, end in plan.steady_s:
        inside |= (found.rr_end_s - found.rr_s >= begin) & (found.rr_end_s <= end)
    seen = 60.0 / found.rr_s[inside].mean()
    true = raw[1]["measures"]["heart_rate_bpm"]
    assert seen == pytest.approx(true, abs=0.5)
    assert true == pytest.approx(plan.heart_rate_bpm, rel=0.01)


def test_standing_is_quiet_and_walking_has_ten_strides(raw, small, plan):
    standing, walking = (
        read_recording(raw[0] / "P01" / f"{RUN}_{phase}.h5") for phase in ("standing", "walking")
    )
    assert standing.sizes["time"] / RATE_HZ >= 5.0
    size = np.linalg.norm(standing["acc"].values, axis=1)
    assert np.abs(size.mean(axis=1) / GRAVITY_M_S2 - 1.0).max() < 0.08
    assert np.degrees(np.abs(standing["gyr"].values).mean()) < 1.5
    motion = calibration_motion(worn_run(plan, small, SEED), "walking")
    assert motion.duration_s == pytest.approx(walking.sizes["time"] / RATE_HZ, abs=0.003)
    way = motion.states([0.0, motion.duration_s]).position_m[:, 0, 0]
    assert way[1] - way[0] >= 15.0
    for side in range(2):
        assert len(motion.contacts_s(side)[0]) >= 10


def test_sensors_sit_alike_in_the_three_recordings_and_anew_in_the_next_run(
    raw, small, tables, plan
):
    """Gravity in the axes of the sensors while standing, by the mounting of this run."""
    standing = read_recording(raw[0] / "P01" / f"{RUN}_standing.h5")
    files = worn_run(plan, small, SEED)
    still = calibration_motion(files, "standing")
    ideal = ideal_signals(still, files.sensors.skin, RATE_HZ, 0, 2000).mean(axis=2)
    for k, unit in enumerate(files.sensors.units):
        expected = unit.r_sensor_from_body @ ideal[k, :3]
        assert np.abs(standing["acc"].values[k].mean(axis=1) - expected).max() < 0.9
    later = worn_run(planned_run(SHAKY, tables, small, SEED), small, SEED).sensors
    for one, other in zip(files.sensors.units, later.units, strict=True):
        assert np.abs(one.r_sensor_from_body - other.r_sensor_from_body).max() > 1e-3


def test_the_same_seed_gives_the_same_files_and_what_is_lost_is_noted(small, tables, tmp_path):
    course = replace(
        small.course, turn_s=9.0, turn_lasts_s=(3.0, 3.0), turn_ramp_s=1.0, turn_margin_s=0.5
    )
    protocol = replace(small.protocol, duration_s=15.0, warm_up_s=2.0)
    walk = replace(small.walk, distance_m=6.0)
    short = replace(small, protocol=protocol, course=course, walk=walk)
    for folder in ("one", "other"):
        written(SHAKY, short, tables, tmp_path / folder)
    one, other = (sorted((tmp_path / name).rglob("P01_02*")) for name in ("one", "other"))
    assert len(one) == len(other) == 7
    for ours, theirs in zip(one, other, strict=True):
        if ours.suffix == ".h5":
            first, second = read_recording(ours), read_recording(theirs)
            np.testing.assert_array_equal(first["acc"].values, second["acc"].values)
            np.testing.assert_array_equal(first["gyr"].values, second["gyr"].values)
        else:
            assert ours.read_bytes() == theirs.read_bytes()
    run, walk = (
        read_recording(tmp_path / "one" / "P01" / f"{SHAKY}{end}.h5") for end in ("", "_walking")
    )
    assert run["sensor"].values.tolist() == list(SENSOR_LABELS.values())[:-1]
    assert "Head" in walk["sensor"].values
    assert not (tmp_path / "one" / "P01" / f"{SHAKY}_ecg.csv").exists()
    events = pd.read_csv(
        tmp_path / "one" / "P01" / f"{SHAKY}_events.tsv", sep="\t", keep_default_na=False
    )
    assert [tuple(row) for row in events.iloc[1:].itertuples(index=False)] == [
        (0.0, 15.0, "data_loss", "heart rate"),
        (0.0, 15.0, "data_loss", "Head"),
        (5.0, 15.0, "data_loss", "ratings"),
    ]
    truth = json.loads((tmp_path / "one" / "truth" / f"{SHAKY}.json").read_text())["measures"]
    assert np.isfinite([truth["peak_head_g"], truth["heart_rate_bpm"]]).all()
    # Too few strides for coordination variability.
    assert truth["foot_shank_early_stance"] is None


def test_a_loose_sensor_shakes_and_its_run_is_noted(small, plan, tmp_path):
    loose = replace(small, losses=replace(small.losses, head_loose_runs=(RUN,)))
    events = events_of(plan, loose)
    assert events.iloc[1].tolist() == [0.0, DURATION_S, "poor_attachment", "Head"]
    motion = replace(running_motion(plan, small, SEED), duration_s=4.0)
    seen = {}
    for name, cohort in (("firm", small), ("loose", loose)):
        worn = worn_run(plan, cohort, SEED)
        chunks = list(recording(tmp_path / f"{name}.h5", worn, motion, "running"))
        seen[name] = read_recording(tmp_path / f"{name}.h5")["acc"].values, chunks[0].ideal
    difference = seen["loose"][0] - seen["firm"][0]
    head = list(SENSOR_LABELS).index("head")
    assert np.abs(np.delete(difference, head, axis=0)).max() == 0.0
    size = np.linalg.norm(difference[head], axis=0)
    assert 0.4 < np.sqrt(np.mean(size**2)) / small.losses.loose_m_s2 < 1.6
    np.testing.assert_array_equal(seen["loose"][1], seen["firm"][1])
