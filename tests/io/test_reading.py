"""The format is found by content, and a compressed file is read as it is."""

import bz2
import gzip
import hashlib
import lzma
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import swaystride.io
from swaystride.io.reading import read_recording
from swaystride.io.xsens_txt_writer import write_xsens_txt
from swaystride.recording import load_recording, save_recordings


def xsens(path: Path) -> Path:
    acc = np.outer([0.6, 0.0, 0.8], np.full(50, 9.8))
    lost = np.arange(50) == 7
    write_xsens_txt(path, acc, acc / 100, rate_hz=100.0, first_packet=65530, lost=lost)
    return path


@pytest.mark.parametrize("compress", [lzma.compress, gzip.compress, bz2.compress])
@pytest.mark.parametrize("name", ["a.txt", "a.csv", "a.xz", "a"])
def test_neither_extension_nor_compression_matters(
    tmp_path: Path, compress: Callable[[bytes], bytes], name: str
) -> None:
    plain = xsens(tmp_path / "plain.txt")
    (tmp_path / name).write_bytes(compress(plain.read_bytes()))
    found = read_recording(tmp_path / name)
    xr.testing.assert_equal(
        found.assign_coords(sensor=["s"]), read_recording(plain).assign_coords(sensor=["s"])
    )
    assert found.attrs["source_file"] == name
    on_disk = (tmp_path / name).read_bytes()
    assert found.attrs["source_sha256"] == hashlib.sha256(on_disk).hexdigest()


def test_what_was_read_can_be_saved(tmp_path: Path) -> None:
    recording = read_recording(xsens(tmp_path / "a.txt"), sensor="lumbar")
    save_recordings(tmp_path / "a.nc", {"trial-1": recording})
    stored = load_recording(tmp_path / "a.nc", "trial-1")
    xr.testing.assert_allclose(stored, recording, rtol=1e-7)
    assert stored.attrs["findings"] == recording.attrs["findings"]
    assert stored.attrs["first_packet"] == 65530


def test_the_room_exports_the_reader() -> None:
    assert swaystride.io.read_recording is read_recording
