"""What the writer prints, the reader reads back."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.errors import RecordingError
from swaystride.io.apdm_csv_writer import write_apdm_csv
from swaystride.io.reading import read_recording
from swaystride.recording import findings_of, make_recording


def recording_of(acc, gyr, rate_hz=128.0, sensors=("Left Foot",)):
    return make_recording(
        rate_hz=rate_hz,
        rate_source="argument",
        sensors=list(sensors),
        acc_m_s2=acc,
        gyr_rad_s=gyr,
    )


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("apdm")


@settings(max_examples=40, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    n=st.integers(60, 300),
    share_lost=st.sampled_from([0.0, 0.05, 0.2]),
    rate=st.sampled_from([20.0, 100.0, 128.0, 200.0]),
    sensors=st.sampled_from([("Left Foot",), ("Left Foot", "Right Foot")]),
)
def test_round_trip_within_the_printed_decimals(folder, seed, n, share_lost, rate, sensors):
    rng = np.random.default_rng(seed)
    acc, gyr = rng.normal(size=(2, len(sensors), 3, n)) * [[[[20.0]]], [[[5.0]]]]
    lost = rng.random(n) < share_lost
    lost[[0, -1]] = False
    acc[..., lost] = gyr[..., lost] = np.nan
    write_apdm_csv(folder / "a.csv", recording_of(acc, gyr, rate, sensors), test_name="walk")
    found = read_recording(folder / "a.csv")
    assert found.attrs["rate_hz"] == rate
    assert found.attrs["rate_source"] == "header"
    assert found.attrs["device"] == "APDM Opal"
    assert found["sensor"].values.tolist() == list(sensors)
    for name, truth in (("acc", acc), ("gyr", gyr)):
        np.testing.assert_allclose(found[name].values, truth, rtol=0, atol=0.5001e-6)
    checks = {finding.check for finding in findings_of(found)}
    assert ("packet_loss" in checks) == bool(lost.any())


def test_the_layout_is_the_older_one(tmp_path):
    one = np.array([[[0.0, 1.0], [0.5, -0.5], [9.8, 9.8]]])
    write_apdm_csv(tmp_path / "a.csv", recording_of(one, one / 10), test_name="not a measurement")
    assert (tmp_path / "a.csv").read_text().splitlines() == [
        "Test Name:,not a measurement,,,,,",
        "Sample Rate:,128,Hz,,,,",
        "Time,Left Foot/Acceleration/X,Left Foot/Acceleration/Y,Left Foot/Acceleration/Z,"
        "Left Foot/Angular Velocity/X,Left Foot/Angular Velocity/Y,Left Foot/Angular Velocity/Z",
        "s,m/s^2,m/s^2,m/s^2,rad/s,rad/s,rad/s",
        "0.000000,0.000000,0.500000,9.800000,0.000000,0.050000,0.980000",
        "0.007812,1.000000,-0.500000,9.800000,0.100000,-0.050000,0.980000",
    ]


@pytest.mark.parametrize(("label", "name"), [("a,b", "walk"), ("foot", "walk\n"), ("foot", 'a"')])
def test_names_that_do_not_fit_are_refused(tmp_path, label, name):
    recording = recording_of(np.zeros((1, 3, 4)), np.zeros((1, 3, 4)), sensors=(label,))
    with pytest.raises(RecordingError, match=r"a\.csv: a name does not fit a CSV field"):
        write_apdm_csv(tmp_path / "a.csv", recording, test_name=name)


def test_both_signals_are_needed(tmp_path):
    recording = recording_of(np.zeros((1, 3, 4)), None)
    with pytest.raises(RecordingError, match=r"a\.csv: a signal is missing \(gyr\)"):
        write_apdm_csv(tmp_path / "a.csv", recording, test_name="walk")
