"""Provenance: known sums, relative sorted paths, no clock."""

from __future__ import annotations

import json
import sys
from importlib.metadata import version

import pytest

from swaystride.errors import ConfigurationError, DesignError
from swaystride.report.provenance import collect_provenance, config_hash, write_json

ABC = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"  # FIPS 180-2, "abc"
EMPTY_OBJECT = "44136fa355b3678a1146ad16f7e8649e94fb4fc21fe77e8310c060f61caaff8a"  # of "{}"


def collect(root, **options):
    settings = {"commit": "c0ffee", "config": {}, "seed": 1, "packages": ["numpy"]}
    return collect_provenance(root=root, **(settings | {"inputs": [], "outputs": []} | options))


def test_sums_are_sha256_and_paths_relative_and_sorted(tmp_path):
    (tmp_path / "data").mkdir()
    for name in ("b.csv", "a.csv"):
        (tmp_path / "data" / name).write_text("abc")
    found = collect(tmp_path, inputs=[tmp_path / "data" / "b.csv", "data/a.csv", "data/b.csv"])
    assert [entry["path"] for entry in found["inputs"]] == ["data/a.csv", "data/b.csv"]
    assert {entry["sha256"] for entry in found["inputs"]} == {ABC}
    assert {entry["bytes"] for entry in found["inputs"]} == {3}
    assert str(tmp_path) not in json.dumps(found)


def test_configuration_sum_ignores_order_and_sees_values():
    assert config_hash({}) == EMPTY_OBJECT
    assert config_hash({"a": 1, "b": {"c": 2, "d": 3}}) == config_hash(
        {"b": {"d": 3, "c": 2}, "a": 1}
    )
    assert config_hash({"a": 1}) != config_hash({"a": 1.5})


@pytest.mark.parametrize("value", [float("nan"), {1, 2}, object()])
def test_configuration_without_json_is_refused(value):
    with pytest.raises(ConfigurationError, match=r"cannot be written as JSON"):
        config_hash({"a": value})


def test_versions_are_those_installed(tmp_path):
    found = collect(tmp_path, packages=["scipy", "numpy"])
    assert found["versions"]["numpy"] == version("numpy")
    assert found["versions"]["python"] == ".".join(map(str, sys.version_info[:3]))
    with pytest.raises(ConfigurationError, match=r"version of a package; .* found no-such-thing"):
        collect(tmp_path, packages=["no-such-thing"])


def test_files_outside_and_absent_files_are_refused(tmp_path):
    root = tmp_path / "root"
    root.mkdir()
    (tmp_path / "x.csv").write_text("")
    for path in (tmp_path / "x.csv", "../x.csv"):
        with pytest.raises(DesignError, match=r"^x.csv: file outside the repository"):
            collect(root, inputs=[path])
    with pytest.raises(DesignError, match=r"^data/none.csv: no such file"):
        collect(root, outputs=["data/none.csv"])


def test_a_link_to_another_disk_counts_under_its_own_name(tmp_path):
    disk, root = tmp_path / "disk", tmp_path / "root"
    disk.mkdir()
    root.mkdir()
    (disk / "P01.txt").write_text("abc")
    (root / "raw").symlink_to(disk)
    assert collect(root, inputs=["raw/P01.txt"])["inputs"] == [
        {"path": "raw/P01.txt", "sha256": ABC, "bytes": 3}
    ]


def test_json_is_the_same_every_time(tmp_path):
    found = collect(tmp_path)
    for name in ("a", "b"):
        write_json(dict(reversed(found.items())) if name == "b" else found, tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()
    assert json.loads((tmp_path / "a").read_text()) == found
