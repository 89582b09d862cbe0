"""Chest straps: stamps as whole numbers, drop-outs as gaps, truncated rows left out."""

import gzip
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.ecg_recording import POLAR_EPOCH, UNIX_EPOCH, EcgRecording, make_ecg
from swaystride.errors import RecordingError
from swaystride.findings import Finding, findings_from_json
from swaystride.io.polar_ecg import read_ecg
from swaystride.io.polar_ecg_writer import write_ecg_logger, write_polar_acc, write_polar_ecg
from swaystride.io.reading import read_recording
from swaystride.recording import findings_of, make_recording

START_NS = 1_714_920_600_006_020_096
POLAR_NS = 768_235_800_006_020_097
RATE_HZ = 130.16


def findings(ecg: EcgRecording) -> list[Finding]:
    return findings_from_json(ecg.attrs["findings"])


def ecg_of(values: Any, clock: str = UNIX_EPOCH, **changes: Any) -> EcgRecording:
    start = START_NS if clock == UNIX_EPOCH else POLAR_NS
    arguments: dict[str, Any] = {
        "rate_hz": RATE_HZ, "rate_source": "argument", "start_ns": start, "clock_epoch": clock,
    }  # fmt: skip
    return make_ecg(values, **(arguments | changes))


def good(path: Path, n: int = 20) -> Path:
    write_ecg_logger(path, ecg_of(np.linspace(-5e-4, 1e-3, n)))
    return path


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("polar")


gaps_strategy = st.lists(st.tuples(st.floats(0, 1), st.integers(1, 300)), max_size=4)


def with_gaps(n: int, gaps: list[tuple[float, int]]) -> np.ndarray:
    lost = np.zeros(n, dtype=bool)
    for place, length in gaps:
        lost[int(place * n) :][:length] = True
    lost[: n // 2 + 2] = False
    lost[-1] = False
    return lost


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    n=st.integers(10, 1500),
    rate_hz=st.sampled_from([125.0, 130.0, 130.16]),
    start_ns=st.integers(10**18, 9 * 10**18),
    gaps=gaps_strategy,
    polar=st.booleans(),
)
def test_ecg_round_trip(
    folder: Path,
    seed: int,
    n: int,
    rate_hz: float,
    start_ns: int,
    gaps: list[tuple[float, int]],
    polar: bool,
) -> None:
    rng = np.random.default_rng(seed)
    truth = np.round(rng.normal(0, 400, n)) * 1e-6
    truth[with_gaps(n, gaps)] = np.nan
    clock, write = (POLAR_EPOCH, write_polar_ecg) if polar else (UNIX_EPOCH, write_ecg_logger)
    write(
        folder / "a.csv",
        ecg_of(truth, clock, rate_hz=rate_hz, start_ns=start_ns // (1 + 9 * polar)),
    )
    found = read_ecg(folder / "a.csv")
    assert found.attrs["start_ns"] == start_ns // (1 + 9 * polar)
    assert found.attrs["clock_epoch"] == clock
    assert found.attrs["rate_hz"] == pytest.approx(rate_hz, rel=1e-7 * 1e3 / n)
    np.testing.assert_allclose(found["ecg"].values, truth, rtol=0, atol=1e-12)
    checks = [finding.check for finding in findings(found)]
    assert checks == (["packet_loss"] if np.isnan(truth).any() else [])


@settings(max_examples=30, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    n=st.integers(10, 400),
    gaps=gaps_strategy,
    rate_hz=st.sampled_from([25.0, 50.0, 200.0]),
)
def test_acceleration_round_trip(
    folder: Path, seed: int, n: int, gaps: list[tuple[float, int]], rate_hz: float
) -> None:
    rng = np.random.default_rng(seed)
    acc_mg = np.round(rng.normal(0, 200, (3, n)) + np.array([[0], [-980], [100]]))
    truth = acc_mg * 9.80665e-3
    truth[:, with_gaps(n, gaps)] = np.nan
    recording = make_recording(
        rate_hz=rate_hz, rate_source="argument", sensors=["chest"], acc_m_s2=truth[None]
    )
    write_polar_acc(folder / "a.csv", recording, start_ns=POLAR_NS)
    found = read_recording(folder / "a.csv", sensor="chest", units={"acc": "mg"})
    np.testing.assert_allclose(found["acc"].values[0], truth, rtol=1e-12)
    assert found["sensor"].values.tolist() == ["chest"]
    assert (found.attrs["start_ns"], found.attrs["clock_epoch"]) == (POLAR_NS, POLAR_EPOCH)
    assert found.attrs["rate_hz"] == pytest.approx(rate_hz, rel=1e-6)
    assert {f.check for f in findings_of(found)} <= {"packet_loss"}
    assert set(found.data_vars) == {"acc"}


def test_reports_of_the_strap_stand_in_their_rows(tmp_path: Path) -> None:
    time_s = np.array([1.0, 1.0, 2.5, 9.99])
    rr_s, hr = [0.751, 0.702, np.nan, 0.8], [80.0, np.nan, 78.0, 79.0]
    truth = np.zeros(1301)
    truth[1:-1:2] = 1e-4
    made = ecg_of(truth, report_time_s=time_s, strap_rr_s=rr_s, strap_hr_bpm=hr)
    write_ecg_logger(tmp_path / "a.csv", made)
    found = read_ecg(tmp_path / "a.csv")
    np.testing.assert_allclose(found["report_time"].values, time_s, atol=1.01 / RATE_HZ)
    np.testing.assert_allclose(found["strap_rr_s"].values, rr_s)
    np.testing.assert_allclose(found["strap_hr_bpm"].values, hr)
    assert len(np.unique(found["report_time"].values)) == 4


def test_every_digit_of_a_stamp_counts(tmp_path: Path) -> None:
    path = good(tmp_path / "a.csv")
    assert path.read_text().splitlines()[1] == f"{START_NS},-0.500,NA,NA"
    assert read_ecg(path).attrs["start_ns"] == START_NS
    assert int(float(START_NS)) == START_NS, "a multiple of 256"
    odd = ecg_of(np.zeros(9), start_ns=START_NS + 1)
    write_ecg_logger(path, odd)
    assert read_ecg(path).attrs["start_ns"] == START_NS + 1


def test_a_row_with_a_truncated_stamp_is_left_out(tmp_path: Path) -> None:
    lines = good(tmp_path / "a.csv").read_text().splitlines(keepends=True)
    lines[7] = "17149206000" + lines[7][19:]
    lines[-1] = "171492"
    (tmp_path / "a.csv").write_text("".join(lines))
    found = read_ecg(tmp_path / "a.csv")
    seen = {finding.check: finding for finding in findings(found)}
    assert seen["truncated_time_stamp"].place == "first at line 8"
    assert seen["truncated_time_stamp"].expected == "19 digits in column time"
    assert seen["truncated_time_stamp"].found == "fewer; rows left out: 2 of 20"
    assert np.flatnonzero(np.isnan(found["ecg"].values)).tolist() == [6]
    assert found.sizes["time"] == 19
    assert seen["packet_loss"].found.startswith("1 of 19 packets lost in 1 gap")


def test_the_sensor_clock_may_pass_a_power_of_ten(tmp_path: Path) -> None:
    made = ecg_of(np.zeros(60), POLAR_EPOCH, start_ns=10**18 - 10**8)
    write_polar_ecg(tmp_path / "a.csv", made)
    found = read_ecg(tmp_path / "a.csv")
    assert (found.sizes["time"], findings(found)) == (60, [])
    lines = (tmp_path / "a.csv").read_text().splitlines(keepends=True)
    lines[3] = lines[3].replace(";9999", ";99", 1)
    (tmp_path / "a.csv").write_text("".join(lines))
    assert "truncated_time_stamp" in [f.check for f in findings(read_ecg(tmp_path / "a.csv"))]


def test_windows_line_ends_and_compression(tmp_path: Path) -> None:
    text = good(tmp_path / "a.csv").read_bytes()
    (tmp_path / "b.csv.gz").write_bytes(gzip.compress(text.replace(b"\n", b"\r\n")))
    expected, found = read_ecg(tmp_path / "a.csv"), read_ecg(tmp_path / "b.csv.gz")
    np.testing.assert_array_equal(found["ecg"].values, expected["ecg"].values)


def test_a_column_of_milliseconds_may_stand_between(tmp_path: Path) -> None:
    head = "Phone timestamp;sensor timestamp [ns];timestamp [ms];ecg [uV]\n"
    rows = [
        f"2024-05-05T14:50:00.{i:03d};{POLAR_NS + i * 7_692_308};{i * 7.7:.1f};{i - 5}\n"
        for i in range(30)
    ]
    (tmp_path / "a.txt").write_text(head + "".join(rows))
    found = read_ecg(tmp_path / "a.txt", rate_hz=130.0)
    np.testing.assert_allclose(found["ecg"].values, (np.arange(30) - 5) * 1e-6)


CASES = {
    "empty": ("", "a.csv: empty file; expected a header and rows of data; found 0 bytes"),
    "only a header": (
        "time,ecg,hr,rr\n",
        "a.csv: line 2: no data rows; expected numbers after the column row; found end of file",
    ),
    "only truncated stamps": (
        "time,ecg,hr,rr\n17149206,0.1,NA,NA\n",
        "a.csv: from line 2: no row has a whole time stamp in column time; "
        "expected 19 digits; found '17149206,0.1,NA,NA'",
    ),
    "a single row": (
        f"time,ecg,hr,rr\n{START_NS},0.1,NA,NA\n",
        "a.csv: line 2: time: a single time stamp; "
        "expected a number in every row, and at least two rows; found one row",
    ),
    "not a number": (
        f"time,ecg,hr,rr\n{START_NS},abc,NA,NA\n{START_NS + 7692308},0.1,NA,NA\n",
        "a.csv: line 2, column 2 (ecg): not a number; "
        "expected a finite number, an empty field or NaN; found 'abc'",
    ),
    "a short row": (
        f"time,ecg,hr,rr\n{START_NS},0.1\n{START_NS + 7692308},0.1,NA,NA\n",
        "a.csv: line 2: wrong number of fields; expected 4 fields separated by comma; "
        f"found 2 fields: '{START_NS},0.1'",
    ),
    "time runs backwards": (
        f"time,ecg,hr,rr\n{START_NS},0.1,NA,NA\n{START_NS - 7692308},0.1,NA,NA\n",
        "a.csv: line 3: time: time stamps do not advance by whole sampling intervals; "
        "expected a stamp at least half a sampling interval after the one before; "
        "found a step of -0.00769231 s",
    ),
    "one stamp far away": (
        "time,ecg,hr,rr\n"
        + "".join(f"{START_NS + i * 7692308},0.1,NA,NA\n" for i in range(5))
        + "9000000000000000000,0.1,NA,NA\n",
        "a.csv: almost every sample is missing; expected at least one row for 1000 samples; "
        "found 6 rows for 947060284118 samples",
    ),
    "another file": (
        "hello\n",
        "a.csv: first line: not an ECG file; expected time,ecg,hr,rr or Phone timestamp;"
        "sensor timestamp [ns];…;ecg [uV]; found 'hello'",
    ),
}


@pytest.mark.parametrize(("text", "message"), CASES.values(), ids=CASES)
def test_bad_files(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(RecordingError) as caught:
        read_ecg(tmp_path / "a.csv")
    assert str(caught.value).startswith(message)


def test_arguments_and_units_that_contradict(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="the argument rate_hz contradicts the file"):
        read_ecg(good(tmp_path / "a.csv"), rate_hz=250.0)
    head = "Phone timestamp;sensor timestamp [ns];X [mg];Y [mg];Z [g]\n"
    (tmp_path / "b.csv").write_text(head + "a;1;1;1;1\n")
    with pytest.raises(RecordingError, match="the axes of the acceleration are not three of one u"):
        read_recording(tmp_path / "b.csv")


def test_what_does_not_fit_is_not_written(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="another clock than the format"):
        write_ecg_logger(tmp_path / "a.csv", ecg_of(np.zeros(9), POLAR_EPOCH))
    with pytest.raises(RecordingError, match="the start does not fit the format"):
        write_ecg_logger(tmp_path / "a.csv", ecg_of(np.zeros(9), start_ns=10**17))
    two = make_recording(
        rate_hz=50.0, rate_source="argument", sensors=["a", "b"], acc_m_s2=np.zeros((2, 3, 5))
    )
    with pytest.raises(RecordingError, match="not the recording of a chest strap"):
        write_polar_acc(tmp_path / "a.csv", two, start_ns=0)
