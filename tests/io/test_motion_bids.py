"""Motion-BIDS: columns without a header, described beside them."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.errors import RecordingError
from swaystride.io.motion_bids import companion
from swaystride.io.reading import read_recording
from swaystride.recording import findings_of

STEM = "sub-01_task-run_tracksys-imu"
POINTS = ("left_foot", "lumbar")
ACC, GYR = (9.7, 0.25, -0.125), (1.0, -2.0, 0.5)
QUAT = {"quat_x": 0.5, "quat_y": -0.5, "quat_z": 0.5, "quat_w": -0.5}
Row = tuple[str, str, str, str, str]


def channel_rows(points: Sequence[str] = POINTS, acc: str = "m/s^2", gyr: str = "rad/s",
                 quat: bool = True) -> list[Row]:  # fmt: skip
    """Name, component, type, tracked point, unit of each channel, latency first."""
    rows: list[Row] = [("latency", "n/a", "LATENCY", "n/a", "s")]
    for point in points:
        rows += [(f"{point}_acc_{c}", c, "ACCEL", point, acc) for c in "xyz"]
        rows += [(f"{point}_gyr_{c}", c, "GYRO", point, gyr) for c in "zyx"]
        rows += [(f"{point}_pos_x", "x", "POS", point, "m")]
        if quat:
            rows += [(f"{point}_{c}", c, "ORNT", point, "n/a") for c in QUAT]
    return rows


def value_of(row: Row, sample: int, rate_hz: float) -> str:
    _, component, kind, _, _ = row
    if kind == "LATENCY":
        return f"{sample / rate_hz:.9f}"
    if kind == "ORNT":
        return str(QUAT[component])
    axis = "xyz".index(component)
    return {"ACCEL": f"{ACC[axis]}", "GYRO": f"{GYR[axis]}", "POS": "1.5"}[kind]


def dataset(folder: Path, samples: Sequence[int] = range(20), rows: list[Row] | None = None,
            rate_hz: float = 100.0, motion: dict[str, Any] | None = None,
            extra: dict[str, list[str]] | None = None) -> Path:  # fmt: skip
    rows = channel_rows() if rows is None else rows
    names = ["name", "component", "type", "tracked_point", "units", *(extra or {})]
    table = [
        [*row, *(column[i] for column in (extra or {}).values())] for i, row in enumerate(rows)
    ]
    lines = ["\t".join(fields) for fields in [names, *table]]
    (folder / f"{STEM}_channels.tsv").write_text("\n".join(lines) + "\n")
    stated = {"TaskName": "run", "SamplingFrequency": rate_hz} if motion is None else motion
    (folder / f"{STEM}_motion.json").write_text(json.dumps(stated))
    body = ["\t".join(value_of(row, s, rate_hz) for row in rows) for s in samples]
    path = folder / f"{STEM}_motion.tsv"
    path.write_text("\n".join(body) + "\n")
    return path


def test_tracked_points_become_sensors(tmp_path: Path) -> None:
    motion = {"TaskName": "run", "SamplingFrequency": 100, "Manufacturer": "Xsens"}
    found = read_recording(dataset(tmp_path, motion=motion))
    assert found["sensor"].values.tolist() == list(POINTS)
    for point in POINTS:
        one = found.sel(sensor=point)
        np.testing.assert_array_equal(one["acc"].values.T, np.tile(ACC, (20, 1)))
        np.testing.assert_array_equal(one["gyr"].values.T, np.tile(GYR, (20, 1)))
        np.testing.assert_array_equal(one["quat"].values[:, 0], [-0.5, 0.5, -0.5, 0.5])
    assert (found.attrs["rate_hz"], found.attrs["rate_source"]) == (100.0, "header")
    assert (found.attrs["task"], found.attrs["device"]) == ("run", "Xsens")
    (finding,) = findings_of(found)
    assert (finding.check, finding.severity) == ("channels_left_out", "info")
    assert finding.found == "left_foot_pos_x (POS), lumbar_pos_x (POS)"


@settings(max_examples=30, deadline=None)
@given(
    points=st.lists(st.from_regex(r"\A[a-z_]{1,10}\Z"), min_size=1, max_size=4, unique=True),
    order=st.randoms(use_true_random=False),
    lost=st.sets(st.integers(15, 28), max_size=5),
    rate_hz=st.sampled_from([60.0, 100.0, 240.0]),
    units=st.sampled_from([("m/s^2", "rad/s", 1.0, 1.0), ("g", "deg/s", 9.80665, np.pi / 180)]),
)
def test_any_order_of_channels_and_any_gap(
    tmp_path_factory: pytest.TempPathFactory,
    points: list[str],
    order: Any,
    lost: set[int],
    rate_hz: float,
    units: tuple[str, str, float, float],
) -> None:
    rows = channel_rows(points, *units[:2])
    order.shuffle(rows)
    samples = [sample for sample in range(30) if sample not in lost]
    path = dataset(tmp_path_factory.mktemp("bids"), samples, rows, rate_hz)
    found = read_recording(path) if units[0] != "g" else None
    if found is None:
        # 9.7 g is no acceleration of a person; the check of the unit says so.
        with pytest.raises(RecordingError, match="acceleration unit"):
            read_recording(path)
        return
    assert sorted(found["sensor"].values.tolist()) == sorted(points)
    expected = np.full((3, 30), np.nan)
    expected[:, samples] = np.array(ACC)[:, None] * units[2]
    for point in points:
        np.testing.assert_allclose(found["acc"].sel(sensor=point).values, expected)
    checks = {finding.check for finding in findings_of(found)}
    assert checks == {"channels_left_out"} | ({"packet_loss"} if lost else set())


def test_units_are_those_of_the_file(tmp_path: Path) -> None:
    path = dataset(tmp_path, rows=channel_rows(gyr="deg/s"))
    found = read_recording(path, units={"gyr": "deg/s"})
    np.testing.assert_allclose(found["gyr"].values[0, :, 0], np.deg2rad(GYR))
    with pytest.raises(RecordingError, match="the argument units contradicts the unit of gyr"):
        read_recording(path, units={"gyr": "rad/s"})
    with pytest.raises(RecordingError, match=r"_channels\.tsv: unknown unit of acc"):
        read_recording(dataset(tmp_path, rows=channel_rows(acc="ft/s^2")))


def test_without_latency_lost_samples_cannot_be_seen(tmp_path: Path) -> None:
    found = read_recording(dataset(tmp_path, rows=channel_rows()[1:]))
    checks = {finding.check: finding.severity for finding in findings_of(found)}
    assert checks["no_packet_counter"] == "warning"


def test_missing_numbers(tmp_path: Path) -> None:
    path = dataset(tmp_path)
    text = path.read_text().split("\n")
    text[3] = text[3].replace("9.7", "n/a", 1)
    path.write_text("\n".join(text))
    found = read_recording(path)
    assert np.argwhere(np.isnan(found["acc"].values)).tolist() == [[0, 0, 3]]


def test_the_frame_of_reference(tmp_path: Path) -> None:
    rows = channel_rows()
    path = dataset(
        tmp_path, rows=rows, extra={"reference_frame": ["n/a", *["global"] * (len(rows) - 1)]}
    )
    assert read_recording(path, sensor="lumbar").attrs["world_frame"] in ("global", "n/a")
    levels = {"global": {"SpatialAxes": "ALS", "RotationRule": "right-hand"}}
    text = json.dumps({"reference_frame": {"Levels": levels}})
    companion(path, "_channels.json").write_text(text)
    assert read_recording(path, sensor="lumbar").attrs["world_frame"] == "global (ALS)"


def test_sensors_are_selected(tmp_path: Path) -> None:
    path = dataset(tmp_path)
    assert read_recording(path, sensor="lumbar")["sensor"].values.tolist() == ["lumbar"]
    with pytest.raises(RecordingError, match="no such sensor; expected one of left_foot, lumbar"):
        read_recording(path, sensor="head")


def without(rows: list[Row], name: str) -> list[Row]:
    return [row for row in rows if row[0] != name]


def change(rows: list[Row], name: str, **fields: str) -> list[Row]:
    keys = ("name", "component", "type", "tracked_point", "units")
    return [
        tuple(fields.get(key, value) for key, value in zip(keys, row, strict=True))  # type: ignore[misc]
        if row[0] == name
        else row
        for row in rows
    ]


CHANNELS = {
    "incomplete": (
        without(channel_rows(), "lumbar_acc_y"),
        f"{STEM}_channels.tsv: tracked point lumbar: acc of lumbar is not complete; "
        "expected x, y, z; found x, z",
    ),
    "two units": (
        change(channel_rows(), "lumbar_acc_y", units="g"),
        f"{STEM}_channels.tsv: tracked point lumbar: acc in several units; "
        "expected one unit for all channels of a quantity; found g, m/s^2",
    ),
    "twice": (
        change(channel_rows(), "lumbar_acc_y", component="x"),
        f"{STEM}_channels.tsv: line 15 (lumbar_acc_y): two channels for one component; "
        "expected one ACCEL x of lumbar; found another one above",
    ),
    "no inertial channel": (
        [row for row in channel_rows() if row[2] == "POS"],
        f"{STEM}_channels.tsv: no inertial channel; expected ACCEL, GYRO, MAGN or quaternions",
    ),
}


@pytest.mark.parametrize(("rows", "message"), CHANNELS.values(), ids=CHANNELS)
def test_channels_that_contradict_themselves(tmp_path: Path, rows: list[Row], message: str) -> None:
    with pytest.raises(RecordingError) as caught:
        read_recording(dataset(tmp_path, rows=rows))
    assert str(caught.value) == message


def test_columns_must_agree_in_number(tmp_path: Path) -> None:
    path = dataset(tmp_path)
    path.write_text("".join(f"{line}\t0\n" for line in path.read_text().splitlines()))
    with pytest.raises(RecordingError) as caught:
        read_recording(path)
    assert str(caught.value) == (
        f"{STEM}_motion.tsv: line 1: columns and channels differ in number; "
        "expected 23 columns, as in _channels.tsv; found 24 columns"
    )


def test_companions_that_are_missing_or_wrong(tmp_path: Path) -> None:
    path = dataset(tmp_path, motion={"TaskName": "run"})
    with pytest.raises(RecordingError, match=r"_motion\.json: SamplingFrequency: no sampling rate"):
        read_recording(path)
    path = dataset(tmp_path, extra={"sampling_frequency": ["100", "50", *["n/a"] * 21]})
    with pytest.raises(
        RecordingError, match=r"left_foot_acc_x: channels of unequal rate; expected 1"
    ):
        read_recording(path)
    path = dataset(tmp_path, extra={"sampling_frequency": ["fast"] * 23})
    with pytest.raises(RecordingError, match="sampling_frequency is not a number"):
        read_recording(path)
    path = dataset(tmp_path)
    table = companion(path, "_channels.tsv")
    table.write_text(table.read_text().replace("tracked_point", "point", 1))
    with pytest.raises(
        RecordingError, match=r"_channels\.tsv: line 1: column tracked_point is miss"
    ):
        read_recording(path)
    table.unlink()
    with pytest.raises(RecordingError, match="a companion of the motion file cannot be read"):
        read_recording(path)
    path = dataset(tmp_path)
    companion(path, "_motion.json").write_text("{")
    with pytest.raises(RecordingError, match="a companion of the motion file cannot be read"):
        read_recording(path)
    companion(path, "_motion.json").write_text("[]")
    with pytest.raises(RecordingError, match="not a JSON object"):
        read_recording(path)
    companion(path, "_channels.tsv").unlink()
    companion(path, "_motion.json").unlink()
    with pytest.raises(RecordingError, match="unknown format"):
        read_recording(path)


def test_a_rate_that_contradicts_the_latency(tmp_path: Path) -> None:
    path = dataset(tmp_path, motion={"TaskName": "run", "SamplingFrequency": 120})
    checks = [finding.check for finding in findings_of(read_recording(path))]
    assert "sampling_rate" in checks
    with pytest.raises(RecordingError, match="the argument rate_hz contradicts the file"):
        read_recording(path, rate_hz=100.0)
