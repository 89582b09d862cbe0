"""Validation: verdicts, and files that are not the ones it was written for."""

import pytest

from swaystride.errors import RecordingError
from swaystride.validation import lumbar_imu_standing, manifest, standing_force_plate
from swaystride.validation.summary import Check, reported, summary_frame


@pytest.mark.parametrize(
    ("value", "tolerance", "within"),
    [(1.0, 0.0, "yes"), (1.1, 0.05, "no"), (0.95, 0.05000001, "yes"), (float("nan"), 1.0, "no")],
)
def test_a_value_is_held_against_its_reference(value, tolerance, within):
    assert Check("set", "quantity", value, 1.0, "source", tolerance).within == within


def test_what_nobody_published_is_only_reported():
    table = summary_frame([reported("set", "quantity", 3.0, "a count")])
    assert table["within"].tolist() == ["reported"]


@pytest.mark.parametrize("module", [lumbar_imu_standing, standing_force_plate])
def test_the_manifest_names_source_licence_and_hash_of_every_file(module):
    files = manifest.load_manifest(module.DATASET)
    assert len(files) > 100
    assert files["file"].is_unique
    assert files["sha256"].str.fullmatch("[0-9a-f]{64}").all()
    assert files[["source", "licence"]].notna().all(axis=None)


def test_an_unknown_data_set_is_named():
    with pytest.raises(RecordingError, match=r"one of standing_force_plate, lumbar_imu_standing"):
        manifest.load_manifest("walking")


def test_absent_and_changed_files_are_refused(tmp_path):
    name = manifest.load_manifest("lumbar_imu_standing")["file"].iloc[0]
    with pytest.raises(RecordingError, match="no such file; expected from"):
        manifest.verified_files(tmp_path, "lumbar_imu_standing")
    path = tmp_path / "lumbar_imu_standing" / name
    path.parent.mkdir(parents=True)
    path.write_bytes(b"something else")
    with pytest.raises(RecordingError, match="not the file that validation was written for"):
        manifest.verified_files(tmp_path, "lumbar_imu_standing")
