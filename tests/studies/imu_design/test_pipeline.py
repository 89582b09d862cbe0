"""One simulated participant through files, import, trajectories and conditions; and bad recordings."""

import json
import sys

import numpy as np
import pandas as pd
import pytest

from import_graph import REPOSITORY
from study_parameters import resolve
from swaystride.configuration import from_mapping, plain_values
from swaystride.errors import RecordingError
from swaystride.gait.foot_methods import PRINTED, RECOMMENDED, FootMethod
from swaystride.io.study_tables import write_study_table
from swaystride.recording import list_recordings
from swaystride.simulate.imu_design_cohort import imu_design_tables
from swaystride.simulate.imu_design_parameters import cohort_from_config
from swaystride.simulate.imu_design_recordings import write_participant
from swaystride.simulate.imu_design_truth import read_truth
from swaystride.studies.imu_design.conditions import Signals
from swaystride.studies.imu_design.design import read_design, usable_trials
from swaystride.studies.imu_design.importing import import_participant
from swaystride.studies.imu_design.metrics import foot_estimate, measure_participant
from swaystride.studies.imu_design.observations import observations, recording_verdicts
from swaystride.studies.imu_design.sensors import sensor_specifications
from swaystride.studies.imu_design.signals_file import load_signals
from swaystride.studies.imu_design.stance import stance_intervals
from swaystride.studies.imu_design.truth import true_strides
from swaystride.sway.trial_import import RecordingRules

DISTANCE_M = 40.0


def parameters(variant="printed"):
    return plain_values(resolve("imu_design", variant, "demo"))


ANALYSIS = parameters()["analysis"]
METHOD = from_mapping(FootMethod, ANALYSIS["measurement"], place="analysis.measurement")
RULES = from_mapping(RecordingRules, ANALYSIS["recording"], place="analysis.recording")
SENSORS = sensor_specifications(ANALYSIS["sensors"])


@pytest.fixture(scope="module")
def raw(tmp_path_factory):
    """Files of one person: one walk and one run over 40 m."""
    folder = tmp_path_factory.mktemp("imu_design")
    given = json.loads(json.dumps(parameters()["simulation"]))
    given["cohort"]["protocol"].update(n_participants=1, n_walking=1, n_running=1)
    given["cohort"]["protocol"]["slow_run_m_s"] = [2.6, 2.6]
    given["foot"]["course"]["distance_m"] = DISTANCE_M
    cohort = cohort_from_config(given)
    tables = imu_design_tables(cohort, 5)
    for name in ("participants", "trials"):
        write_study_table(getattr(tables, name), folder / f"{name}.tsv")
    write_participant(
        "P01", tables=tables, cohort=cohort, seed=5, folder=folder,
        truth_file=folder / "truth/P01.json",
    )  # fmt: skip
    return folder


def imported(raw, out):
    return import_participant("P01", read_design(raw), raw, RULES, SENSORS, out)


@pytest.fixture(scope="module")
def recordings(raw, tmp_path_factory):
    out = tmp_path_factory.mktemp("recordings") / "P01.nc"
    return out, imported(raw, out)


@pytest.fixture(scope="module")
def measures(raw, recordings, settings):
    trials = usable_trials(read_design(raw).trials, list_recordings(recordings[0]))
    return measure_participant(trials, recordings[0], METHOD, settings)


@pytest.fixture
def copy_of(raw, tmp_path):
    """The same files with one trial of one foot, to be damaged."""

    def make(trial="02", foot="left", imu="imu_1"):
        trials = pd.read_csv(raw / "trials.tsv", sep="\t", dtype=str, keep_default_na=False)
        kept = trials.query("trial == @trial and foot == @foot and imu == @imu")
        write_study_table(kept, tmp_path / "trials.tsv")
        (tmp_path / "participants.tsv").write_bytes((raw / "participants.tsv").read_bytes())
        name = kept["file"].item()
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes((raw / name).read_bytes())
        return tmp_path, tmp_path / name

    return make


def test_the_configuration_spells_the_two_methods():
    """All but the threshold of rest, which the noise of a ±200 g accelerometer sets."""
    for variant, method in (("printed", PRINTED), ("recommended", RECOMMENDED)):
        values = parameters(variant)["analysis"]["measurement"]
        ours = from_mapping(FootMethod, values, place="analysis.measurement")
        differ = {name for name in values if getattr(ours, name) != getattr(method, name)}
        assert differ <= {"rest_acc_m_s2"}


def test_every_recording_is_imported_with_its_rate_and_peaks(recordings):
    tables = recordings[1]
    assert len(tables.ranges) == 2 * 2 * 2
    assert tables.exclusions.empty
    rates = tables.ranges.groupby("imu")["rate_hz"].unique()
    assert rates["imu_1"].tolist() == [128.0]
    assert rates["imu_2"].tolist() == [1000.0]
    assert (tables.ranges.query("imu == 'imu_2'")["peak_acc_g"] <= 32.0).all()
    assert (tables.ranges["acc_at_range_percent"] == 0).groupby(tables.ranges["imu"]).all()["imu_1"]


def test_every_condition_of_every_foot_is_measured(measures, settings):
    table = measures.conditions
    assert len(table) == 2 * 2 * (7 + 5 + 5 + 5)
    assert table["distance_m"].notna().all()
    baseline = table["condition"].str.startswith("baseline_")
    assert (table.loc[baseline, "length_difference_sd_m"] == 0).all()
    assert (
        table.loc[table["experiment"].str.endswith("range") & baseline, "loss_percent"] == 0
    ).all()
    assert table.loc[~table["experiment"].str.endswith("range"), "loss_percent"].isna().all()


def test_conditions_that_change_nothing_agree_to_the_last_digit(measures):
    """A walk never reaches 24 g nor 1000 °/s."""
    walk = measures.conditions[measures.conditions["trial"] == "01"]
    for experiment, names in (
        ("accelerometer_range", ["baseline_100g", "75g", "50g", "24g"]),
        ("gyro_range", ["baseline_2000dps", "1500dps", "1000dps"]),
    ):
        own = walk[(walk["experiment"] == experiment) & walk["condition"].isin(names)]
        assert own.groupby("foot")["distance_m"].nunique().tolist() == [1, 1]


def test_distances_and_speeds_are_near_the_truth(measures, raw):
    truth = read_truth(raw / "truth/P01.json")
    table = observations(measures.conditions)
    base = table[table["condition"].str.startswith("baseline_")]
    assert base["error_pct"].abs().max() < 4.0
    for trial, own in base.groupby("trial"):
        known = truth.foot(trial, "left").mean_speed_m_s
        assert own["speed_m_s"].iloc[0] == pytest.approx(known, rel=0.03)


def test_strides_agree_with_the_true_path_of_the_sensor(measures, raw):
    truth = read_truth(raw / "truth/P01.json")
    for (trial, foot, imu), own in measures.strides.groupby(["trial", "foot", "imu"]):
        of_foot = truth.foot(trial, foot)
        errors = true_strides(own, lambda t, f=of_foot, i=imu: f.sensor_position_m(i, t))
        assert len(errors) > 5
        assert errors["length_m"].sum() == pytest.approx(errors["true_length_m"].sum(), rel=0.04)


def test_stance_is_found_from_the_signals_alone(measures, recordings, raw):
    """Contact within 40 ms and toe-off within 60 ms of the truth, in walking and in running."""
    truth = read_truth(raw / "truth/P01.json")
    for trial in ("01", "02"):
        signals, _ = load_signals(recordings[0], f"trial_{trial}_left_imu_1")
        own = measures.strides.query("trial == @trial and foot == 'left' and imu == 'imu_1'")
        found = stance_intervals(signals, own)[2:-2]
        foot = truth.foot(trial, "left")
        for at, (known, tolerance) in enumerate(((foot.contact_s, 0.04), (foot.toe_off_s, 0.06))):
            gaps = np.abs(known[np.newaxis] - found[:, at, np.newaxis]).min(axis=1)
            assert np.median(gaps) < tolerance


def test_a_missing_file_stops_the_participant_with_its_name(copy_of, tmp_path):
    folder, file = copy_of()
    file.unlink()
    with pytest.raises(RecordingError) as error:
        imported(folder, tmp_path / "P01.nc")
    assert str(error.value) == (
        "P01/P01_02_left_imu_1.csv: no such file; expected the file named in trials.tsv"
    )


def cut(file, first, last, rate_hz=128.0):
    """Keep the lines of a part of an APDM file, in seconds."""
    lines = file.read_text(encoding="utf-8").splitlines()
    head, rows = lines[:4], lines[4:]
    kept = rows[round(first * rate_hz) : None if last is None else round(last * rate_hz)]
    file.write_text("\n".join([*head, *kept]) + "\n", encoding="utf-8")


def test_a_recording_that_ends_in_motion_is_counted_not_used(copy_of, tmp_path, settings):
    folder, file = copy_of()
    cut(file, 0.0, 8.0)
    out = tmp_path / "P01.nc"
    imported(folder, out)
    trials = usable_trials(read_design(folder).trials, list_recordings(out))
    measured = measure_participant(trials, out, METHOD, settings)
    assert recording_verdicts(measured.conditions)["reason"].tolist() == ["no rest at the end"]
    assert "no_rest_at_end" in set(measured.findings["check"])
    assert measured.findings["file"].iloc[0] == "P01_02_left_imu_1.csv"


def test_two_missing_seconds_exclude_the_recording(copy_of, tmp_path):
    folder, file = copy_of()
    lines = file.read_text(encoding="utf-8").splitlines()
    del lines[4 + 5 * 128 : 4 + 7 * 128]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    tables = imported(folder, tmp_path / "P01.nc")
    row = tables.exclusions.iloc[0]
    assert row[["participant", "trial", "foot", "imu"]].tolist() == ["P01", "02", "left", "imu_1"]
    assert (row["reason"], row["expected"]) == ("data loss: gap too long", "no gap over 0.02 s")
    assert "packet_loss" in set(tables.findings["check"])


def test_a_recording_that_the_lab_excludes_is_not_read(copy_of, tmp_path):
    folder, file = copy_of()
    path = folder / "trials.tsv"
    table = pd.read_csv(path, sep="\t", dtype=str, keep_default_na=False)
    write_study_table(table.assign(exclude="strap came off"), path)
    file.unlink()
    tables = imported(folder, tmp_path / "P01.nc")
    assert tables.exclusions["reason"].tolist() == ["strap came off"]
    assert list_recordings(tmp_path / "P01.nc") == []


def test_saturation_of_the_sensor_itself_is_a_finding(copy_of, tmp_path):
    folder, _ = copy_of(trial="02", imu="imu_1")
    low = {**SENSORS, "imu_1": type(SENSORS["imu_1"])("Opal", "APDM", 3.0, 2000.0)}
    tables = import_participant("P01", read_design(folder), folder, RULES, low, tmp_path / "P01.nc")
    finding = tables.findings[tables.findings["check"] == "saturated"].iloc[0]
    assert finding["place"] == "accelerometer, left foot, imu_1"
    assert finding["expected"] == "readings below ±3 g"
    assert tables.ranges["acc_at_range_percent"].item() > 0


def test_one_foot_alone_gives_the_distance_of_that_foot(measures):
    left = measures.conditions[measures.conditions["foot"] == "left"]
    both = observations(measures.conditions)
    alone = observations(left)
    assert set(alone["n_feet"]) == {1}
    assert len(alone) == len(both)
    exact = 100 * (left["distance_m"].to_numpy() / DISTANCE_M - 1)
    np.testing.assert_allclose(np.sort(alone["error_pct"]), np.sort(exact))


def test_left_and_right_exchanged_change_nothing(measures):
    """The study averages over the feet: which is which does not matter."""
    swapped = measures.conditions.assign(
        foot=measures.conditions["foot"].map({"left": "right", "right": "left"})
    )
    pd.testing.assert_frame_equal(observations(swapped), observations(measures.conditions))


def test_the_sensor_upside_down_gives_the_same_strides(recordings):
    """The trajectory needs no alignment: a sensor turned by half a turn sees the same path."""
    signals, _ = load_signals(recordings[0], "trial_02_right_imu_1")
    turn = np.diag([1.0, -1.0, -1.0])
    turned = Signals(turn @ signals.acc_m_s2, turn @ signals.gyr_rad_s, signals.rate_hz)
    one, other = (foot_estimate(x, METHOD).strides["length_m"] for x in (signals, turned))
    np.testing.assert_allclose(one, other, rtol=1e-6)


def test_a_whole_cohort_is_recovered_from_its_raw_files(tmp_path, monkeypatch):
    """The job of the recovery in small: two people, three trials over 40 m."""
    monkeypatch.syspath_prepend(str(REPOSITORY / "scripts"))
    import imu_design_recovery_cohort

    tree = json.loads(json.dumps(parameters()))
    tree["simulation"]["cohort"]["protocol"].update(n_participants=2, n_walking=1, n_running=2)
    tree["simulation"]["foot"]["course"]["distance_m"] = DISTANCE_M
    sections = ("recording", "sensors", "experiments", "measurement", "model")
    given = {
        "simulation": tree["simulation"],
        **{name: tree["analysis"][name] for name in sections},
    }
    file, output = tmp_path / "parameters.json", tmp_path / "7.parquet"
    file.write_text(json.dumps(given), encoding="utf-8")
    arguments = ["x", "--parameters", str(file), "--seed", "7", "--output", str(output)]
    monkeypatch.setattr(sys, "argv", arguments)
    imu_design_recovery_cohort.main()
    table = pd.read_parquet(output)
    assert len(table) == 2 * (7 + 5 + 5 + 5)
    assert set(table["seed"]) == {7}
    assert table["slope_pct_per_m_s"].notna().all()
