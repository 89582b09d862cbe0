"""Import of standing trials: exclusions by rule, errors by file, gaps that are filled."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from swaystride.errors import RecordingError
from swaystride.io.xsens_txt_writer import write_xsens_txt
from swaystride.recording import make_recording
from swaystride.sway.participant_import import (
    ImportFiles,
    import_participant,
    read_quality_tables,
)
from swaystride.sway.trial_import import RecordingRules, import_trials, unusable
from swaystride.sway.trial_measures import (
    TRIAL_MEASURES,
    MeasurementMethod,
    measure_participant,
    measure_trial,
)
from swaystride.units import GRAVITY_M_S2

RULES = RecordingRules(
    rate_hz=None,
    units=None,
    duplicate_packets="error",
    shortest_duration_s=29.0,
    longest_duration_s=31.0,
    longest_gap_s=0.25,
)
METHOD = MeasurementMethod(
    sensor_forward="x",
    sensor_left="y",
    sensor_up="z",
    fusion="vqf",
    tau_acc_s=3.0,
    level_sensor=False,
    remove_mean_rate=True,
    filter_order=2,
    cutoff_hz=2.0,
    filter_direction="zero_lag",
    pad_s=3.0,
)


def standing(duration_s=30.0, rate_hz=100.0, lost=slice(0, 0)):
    """A sensor that leans by 1.5° at 0.3 Hz."""
    time_s = np.arange(round(duration_s * rate_hz)) / rate_hz
    lean = np.deg2rad(1.5) * np.sin(2 * np.pi * 0.3 * time_s)
    rate = np.deg2rad(1.5) * 2 * np.pi * 0.3 * np.cos(2 * np.pi * 0.3 * time_s)
    acc = GRAVITY_M_S2 * np.stack([-np.sin(lean), 0 * lean, np.cos(lean)])
    gyr = np.stack([0 * lean, rate, 0 * lean])
    acc[:, lost] = gyr[:, lost] = np.nan
    return make_recording(
        rate_hz=rate_hz,
        rate_source="header",
        sensors=["lumbar"],
        acc_m_s2=acc[None],
        gyr_rad_s=gyr[None],
    )


@pytest.mark.parametrize(
    ("recording", "reason"),
    [
        (standing(), None),
        (standing(29.01), None),
        (standing(28.9), "data loss: trial too short"),
        (standing(31.2), "trial too long"),
        (standing(lost=slice(1000, 1025)), None),
        (standing(lost=slice(1000, 1026)), "data loss: gap too long"),
    ],
)
def test_a_trial_is_excluded_by_duration_and_by_its_longest_gap(recording, reason):
    verdict = unusable(recording, RULES)
    assert (verdict and verdict["reason"]) == reason


def test_a_short_gap_hardly_changes_the_measures():
    whole, gappy = (
        measure_trial(standing(), METHOD),
        measure_trial(standing(lost=slice(900, 910)), METHOD),
    )
    assert gappy["samples_filled"] == 10
    assert whole["samples_filled"] == 0
    for name in ("ap_rms", "phi_mv", "path_length"):
        assert gappy[name] == pytest.approx(whole[name], rel=2e-3)


def test_a_constant_gyroscope_bias_is_removed():
    recording = standing()
    biased = recording.copy(deep=True)
    biased["gyr"] += np.deg2rad(0.5)
    clean, with_bias = measure_trial(recording, METHOD), measure_trial(biased, METHOD)
    assert with_bias["ap_rms"] == pytest.approx(clean["ap_rms"], rel=1e-6)


def spoilt(change):
    """A standing trial with one thing wrong."""
    recording = standing().assign_attrs(source_file="P01_01.txt")
    change(recording)
    return recording


def turned(recording):
    recording["acc"][0, [0, 2]] = recording["acc"].to_numpy()[0, [2, 0]]


def upside_down(recording):
    recording["acc"][0, 2] = -recording["acc"][0, 2]


def in_degrees(recording):
    recording["gyr"][:] = np.rad2deg(recording["gyr"].to_numpy()) * 2


def dead(recording):
    recording["gyr"][:] = 0.01


@pytest.mark.parametrize(
    ("change", "line"),
    [
        (turned, "P01_01.txt: the sensor is not worn as configured; .* along the forward axis"),
        (upside_down, "found it 180° away .* along the negative up axis"),
        (in_degrees, "too large for standing; .* are these degrees per second"),
        (dead, "the gyroscope never changes"),
    ],
)
def test_a_sensor_that_cannot_be_right_is_refused(change, line):
    with pytest.raises(RecordingError, match=line):
        measure_trial(spoilt(change), METHOD)


def test_a_missing_file_stops_the_unit_with_its_name(tmp_path):
    with pytest.raises(RecordingError, match=r"^P01/P01_03.txt: no such file"):
        import_trials({"trial_03": "P01/P01_03.txt"}, tmp_path, RULES, {})


def test_the_labs_own_exclusion_is_kept_and_the_file_not_opened(tmp_path):
    imported = import_trials(
        {"trial_03": "P01/absent.txt"}, tmp_path, RULES, {"trial_03": "stepped off the pad"}
    )
    assert not imported.recordings
    assert imported.exclusions["reason"].tolist() == ["stepped off the pad"]


def test_a_duplicate_packet_is_an_error_or_kept_once_with_a_finding(tmp_path):
    signal = standing()
    path = tmp_path / "P01_01.txt"
    write_xsens_txt(
        path,
        signal["acc"].to_numpy()[0],
        signal["gyr"].to_numpy()[0],
        rate_hz=100.0,
        first_packet=7,
    )
    lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    path.write_text("".join([*lines[:50], lines[49], *lines[50:]]), encoding="utf-8")
    files = {"trial_01": Path("P01_01.txt")}
    with pytest.raises(RecordingError, match="duplicate packet"):
        import_trials(files, tmp_path, RULES, {})
    kept = import_trials(files, tmp_path, replace(RULES, duplicate_packets="keep_first"), {})
    assert kept.recordings["trial_01"].sizes["time"] == 3000
    assert kept.findings["check"].tolist() == ["duplicate_packet"]


def write_trial(path, n_lost=0):
    """A raw file of 30 s; the last packets may be lost."""
    recording = standing()
    acc, gyr = recording["acc"].to_numpy()[0], recording["gyr"].to_numpy()[0]
    n = acc.shape[1] - n_lost
    path.parent.mkdir(exist_ok=True)
    write_xsens_txt(path, acc[:, :n], gyr[:, :n], rate_hz=100.0, first_packet=0)


def test_a_participant_goes_from_a_table_of_trials_to_measures(tmp_path):
    """Own rows only, the lab's reason, an exclusion by rule, and one row per usable trial."""
    trials = pd.DataFrame(
        [
            ("P01", "b", "P01/b.txt", ""),
            ("P02", "b", "P02/not_there.txt", ""),
            ("P01", "a", "P01/a.txt", ""),
            ("P01", "c", "P01/c.txt", ""),
            ("P01", "d", "P01/not_there.txt", "fell ill"),
        ],
        columns=["participant", "trial", "file", "exclude"],
    )
    for name, n_lost in (("a", 0), ("b", 0), ("c", 500)):
        write_trial(tmp_path / "P01" / f"{name}.txt", n_lost)
    files = ImportFiles(tmp_path / "P01.nc", tmp_path / "f" / "P01.csv", tmp_path / "e" / "P01.csv")
    for file in (files.findings, files.exclusions):
        file.parent.mkdir()
    imported = import_participant("P01", trials, tmp_path, RULES, files)
    assert imported.summary == "4 trials, 2 usable, 2 excluded, 0 findings"
    exclusions = read_quality_tables(tmp_path / "e", ["P01"])
    assert exclusions[["participant", "trial"]].to_numpy().tolist() == [["P01", "c"], ["P01", "d"]]
    assert exclusions["reason"].tolist() == ["data loss: trial too short", "fell ill"]
    assert read_quality_tables(tmp_path / "f", ["P01"]).empty

    measures = measure_participant("P01", files.recordings, METHOD)
    assert list(measures.columns) == ["participant", "trial", *TRIAL_MEASURES]
    assert measures["trial"].tolist() == ["a", "b"]
    expected = measure_trial(imported.recordings["a"], METHOD)
    assert measures["phi_rms"].tolist() == pytest.approx([expected["phi_rms"]] * 2, rel=1e-5)


def test_a_participant_without_usable_trials_has_no_measures(tmp_path):
    trials = pd.DataFrame(
        [("P01", "a", "a.txt", "fell ill")], columns=["participant", "trial", "file", "exclude"]
    )
    files = ImportFiles(tmp_path / "P01.nc", tmp_path / "f.csv", tmp_path / "e.csv")
    assert not import_participant("P01", trials, tmp_path, RULES, files).recordings
    assert measure_participant("P01", files.recordings, METHOD).empty
