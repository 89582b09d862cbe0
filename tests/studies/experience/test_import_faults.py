"""What a lab gets to read when a run is not what it should be, and what remains of the run."""

import re

import numpy as np
import pandas as pd
import pytest

from swaystride.errors import DesignError, RecordingError, SwaystrideError

RUN = "P01_01"
WARM_UP_S = 6.0


def without(*labels):
    def change(recording):
        return recording.sel(sensor=[s for s in recording["sensor"].values if s not in labels])

    return change


def late(label, samples):
    def change(recording):
        out = recording.copy(deep=True)
        row = list(out["sensor"].values).index(label)
        for signal in ("acc", "gyr"):
            out[signal].values[row] = np.roll(out[signal].values[row], samples, axis=1)
        return out

    return change


def turned_over(label):
    """The sensor hangs head down: x and z point the other way."""

    def change(recording):
        out = recording.copy(deep=True)
        row = list(out["sensor"].values).index(label)
        for signal in ("acc", "gyr"):
            out[signal].values[row] *= np.array([-1.0, 1.0, -1.0])[:, None]
        return out

    return change


def test_a_whole_run_is_imported_without_exclusion(whole_lab):
    findings = pd.read_csv(whole_lab.folder / "findings.csv")
    assert pd.read_csv(whole_lab.folder / "exclusions.csv").empty
    assert set(findings["check"]) <= {"clipped", "main_axis_weak", "main_axis_not_horizontal"}


def test_without_the_head_its_measures_are_missing_and_the_rest_stays(lab, whole_lab):
    lab.change_sensors(".h5", without("Head"))
    findings, exclusions, summary = lab.imported()
    assert exclusions.empty
    assert summary["missing_sensors"] == ["head"]
    (row,) = findings[findings["check"] == "sensor_missing"].to_dict("records")
    assert (row["file"], row["place"]) == ("P01/P01_01.h5", "Head")
    one, all_ = (own.measured("printed")[0]["runs"].iloc[0] for own in (lab, whole_lab))
    assert np.isnan(one["peak_head_g"])
    assert np.isnan(one["attenuation_shank_head"])
    assert one["peak_tibial_g"] == pytest.approx(all_["peak_tibial_g"], rel=1e-6)


@pytest.mark.parametrize("label", ["Right Foot", "Lumbar"])
def test_without_a_sensor_of_the_events_the_run_is_left_out(lab, label):
    lab.change_sensors(".h5", without(label))
    _, exclusions, summary = lab.imported()
    assert summary["excluded"]
    assert exclusions["reason"].tolist() == ["no events without this sensor"]
    assert exclusions["found"].tolist() == [f"{label}: no samples of it"]
    tables, findings = lab.measured("printed")
    assert all(table.empty for table in tables.values())
    assert findings.empty


def test_late_shank_is_left_out_with_its_pair(lab):
    lab.change_sensors(".h5", late("Left Shank", 60))
    findings, exclusions, summary = lab.imported()
    assert exclusions.empty
    assert summary["missing_sensors"] == ["shank_right", "shank_left"]
    (row,) = findings[findings["check"] == "sensors_out_of_step"].to_dict("records")
    assert row["place"] == "Left Shank beside Right Shank"
    assert float(re.match(r"([+-]\d+) ms", row["found"])[1]) == pytest.approx(120, abs=15)


def test_late_head_is_left_out_alone(lab):
    lab.change_sensors(".h5", late("Head", 50))
    _, exclusions, summary = lab.imported()
    assert exclusions.empty
    assert summary["missing_sensors"] == ["head"]


def test_with_a_late_foot_there_are_no_events(lab):
    lab.change_sensors(".h5", late("Right Foot", 60))
    _, exclusions, summary = lab.imported()
    assert summary["excluded"]
    assert exclusions["reason"].tolist() == ["sensors out of step"]
    assert exclusions["found"].str.startswith("Left Foot beside Right Foot").all()


@pytest.mark.parametrize("label", ["Left Thigh", "Head"])
def test_a_sensor_turned_over_is_an_error_with_its_label(lab, label):
    for end in ("_standing.h5", "_walking.h5", ".h5"):
        lab.change_sensors(end, turned_over(label))
    with pytest.raises(RecordingError, match=rf"P01_01_standing\.h5.*{label}.*not mounted as said"):
        lab.imported()


def test_a_clipped_shank_spoils_the_peaks_of_its_own_steps_only(lab, whole_lab):
    """A range that the highest 5 % of the steps of one leg exceed."""
    whole = whole_lab.measured("printed")[0]["strides"]

    def clip(recording):
        out = recording.copy(deep=True)
        row = list(out["sensor"].values).index("Right Shank")
        acc = out["acc"].values[row]
        size = np.abs(acc)
        axis = int(np.argmax(size.max(axis=1)))
        # highest value of each 0.7 s: about one a stride
        n = size.shape[1] // 350
        peaks = size[axis, : 350 * n].reshape(n, 350).max(axis=1)
        level = float(np.sort(peaks)[-8])
        acc[:] = np.clip(acc, -level, level)
        return out

    lab.change_sensors(".h5", clip)
    findings, exclusions, _ = lab.imported()
    assert exclusions.empty
    (row,) = findings[
        (findings["check"] == "clipped") & (findings["place"] == "Right Shank")
    ].to_dict("records")
    assert int(row["found"].split()[0]) >= 5
    strides = lab.measured("printed")[0]["strides"]
    lost = strides["peak_tibial_g"].isna() & whole["peak_tibial_g"].notna()
    assert 3 <= lost.sum() <= 12
    assert strides.loc[lost, "side"].eq("right").all()
    assert strides["peak_head_g"].to_numpy() == pytest.approx(
        whole["peak_head_g"].to_numpy(), nan_ok=True
    )
    kept = ~lost & whole["peak_tibial_g"].notna()
    assert strides.loc[kept, "peak_tibial_g"].to_numpy() == pytest.approx(
        whole.loc[kept, "peak_tibial_g"].to_numpy(), rel=0.02
    )


@pytest.mark.parametrize("kind", ["standing", "walking"])
def test_a_run_without_calibration_is_left_out(lab, kind):
    lab.change_table(lab.folder / "runs.tsv", lambda runs: runs.assign(**{kind: ""}))
    _, exclusions, summary = lab.imported()
    assert summary["excluded"]
    expected = {
        "standing": "no calibration in quiet standing",
        "walking": "no calibration in walking",
    }
    assert exclusions["reason"].tolist() == [expected[kind]]


def test_a_calibration_file_that_is_not_there_is_an_error(lab):
    lab.file("_walking.h5").unlink()
    with pytest.raises(RecordingError, match=r"P01/P01_01_walking\.h5: no such file"):
        lab.imported()


def test_a_run_shorter_than_the_warm_up_is_left_out(lab):
    lab.change_sensors(".h5", lambda recording: recording.isel(time=slice(int(5.0 * 500))))
    _, exclusions, _ = lab.imported()
    assert exclusions["reason"].tolist() == ["the run is hardly longer than the warm-up"]
    assert exclusions["found"].tolist() == ["5.0 s"]


def test_two_runs_with_one_name_are_an_error_before_anything_is_read(lab):
    lab.change_table(lab.folder / "runs.tsv", lambda runs: pd.concat([runs, runs]))
    with pytest.raises(DesignError, match=r"runs\.tsv: line 3: row stands twice.*P01.*01"):
        lab.imported()


def test_two_runs_of_one_file_are_an_error(lab):
    lab.change_table(lab.folder / "runs.tsv", lambda runs: pd.concat([runs, runs.assign(run="02")]))
    with pytest.raises(DesignError, match=r"two runs name the same file \(imu\)"):
        lab.imported()


def test_a_sensor_that_the_lab_does_not_trust_is_not_used(lab):
    def loose(events):
        row = {"start_s": "0", "stop_s": "", "event": "poor_attachment", "sensor": "Head"}
        return pd.concat([events, pd.DataFrame([row])])

    lab.change_table(lab.file("_events.tsv"), loose)
    findings, _, summary = lab.imported()
    assert summary["missing_sensors"] == ["head"]
    assert "none used from 0.0 s to 50.0 s" in set(findings["found"])


def test_lost_samples_and_what_the_lab_says_are_no_steady_running(lab):
    def lost(events):
        rows = [
            {"start_s": "36", "stop_s": "38", "event": "data_loss", "sensor": ""},
            {"start_s": "44", "stop_s": "", "event": "stop", "sensor": ""},
        ]
        return pd.concat([events, pd.DataFrame(rows)])

    lab.change_table(lab.file("_events.tsv"), lost)
    lab.imported()
    strides = lab.measured("printed")[0]["strides"]
    for begin, end in ((0.0, WARM_UP_S), (35.0, 39.0), (43.0, 45.0)):
        inside = (strides["start_s"] < end) & (strides["stop_s"] > begin)
        assert inside.any()
        assert not strides.loc[inside, "is_steady"].any()
    assert strides.loc[strides["start_s"].between(39.1, 42.0), "is_steady"].all()


def test_without_a_chest_strap_there_is_no_heart_rate_and_a_finding(lab):
    lab.change_table(lab.folder / "runs.tsv", lambda runs: runs.assign(ecg=""))
    findings, exclusions, _ = lab.imported()
    assert exclusions.empty
    assert "no_heart_rate" in set(findings["check"])
    assert np.isnan(lab.measured("printed")[0]["runs"]["heart_rate_bpm"].iloc[0])


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        (lambda events: events.assign(start_s="forty"), "cell does not fit its column"),
        (lambda events: events.assign(start_s="30", stop_s="20"), "stops before it starts"),
    ],
)
def test_a_table_of_events_that_cannot_be(lab, change, problem):
    lab.change_table(lab.file("_events.tsv"), change)
    with pytest.raises(SwaystrideError, match=problem):
        lab.imported()


def test_a_run_that_the_lab_leaves_out_is_not_read(lab):
    lab.file(".h5").unlink()
    lab.change_table(lab.folder / "runs.tsv", lambda runs: runs.assign(exclude="rain"))
    _, exclusions, summary = lab.imported()
    assert exclusions["reason"].tolist() == ["rain"]
    assert summary["excluded"]
