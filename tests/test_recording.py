"""The recording: shapes, attributes, storage."""

import hashlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.checksums import file_sha256
from swaystride.errors import RecordingError
from swaystride.findings import Finding
from swaystride.recording import (
    Recording,
    findings_of,
    list_recordings,
    load_recording,
    make_recording,
    save_recordings,
    with_findings,
)

FINDING = Finding("packet_loss", "warning", "P01.txt", "t = 3.20 s", "no gap", "4 packets")


def recording(seed: int = 1, n_sensors: int = 2, n: int = 30, **changes: Any) -> Recording:
    rng = np.random.default_rng(seed)
    arguments: dict[str, Any] = {
        "rate_hz": 100.0,
        "rate_source": "header",
        "sensors": [f"s{i}" for i in range(n_sensors)],
        "acc_m_s2": rng.normal(size=(n_sensors, 3, n)),
        "gyr_rad_s": rng.normal(size=(n_sensors, 3, n)),
        "findings": [FINDING],
    }
    return make_recording(**(arguments | changes))


def test_dimensions_time_and_attributes() -> None:
    made = recording(
        rate_hz=128.0,
        quat_world_from_sensor=np.ones((2, 4, 30)),
        mag=np.ones((2, 3, 30)),
        device="Opal",
        world_frame="ENU",
    )
    assert made["acc"].dims == made["mag"].dims == ("sensor", "axis", "time")
    assert made["quat"].dims == ("sensor", "component", "time")
    assert made["component"].values.tolist() == ["w", "x", "y", "z"]
    np.testing.assert_array_equal(made["time"].values, np.arange(30) / 128.0)
    assert made["acc"].values.flags["C_CONTIGUOUS"]
    assert (made.attrs["device"], made.attrs["world_frame"]) == ("Opal", "ENU")


@pytest.mark.parametrize("rate", [0.0, -100.0, np.nan, np.inf])
def test_a_rate_must_be_positive(rate: float) -> None:
    with pytest.raises(RecordingError) as caught:
        recording(rate_hz=rate, source_file="a.txt")
    assert str(caught.value) == (
        f"a.txt: sampling rate is not a positive number; expected rate_hz > 0; found {rate}"
    )


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"gyr_rad_s": np.zeros((2, 3, 29))},
            "signal gyr has the wrong shape; expected (2, 3, 30); found (2, 3, 29)",
        ),
        (
            {"acc_m_s2": np.zeros((3, 30))},
            "signal acc has the wrong shape; expected (2, 3, None); found (3, 30)",
        ),
        (
            {"sensors": ["only one"]},
            "signal acc has the wrong shape; expected (1, 3, 30); found (2, 3, 30)",
        ),
        (
            {"quat_world_from_sensor": np.zeros((2, 3, 30))},
            "signal quat has the wrong shape; expected (2, 4, 30); found (2, 3, 30)",
        ),
        ({"acc_m_s2": None, "gyr_rad_s": None}, "recording without any signal"),
    ],
)
def test_signals_must_agree(change: dict[str, Any], message: str) -> None:
    with pytest.raises(RecordingError) as caught:
        recording(**change)
    assert str(caught.value) == message


def test_findings_travel_with_the_recording() -> None:
    made = recording()
    more = Finding("nan_run", "info", "P01.txt", "", "", "µ, °")
    joined = with_findings(made, [more])
    assert findings_of(joined) == [FINDING, more]
    assert findings_of(made) == [FINDING]


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), n_sensors=st.integers(1, 4), n=st.integers(1, 50))
def test_round_trip_in_float32(
    tmp_path_factory: pytest.TempPathFactory, seed: int, n_sensors: int, n: int
) -> None:
    path = tmp_path_factory.mktemp("nc") / "unit.nc"
    made = recording(seed, n_sensors, n)
    made["acc"].values[0, 0, 0] = np.nan
    save_recordings(path, {"trial-01": made})
    stored = load_recording(path, "trial-01")
    for name in ("acc", "gyr"):
        assert stored[name].dtype == np.float64
        np.testing.assert_array_equal(stored[name].values, made[name].values.astype(np.float32))
    np.testing.assert_array_equal(stored["time"].values, made["time"].values)
    assert stored["sensor"].values.tolist() == made["sensor"].values.tolist()
    assert stored.attrs["rate_hz"] == 100.0
    assert findings_of(stored) == [FINDING]


def test_a_file_holds_several_trials_and_is_replaced_whole(tmp_path: Path) -> None:
    path = tmp_path / "unit.nc"
    save_recordings(path, {"old": recording()})
    trials = {"trial-02": recording(2), "trial-01": recording(3, n=7)}
    save_recordings(path, trials)
    assert list_recordings(path) == ["trial-01", "trial-02"]
    for name, made in trials.items():
        xr.testing.assert_allclose(load_recording(path, name), made, rtol=1e-6)


def test_the_same_recordings_give_the_same_bytes(tmp_path: Path) -> None:
    hashes = set()
    for name in ("a.nc", "b.nc"):
        save_recordings(tmp_path / name, {"x": recording(5), "y": recording(6)})
        hashes.add(file_sha256(tmp_path / name))
    assert len(hashes) == 1


def test_a_group_or_file_that_is_not_there(tmp_path: Path) -> None:
    save_recordings(tmp_path / "unit.nc", {"x": recording()})
    with pytest.raises(RecordingError, match=r"unit\.nc: group y: no such recording"):
        load_recording(tmp_path / "unit.nc", "y")
    with pytest.raises(RecordingError, match=r"gone\.nc: group x: no such recording"):
        load_recording(tmp_path / "gone.nc", "x")


def test_file_sha256(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"abc" * 100_000)
    assert file_sha256(tmp_path / "a") == hashlib.sha256(b"abc" * 100_000).hexdigest()
