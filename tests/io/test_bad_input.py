"""Bad files: each gives one line that names the place, what was expected and what was found."""

import gzip
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.errors import RecordingError
from swaystride.io.reading import read_recording
from swaystride.recording import findings_of

COLUMNS = "PacketCounter\tAcc_X\tAcc_Y\tAcc_Z"
HEADER = f"// Start Time: Unknown\n// Update Rate: 100.0Hz\n{COLUMNS}\n"


def rows(n: int = 30, z: float = 9.81) -> str:
    return "".join(f"{i:05d}\t0.100000\t-0.200000\t{z:.6f}\n" for i in range(n))


GOOD = HEADER + rows()


def line(text: str, number: int, change: Callable[[str], str]) -> str:
    """The text with one line changed (1-based)."""
    lines = text.split("\n")
    lines[number - 1] = change(lines[number - 1])
    return "\n".join(lines)


CASES = {
    "truncated file": (
        GOOD[: GOOD.rindex("\t")],
        "a.txt: line 33: truncated file: the last line is not complete; "
        "expected 4 fields separated by tab; "
        "found 3 fields: '00029\\t0.100000\\t-0.200000'",
    ),
    "short line inside": (
        line(GOOD, 10, lambda text: text[: text.rindex("\t")]),
        "a.txt: line 10: wrong number of fields; expected 4 fields separated by tab; "
        "found 3 fields: '00006\\t0.100000\\t-0.200000'",
    ),
    "long line": (
        line(GOOD, 10, lambda text: text + "\t1"),
        "a.txt: line 10: wrong number of fields; expected 4 fields separated by tab; "
        "found 5 fields: '00006\\t0.100000\\t-0.200000\\t9.810000\\t1'",
    ),
    "empty line inside": (
        line(GOOD, 10, lambda _: ""),
        "a.txt: line 10: empty line inside the data; expected 4 fields separated by tab; "
        "found nothing",
    ),
    "rows with another delimiter": (
        HEADER + rows().replace("\t", ";"),
        "a.txt: line 4: wrong delimiter; expected 4 fields separated by tab; "
        "found 4 fields separated by semicolon",
    ),
    "one column": (
        GOOD.replace("\t", "|"),
        "a.txt: line 3: wrong delimiter: one column found; "
        "expected tab, comma, semicolon, space between the column names; "
        "found 'PacketCounter|Acc_X|Acc_Y|Acc_Z'",
    ),
    "glued columns": (
        GOOD.replace("Acc_X\tAcc_Y", "Acc_XAcc_Y"),
        "a.txt: line 3, column 2: wrong delimiter: glued columns; "
        "expected one column name between two delimiters (tab); found 'Acc_XAcc_Y'",
    ),
    "missing column": (
        GOOD.replace("Acc_Y", "Comment"),
        "a.txt: line 3: column Acc_Y is missing; expected one column Acc_Y; "
        "found PacketCounter, Acc_X, Comment, Acc_Z",
    ),
    "ambiguous column": (
        GOOD.replace("Acc_Y", "Acc_X"),
        "a.txt: line 3: column Acc_X is ambiguous; expected one column Acc_X; "
        "found PacketCounter, Acc_X, Acc_X, Acc_Z",
    ),
    "no signal": (
        "// Update Rate: 100.0Hz\nPacketCounter\tYear\n1\t2\n",
        "a.txt: line 2: no signal columns; "
        "expected Acc_X, Acc_Y, Acc_Z, or Gyr_…, or an orientation; found PacketCounter, Year",
    ),
    "not a number": (
        line(GOOD, 12, lambda text: text.replace("-0.200000", "-0,200000")),
        "a.txt: line 12, column 3 (Acc_Y): not a number; "
        "expected a finite number, an empty field or NaN; found '-0,200000'",
    ),
    "infinite number": (
        line(GOOD, 12, lambda text: text.replace("9.810000", "inf")),
        "a.txt: line 12, column 4 (Acc_Z): not a number; "
        "expected a finite number, an empty field or NaN; found 'inf'",
    ),
    "duplicate counter": (
        line(GOOD, 20, lambda text: text.replace("00016", "00015")),
        "a.txt: line 20: duplicate packet; expected a packet counter after 15; found 15",
    ),
    "backward counter": (
        line(GOOD, 20, lambda text: text.replace("00016", "00011")),
        "a.txt: line 20: the packet counter runs backwards; "
        "expected a packet counter after 15; found 11",
    ),
    "counter jumps": (
        line(GOOD, 20, lambda text: text.replace("00016", "50000")),
        "a.txt: line 20: the packet counter jumps by more than half a turn; "
        "expected a packet counter after 15; found 50000",
    ),
    "counter missing": (
        line(GOOD, 20, lambda text: text.replace("00016", "")),
        "a.txt: line 20: PacketCounter is not a whole number; expected 0, 1, 2, …; found nan",
    ),
    "fractional counter": (
        line(GOOD, 20, lambda text: text.replace("00016", "15.5")),
        "a.txt: line 20: PacketCounter is not a whole number; expected 0, 1, 2, …; found 15.5",
    ),
    "counter beyond whole floats": (
        line(GOOD, 20, lambda text: text.replace("00016", "1e300")),
        "a.txt: line 20: PacketCounter is not a whole number; expected 0, 1, 2, …; found 1e+300",
    ),
    "almost all lost": (
        HEADER + "00000\t0\t0\t9.8\n20000\t0\t0\t9.8\n",
        "a.txt: almost every sample is missing; expected at least one row for 1000 samples; "
        "found 2 rows for 20001 samples",
    ),
    "g given as m/s²": (
        HEADER + rows(z=1.0),
        "a.txt: acc: acceleration unit; "
        "expected a median |acc| from 4 to 70 m/s² (about 9.8 at rest); "
        "found a median of 1.025 m/s²: values look like g, not m/s²",
    ),
    "deg/s given as rad/s": (
        GOOD.replace("Acc_", "Gyr_").replace("9.810000", "50.000000"),
        "a.txt: gyr: angular rate unit; "
        "expected a median |gyr| of at most 35 rad/s (2005 deg/s); "
        "found a median of 50 rad/s: values look like deg/s, not rad/s",
    ),
    "no sampling rate": (
        GOOD.replace("// Update Rate: 100.0Hz\n", ""),
        "a.txt: header: no sampling rate; "
        "expected '// Update Rate:' or the argument rate_hz; found neither",
    ),
    "unreadable sampling rate": (
        GOOD.replace("100.0Hz", "0.0.0Hz"),
        "a.txt: header: no sampling rate; "
        "expected '// Update Rate:' or the argument rate_hz; found neither",
    ),
    "empty file": ("", "a.txt: empty file; expected a header and rows of data; found 0 bytes"),
    "blank file": (
        "\n \n",
        "a.txt: empty file; expected a header and rows of data; found 3 bytes",
    ),
    "header only": (
        HEADER,
        "a.txt: line 4: no data rows; expected numbers after the column row; found end of file",
    ),
    "comments only": (
        "// Start Time: Unknown\n",
        "a.txt: the file ends before its column row; "
        "expected a row of column names (PacketCounter, Acc_X, …); found comment lines only",
    ),
    "unknown format": (
        "\nhello world\n1 2 3\n",
        "a.txt: first line: unknown format; expected one of CSV with a JSON sidecar, "
        "Motion-BIDS, APDM CSV, Polar Sensor Logger ACC, text with an acquisition frequency, "
        "Xsens MT Manager TXT, APDM Opal HDF5; found 'hello world'",
    ),
}


@pytest.mark.parametrize(("text", "message"), CASES.values(), ids=CASES)
def test_the_error_line(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "a.txt"
    path.write_bytes(text.encode())
    with pytest.raises(RecordingError) as caught:
        read_recording(path)
    assert str(caught.value) == message


def test_the_unchanged_file_is_good(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text(GOOD)
    assert findings_of(read_recording(path)) == []


def test_a_run_of_nan_is_a_warning_with_its_place(tmp_path: Path) -> None:
    text = GOOD
    for number in (14, 15, 16, 25):
        text = line(text, number, lambda row: row.replace("-0.200000", ""))
    path = tmp_path / "a.txt"
    path.write_text(text)
    (finding,) = findings_of(read_recording(path))
    assert (finding.check, finding.severity, finding.file) == ("nan_run", "warning", "a.txt")
    assert finding.place == "acc, first at t = 0.100 s, line 14"
    assert finding.found == (
        "4 of 30 samples without a number in 2 runs, the longest 3 samples (0.030 s)"
    )


def test_a_rate_that_contradicts_the_header(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text(GOOD)
    assert read_recording(path, rate_hz=100.05).attrs["rate_hz"] == 100.0
    with pytest.raises(RecordingError) as caught:
        read_recording(path, rate_hz=102.4)
    assert str(caught.value) == (
        "a.txt: line 2: the argument rate_hz contradicts the file; expected 100 Hz; found 102.4 Hz"
    )


@pytest.mark.parametrize("rate", [0.0, -1.0, float("nan"), float("inf")])
def test_an_impossible_rate(tmp_path: Path, rate: float) -> None:
    with pytest.raises(RecordingError, match="argument rate_hz: the sampling rate is not a pos"):
        read_recording(tmp_path / "a.txt", rate_hz=rate)


def test_arguments_that_do_not_exist(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"argument units: unknown signal.*found 'accel'"):
        read_recording(tmp_path / "a.txt", units={"accel": "g"})
    with pytest.raises(RecordingError, match="argument duplicate_packets: unknown choice"):
        read_recording(tmp_path / "a.txt", duplicate_packets="drop")  # type: ignore[arg-type]


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"gone\.txt: the file cannot be opened"):
        read_recording(tmp_path / "gone.txt")


def test_a_damaged_compressed_file(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_bytes(gzip.compress(GOOD.encode())[:-20])
    with pytest.raises(RecordingError) as caught:
        read_recording(path)
    assert str(caught.value).startswith(
        "a.txt: the compressed file is damaged or truncated; expected a whole gzip stream; found"
    )


FILES = {
    "a.txt": GOOD,
    "b.txt": "Acquisition frequency: 100 Hz\n" + COLUMNS + "\n" + rows(),
    "c.csv": "Test Name:,x,,\nSample Rate:,128,Hz,\nTime,L/Acceleration/X,L/Acceleration/Y,"
    "L/Acceleration/Z\ns,m/s^2,m/s^2,m/s^2\n0.0,0,0,9.8\n0.0078125,0,0,9.8\n",
    "d.csv": "Format=7,5718,,,Lumbar,,,,,,,,,,\n"
    "Time,Accelerometer,,,Gyroscope,,,Magnetometer,,,Barometer,Orientation,,,\n"
    ",X,Y,Z,X,Y,Z,X,Y,Z,,S,X,Y,Z\n"
    "1550879504438281,0,0,9.8,0,0,0,0,0,0,4636858284341460992,1,0,0,0\n"
    "1550879504446093,0,0,9.8,0,0,0,0,0,0,4636858284341460992,1,0,0,0\n",
}


@settings(max_examples=300, deadline=None)
@given(
    name=st.sampled_from(sorted(FILES)),
    edits=st.lists(
        st.tuples(st.floats(0, 1), st.integers(0, 40), st.binary(max_size=12)), max_size=3
    ),
    end=st.one_of(st.just(1.0), st.floats(0, 1)),
)
def test_damage_of_any_kind_is_read_or_refused_in_one_line(
    tmp_path_factory: pytest.TempPathFactory,
    name: str,
    edits: list[tuple[float, int, bytes]],
    end: float,
) -> None:
    data = FILES[name].encode()
    for place, length, new in edits:
        start = int(place * len(data))
        data = data[:start] + new + data[start + length :]
    path = tmp_path_factory.mktemp("damaged") / name
    path.write_bytes(data[: int(end * len(data))])
    refusal = None
    try:
        read_recording(path, units={"acc": "m/s^2"})
    except RecordingError as error:
        refusal = error
    if refusal is not None:
        assert refusal.file == name
        assert len(str(refusal).splitlines()) == 1
