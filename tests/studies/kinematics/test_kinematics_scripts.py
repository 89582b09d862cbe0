"""The scripts of the stages from import to truth, on the files of one runner."""

import json
import runpy
import sys

import pandas as pd
import pytest

from import_graph import REPOSITORY
from swaystride.studies.kinematics.estimate_files import usable_trials
from swaystride.studies.kinematics.participant_measures import COLUMNS
from swaystride.studies.kinematics.perturbation import CURVE_COLUMNS, PERTURBATION_COLUMNS
from swaystride.studies.kinematics.truth import ANGLE_ERROR_COLUMNS, STRIDE_ERROR_COLUMNS

KEYS = ["participant", "trial"]


@pytest.fixture
def run(monkeypatch, analysis, tmp_path):
    """Run a script with the parameters of the printed variant; its files lie in a folder."""
    given = tmp_path / "parameters.json"
    given.write_text(json.dumps(analysis("printed")))

    def of(name, **options):
        words = [f"--{key.replace('_', '-')}={value}" for key, value in options.items()]
        if name != "truth":
            words.append(f"--parameters={given}")
        script = REPOSITORY / "scripts" / f"kinematics_{name}.py"
        monkeypatch.setattr(sys, "argv", [str(script), "--participant=P01", *words])
        runpy.run_path(str(script), run_name="__main__")

    return of


def test_from_raw_files_to_errors(run, sound_lab, tmp_path, capsys):
    raw = sound_lab.folder
    recordings, estimates = tmp_path / "recordings.nc", tmp_path / "estimates.nc"
    quality = {name: tmp_path / f"{name}.csv" for name in ("findings", "exclusions")}
    run("import", raw=raw, recordings=recordings, **quality)
    assert "P01: 1 trials usable, 0 excluded" in capsys.readouterr().out
    told = pd.read_csv(quality["findings"], dtype=str)
    assert told["trial"].tolist() == ["01"] * len(told)
    run(
        "estimate", raw=raw, recordings=recordings, estimates=estimates, findings=tmp_path / "e.csv"
    )
    assert usable_trials(estimates) == ["01"]
    tables = {name: tmp_path / f"{name}.parquet" for name in COLUMNS}
    run("measure", estimates=estimates, findings=tmp_path / "m.csv", **tables)
    for name, path in tables.items():
        table = pd.read_parquet(path)
        assert list(table) == [*KEYS, *COLUMNS[name]]
        assert len(table) > 0
    errors, strides = tmp_path / "truth.parquet", tmp_path / "truth_strides.parquet"
    run(
        "truth",
        estimates=estimates,
        strides=tables["strides"],
        truth=raw / "truth" / "P01.npz",
        output=errors,
        output_strides=strides,
    )
    assert list(pd.read_parquet(errors)) == [*KEYS, *ANGLE_ERROR_COLUMNS]
    assert list(pd.read_parquet(strides)) == [*KEYS, *STRIDE_ERROR_COLUMNS]


def test_shifted_joint_centres(run, sound_lab, tmp_path):
    """Optical joint angles of this run are computed again with every centre shifted."""
    table, curves = tmp_path / "perturbation.parquet", tmp_path / "curves.parquet"
    run(
        "perturbation",
        raw=sound_lab.folder,
        recordings=sound_lab.folder / "recordings.nc",
        perturbation=table,
        perturbation_curves=curves,
    )
    assert list(pd.read_parquet(table)) == [*KEYS, *PERTURBATION_COLUMNS]
    assert list(pd.read_parquet(curves)) == [*KEYS, *CURVE_COLUMNS]


def test_a_participant_without_a_usable_trial_goes_through_all_stages(run, lab, tmp_path):
    lab.change_table("trials", lambda t: t.assign(exclude="treadmill stopped"))
    recordings, estimates = tmp_path / "recordings.nc", tmp_path / "estimates.nc"
    quality = {name: tmp_path / f"{name}.csv" for name in ("findings", "exclusions")}
    run("import", raw=lab.folder, recordings=recordings, **quality)
    assert pd.read_csv(quality["exclusions"])["reason"].tolist() == ["treadmill stopped"]
    run(
        "estimate",
        raw=lab.folder,
        recordings=recordings,
        estimates=estimates,
        findings=tmp_path / "e.csv",
    )
    tables = {name: tmp_path / f"{name}.parquet" for name in COLUMNS}
    run("measure", estimates=estimates, findings=tmp_path / "m.csv", **tables)
    for name, path in tables.items():
        table = pd.read_parquet(path)
        assert list(table) == [*KEYS, *COLUMNS[name]]
        assert table.empty


def test_an_error_is_one_line(run, lab, tmp_path, capsys):
    lab.change_table("participants", lambda t: t.assign(leg_length_left_m="0.45"))
    quality = {name: tmp_path / f"{name}.csv" for name in ("findings", "exclusions")}
    with pytest.raises(SystemExit) as stopped:
        run("import", raw=lab.folder, recordings=tmp_path / "recordings.nc", **quality)
    assert stopped.value.code == 1
    told = capsys.readouterr().err
    assert told.startswith("error: participants.tsv: P01: leg_length_m, left: a measure")
    assert told.count("\n") == 1
    assert not quality["findings"].exists()
