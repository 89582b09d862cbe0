"""Raw files of a participant against the truth kept beside them."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from swaystride.io.reading import read_recording
from swaystride.recording import findings_of
from swaystride.simulate.foot_kinematics import point_signals
from swaystride.simulate.imu_design_cohort import imu_design_tables, mean_speeds
from swaystride.simulate.imu_design_recordings import (
    sensor_signals,
    trial_summary,
    write_participant,
)
from swaystride.simulate.imu_design_truth import read_truth
from swaystride.simulate.inertial_sensor import SensorUnit
from swaystride.units import GRAVITY_M_S2

SEED = 11


@pytest.fixture(scope="module")
def small(runners):
    """One walk and two runs over 30 m."""
    protocol = replace(runners.protocol, n_participants=2, n_walking=1, n_running=2)
    return replace(runners, protocol=protocol, course=replace(runners.course, distance_m=30.0))


@pytest.fixture(scope="module")
def raw(small, tmp_path_factory):
    """Folder of participant P02, the truth, and the trials as returned."""
    folder = tmp_path_factory.mktemp("imu_design")
    trials = write_participant(
        "P02",
        tables=imu_design_tables(small, SEED),
        cohort=small,
        seed=SEED,
        folder=folder,
        truth_file=folder / "truth" / "P02.json",
    )
    return folder, read_truth(folder / "truth" / "P02.json"), trials


def recording(raw, trial, foot, imu):
    return read_recording(raw[0] / "P02" / f"P02_{trial}_{foot}_{imu}.csv")


def test_every_file_of_the_table_is_written_and_says_that_it_is_simulated(small, raw):
    table = imu_design_tables(small, SEED).trials
    for file in table.loc[table["participant"] == "P02", "file"]:
        path = raw[0] / file
        told = path if "imu_1" in file else path.with_suffix(".json")
        assert "simulated by swaystride" in told.read_text()[:600]
        assert "not a measurement" in told.read_text()[:600]
    assert len(list((raw[0] / "P02").glob("*.csv"))) == 12
    assert "simulated" in (raw[0] / "truth" / "P02.json").read_text()[:200]


@pytest.mark.parametrize(("imu", "rate"), [("imu_1", 128.0), ("imu_2", 1000.0)])
@pytest.mark.parametrize("trial", ["01", "02", "03"])
def test_files_read_back_without_findings(raw, trial, imu, rate):
    lasts = []
    for foot in ("left", "right"):
        found = recording(raw, trial, foot, imu)
        assert found.attrs["rate_hz"] == rate
        assert [f for f in findings_of(found) if f.severity == "error"] == []
        assert np.isfinite(found["acc"].values).all()
        lasts.append(found.sizes["time"] / rate)
    assert lasts[0] == lasts[1]
    assert lasts[0] == pytest.approx(raw[1].foot(trial, "left").duration_s, abs=1.5 / rate)


@pytest.mark.parametrize("trial", ["01", "03"])
def test_signals_are_those_of_the_truth(small, raw, trial):
    """Mounting undone, the files hold the ideal signals up to the errors of the sensor."""
    truth = raw[1].foot(trial, "right")
    found = recording(raw, trial, "right", "imu_2")
    time = np.arange(found.sizes["time"]) / 1000.0
    acc, gyr = point_signals(truth.pose(time), truth.sensor_m[1])
    model = small.imu_2.model
    for name, ideal, bias, unit in (
        ("acc", acc, model.acc_bias_sd_m_s2, GRAVITY_M_S2),
        ("gyr", gyr, np.radians(model.gyr_bias_sd_deg_s), np.radians(100.0)),
    ):
        seen = truth.r_sensor_from_foot.T @ found[name].values[0]
        error = seen - ideal
        assert np.abs(np.median(error, axis=1)).max() < 5 * bias
        spread = np.median(np.abs(error), axis=1).max()
        assert spread < 0.1 * unit
        assert np.corrcoef(seen.ravel(), ideal.ravel())[0, 1] > 0.95


def test_an_ideal_sensor_shows_the_ideal_signals(small, raw):
    truth = raw[1].foot("01", "left")
    model = replace(
        small.imu_1.model,
        acc_noise_density_m_s2_rthz=0.0,
        gyr_noise_density_deg_s_rthz=0.0,
        acc_adc_bits=32,
        gyr_adc_bits=32,
    )
    unit = SensorUnit(np.eye(3), np.eye(3), np.eye(3), np.zeros(3), np.zeros(3))
    acc, gyr = sensor_signals(
        truth.motion,
        truth.sensor_m[0],
        replace(small.imu_1, model=model),
        unit,
        duration_s=truth.duration_s,
        rng=np.random.default_rng(0),
    )
    time = np.arange(acc.shape[1]) / 128.0
    ideal_acc, ideal_gyr = point_signals(truth.pose(time), truth.sensor_m[0])
    far = np.abs(time[:, None] - truth.contact_s).min(axis=1) > 0.12
    assert np.abs(acc - ideal_acc)[:, far].max() < 6.0
    assert np.degrees(np.abs(gyr - ideal_gyr)[:, far]).max() < 40.0
    # Through the impacts, velocity is not lost: the filter passes what does not vary.
    assert np.abs((acc - ideal_acc).mean(axis=1)).max() < 0.05


def test_the_sensor_saturates_before_its_filter(small, raw):
    """A sprint exceeds ±32 g for milliseconds; the filtered file stays below, and differs."""
    truth = raw[1].foot("03", "left")
    unit = SensorUnit(np.eye(3), np.eye(3), np.eye(3), np.zeros(3), np.zeros(3))
    narrow = replace(small.imu_1.model, acc_range_m_s2=10.0 * GRAVITY_M_S2)
    wide, clipped = (
        sensor_signals(
            truth.motion,
            truth.sensor_m[0],
            replace(small.imu_1, model=model),
            unit,
            duration_s=truth.duration_s,
            rng=np.random.default_rng(0),
        )[0]
        for model in (small.imu_1.model, narrow)
    )
    late = np.clip(wide, -10.0 * GRAVITY_M_S2, 10.0 * GRAVITY_M_S2)
    assert np.abs(clipped).max() < 10.5 * GRAVITY_M_S2
    assert np.abs(late - clipped).max() > 3.0 * GRAVITY_M_S2


def test_the_truth_rebuilds_what_was_simulated(raw):
    _, truth, trials = raw
    for trial, simulated in trials.items():
        for side in ("left", "right"):
            known = truth.foot(trial, side)
            stances = getattr(simulated, side)
            for name in stances.names():
                np.testing.assert_array_equal(
                    getattr(known.stances, name), getattr(stances, name), err_msg=name
                )
            assert (known.start_s, known.stop_s) == (simulated.start_s, simulated.stop_s)


def test_positions_velocities_and_orientations_of_the_truth_agree(raw):
    truth = raw[1].foot("02", "left")
    time = np.linspace(3.0, truth.stop_s, 500)
    for imu in ("imu_1", "imu_2"):
        ahead, behind = (truth.sensor_position_m(imu, time + s) for s in (1e-6, -1e-6))
        np.testing.assert_allclose(
            (ahead - behind) / 2e-6, truth.sensor_velocity_m_s(imu, time), atol=1e-3
        )
    apart = truth.sensor_position_m("imu_2", time) - truth.sensor_position_m("imu_1", time)
    r = truth.r_world_from_sensor(time)
    np.testing.assert_allclose(np.einsum("nji,nj->ni", r, apart)[:, :2], 0.0, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(apart, axis=1), 0.014, atol=1e-9)


def test_true_strides_add_up_to_the_distance(small, raw):
    for trial, speed in zip(("01", "02", "03"), mean_speeds("P02", small, SEED), strict=True):
        for side in ("left", "right"):
            truth = raw[1].foot(trial, side)
            strides = truth.strides()
            assert truth.mean_speed_m_s == pytest.approx(speed, rel=1e-9)
            assert strides["length_m"].sum() == pytest.approx(30.0, abs=0.03)
            assert (strides["start_s"].to_numpy()[1:] == strides["stop_s"].to_numpy()[:-1]).all()
            np.testing.assert_array_equal(strides["stop_s"], truth.contact_s)
            assert (truth.toe_off_s < truth.contact_s).all()
            assert strides["is_half"].tolist()[:: len(strides) - 1] == [True, True]
            assert strides["is_half"].sum() == 2
            # The last, short step also brings the feet side by side.
            assert strides["angle_rad"].iloc[:-2].between(0, 0.25).all()
            rest = truth.sensor_position_m("imu_1", [0.0, truth.duration_s])
            assert rest[1, 0] - rest[0, 0] == pytest.approx(30.0, abs=0.02)


def test_files_do_not_depend_on_the_size_of_the_cohort(small, raw, tmp_path):
    larger = replace(small, protocol=replace(small.protocol, n_participants=4))
    write_participant(
        "P02",
        tables=imu_design_tables(larger, SEED),
        cohort=larger,
        seed=SEED,
        folder=tmp_path,
        truth_file=tmp_path / "truth" / "P02.json",
    )
    for path in sorted(raw[0].rglob("P02*")):
        if path.is_file():
            assert path.read_bytes() == (tmp_path / path.relative_to(raw[0])).read_bytes()


def test_the_summary_counts_steps(small, raw):
    summary = trial_summary(raw[2], small.course.distance_m)
    assert isinstance(summary, pd.DataFrame)
    assert summary["trial"].tolist() == ["01", "02", "03"]
    assert (summary["n_steps"] > 10).all()
    assert (np.diff(summary["mean_speed_m_s"]) > 0).all()
