"""APDM CSV: both layouts."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from swaystride.errors import RecordingError
from swaystride.io.apdm_csv import barometer_kpa_from_bits
from swaystride.io.reading import read_recording
from swaystride.recording import findings_of

LABELS = ("Lumbar", "Left Foot")
QUANTITIES = {
    "Acceleration": ("XYZ", "m/s^2"),
    "Angular Velocity": ("XYZ", "rad/s"),
    "Magnetic Field": ("XYZ", "uT"),
    "Orientation": (("Scalar", "X", "Y", "Z"), ""),
    "Temperature": (("Scalar",), "deg C"),
}
ACC = {"Lumbar": (9.7, 0.2, -0.1), "Left Foot": (0.1, -9.6, 1.0)}
GYR, MAG, QUAT = (0.1, -0.2, 0.3), (30.0, -10.0, 5.0), (0.5, -0.5, 0.5, 0.5)


def with_units(path: Path, samples: Sequence[int], rate: str = "128", acc_unit: str = "m/s^2",
               time_unit: str = "s") -> Path:  # fmt: skip
    names, units = ["Time"], [time_unit]
    for label in LABELS:
        for quantity, (components, unit) in QUANTITIES.items():
            names += [f"{label}/{quantity}/{component}" for component in components]
            units += [acc_unit if quantity == "Acceleration" else unit] * len(components)
    rows = [
        [0.0074 + sample / 128, *(v for la in LABELS for v in (*ACC[la], *GYR, *MAG, *QUAT, 22.5))]
        for sample in samples
    ]
    head = [["Test Name:", "Quiet standing"], ["Sample Rate:", rate, "Hz"]]
    commas = [""] * (len(names) - 3)
    lines = [[*head[0], "", *commas], [*head[1], *commas], names, units]
    text = "\n".join(",".join(map(str, fields)) for fields in [*lines, *rows])
    path.write_text(text + "\n")
    return path


def format_7(path: Path, samples: Sequence[int], labels: Sequence[str] = LABELS) -> Path:
    ids = [str(5700 + i) for i in range(len(labels))]
    quantities = ["Accelerometer", "", "", "Gyroscope", "", "", "Magnetometer", "", "", "Barometer"]
    lines = [
        ["Format=7", *(f for i, la in zip(ids, labels, strict=True)
                       for f in (i, "", "", la, *[""] * 10))],
        ["Time", *[*quantities, "Orientation", "", "", ""] * len(labels)],
        ["", *[*"XYZXYZXYZ", "", *"SXYZ"] * len(labels)],
    ]  # fmt: skip
    for sample in samples:
        fields = [str(1550879504438281 + int(sample * 1e6 / 128))]
        for acc in list(ACC.values())[: len(labels)]:
            fields += [f"{v:.6f}" for v in (*acc, *GYR, *MAG)]
            fields += ["4636858284341460992.000000", *(f"{v:.6f}" for v in QUAT)]
        lines.append(fields)
    path.write_text("\n".join(map(",".join, lines)) + "\n")
    return path


@pytest.mark.parametrize("write", [with_units, format_7])
def test_several_sensors_become_a_dimension(tmp_path: Path, write: object) -> None:
    recording = read_recording(write(tmp_path / "a.csv", range(40)))  # type: ignore[operator]
    assert recording["sensor"].values.tolist() == list(LABELS)
    for label in LABELS:
        one = recording.sel(sensor=label)
        np.testing.assert_array_equal(one["acc"].values.T, np.tile(ACC[label], (40, 1)))
        np.testing.assert_array_equal(one["gyr"].values.T, np.tile(GYR, (40, 1)))
        np.testing.assert_allclose(one["mag"].values.T, np.tile(MAG, (40, 1)) * 1e-6)
        np.testing.assert_array_equal(one["quat"].values.T, np.tile(QUAT, (40, 1)))
    assert recording.attrs["rate_hz"] == pytest.approx(128.0, rel=1e-5)
    assert findings_of(recording) == []


def test_the_rate_is_read_or_measured(tmp_path: Path) -> None:
    assert read_recording(with_units(tmp_path / "a.csv", range(9))).attrs["rate_source"] == "header"
    measured = read_recording(format_7(tmp_path / "b.csv", range(9)))
    assert measured.attrs["rate_source"] == "time stamps"


@pytest.mark.parametrize("write", [with_units, format_7])
def test_gaps_are_found_in_the_time_stamps(tmp_path: Path, write: object) -> None:
    samples = [0, 1, 2, 3, 7, 8, 9]
    recording = read_recording(write(tmp_path / "a.csv", samples))  # type: ignore[operator]
    there = np.isfinite(recording["acc"].values).all(axis=(0, 1))
    assert np.flatnonzero(there).tolist() == samples
    (finding,) = findings_of(recording)
    assert finding.found == "3 of 10 packets lost in 1 gap, the longest 3 packets (0.023 s)"


@pytest.mark.parametrize("write", [with_units, format_7])
def test_sensors_are_selected_by_label(tmp_path: Path, write: object) -> None:
    path = write(tmp_path / "a.csv", range(5))  # type: ignore[operator]
    recording = read_recording(path, sensor="Left Foot")
    assert recording["sensor"].values.tolist() == ["Left Foot"]
    np.testing.assert_array_equal(recording["acc"].values[0, :, 0], ACC["Left Foot"])
    with pytest.raises(RecordingError) as caught:
        read_recording(path, sensor="Sternum")
    assert str(caught.value) == (
        "a.csv: no such sensor; expected one of Lumbar, Left Foot; found 'Sternum'"
    )


def test_units_come_from_the_file(tmp_path: Path) -> None:
    path = with_units(tmp_path / "a.csv", range(5), acc_unit="mg", time_unit="s")
    recording = read_recording(path, units={"acc": "mg"})
    assert recording["acc"].values[0, 0, 0] == pytest.approx(9.7e-3 * 9.80665)
    with pytest.raises(RecordingError, match="the argument units contradicts the unit of acc"):
        read_recording(path, units={"acc": "g"})


def test_a_rate_that_contradicts_the_time_stamps_is_a_finding(tmp_path: Path) -> None:
    (finding,) = findings_of(read_recording(with_units(tmp_path / "a.csv", range(50), rate="100")))
    assert (finding.check, finding.severity) == ("sampling_rate", "warning")
    assert finding.found == "time stamps at 128 Hz"


def test_a_rate_that_contradicts_the_argument(tmp_path: Path) -> None:
    for path in (
        with_units(tmp_path / "a.csv", range(50)),
        format_7(tmp_path / "b.csv", range(50)),
    ):
        with pytest.raises(RecordingError, match="the argument rate_hz contradicts the file"):
            read_recording(path, rate_hz=100.0)


def test_labels_that_repeat_are_replaced_by_ids(tmp_path: Path) -> None:
    recording = read_recording(format_7(tmp_path / "a.csv", range(3), labels=["Foot", "Foot"]))
    assert recording["sensor"].values.tolist() == ["5700", "5701"]


def edit(path: Path, old: str, new: str) -> Path:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    return path


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("Format=7", "Format=8", "line 1: unknown version of APDM CSV; expected Format=7"),
        ("Barometer", "Pressure", "line 2, column 11: the header is not that of Format=7"),
        (",S,X", ",W,X", "line 3, column 12: the header is not that of Format=7"),
        ("1550879504438281,", ",", "line 4: Time: no time stamp"),
        ("1550879504461718,", "1e300,", "almost every sample is missing"),
        ("1550879504446093,", "1550879504438281,", "line 5: Time: time stamps do not advance"),
    ],
)
def test_damage_to_format_7(tmp_path: Path, old: str, new: str, message: str) -> None:
    path = edit(format_7(tmp_path / "a.csv", range(4)), old, new)
    with pytest.raises(RecordingError) as caught:
        read_recording(path)
    assert str(caught.value).startswith(f"a.csv: {message}")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("\nTime,", "\nClock,", "no column row; expected a row that begins with Time"),
        ("\ns,m/s^2", "\n0.1,9.8", "line 4: no row of units"),
        ("s,m/s^2,m/s^2", "s,m/s^2,g", "line 4: columns of one quantity differ in unit (Lumbar/A"),
        ("uT,uT,uT", "Gs,Gs,Gs", "unknown unit of mag; expected one of T, uT"),
        ("Lumbar/Acceleration/Y", "Lumbar/A/Y", "line 4: column Lumbar/Acceleration/Y is missing"),
    ],
)
def test_damage_to_the_layout_with_units(tmp_path: Path, old: str, new: str, message: str) -> None:
    path = with_units(tmp_path / "a.csv", range(4))
    if old.startswith("uT"):
        path.write_text(path.read_text().replace(old, new))
    else:
        edit(path, old, new)
    with pytest.raises(RecordingError) as caught:
        read_recording(path)
    assert str(caught.value).startswith(f"a.csv: {message}")


def test_a_single_row_has_no_rate(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="line 4: Time: a single time stamp"):
        read_recording(format_7(tmp_path / "a.csv", [0]))


def test_barometer_bits() -> None:
    pressure = np.array([101.72, 99.5, 30.0])
    np.testing.assert_array_equal(barometer_kpa_from_bits(pressure.view(np.int64)), pressure)
    # Printed and read back as a float, the lowest bits are lost.
    np.testing.assert_allclose(barometer_kpa_from_bits([4636858284341460992.0]), 101.72, atol=1e-3)
