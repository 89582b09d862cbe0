"""Text under a line with the acquisition frequency."""

from pathlib import Path

import numpy as np
import pytest

from swaystride.errors import RecordingError
from swaystride.io.reading import read_recording
from swaystride.recording import findings_of

UNITS = {"acc": "m/s^2", "gyr": "rad/s", "mag": "a.u."}
COLUMNS = [
    "PacketCounter",
    *(f"{sensor}_{axis}" for sensor in ("Acc", "Gyr", "Mag") for axis in "XYZ"),
]


def write(path: Path, title: str = "Acquisition frequency: 100 Hz", n: int = 6) -> Path:
    rows = [[float(2 * i), 8.2, 0.1, 5.9, -0.004, 0.005, 0.0, -0.3, 0.07, -0.8] for i in range(n)]
    lines = [title, "\t".join(COLUMNS), *("\t".join(map(str, row)) for row in rows)]
    path.write_text("\n".join(lines) + "\n")
    return path


def test_float_counters_find_gaps(tmp_path: Path) -> None:
    recording = read_recording(write(tmp_path / "1-1_lb.txt"), units=UNITS, sensor="lumbar")
    assert recording.attrs["rate_hz"] == 100.0
    assert recording["sensor"].values.tolist() == ["lumbar"]
    assert recording["mag"].attrs["units"] == "a.u."
    acc = recording["acc"].values[0]
    np.testing.assert_array_equal(acc[:, ::2], np.tile([[8.2], [0.1], [5.9]], 6))
    assert np.isnan(acc[:, 1::2]).all()
    assert findings_of(recording)[0].found.startswith("5 of 11 packets lost in 5 gaps")


def test_units_are_converted(tmp_path: Path) -> None:
    units = {"acc": "m/s^2", "gyr": "deg/s", "mag": "uT"}
    recording = read_recording(write(tmp_path / "a.txt"), units=units)
    assert recording["gyr"].values[0, 0, 0] == pytest.approx(np.radians(-0.004))
    assert recording["mag"].values[0, 0, 0] == pytest.approx(-0.3e-6)
    assert recording["mag"].attrs["units"] == "T"


def test_units_are_required(tmp_path: Path) -> None:
    with pytest.raises(RecordingError) as caught:
        read_recording(write(tmp_path / "a.txt"), units={"acc": "m/s^2"})
    assert str(caught.value) == (
        "a.txt: the file does not state its units; expected the argument units with gyr, mag, "
        "such as {'gyr': 'rad/s', 'mag': 'T'}; found units of acc"
    )


def test_a_frequency_that_cannot_be_read_must_be_given(tmp_path: Path) -> None:
    path = write(tmp_path / "a.txt", title="Acquisition frequency: unknown")
    with pytest.raises(RecordingError, match="no sampling rate; expected line 1 or the argument"):
        read_recording(path, units=UNITS)
    assert read_recording(path, units=UNITS, rate_hz=50.0).attrs["rate_hz"] == 50.0


def test_a_frequency_that_contradicts_the_argument(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="line 1: the argument rate_hz contradicts the file"):
        read_recording(write(tmp_path / "a.txt"), units=UNITS, rate_hz=128.0)


def test_without_counter_lost_packets_cannot_be_seen(tmp_path: Path) -> None:
    path = write(tmp_path / "a.txt")
    path.write_text(path.read_text().replace("PacketCounter", "Row"))
    recording = read_recording(path, units=UNITS)
    assert [finding.check for finding in findings_of(recording)] == ["no_packet_counter"]
    assert recording.sizes["time"] == 6


def test_a_title_alone(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text("Acquisition frequency: 100 Hz\n")
    with pytest.raises(RecordingError, match=r"a\.txt: the file ends before its column row"):
        read_recording(path, units=UNITS)
