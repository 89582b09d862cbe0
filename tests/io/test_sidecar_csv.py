"""CSV described by a JSON sidecar: reader, writer, schema."""

import gzip
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.errors import RecordingError
from swaystride.io.reading import read_recording
from swaystride.io.sidecar_csv import sidecar_path
from swaystride.io.sidecar_csv_writer import write_sidecar_csv
from swaystride.recording import findings_of, make_recording
from swaystride.units import FACTORS_TO_SI

SIDECAR: dict[str, Any] = {
    "format": "swaystride-csv-1",
    "delimiter": ";",
    "decimal": ",",
    "skip_lines": 1,
    "time": {"column": "t", "unit": "ms"},
    "units": {"acc": "g", "gyr": "deg/s"},
    "sensors": {"lumbar": {"acc": ["az", "ax", "ay"], "gyr": ["gx", "gy", "gz"]}},
    "world_frame": "NWU",
    "device": "our own",
}
TEXT = (
    'Our laboratory\n"t";"ax";"ay";"az";"gx";"gy";"gz";"note"\n'
    "0;0,1;0,2;1,0;10;20;30;x\n10;0,1;0,2;1,0;10;20;30;y\n40;0,1;0,2;1,0;10;20;30;z\n"
)


def write(folder: Path, sidecar: dict[str, Any] | str = SIDECAR, text: str = TEXT) -> Path:
    (folder / "walk.csv").write_text(text)
    (folder / "walk.json").write_text(sidecar if isinstance(sidecar, str) else json.dumps(sidecar))
    return folder / "walk.csv"


def test_columns_units_and_gaps_follow_the_sidecar(tmp_path: Path) -> None:
    recording = read_recording(write(tmp_path))
    assert recording.attrs["rate_hz"] == pytest.approx(100.0)
    assert recording.attrs["world_frame"] == "NWU"
    assert recording.sizes["time"] == 5
    np.testing.assert_allclose(
        recording["acc"].values[0, :, 0], np.array([1.0, 0.1, 0.2]) * 9.80665
    )
    np.testing.assert_allclose(recording["gyr"].values[0, :, 4], np.radians([10, 20, 30]))
    assert [finding.check for finding in findings_of(recording)] == ["packet_loss"]


def test_a_compressed_file_shares_the_sidecar(tmp_path: Path) -> None:
    path = write(tmp_path)
    compressed = tmp_path / "walk.csv.gz"
    compressed.write_bytes(gzip.compress(path.read_bytes()))
    xr.testing.assert_equal(read_recording(compressed), read_recording(path))


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), n=st.integers(2, 60), signals=st.sets(
    st.sampled_from(["acc_m_s2", "gyr_rad_s", "mag", "quat_world_from_sensor"]), min_size=1
))  # fmt: skip
def test_round_trip_is_exact(
    tmp_path_factory: pytest.TempPathFactory, seed: int, n: int, signals: set[str]
) -> None:
    rng = np.random.default_rng(seed)
    size = {"quat_world_from_sensor": 4}
    arrays = {s: rng.normal(size=(2, size.get(s, 3), n)) for s in sorted(signals)}
    if "acc_m_s2" in arrays:
        arrays["acc_m_s2"] += 9.0
    lost = rng.random(n) < 0.3
    lost[[0, -1]] = False
    for values in arrays.values():
        values[:, :, lost] = np.nan
    recording = make_recording(
        rate_hz=100 / 3,
        rate_source="argument",
        sensors=["lumbar", "left foot"],
        world_frame="ENU",
        **arrays,  # type: ignore[arg-type]
    )
    path = tmp_path_factory.mktemp("sidecar") / "walk.csv"
    write_sidecar_csv(path, recording)
    found = read_recording(path)
    xr.testing.assert_equal(found, recording)
    assert found.attrs["rate_hz"] == 100 / 3
    assert found.attrs["world_frame"] == "ENU"
    assert [f.check for f in findings_of(found)] == (["packet_loss"] if lost.any() else [])


def without(key: str) -> dict[str, Any]:
    return {k: v for k, v in SIDECAR.items() if k != key}


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), n=st.integers(2, 60))
def test_whole_numbers_lose_half_a_unit(
    tmp_path_factory: pytest.TempPathFactory, seed: int, n: int
) -> None:
    path = tmp_path_factory.mktemp("whole") / "walk.csv"
    rng = np.random.default_rng(seed)
    acc, gyr = rng.normal(size=(2, 1, 3, n)) * [[[[15.0]]], [[[5.0]]]]
    acc[..., n // 2], gyr[..., n // 2] = np.nan, np.nan
    acc[..., [0, -1]], gyr[..., [0, -1]] = 9.8, 0.1
    recording = make_recording(
        rate_hz=1000.0, rate_source="argument", sensors=["foot"], acc_m_s2=acc, gyr_rad_s=gyr
    )
    write_sidecar_csv(path, recording, whole={"acc": "mg", "gyr": "mdeg/s"})
    assert "." not in path.read_text().split("\n", 1)[1]
    found = read_recording(path)
    for name, quantity, unit in (
        ("acc", "acceleration", "mg"),
        ("gyr", "angular_rate", "mdeg/s"),
    ):
        np.testing.assert_allclose(
            found[name].values,
            recording[name].values,
            rtol=0,
            atol=0.5001 * FACTORS_TO_SI[quantity][unit],
        )


def test_whole_numbers_are_printed_as_pandas_would(tmp_path: Path) -> None:
    acc = np.arange(-12.0, 12.0).reshape(1, 3, 8)
    recording = make_recording(rate_hz=50.0, rate_source="argument", sensors=["foot"], acc_m_s2=acc)
    write_sidecar_csv(tmp_path / "a.csv", recording, whole={"acc": "m/s^2"})
    assert (tmp_path / "a.csv").read_text().splitlines()[:3] == [
        "sample,foot_acc_x,foot_acc_y,foot_acc_z",
        "0,-12,-4,4",
        "1,-11,-3,5",
    ]


@pytest.mark.parametrize(
    ("sidecar", "message"),
    [
        ("{swaystride-csv-1", "walk.json: the sidecar is not JSON"),
        (without("time"), "walk.json: $: the sidecar does not follow its schema"),
        (without("delimiter"), "walk.json: $: the sidecar does not follow its schema"),
        (SIDECAR | {"rate": 100.0}, "walk.json: $: the sidecar does not follow its schema"),
        (SIDECAR | {"rate_hz": 0}, "walk.json: $.rate_hz: the sidecar does not follow its schema"),
        (
            SIDECAR | {"units": {"acc": "furlong"}},
            "walk.json: $.units.acc: the sidecar does not follow its schema",
        ),
        (
            SIDECAR | {"units": {"acc": "g"}},
            "walk.json: $.units: the sidecar states no unit of gyr",
        ),
        (SIDECAR | {"delimiter": "|"}, "walk.csv: line 2: wrong delimiter: one column found"),
        (SIDECAR | {"skip_lines": 9}, "walk.csv: line 10: wrong delimiter: one column found"),
        (
            SIDECAR | {"sensors": {"lumbar": {"acc": ["ax", "ay", "a_z"]}}},
            "walk.csv: line 2: column a_z is missing",
        ),
        (
            SIDECAR | {"decimal": "."},
            "walk.csv: line 3, column 2 (ax): not a number",
        ),
        (
            SIDECAR | {"sensors": {"lumbar": {"acc": ["ax", "ay", "note"]}}},
            "walk.csv: line 3, column 8 (note): not a number",
        ),
    ],
)
def test_the_error_line(tmp_path: Path, sidecar: dict[str, Any] | str, message: str) -> None:
    with pytest.raises(RecordingError) as caught:
        read_recording(write(tmp_path, sidecar))
    assert str(caught.value).startswith(message)


def test_a_decimal_point_where_commas_are_announced(tmp_path: Path) -> None:
    with pytest.raises(RecordingError) as caught:
        read_recording(write(tmp_path, text=TEXT.replace("0,2", "0.2", 1)))
    assert str(caught.value) == (
        "walk.csv: line 3, column 3 (ay): not a number; "
        "expected a finite number, an empty field or NaN; found '0.2'"
    )


def test_rate_and_time_stamps_are_compared(tmp_path: Path) -> None:
    recording = read_recording(write(tmp_path, SIDECAR | {"rate_hz": 100.0}))
    assert recording.attrs["rate_source"] == "header"
    assert [finding.check for finding in findings_of(recording)] == ["packet_loss"]
    recording = read_recording(write(tmp_path, SIDECAR | {"rate_hz": 90.0}))
    assert [finding.check for finding in findings_of(recording)] == ["sampling_rate", "packet_loss"]


def test_a_packet_counter_beside_time_stamps(tmp_path: Path) -> None:
    sidecar = SIDECAR | {"packet_counter": "n", "rate_hz": 90.0}
    text = (
        TEXT.replace('"note"', '"n"').replace(";x", ";7").replace(";y", ";8").replace(";z", ";11")
    )
    recording = read_recording(write(tmp_path, sidecar, text))
    assert recording.attrs["first_packet"] == 7
    assert recording.sizes["time"] == 5
    rate, loss = findings_of(recording)
    assert (rate.check, rate.found) == ("sampling_rate", "time stamps at 100 Hz")
    assert loss.check == "packet_loss"


def test_neither_counter_nor_time(tmp_path: Path) -> None:
    recording = read_recording(write(tmp_path, without("time") | {"rate_hz": 100.0}))
    assert recording.sizes["time"] == 3
    assert [finding.check for finding in findings_of(recording)] == ["no_packet_counter"]


def test_a_json_file_that_is_no_sidecar_is_left_alone(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="unknown format"):
        read_recording(write(tmp_path, '{"Subject": 1}'))


def test_a_label_that_does_not_fit_a_column_name(tmp_path: Path) -> None:
    recording = make_recording(
        rate_hz=1.0, rate_source="argument", sensors=["foot, left"], acc_m_s2=np.zeros((1, 3, 2))
    )
    with pytest.raises(RecordingError, match="a sensor label does not fit a column name"):
        write_sidecar_csv(tmp_path / "a.csv", recording)


def test_the_schema_accepts_the_units_of_the_library() -> None:
    schema_path = Path(__file__).parents[2] / "src/swaystride/io/sidecar.schema.json"
    properties = json.loads(schema_path.read_text())["properties"]
    units = properties["units"]["properties"]
    assert units["acc"]["enum"] == list(FACTORS_TO_SI["acceleration"])
    assert units["gyr"]["enum"] == list(FACTORS_TO_SI["angular_rate"])
    assert units["mag"]["enum"] == list(FACTORS_TO_SI["magnetic_field"])
    assert properties["time"]["properties"]["unit"]["enum"] == list(FACTORS_TO_SI["time"])


@pytest.mark.parametrize("name", ["walk.csv", "walk.csv.xz", "walk.txt", "walk"])
def test_sidecar_path(name: str) -> None:
    assert sidecar_path(Path("raw") / name) == Path("raw/walk.json")
