"""APDM Opal HDF5: all versions read, version 5 written, damage refused in one line."""

import gzip
from collections.abc import Callable, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.errors import RecordingError
from swaystride.io.opal_hdf5 import read_opal_annotations
from swaystride.io.opal_hdf5_writer import LABEL_BYTES, OpalRun, OpalWriter, write_opal_hdf5
from swaystride.io.reading import read_recording
from swaystride.recording import Recording, findings_of, make_recording, save_recordings

START_US = 1_700_000_000_123_456
LABELS = ("Lumbar", "Left Foot")
IDS = ("XI-010284", "5718")
FLOAT32 = 2.0**-24


def signals(n_sensors: int, n: int, seed: int = 1) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(seed)
    quat = rng.normal(size=(n_sensors, 4, n))
    return {
        "acc": rng.normal(0, 3, (n_sensors, 3, n)) + np.array([9.0, 1.0, -3.0])[:, None],
        "gyr": rng.normal(0, 2, (n_sensors, 3, n)),
        "mag": rng.normal(0, 30e-6, (n_sensors, 3, n)),
        "quat": quat / np.linalg.norm(quat, axis=1, keepdims=True),
    }


def recording(labels: Sequence[str], n: int, rate_hz: float = 128.0, seed: int = 1) -> Recording:
    values = signals(len(labels), n, seed)
    made = make_recording(
        rate_hz=rate_hz,
        rate_source="argument",
        sensors=labels,
        acc_m_s2=values["acc"],
        gyr_rad_s=values["gyr"],
        mag=values["mag"],
        quat_world_from_sensor=values["quat"],
    )
    made["mag"].attrs["units"] = "T"
    return made


def good(path: Path, n: int = 40) -> Path:
    write_opal_hdf5(path, recording(LABELS, n), ids=IDS, start_unix_us=START_US)
    return path


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("opal")


labels_strategy = st.lists(
    st.text(st.characters(codec="utf-8", exclude_categories=("C", "Z")), min_size=1, max_size=12)
    .filter(lambda text: len(text.encode()) <= LABEL_BYTES)
    .filter(lambda text: text == text.strip()),
    min_size=1,
    max_size=4,
    unique=True,
)


@settings(max_examples=60, deadline=None)
@given(
    labels=labels_strategy,
    n=st.integers(12, 150),
    rate_hz=st.sampled_from([20.0, 128.0, 199.5, 500.0]),
    gaps=st.lists(st.tuples(st.floats(0, 1), st.integers(1, 30)), max_size=3),
    pieces=st.lists(st.integers(0, 150), max_size=4),
    seed=st.integers(0, 2**32 - 1),
)
def test_round_trip_in_any_pieces(
    folder: Path,
    labels: list[str],
    n: int,
    rate_hz: float,
    gaps: list[tuple[float, int]],
    pieces: list[int],
    seed: int,
) -> None:
    rng = np.random.default_rng(seed)
    lost = np.zeros(n, dtype=bool)
    for place, length in gaps:
        # Most steps must be of one sample, or the stamps would show another rate.
        lost[8 + int(place * (n - 8)) :][:length] = True
    lost[n // 2 :] &= n > 20
    single = rng.random((len(labels), n)) < 0.05
    truth = signals(len(labels), n, seed)
    for values in truth.values():
        values[:, :, lost] = np.nan
    truth["gyr"].transpose(0, 2, 1)[single] = np.nan
    run = OpalRun(
        ids=tuple(f"SI-{i:06d}" for i in range(len(labels))),
        labels=tuple(labels),
        rate_hz=rate_hz,
        start_unix_us=START_US,
        timezone_offset_h=-7.0,
        mag=True,
        quat=True,
    )
    bounds = [0, *sorted(min(piece, n) for piece in pieces), n]
    with OpalWriter(folder / "a.h5", run) as writer:
        for start, stop in pairwise(bounds):
            writer.append(
                acc_m_s2=truth["acc"][:, :, start:stop],
                gyr_rad_s=truth["gyr"][:, :, start:stop],
                mag_t=truth["mag"][:, :, start:stop],
                quat_world_from_sensor=truth["quat"][:, :, start:stop],
            )
    found = read_recording(folder / "a.h5")
    assert found["sensor"].values.tolist() == labels
    assert found.attrs["rate_hz"] == rate_hz
    assert found.attrs["start_unix_us"] == START_US
    assert found.attrs["timezone_offset_h"] == -7.0
    for name, values in truth.items():
        bound = 2 * FLOAT32 * np.abs(np.nan_to_num(values)).max()
        np.testing.assert_allclose(found[name].values, values, rtol=0, atol=bound)


def test_the_file_is_the_same_however_it_was_cut(tmp_path: Path) -> None:
    truth = signals(2, 100)
    run = OpalRun(ids=IDS, labels=LABELS, rate_hz=500.0, start_unix_us=START_US)
    contents = []
    for name, step in (("a.h5", 100), ("b.h5", 7)):
        with OpalWriter(tmp_path / name, run) as writer:
            for start in range(0, 100, step):
                part = slice(start, start + step)
                writer.append(acc_m_s2=truth["acc"][:, :, part], gyr_rad_s=truth["gyr"][:, :, part])
        found = read_recording(tmp_path / name)
        contents.append(np.stack([found["acc"].values, found["gyr"].values]))
    np.testing.assert_array_equal(*contents)


def test_a_gap_is_found_in_the_time_stamps(tmp_path: Path) -> None:
    made = recording(LABELS, 30)
    for name in ("acc", "gyr", "mag", "quat"):
        made[name].values[:, :, 10:13] = np.nan
    write_opal_hdf5(tmp_path / "a.h5", made, ids=IDS, start_unix_us=START_US)
    with h5py.File(tmp_path / "a.h5") as file:
        assert len(file["Sensors/5718/Time"]) == 27
    (finding,) = findings_of(read_recording(tmp_path / "a.h5"))
    assert finding.found == "3 of 30 packets lost in 1 gap, the longest 3 packets (0.023 s)"
    assert finding.place == "first at t = 0.078 s, before row 10"


def test_a_lost_end_is_kept(tmp_path: Path) -> None:
    made = recording(LABELS, 30)
    for name in ("acc", "gyr", "mag", "quat"):
        made[name].values[:, :, 25:] = np.nan
    write_opal_hdf5(tmp_path / "a.h5", made, ids=IDS, start_unix_us=START_US)
    assert read_recording(tmp_path / "a.h5").sizes["time"] == 30


def test_the_layout_of_version_5(tmp_path: Path) -> None:
    run = OpalRun(IDS, LABELS, 500.0, START_US, note="simulated")
    with OpalWriter(tmp_path / "a.h5", run) as writer:
        writer.append(acc_m_s2=np.full((2, 3, 5), 6.0), gyr_rad_s=np.zeros((2, 3, 5)))
        writer.annotate(START_US + 2000, "start of the run", sensor="5718")
    with h5py.File(tmp_path / "a.h5") as file:
        assert file.attrs["FileFormatVersion"] == 5
        sensor = file["Sensors/XI-010284"]
        assert sensor["Time"].dtype.kind == "i"
        assert np.diff(sensor["Time"][()]).tolist() == [2000] * 4
        assert sensor["Accelerometer"].shape == (5, 3)
        assert sensor["Temperature"].shape == (5,)
        assert sensor["Configuration"].attrs["Label 0"] == b"Lumbar"
        assert sensor["Configuration"].attrs["Sample Rate"] == 500
    notes = read_opal_annotations(tmp_path / "a.h5")
    assert notes.to_dict("list") == {
        "time_unix_us": [START_US + 2000],
        "sensor": ["5718"],
        "annotation": ["start of the run"],
    }
    assert len(read_opal_annotations(good(tmp_path / "b.h5"))) == 0


def test_a_run_that_breaks_off_leaves_no_file(tmp_path: Path) -> None:
    run = OpalRun(IDS, LABELS, 500.0, START_US)
    with (
        pytest.raises(RecordingError, match="the signals do not fit the run"),
        OpalWriter(tmp_path / "a.h5", run) as writer,
    ):
        writer.append(acc_m_s2=np.ones((2, 3, 5)), gyr_rad_s=np.zeros((2, 3, 4)))
    assert not (tmp_path / "a.h5").exists()


@pytest.mark.parametrize(
    "change",
    [
        {"ids": ("1", "1")},
        {"ids": ("1/2", "3")},
        {"ids": (), "labels": ()},
        {"labels": ("Lumbar", "x" * (LABEL_BYTES + 1))},
        {"labels": ("Lumbar ", "Foot")},
        {"rate_hz": 0.0},
    ],
)
def test_runs_that_do_not_fit_the_format(change: dict[str, Any]) -> None:
    with pytest.raises(RecordingError):
        OpalRun(**{"ids": IDS, "labels": LABELS, "rate_hz": 500.0, "start_unix_us": 0} | change)


def test_a_field_without_unit_is_not_written(tmp_path: Path) -> None:
    made = recording(LABELS, 5)
    made["mag"].attrs["units"] = "a.u."
    with pytest.raises(RecordingError, match=r"no unit that the format knows; expected T; found"):
        write_opal_hdf5(tmp_path / "a.h5", made, ids=IDS, start_unix_us=0)
    with pytest.raises(RecordingError, match=r"a signal is missing \(gyr\)"):
        write_opal_hdf5(tmp_path / "a.h5", made.drop_vars("gyr"), ids=IDS, start_unix_us=0)


def old_version(path: Path, version: int, lists_are_datasets: bool) -> dict[str, np.ndarray]:
    """A file of version 2 to 4, with what is in it."""
    truth = signals(2, 30)
    with h5py.File(path, "w") as file:
        file.attrs["FileFormatVersion"] = version
        lists = {
            "CaseIdList": np.array([b"SI-000738\x00\x00", b"SI-000739"]),
            "MonitorLabelList": np.array([b"Lumbar   ", b"Left Foot"]),
        }
        for name, value in lists.items():
            if lists_are_datasets and name == "CaseIdList":
                file[name] = value
            else:
                file.attrs[name] = value
        for position, case in enumerate(("SI-000738", "SI-000739")):
            group = file.create_group(case)
            group.attrs["SampleRate"] = 128
            group["Time"] = (START_US + np.arange(30) * 1e6 / 128).astype(np.uint64)
            group["Calibrated/Accelerometers"] = truth["acc"][position].T
            group["Calibrated/Gyroscopes"] = truth["gyr"][position].T
            group["Calibrated/Magnetometers"] = truth["mag"][position].T * 1e6
            group["Calibrated/Orientation"] = truth["quat"][position].T
    return truth


@pytest.mark.parametrize(("version", "datasets"), [(2, True), (3, False), (4, False)])
def test_older_versions(tmp_path: Path, version: int, datasets: bool) -> None:
    truth = old_version(tmp_path / "a.h5", version, datasets)
    found = read_recording(tmp_path / "a.h5")
    assert found["sensor"].values.tolist() == list(LABELS)
    for name, values in truth.items():
        np.testing.assert_allclose(found[name].values, values, rtol=1e-12)
    assert (found.attrs["rate_hz"], found.attrs["rate_source"]) == (128.0, "header")
    with h5py.File(tmp_path / "a.h5", "a") as file:
        file.attrs["MonitorLabelList"] = np.array([b"Lumbar"])
    with pytest.raises(RecordingError, match="cases and labels differ in number"):
        read_recording(tmp_path / "a.h5")


def edited(path: Path, edit: Callable[[h5py.File], None]) -> Path:
    with h5py.File(good(path), "a") as file:
        edit(file)
    return path


def test_labels_are_padded_or_stand_in_the_strings(tmp_path: Path) -> None:
    def spaces(file: h5py.File) -> None:
        configuration = file["Sensors/XI-010284/Configuration"]
        configuration.attrs["Label 0"] = np.array(b"Sternum   ", dtype="S10")
        configuration = file["Sensors/5718/Configuration"]
        del configuration.attrs["Label 0"]
        layout = [("Config Name", "S8"), ("Unit", "S4"), ("Value", "S16")]
        rows = np.array([(b"Label 0", b"", b"Right Foot"), (b"Other", b"", b"x")], dtype=layout)
        configuration["Config Strings"] = rows

    found = read_recording(edited(tmp_path / "a.h5", spaces))
    assert sorted(found["sensor"].values.tolist()) == ["Right Foot", "Sternum"]


def test_labels_that_repeat_or_are_empty_are_replaced_by_ids(tmp_path: Path) -> None:
    def repeat(file: h5py.File) -> None:
        for name in IDS:
            file[f"Sensors/{name}/Configuration"].attrs["Label 0"] = b"Foot"

    def empty(file: h5py.File) -> None:
        for name in IDS:
            file[f"Sensors/{name}/Configuration"].attrs["Label 0"] = b"   "

    for edit in (repeat, empty):
        found = read_recording(edited(tmp_path / "a.h5", edit))
        assert sorted(found["sensor"].values.tolist()) == sorted(IDS)


def test_sensors_are_selected_by_label(tmp_path: Path) -> None:
    path = good(tmp_path / "a.h5")
    found = read_recording(path, sensor="Left Foot")
    assert found["sensor"].values.tolist() == ["Left Foot"]
    whole = read_recording(path).sel(sensor=["Left Foot"])
    np.testing.assert_array_equal(found["acc"].values, whole["acc"].values)
    with pytest.raises(RecordingError) as caught:
        read_recording(path, sensor="Sternum")
    assert caught.value.problem == "no such sensor"
    assert "Left Foot" in str(caught.value.expected)


def shift_clock(file: h5py.File, shift_us: int) -> None:
    time = file["Sensors/5718/Time"]
    time[...] = time[()] + shift_us


def shorten(file: h5py.File) -> None:
    for item in file["Sensors/5718"].values():
        if isinstance(item, h5py.Dataset):
            item.resize(39, axis=0)
    file["Processed/5718/Orientation"].resize(39, axis=0)


def test_sensors_of_unequal_length_name_both(tmp_path: Path) -> None:
    path = edited(tmp_path / "a.h5", shorten)
    with pytest.raises(RecordingError) as caught:
        read_recording(path, sensor=list(LABELS))
    assert str(caught.value) == (
        "a.h5: Left Foot beside Lumbar: sensors of unequal length; expected 40 samples; "
        "found 39 samples"
    )
    assert read_recording(path, sensor="Left Foot").sizes["time"] == 39


def test_sensors_of_unequal_clock_name_both(tmp_path: Path) -> None:
    path = edited(tmp_path / "a.h5", lambda file: shift_clock(file, 7000))
    with pytest.raises(RecordingError) as caught:
        read_recording(path, sensor=list(LABELS))
    assert str(caught.value) == (
        "a.h5: Left Foot beside Lumbar: sensors of unequal clock; expected the same time stamps; "
        "found stamps 7000 µs apart, in row 0"
    )
    path = edited(tmp_path / "b.h5", lambda file: shift_clock(file, 500))
    (finding,) = findings_of(read_recording(path, sensor=list(LABELS)))
    assert (finding.check, finding.severity) == ("sensor_clock", "warning")
    path = edited(tmp_path / "c.h5", lambda file: shift_clock(file, 1))
    assert findings_of(read_recording(path)) == []


def test_the_rate_is_measured_and_compared(tmp_path: Path) -> None:
    def rate_of_both(rate: Any) -> Callable[[h5py.File], None]:
        def edit(file: h5py.File) -> None:
            for name in IDS:
                file[f"Sensors/{name}/Configuration"].attrs["Sample Rate"] = rate

        return edit

    def no_rate(file: h5py.File) -> None:
        for name in IDS:
            del file[f"Sensors/{name}/Configuration"].attrs["Sample Rate"]

    def one_rate(file: h5py.File) -> None:
        file["Sensors/5718/Configuration"].attrs["Sample Rate"] = 100

    (finding,) = findings_of(read_recording(edited(tmp_path / "a.h5", rate_of_both(100))))
    assert (finding.check, finding.expected) == (
        "sampling_rate",
        "time stamps at the stated 100 Hz",
    )
    measured = read_recording(edited(tmp_path / "b.h5", no_rate))
    assert measured.attrs["rate_source"] == "time stamps"
    assert measured.attrs["rate_hz"] == pytest.approx(128.0, rel=1e-4)
    for edit, problem in (
        (one_rate, "sensors of unequal rate"),
        (rate_of_both(0), "the sampling rate is not a positive number"),
        (rate_of_both(b"fast"), "an attribute is not a number"),
    ):
        with pytest.raises(RecordingError, match=problem):
            read_recording(edited(tmp_path / "c.h5", edit))
    with pytest.raises(RecordingError, match="the argument rate_hz contradicts the file"):
        read_recording(good(tmp_path / "d.h5"), rate_hz=100.0)
    with pytest.raises(RecordingError, match="the argument units contradicts the unit of acc"):
        read_recording(tmp_path / "d.h5", units={"acc": "g"})


def replace_data(name: str, **creation: Any) -> Callable[[h5py.File], None]:
    def edit(file: h5py.File) -> None:
        del file[name]
        file.create_dataset(name, **creation)

    return edit


ACC = "Sensors/5718/Accelerometer"
DAMAGE: dict[str, tuple[Callable[[h5py.File], None], str]] = {
    "a signal of another length": (
        replace_data(ACC, data=np.ones((39, 3))),
        "/Sensors/5718: Accelerometer: a signal and its time stamps differ in length; "
        "expected 40 rows; found 39 rows",
    ),
    "two columns": (
        replace_data(ACC, data=np.ones((40, 2))),
        "/Sensors/5718/Accelerometer: a data set has the wrong shape or type; "
        "expected (n, 3) numbers; found (40, 2) of type float64",
    ),
    "text": (
        replace_data("Sensors/5718/Time", data=np.array([b"a"] * 40)),
        "/Sensors/5718/Time: a data set has the wrong shape or type; expected (n,) whole numbers; ",
    ),
    "time as float": (
        replace_data("Sensors/5718/Time", data=np.arange(40.0)),
        "/Sensors/5718/Time: a data set has the wrong shape or type; expected (n,) whole numbers; ",
    ),
    "no time": (
        lambda file: file.__delitem__("Sensors/5718/Time"),
        "/Sensors/5718/Time: a data set is missing; ",
    ),
    "infinite": (
        lambda file: file[ACC].__setitem__((7, 0), np.inf),
        "/Sensors/5718: Accelerometer, row 7: an infinite number",
    ),
    "forged size, chunked": (
        lambda file: file[ACC].resize((10**12, 3)),
        f"{'/' + ACC}: the file does not hold what it declares; expected 12000000000000 bytes for ",
    ),
    "forged size, contiguous": (
        replace_data(ACC, shape=(10**12, 3), dtype="f8"),
        f"{'/' + ACC}: the file does not hold what it declares; expected 24000000000000 bytes for ",
    ),
    "forged size, compressed": (
        replace_data(ACC, shape=(10**12, 3), dtype="f8", chunks=(1000, 3), compression="gzip"),
        f"{'/' + ACC}: the file does not hold what it declares; expected 24000000000000 bytes for ",
    ),
    "forged size of the time": (
        lambda file: file["Sensors/5718/Time"].resize((10**13,)),
        "/Sensors/5718/Time: the file does not hold what it declares; ",
    ),
    "data elsewhere": (
        replace_data(ACC, shape=(40, 3), dtype="f8", external=[("/etc/hostname", 0, 960)]),
        f"{'/' + ACC}: the file does not hold what it declares; expected 960 bytes for (40, 3); "
        "found data in other files",
    ),
    "no sensors": (
        lambda file: file.__delitem__("Sensors"),
        "/Sensors: a group is missing; ",
    ),
    "no configuration": (
        lambda file: file.__delitem__("Sensors/5718/Configuration"),
        "/Sensors/5718/Configuration: a group is missing; ",
    ),
    "another version": (
        lambda file: file.attrs.__setitem__("FileFormatVersion", 6),
        "root attribute FileFormatVersion: unknown version of Opal HDF5; "
        "expected 2, 3, 4 or 5; found 6",
    ),
    "acceleration in g": (
        lambda file: file[ACC].__setitem__(..., file[ACC][()] / 9.80665),
        "Left Foot acc: acceleration unit; ",
    ),
}


@pytest.mark.parametrize("case", DAMAGE)
def test_damage_is_refused_with_its_place(tmp_path: Path, case: str) -> None:
    edit, message = DAMAGE[case]
    path = edited(tmp_path / "a.h5", edit)
    with pytest.raises(RecordingError) as caught:
        read_recording(path)
    assert str(caught.value).startswith(f"a.h5: {message}")


def test_a_compressed_data_set_is_read(tmp_path: Path) -> None:
    truth = np.full((40, 3), 6.0)
    path = edited(tmp_path / "a.h5", replace_data(ACC, data=truth, chunks=(16, 3), compression=9))
    found = read_recording(path).sel(sensor="Left Foot")
    np.testing.assert_array_equal(found["acc"].values.T, truth)


@pytest.mark.parametrize("share", [0.02, 0.3, 0.5, 0.9, 0.999])
def test_a_file_cut_off(tmp_path: Path, share: float) -> None:
    data = good(tmp_path / "a.h5").read_bytes()
    (tmp_path / "a.h5").write_bytes(data[: int(share * len(data))])
    with pytest.raises(RecordingError) as caught:
        read_recording(tmp_path / "a.h5")
    assert str(caught.value).startswith(
        "a.h5: the HDF5 file is damaged or cut off; expected a whole HDF5 file; found"
    )


def test_other_files_that_are_hdf5(tmp_path: Path) -> None:
    save_recordings(tmp_path / "a.nc", {"trial": recording(LABELS, 5)})
    with pytest.raises(RecordingError) as caught:
        read_recording(tmp_path / "a.nc")
    assert str(caught.value) == (
        "a.nc: root attribute FileFormatVersion: not an Opal HDF5 file; expected 2, 3, 4 or 5; "
        "found no such attribute"
    )


def test_compressed_files_say_what_to_do(tmp_path: Path) -> None:
    (tmp_path / "a.h5.gz").write_bytes(gzip.compress(good(tmp_path / "a.h5").read_bytes()))
    with pytest.raises(RecordingError, match="a compressed HDF5 file is not read; expected the fi"):
        read_recording(tmp_path / "a.h5.gz")
    with pytest.raises(RecordingError, match=r"not compressed; found a file compressed with gzip"):
        read_opal_annotations(tmp_path / "a.h5.gz")
    (tmp_path / "b.h5").write_bytes(b"")
    with pytest.raises(RecordingError, match=r"b\.h5: empty file"):
        read_opal_annotations(tmp_path / "b.h5")


@settings(max_examples=150, deadline=None)
@given(
    edits=st.lists(st.tuples(st.floats(0, 1), st.binary(min_size=1, max_size=8)), max_size=4),
    end=st.one_of(st.just(1.0), st.floats(0, 1)),
)
def test_damage_of_any_kind_is_read_or_refused_in_one_line(
    folder: Path, edits: list[tuple[float, bytes]], end: float
) -> None:
    path = folder / "whole.h5"
    if not path.exists():
        good(path)
    data = bytearray(path.read_bytes())
    for place, new in edits:
        start = int(place * (len(data) - len(new)))
        data[start : start + len(new)] = new
    (folder / "damaged.h5").write_bytes(data[: int(end * len(data))])
    refusal = None
    try:
        read_recording(folder / "damaged.h5")
    except RecordingError as error:
        refusal = error
    if refusal is not None:
        assert Path(str(refusal.file)).name == "damaged.h5"
        assert "\n" not in str(refusal)
