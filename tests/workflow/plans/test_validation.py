"""Validation: data sets that are at hand, and gaitmap's numbers where they can be had."""

import pytest

FEET = ("foot_imu_vicon", "foot_imu_mocap_walk")


@pytest.fixture
def real(sandbox, tmp_path):
    """Arguments of a run with the (empty) folders of the foot recordings."""
    for name in FEET:
        (tmp_path / "real" / name).mkdir(parents=True)
    return ("--config", f"real_data_dir={tmp_path / 'real'}", "--", "validation")


def test_only_data_sets_at_hand_are_computed(sandbox, real):
    assert sandbox.planned("validation") == {"validation": 1}
    ours = {f"validation_{name}": 1 for name in FEET}
    assert sandbox.planned(*real) == {**ours, "validation": 1}


def test_gaitmap_runs_once_its_environment_is_there(sandbox, real):
    marker = sandbox.root / ".venv-peers-gait/.complete"
    marker.parent.mkdir()
    marker.touch()
    (sandbox.root / "requirements-peers-gait.txt").touch()
    assert sandbox.planned(*real)["validation_gaitmap"] == 2


def test_a_table_of_gaitmap_at_hand_is_used_without_its_environment(sandbox, real):
    table = sandbox.root / "results/peers/gaitmap_foot_imu_vicon.csv"
    table.parent.mkdir(parents=True)
    table.touch()
    output = sandbox.snakemake("--dry-run", *real).stdout
    assert output.count("results/peers/gaitmap_foot_imu_vicon.csv") == 1
    assert "validation_gaitmap" not in output
    assert "gaitmap_foot_imu_mocap_walk.csv" not in output
