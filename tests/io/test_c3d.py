"""C3D: what is written is read, also by ezc3d itself; forged and incomplete files are refused."""

import gzip
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import ezc3d
import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.errors import RecordingError
from swaystride.findings import findings_from_json
from swaystride.io.c3d import read_c3d
from swaystride.io.c3d_header import C3dHeader, read_header
from swaystride.io.c3d_writer import write_c3d
from swaystride.io.reading import read_recording
from swaystride.io.source_binary import require_binary
from swaystride.marker_recording import make_marker_recording

NAMES = ["L.Heel", "R.Heel", "Sacrum"]


def walk(n: int = 20, **changes: Any) -> xr.Dataset:
    position = np.random.default_rng(2).normal(1, 0.5, (3, 3, n))
    arguments: dict[str, Any] = {"markers": NAMES, "rate_hz": 200.0, "rate_source": "argument"}
    return make_marker_recording(position, **(arguments | changes))


def good(path: Path, **changes: Any) -> Path:
    write_c3d(path, walk(**changes), unit="mm")
    return path


def header_of(path: Path) -> C3dHeader:
    return read_header(require_binary(path, "C3D", expected="a C3D file"))


def through_ezc3d(path: Path, change: Callable[[Any], None], n: int = 20) -> Path:
    """A file that ezc3d wrote itself."""
    file: Any = ezc3d.c3d()
    points = np.ones((4, 3, n))
    points[:3] = np.random.default_rng(3).normal(900, 300, (3, 3, n))
    parameters = file["parameters"]["POINT"]
    parameters["RATE"]["value"], parameters["UNITS"]["value"] = [150.0], ["mm"]
    parameters["LABELS"]["value"] = list(NAMES)
    file["data"]["points"] = points
    change(file)
    file.write(str(path))
    return path


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("c3d")


names_strategy = st.lists(
    st.text(st.characters(min_codepoint=33, max_codepoint=126), min_size=1, max_size=20),
    min_size=1,
    max_size=6,
    unique=True,
)


@settings(max_examples=50, deadline=None)
@given(
    names=names_strategy,
    n=st.integers(1, 60),
    rate_hz=st.sampled_from([50.0, 119.88, 200.0]),
    unit=st.sampled_from(["m", "cm", "mm"]),
    ratio=st.integers(0, 3),
    first_frame=st.integers(0, 70000),
    share_lost=st.sampled_from([0.0, 0.3]),
    seed=st.integers(0, 2**32 - 1),
)
def test_round_trip(
    folder: Path,
    names: list[str],
    n: int,
    rate_hz: float,
    unit: str,
    ratio: int,
    first_frame: int,
    share_lost: float,
    seed: int,
) -> None:
    rng = np.random.default_rng(seed)
    position = rng.normal(0, 3, (len(names), 3, n))
    position.transpose(0, 2, 1)[rng.random((len(names), n)) < share_lost] = np.nan
    analog = {
        "analog": rng.normal(0, 800, (2, n * ratio)),
        "analog_rate_hz": rate_hz * ratio,
        "channels": ["F1Z", "M1X"],
        "analog_units": ["N", "Nmm"],
    }
    truth = make_marker_recording(
        position,
        markers=names,
        rate_hz=rate_hz,
        rate_source="argument",
        subject="P01",
        first_frame=first_frame,
        **(analog if ratio else {}),
    )
    write_c3d(folder / "a.c3d", truth, unit=unit)
    found = read_c3d(folder / "a.c3d")
    assert found["marker"].values.tolist() == names
    assert found.attrs["rate_hz"] == pytest.approx(rate_hz, rel=1e-7)
    assert (found.attrs["file_unit"], found.attrs["subject"]) == (unit, "P01")
    assert found.attrs["first_frame"] == first_frame
    bound = 2.0**-23 * np.nan_to_num(np.abs(position)).max()
    np.testing.assert_allclose(found["position"].values, position, rtol=0, atol=bound)
    if ratio:
        np.testing.assert_allclose(found["analog"].values, truth["analog"].values, rtol=2.0**-23)
        assert found["analog_unit"].values.tolist() == ["N", "Nmm"]
        assert found["channel"].values.tolist() == ["F1Z", "M1X"]
        assert found.attrs["analog_rate_hz"] == pytest.approx(rate_hz * ratio, rel=1e-7)
    # The library alone sees the same.
    alone = ezc3d.c3d(str(folder / "a.c3d"))
    np.testing.assert_array_equal(
        found["position"].values,
        alone["data"]["points"][:3].transpose(1, 0, 2) * {"m": 1.0, "cm": 1e-2, "mm": 1e-3}[unit],
    )
    if ratio:
        np.testing.assert_array_equal(found["analog"].values, alone["data"]["analogs"][0])


def test_a_trial_longer_than_65535_frames(tmp_path: Path) -> None:
    position = np.arange(3 * 70_000, dtype=float).reshape(1, 3, -1) / 1e5
    truth = make_marker_recording(
        position, markers=["Sacrum"], rate_hz=200.0, rate_source="argument"
    )
    write_c3d(tmp_path / "a.c3d", truth, unit="m")
    found = read_c3d(tmp_path / "a.c3d")
    assert found.sizes["time"] == 70_000
    np.testing.assert_allclose(found["position"].values, position, rtol=1e-6)
    assert header_of(tmp_path / "a.c3d").n_frames == 70_000


def test_a_file_written_by_ezc3d(tmp_path: Path) -> None:
    def lose(file: Any) -> None:
        file["data"]["points"][:3, 1, 4:7] = np.nan
        file.add_parameter("SUBJECTS", "NAMES", ["P07"])
        file.add_parameter("MANUFACTURER", "COMPANY", ["Motion Inc."])

    path = through_ezc3d(tmp_path / "a.c3d", lose)
    found = read_c3d(path)
    whole = ezc3d.c3d(str(path))["data"]["points"][:3].transpose(1, 0, 2) / 1000
    np.testing.assert_allclose(found["position"].values, whole, rtol=1e-12)
    assert (found.attrs["subject"], found.attrs["device"]) == ("P07", "Motion Inc.")
    (finding,) = findings_from_json(found.attrs["findings"])
    assert (finding.check, finding.severity) == ("marker_gap", "warning")
    assert finding.found == "1 of 3 markers, the worst: R.Heel 15.0% of the frames"


def put(path: Path, offset: int, value: int, n: int = 2) -> Path:
    data = bytearray(path.read_bytes())
    data[offset : offset + n] = value.to_bytes(n, "little")
    path.write_bytes(data)
    return path


def with_unit(path: Path, unit: str) -> Path:
    """A file whose two letters of POINT:UNITS are others."""
    value = int.from_bytes(unit.encode(), "little")
    return put(good(path), header_of(path).parameters["POINT:UNITS"].offset, value)


def test_units_and_rate_are_never_guessed(tmp_path: Path) -> None:
    path = with_unit(tmp_path / "a.c3d", "  ")
    with pytest.raises(RecordingError) as caught:
        read_c3d(path)
    assert str(caught.value) == (
        "a.c3d: POINT:UNITS: the file does not state its units; "
        "expected one of m, cm, mm, or the argument unit; found neither"
    )
    assert read_c3d(path, unit="cm").attrs["file_unit"] == "cm"
    path = good(tmp_path / "b.c3d")
    for offset in (20, header_of(path).parameters["POINT:RATE"].offset):
        put(path, offset, 0, 4)
    with pytest.raises(RecordingError) as caught:
        read_c3d(path)
    assert str(caught.value) == (
        "b.c3d: header: no sampling rate; expected POINT:RATE or the argument rate_hz; "
        "found neither"
    )
    assert read_c3d(path, rate_hz=150.0).attrs["rate_source"] == "argument"
    path = with_unit(tmp_path / "c.c3d", "in")
    with pytest.raises(
        RecordingError, match="POINT:UNITS: unknown unit; expected m, cm, mm; found"
    ):
        read_c3d(path)
    path = good(tmp_path / "d.c3d")
    for arguments, message in (
        ({"unit": "m"}, "POINT:UNITS: the argument unit contradicts the file; expected mm; found"),
        ({"unit": "in"}, "argument unit: unknown unit"),
        ({"rate_hz": 150.0}, "POINT:RATE: the argument rate_hz contradicts the file"),
    ):
        with pytest.raises(RecordingError, match=message):
            read_c3d(path, **arguments)


def test_a_marker_that_is_absent(tmp_path: Path) -> None:
    path = good(tmp_path / "a.c3d")
    chosen = read_c3d(path, markers=["Sacrum", "L.Heel"])
    assert chosen["marker"].values.tolist() == ["Sacrum", "L.Heel"]
    with pytest.raises(RecordingError) as caught:
        read_c3d(path, markers=["L.Heel", "L.Toe"])
    assert str(caught.value) == (
        "a.c3d: no such marker; expected one of L.Heel, R.Heel, Sacrum; found 'L.Toe'"
    )


def test_points_that_are_no_positions_are_left_out(tmp_path: Path) -> None:
    def angles(file: Any) -> None:
        file.add_parameter("POINT", "ANGLES", ["R.Heel"])

    found = read_c3d(through_ezc3d(tmp_path / "a.c3d", angles))
    assert found["marker"].values.tolist() == ["L.Heel", "Sacrum"]
    (finding,) = findings_from_json(found.attrs["findings"])
    assert (finding.check, finding.severity, finding.found) == ("points_left_out", "info", "R.Heel")


def test_a_marker_at_the_origin_is_a_warning(tmp_path: Path) -> None:
    def zero(file: Any) -> None:
        file["data"]["points"][:3, 2, :10] = 0

    (finding,) = findings_from_json(
        read_c3d(through_ezc3d(tmp_path / "a.c3d", zero)).attrs["findings"]
    )
    assert finding.check == "marker_at_origin"
    assert finding.found == "1 of 3 markers, the worst: Sacrum 50.0% of the frames"


def test_two_markers_of_one_name(tmp_path: Path) -> None:
    def twice(file: Any) -> None:
        file["parameters"]["POINT"]["LABELS"]["value"] = ["L.Heel", "L.Heel", "Sacrum"]

    with pytest.raises(RecordingError, match=r"two markers of one name; .* found L\.Heel"):
        read_c3d(through_ezc3d(tmp_path / "a.c3d", twice))


@pytest.mark.parametrize(
    ("changes", "unit", "message"),
    [
        ({"markers": ["a", "b", "ä"]}, "mm", "a name does not fit the format"),
        ({"markers": ["a", "b", "c "]}, "mm", "a name does not fit the format"),
        ({}, "in", "unknown unit"),
        ({"subject": "Ä"}, "mm", "a name does not fit the format"),
        (
            {"analog": np.zeros((1, 40)), "analog_rate_hz": 400.0, "channels": ["A"],
             "analog_units": ["°/s"]},
            "mm",
            "a name does not fit the format",
        ),
        (
            {"analog": np.zeros((1, 30)), "analog_rate_hz": 300.0, "channels": ["A"],
             "analog_units": ["V"]},
            "mm",
            "analog samples per frame are not a whole number",
        ),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_not_written(
    tmp_path: Path, changes: dict[str, Any], unit: str, message: str
) -> None:
    with pytest.raises(RecordingError, match=message):
        write_c3d(tmp_path / "a.c3d", walk(**changes), unit=unit)
    assert not (tmp_path / "a.c3d").exists()


def forged_parameter(name: str, value: int) -> Callable[[Path], Path]:
    return lambda path: put(path, header_of(path).parameters[name].offset, value)


def forged_trial(path: Path) -> Path:
    put(path, 8, 65535)
    return put(path, header_of_any(path)["TRIAL:ACTUAL_END_FIELD"], 2**31, 4)


def header_of_any(path: Path) -> dict[str, int]:
    """Offsets of the parameters, which do not depend on the header."""
    good(path.with_name("other.c3d"))
    parameters = header_of(path.with_name("other.c3d")).parameters
    return {name: parameter.offset for name, parameter in parameters.items()}


def forged_dimensions(path: Path) -> Path:
    """A text parameter that claims 255 times 255 characters."""
    parameter = header_of(path).parameters["POINT:LABELS"]
    return put(path, parameter.offset - len(parameter.dimensions), 0xFFFF)


TOO_SMALL = "header: the file does not hold what it declares; "
FORGED: dict[str, tuple[Callable[[Path], Path], str]] = {
    "number of points": (
        lambda path: put(put(path, 2, 65535), header_of_any(path)["POINT:USED"], 65535),
        TOO_SMALL + "expected 20971200 bytes (20 frames of 1048560); found ",
    ),
    "points in the header only": (
        lambda path: put(path, 2, 2),
        "POINT:USED: header and parameters contradict each other; expected 2, as in the header; "
        "found 3",
    ),
    "points in the parameters only": (
        forged_parameter("POINT:USED", 65535),
        "POINT:USED: header and parameters contradict each other; ",
    ),
    "channels in the parameters only": (
        forged_parameter("ANALOG:USED", 65535),
        "ANALOG:USED: header and parameters contradict each other; ",
    ),
    "number of analog values": (
        lambda path: put(put(path, 4, 65534), header_of_any(path)["ANALOG:USED"], 32767),
        TOO_SMALL,
    ),
    "last frame": (lambda path: put(path, 8, 65534), TOO_SMALL + "expected 3145632 bytes"),
    "frames of TRIAL": (forged_trial, TOO_SMALL + "expected 103079215"),
    "sizes of a parameter": (
        forged_dimensions,
        "parameter LABELS: the header of the C3D file is damaged; "
        "expected header and parameters within the file; found sizes beyond the file",
    ),
    "start of the data": (lambda path: put(path, 16, 65535), TOO_SMALL),
    "no start of the data": (lambda path: put(path, 16, 0), TOO_SMALL),
    "processor": (
        lambda path: put(path, 515, 99, 1),
        "processor: the header of the C3D file is damaged; ",
    ),
    "cut off": (
        lambda path: path.write_bytes(path.read_bytes()[:-48]) and path,
        TOO_SMALL + "expected 960 bytes",
    ),
    "cut off in the header": (
        lambda path: path.write_bytes(path.read_bytes()[:300]) and path,
        "header: the header of the C3D file is damaged; ",
    ),
    "no frames": (lambda path: put(path, 8, 0), "no frames; expected one frame at least"),
}


@pytest.mark.parametrize("case", FORGED)
def test_forged_sizes_are_refused_before_anything_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, case: str
) -> None:
    forge, message = FORGED[case]
    with_analog = {
        "analog": np.zeros((1, 40)),
        "analog_rate_hz": 400.0,
        "channels": ["A"],
        "analog_units": ["V"],
    }
    path = forge(
        good(tmp_path / "a.c3d", **(with_analog if case.startswith("number of a") else {}))
    )
    monkeypatch.setattr(np, "memmap", lambda *_, **__: pytest.fail("it was read"))
    with pytest.raises(RecordingError) as caught:
        read_c3d(path)
    assert str(caught.value).startswith(f"a.c3d: {message}")


def parameter(order: str, group: int, name: str, kind: int, dimensions: list[int],
              values: bytes) -> bytes:  # fmt: skip
    body = struct.pack("bB", kind, len(dimensions)) + bytes(dimensions) + values + b"\0"
    step = struct.pack(order + "H", 2 + len(body))
    return struct.pack("bb", len(name), group) + name.encode() + step + body


def old_file(
    path: Path, processor: int, scale: float, analog_format: str = "SIGNED", offset: int = 10
) -> Path:
    """A file as other machines wrote it: 2 frames, 2 points, 1 channel with 2 samples per frame."""
    order = ">" if processor == 86 else "<"

    def floats(*values: float) -> bytes:
        if processor != 85:
            return struct.pack(f"{order}{len(values)}f", *values)
        words = np.array([4 * value for value in values], "<f4").view("<u2").reshape(-1, 2)
        return words[:, ::-1].astype("<u2").tobytes()

    def words(*values: int) -> bytes:
        return struct.pack(f"{order}{len(values)}H", *(value & 0xFFFF for value in values))

    parameters = b"".join(
        struct.pack("bb", len(name), -number) + name.encode() + struct.pack(order + "H", 3) + b"\0"
        for number, name in ((1, "POINT"), (2, "ANALOG"))
    )
    for group, name, kind, dimensions, values in (
        (1, "USED", 2, [], words(2)),
        (1, "SCALE", 4, [], floats(scale)),
        (1, "RATE", 4, [], floats(50.0)),
        (1, "FRAMES", 2, [], words(2)),
        (1, "DATA_START", 2, [], words(4)),
        (1, "UNITS", -1, [2], b"mm"),
        (1, "LABELS", -1, [4, 2], b"HeelToe "),
        (1, "DESCRIPTIONS", -1, [1, 2], b"  "),
        (2, "USED", 2, [], words(1)),
        (2, "RATE", 4, [], floats(100.0)),
        (2, "LABELS", -1, [2, 1], b"Fz"),
        (2, "UNITS", -1, [1, 1], b"N"),
        (2, "DESCRIPTIONS", -1, [1, 1], b" "),
        (2, "GEN_SCALE", 4, [], floats(0.5)),
        (2, "SCALE", 4, [1], floats(4.0)),
        (2, "OFFSET", 2, [1], words(offset)),
        (2, "FORMAT", -1, [len(analog_format)], analog_format.encode()),
        (2, "BITS", 2, [], words(16)),
    ):
        parameters += parameter(order, group, name, kind, dimensions, values)
    head = bytes([2, 0x50]) + words(2, 2, 1, 2, 10) + floats(scale) + words(4, 2) + floats(50.0)
    section = (bytes([1, 0x50, 2, processor]) + parameters + b"\0\0").ljust(1024, b"\0")
    data = b""
    for frame in range(2):
        for point in range(2):
            lost = frame == 1 and point == 1
            values = [0, 0, 0, -1] if lost else [100 + frame, -200 - point, 300, 0]
            data += words(*values) if scale > 0 else floats(*values)
        samples = [20 + frame, 30 if analog_format == "SIGNED" else 40000]
        data += words(*samples) if scale > 0 else floats(*samples)
    path.write_bytes(head.ljust(512, b"\0") + section + data.ljust(512, b"\0"))
    return path


@pytest.mark.parametrize("processor", [84, 85, 86])
@pytest.mark.parametrize("scale", [-1.0, 0.25])
@pytest.mark.parametrize("analog_format", ["SIGNED", "UNSIGNED"])
def test_files_of_other_machines(
    tmp_path: Path, processor: int, scale: float, analog_format: str
) -> None:
    offset, last = (-10, 30) if analog_format == "SIGNED" else (10, 40000)
    found = read_c3d(old_file(tmp_path / "a.c3d", processor, scale, analog_format, offset))
    size = abs(scale) * 1e-3
    expected = size * np.array(
        [[[100, 101], [-200, -200], [300, 300]], [[100, np.nan], [-201, np.nan], [300, np.nan]]]
    )
    np.testing.assert_allclose(found["position"].values, expected, rtol=1e-12)
    np.testing.assert_allclose(
        found["analog"].values[0], 2.0 * (np.array([20, last, 21, last]) - offset)
    )
    assert found["marker"].values.tolist() == ["Heel", "Toe"]
    assert (found.attrs["rate_hz"], found.attrs["analog_rate_hz"]) == (50.0, 100.0)


@pytest.mark.parametrize("scale", [-1.0, 0.25])
def test_ezc3d_sees_the_same_in_them(tmp_path: Path, scale: float) -> None:
    path = old_file(tmp_path / "a.c3d", 84, scale)
    found, alone = read_c3d(path), ezc3d.c3d(str(path))["data"]
    position = alone["points"][:3].transpose(1, 0, 2) / 1000
    np.testing.assert_allclose(found["position"].values, position, rtol=1e-12)
    np.testing.assert_allclose(found["analog"].values, alone["analogs"][0], rtol=1e-12)


def test_other_files(tmp_path: Path) -> None:
    path = good(tmp_path / "a.c3d")
    with pytest.raises(RecordingError) as caught:
        read_recording(path)
    assert str(caught.value) == (
        "a.c3d: the file holds no inertial sensors; expected one of APDM Opal HDF5; "
        "found C3D, whose markers swaystride.io.c3d.read_c3d reads"
    )
    (tmp_path / "b.c3d").write_bytes(gzip.compress(path.read_bytes()))
    with pytest.raises(
        RecordingError, match="a C3D file, not compressed; found a file compressed w"
    ):
        read_c3d(tmp_path / "b.c3d")
    with pytest.raises(RecordingError, match="a compressed C3D file is not read"):
        read_recording(tmp_path / "b.c3d")
    (tmp_path / "c.c3d").write_text("Time,Acc_X\n")
    with pytest.raises(RecordingError, match=r"c\.c3d: this is no C3D file"):
        read_c3d(tmp_path / "c.c3d")
    with pytest.raises(RecordingError, match="the file cannot be opened"):
        read_c3d(tmp_path / "gone.c3d")


@settings(max_examples=150, deadline=None)
@given(
    edits=st.lists(st.tuples(st.floats(0, 1), st.binary(min_size=1, max_size=4)), max_size=3),
    end=st.one_of(st.just(1.0), st.floats(0, 1)),
)
def test_damage_of_any_kind_is_read_or_refused_in_one_line(
    folder: Path, edits: list[tuple[float, bytes]], end: float
) -> None:
    path = folder / "whole.c3d"
    if not path.exists():
        good(path)
    data = bytearray(path.read_bytes())
    for place, new in edits:
        start = int(place * (len(data) - len(new)))
        data[start : start + len(new)] = new
    (folder / "damaged.c3d").write_bytes(data[: int(end * len(data))])
    refusal = None
    try:
        read_c3d(folder / "damaged.c3d")
    except RecordingError as error:
        refusal = error
    if refusal is not None:
        assert "\n" not in str(refusal)
