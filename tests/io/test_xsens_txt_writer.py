"""What the writer prints, the reader reads back."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.errors import RecordingError
from swaystride.io.reading import read_recording
from swaystride.io.xsens_txt_writer import write_xsens_txt
from swaystride.recording import findings_of


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("xsens")


@settings(max_examples=40, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    n=st.integers(2, 200),
    first_packet=st.integers(0, 2**16 - 1),
    share_lost=st.sampled_from([0.0, 0.05, 0.6]),
    rate=st.sampled_from([40.0, 59.9, 100.0, 1000.0]),
)
def test_round_trip_within_the_printed_decimals(
    folder: Path, seed: int, n: int, first_packet: int, share_lost: float, rate: float
) -> None:
    rng = np.random.default_rng(seed)
    acc = rng.normal(scale=2.0, size=(3, n)) + np.array([[9.0], [0.0], [4.0]])
    gyr = rng.normal(scale=1.0, size=(3, n))
    lost = rng.random(n) < share_lost
    lost[[0, -1]] = False
    write_xsens_txt(folder / "a.txt", acc, gyr, rate_hz=rate, first_packet=first_packet, lost=lost)
    recording = read_recording(folder / "a.txt")
    assert recording.attrs["rate_hz"] == rate
    assert recording.attrs["first_packet"] == first_packet
    assert recording.sizes["time"] == n
    for name, truth in (("acc", acc), ("gyr", gyr)):
        found = recording[name].values[0]
        assert np.isnan(found[:, lost]).all()
        np.testing.assert_allclose(found[:, ~lost], truth[:, ~lost], rtol=0, atol=0.5001e-6)
    checks = [finding.check for finding in findings_of(recording)]
    assert checks == (["packet_loss"] if lost.any() else [])


def test_the_layout_of_version_4_6(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    acc = np.array([[0.1, 0.2], [-0.5, -0.25], [9.8066504, 9.75]])
    write_xsens_txt(
        path,
        acc,
        -acc / 10,
        rate_hz=100,
        first_packet=65535,
        device_id="00B42D4D",
        comments=["simulated, not a measurement", "two\nlines"],
    )
    assert path.read_bytes().decode().split("\n") == [
        "// Start Time: Unknown",
        "// Update Rate: 100.0Hz",
        "// Filter Profile: human (46.1)",
        "// Firmware Version: 4.4.0",
        "// DeviceId: 00B42D4D",
        "// Comment: simulated, not a measurement",
        "// Comment: two lines",
        "PacketCounter\tSampleTimeFine\tAcc_X\tAcc_Y\tAcc_Z\tGyr_X\tGyr_Y\tGyr_Z",
        "65535\t\t0.100000\t-0.500000\t9.806650\t-0.010000\t0.050000\t-0.980665",
        "00000\t\t0.200000\t-0.250000\t9.750000\t-0.020000\t0.025000\t-0.975000",
        "",
    ]
    recording = read_recording(path)
    assert recording.attrs["comment"] == "simulated, not a measurement; two lines"
    assert recording.attrs["device"] == "00B42D4D"


def test_a_sample_without_a_number_is_printed_as_nan(tmp_path: Path) -> None:
    acc = np.full((3, 4), 5.7)
    acc[1, 2] = np.nan
    write_xsens_txt(tmp_path / "a.txt", acc, acc / 10, rate_hz=50, first_packet=0)
    assert "\t5.700000\tNaN\t5.700000\t" in (tmp_path / "a.txt").read_text()
    np.testing.assert_array_equal(read_recording(tmp_path / "a.txt")["acc"].values[0], acc)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"gyr_rad_s": np.zeros((3, 5))}, "disagree in shape"),
        ({"acc_m_s2": np.zeros(4)}, "disagree in shape"),
        ({"lost": [False]}, "disagree in shape"),
        ({"lost": [True] * 4}, "no packet to write"),
        ({"rate_hz": 59.94}, "the rate does not fit the header"),
        ({"rate_hz": 0.0}, "the rate does not fit the header"),
    ],
)
def test_what_cannot_be_written(tmp_path: Path, change: dict[str, object], message: str) -> None:
    arguments = {
        "acc_m_s2": np.zeros((3, 4)),
        "gyr_rad_s": np.zeros((3, 4)),
        "rate_hz": 100.0,
        "first_packet": 0,
    }
    with pytest.raises(RecordingError, match=message):
        write_xsens_txt(tmp_path / "a.txt", **(arguments | change))  # type: ignore[arg-type]
    assert not (tmp_path / "a.txt").exists()
