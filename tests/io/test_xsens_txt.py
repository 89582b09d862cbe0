"""Xsens MT Manager TXT: versions, delimiters, orientations, gaps, ticks."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from swaystride.errors import RecordingError
from swaystride.io.reading import read_recording
from swaystride.recording import findings_of

HEADER_4_6 = (
    "// Start Time: Unknown\n// Update Rate: 100.0Hz\n// Filter Profile: human (46.1)\n"
    "// Firmware Version: 4.4.0\n"
)
HEADER_2022 = (
    "// General information: \n//  MT Manager version: 2022.2.0 \n// Device information: \n"
    "//  DeviceId: 00B42D4B\n//  Firmware Version: 4.4.0\n// Coordinate system: ENU\n"
)
DELIMITERS = {"tab": "\t", "comma": ",", "semicolon": ";", "space": " "}
ACC = np.array([[9.61, 0.12, -1.83], [9.62, -0.17, -1.84], [9.64, 0.22, -1.85]])
GYR = np.array([[0.02, 0.001, 0.007], [0.03, -0.002, 0.005], [0.01, 0.003, -0.001]])
ROTATIONS = Rotation.from_rotvec([[0.1, -0.2, 0.3], [0.5, 1.0, -1.5], [0.0, 0.0, 2.0]])
VECTOR_NAMES = [f"{sensor}_{axis}" for sensor in ("Acc", "Gyr") for axis in "XYZ"]


def table(columns: Sequence[str], rows: Sequence[Sequence[object]], delimiter: str = "\t") -> str:
    """Rows as MT Manager prints them: floats with six decimals, None as an empty field."""

    def field(value: object) -> str:
        if value is None:
            return ""
        return f"{value:.6f}" if isinstance(value, float) else str(value)

    lines = [delimiter.join(columns), *(delimiter.join(map(field, row)) for row in rows)]
    return "\n".join(lines) + "\n"


def three_rows(counters: Sequence[object] = ("04097", "04098", "04099")) -> list[list[object]]:
    return [[c, *a, *g] for c, a, g in zip(counters, ACC.tolist(), GYR.tolist(), strict=True)]


def write(path: Path, text: str) -> Path:
    path.write_bytes(text.encode())
    return path


def test_version_4_6_with_rate_in_the_header(tmp_path: Path) -> None:
    text = HEADER_4_6 + table(["PacketCounter", *VECTOR_NAMES], three_rows())
    recording = read_recording(write(tmp_path / "MT46_01-000_00B42D4D.txt", text))
    np.testing.assert_array_equal(recording["acc"].values[0], ACC.T)
    np.testing.assert_array_equal(recording["gyr"].values[0], GYR.T)
    np.testing.assert_allclose(recording["time"].values, [0.0, 0.01, 0.02])
    assert recording.attrs["rate_hz"] == 100.0
    assert recording.attrs["rate_source"] == "header"
    assert recording.attrs["first_packet"] == 4097
    assert recording.attrs["source_file"] == "MT46_01-000_00B42D4D.txt"
    assert recording["sensor"].values.tolist() == ["00B42D4D"]  # from the file name
    assert recording["acc"].attrs["units"] == "m/s^2"
    assert findings_of(recording) == []


@pytest.mark.parametrize("delimiter", DELIMITERS.values(), ids=DELIMITERS)
@pytest.mark.parametrize("empty", [None, "NaN"], ids=["empty", "NaN"])
def test_every_delimiter_and_empty_fields(
    tmp_path: Path, delimiter: str, empty: str | None
) -> None:
    columns = ["PacketCounter", "SampleTimeFine", "Year", "Month", *VECTOR_NAMES]
    rows = [[row[0], empty, empty, empty, *row[1:]] for row in three_rows()]
    text = HEADER_2022 + table(columns, rows, delimiter)
    recording = read_recording(write(tmp_path / "a.txt", text), rate_hz=60.0)
    np.testing.assert_array_equal(recording["acc"].values[0], ACC.T)
    np.testing.assert_array_equal(recording["gyr"].values[0], GYR.T)
    assert recording.attrs["rate_source"] == "argument"
    assert recording.attrs["world_frame"] == "ENU"
    assert recording.attrs["device"] == "00B42D4B"
    assert findings_of(recording) == []


def orientation_rows(form: str) -> tuple[list[str], list[list[float]]]:
    if form == "quaternion":
        return [f"Quat_q{i}" for i in range(4)], ROTATIONS.as_quat(scalar_first=True).tolist()
    if form == "roll_pitch_yaw":
        yaw_pitch_roll = ROTATIONS.as_euler("ZYX", degrees=True)
        return ["Roll", "Pitch", "Yaw"], yaw_pitch_roll[:, ::-1].tolist()
    # Printed by columns: the first three numbers are the x axis of the sensor in the world.
    names = [f"Mat[{row}][{column}]" for column in (1, 2, 3) for row in (1, 2, 3)]
    return names, ROTATIONS.as_matrix().transpose(0, 2, 1).reshape(3, 9).tolist()


@pytest.mark.parametrize("form", ["quaternion", "roll_pitch_yaw", "matrix"])
def test_every_orientation_becomes_the_rotation_from_sensor_to_world(
    tmp_path: Path, form: str
) -> None:
    names, values = orientation_rows(form)
    rows = [[c, *v] for c, v in zip(("7", "8", "9"), values, strict=True)]
    text = HEADER_4_6 + table(["PacketCounter", *names], rows)
    recording = read_recording(write(tmp_path / "a.txt", text))
    assert list(recording.data_vars) == ["quat"]
    found = Rotation.from_quat(recording["quat"].values[0].T, scalar_first=True)
    assert (found.inv() * ROTATIONS).magnitude().max() < 2e-6


def test_an_orientation_row_without_numbers_is_nan(tmp_path: Path) -> None:
    names, values = orientation_rows("matrix")
    rows = [["7", *values[0]], ["8", *[None] * 9], ["9", *values[2]]]
    text = HEADER_4_6 + table(["PacketCounter", *names], rows)
    recording = read_recording(write(tmp_path / "a.txt", text))
    assert np.isnan(recording["quat"].values[0]).any(axis=0).tolist() == [False, True, False]
    assert [finding.check for finding in findings_of(recording)] == ["nan_run"]


def test_missing_gyroscope_and_optional_magnetometer(tmp_path: Path) -> None:
    columns = ["PacketCounter", "Acc_X", "Acc_Y", "Acc_Z", "Mag_X", "Mag_Y", "Mag_Z"]
    rows = [[i, *a, 0.5, -0.25, 1.0] for i, a in enumerate(ACC.tolist())]
    recording = read_recording(write(tmp_path / "a.txt", HEADER_4_6 + table(columns, rows)))
    assert list(recording.data_vars) == ["acc", "mag"]
    assert recording["mag"].attrs["units"] == "a.u."
    np.testing.assert_array_equal(recording["mag"].values[0, :, 0], [0.5, -0.25, 1.0])


def test_lost_packets_and_wrap_around_leave_the_time_axis_uniform(tmp_path: Path) -> None:
    text = HEADER_4_6 + table(["PacketCounter", *VECTOR_NAMES], three_rows((65533, 65534, 2)))
    recording = read_recording(write(tmp_path / "a.txt", text))
    acc = recording["acc"].values[0]
    np.testing.assert_array_equal(acc[:, [0, 1, 5]], ACC.T)
    assert np.isnan(acc[:, 2:5]).all()
    np.testing.assert_allclose(np.diff(recording["time"].values), 0.01)
    (finding,) = findings_of(recording)
    assert (finding.check, finding.severity) == ("packet_loss", "warning")
    assert finding.place == "first at t = 0.020 s, before line 8"
    assert finding.found == "3 of 6 packets lost in 1 gap, the longest 3 packets (0.030 s)"


def test_windows_line_ends_and_byte_order_marks(tmp_path: Path) -> None:
    text = (HEADER_4_6 + table(["PacketCounter", *VECTOR_NAMES], three_rows())).replace(
        "\n", "\r\n"
    )
    for name, encoding in (("a.txt", "utf-8-sig"), ("b.txt", "utf-16")):
        (tmp_path / name).write_bytes(text.encode(encoding))
        recording = read_recording(tmp_path / name)
        np.testing.assert_array_equal(recording["acc"].values[0], ACC.T)


def ticked(ticks: Sequence[object], header: str, counters: Sequence[object] | None = None) -> str:
    counters = counters or range(len(ticks))
    rows = [[c, t, 0.0, 0.1, 9.8] for c, t in zip(counters, ticks, strict=True)]
    names = ["PacketCounter", "SampleTimeFine", "Acc_X", "Acc_Y", "Acc_Z"]
    return header + table(names, rows)


def test_ticks_measure_the_rate_through_their_wrap_and_through_gaps(tmp_path: Path) -> None:
    counters = [0, 1, 5, 6, 9]
    ticks = [(2**32 - 250 + 100 * c) % 2**32 for c in counters]
    path = write(tmp_path / "a.txt", ticked(ticks, HEADER_2022, counters))
    recording = read_recording(path)
    assert recording.attrs["rate_hz"] == pytest.approx(100.0)
    assert recording.attrs["rate_source"] == "time stamps"
    assert recording.sizes["time"] == 10


def test_ticks_that_contradict_the_header_are_a_finding(tmp_path: Path) -> None:
    path = write(tmp_path / "a.txt", ticked(range(0, 5000, 125), HEADER_4_6))
    recording = read_recording(path)
    assert recording.attrs["rate_hz"] == 100.0
    (finding,) = findings_of(recording)
    assert (finding.check, finding.severity, finding.place) == (
        "sampling_rate",
        "warning",
        "line 2",
    )
    assert finding.found == "time stamps at 80 Hz"


def test_ticks_that_run_backwards_are_not_used(tmp_path: Path) -> None:
    path = write(tmp_path / "a.txt", ticked([500, 600, 100, 200], HEADER_4_6))
    (finding,) = findings_of(read_recording(path))
    assert (finding.check, finding.place) == ("sample_time_fine", "line 8")


def test_ticks_stand_in_for_a_missing_packet_counter(tmp_path: Path) -> None:
    names = ["SampleTimeFine", "Acc_X", "Acc_Y", "Acc_Z"]
    rows = [[100 * i, 0.0, 0.1, 9.8] for i in (0, 1, 2, 3, 6)]
    recording = read_recording(write(tmp_path / "a.txt", HEADER_4_6 + table(names, rows)))
    assert recording.sizes["time"] == 7
    assert [finding.check for finding in findings_of(recording)] == ["packet_loss"]


def test_without_counter_or_ticks_lost_packets_cannot_be_seen(tmp_path: Path) -> None:
    text = HEADER_4_6 + table(["Acc_X", "Acc_Y", "Acc_Z"], ACC.tolist())
    recording = read_recording(write(tmp_path / "a.txt", text))
    assert [finding.check for finding in findings_of(recording)] == ["no_packet_counter"]


def test_a_duplicate_packet_may_be_left_out_on_purpose(tmp_path: Path) -> None:
    text = HEADER_4_6 + table(["PacketCounter", *VECTOR_NAMES], three_rows((5, 5, 6)))
    path = write(tmp_path / "a.txt", text)
    recording = read_recording(path, duplicate_packets="keep_first")
    np.testing.assert_array_equal(recording["acc"].values[0], ACC[[0, 2]].T)
    (finding,) = findings_of(recording)
    assert (finding.check, finding.severity, finding.place, finding.found) == (
        "duplicate_packet",
        "warning",
        "first at line 7",
        "5 again; rows left out: 1",
    )


def test_a_last_line_without_line_end_is_a_warning(tmp_path: Path) -> None:
    text = HEADER_4_6 + table(["PacketCounter", *VECTOR_NAMES], three_rows())
    recording = read_recording(write(tmp_path / "a.txt", text[:-3]))
    assert [finding.check for finding in findings_of(recording)] == ["unfinished_last_line"]


def test_units_that_contradict_the_vendor(tmp_path: Path) -> None:
    text = HEADER_4_6 + table(["PacketCounter", *VECTOR_NAMES], three_rows())
    path = write(tmp_path / "a.txt", text)
    assert read_recording(path, units={"acc": "m/s2"})["acc"].values[0, 0, 0] == ACC[0, 0]
    with pytest.raises(RecordingError) as caught:
        read_recording(path, units={"acc": "g"})
    assert str(caught.value) == (
        "a.txt: the argument units contradicts the unit of acc; "
        "expected m/s^2, as the file or its vendor defines it; found g"
    )


def test_the_sensor_argument_labels_the_recording(tmp_path: Path) -> None:
    text = HEADER_4_6 + table(["PacketCounter", *VECTOR_NAMES], three_rows())
    path = write(tmp_path / "a.txt", text)
    assert read_recording(path)["sensor"].values.tolist() == ["sensor"]
    assert read_recording(path, sensor="lumbar")["sensor"].values.tolist() == ["lumbar"]
    with pytest.raises(RecordingError, match="the file holds one sensor"):
        read_recording(path, sensor=["lumbar", "sternum"])
