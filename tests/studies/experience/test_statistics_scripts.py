"""From the tables of a lab and of the measures to associations, script by script."""

import json
import runpy
import sys

import numpy as np
import pandas as pd
import pytest

from import_graph import REPOSITORY
from swaystride.errors import ConfigurationError
from swaystride.gait.rating_windows import PRINTED_WINDOWS, sliding_windows
from swaystride.io.study_tables import write_study_table
from swaystride.studies.experience.plan import MEASURE_KEYS
from swaystride.studies.experience.settings import pattern_rules, within_rules

NAMES = [f"P{at:02d}_01" for at in range(1, 7)]
MODEL = {
    "level": 0.95,
    "cutoffs": {"aerial_below": 0.276, "terrestrial_above": 0.288},
    "patterns": {"duty_factor_slope_s_m": -0.033, "pattern_by": "run_mean"},
    "cluster": {"enabled": True, "n_draws": 50, "seed": 1},
    "within": {
        "n_draws": 20,
        "seed": 2,
        "errors": ["independent", "ar1", "block"],
        "block_windows": 9,
        "least_windows": 10,
    },
}
PARAMETERS = {
    "answers": {
        "scales": {
            "affective_valence": [-5, 5],
            "activity_enjoyment": [18, 126],
            "flow": [13, 97],
        },
        "mean": "time_weighted",
    },
    "model": MODEL,
    "steady": {"warm_up_s": 600.0},
    "windows": {"length_s": 60.0, "step_s": 20.0, "least_strides": 15},
}


@pytest.fixture
def folder(tmp_path):
    """Six runs, one of which is left out."""
    rng = np.random.default_rng(3)
    raw = tmp_path / "raw"
    people = [name[:3] for name in NAMES]
    for name in ("quality", "spans", "measured/runs", "measured/windows", "raw/affect", "answers"):
        (tmp_path / name).mkdir(parents=True)
    table = pd.DataFrame({"participant": people, "sex": "M", "age_years": 40})
    write_study_table(table.assign(height_m=1.8, mass_kg=70), raw / "participants.tsv")
    runs = pd.DataFrame({"participant": people, "run": "01", "imu": [f"{n}.h5" for n in NAMES]})
    runs["affect"] = [f"affect/{name}.tsv" for name in NAMES]
    write_study_table(runs, raw / "runs.tsv")
    scores = [(person, "01", "fss", 60 + at) for at, person in enumerate(people)]
    columns = ["participant", "run", "questionnaire", "score"]
    write_study_table(pd.DataFrame(scores, columns=columns), raw / "questionnaires.tsv")
    edges = sliding_windows(600.0, 1800.0, PRINTED_WINDOWS)
    for name in NAMES:
        out = name == "P06_01"
        said = {"run": name, "excluded": out, "duration_s": None if out else 1800.0}
        (tmp_path / "quality" / f"{name}.json").write_text(json.dumps(said))
        events = pd.DataFrame(columns=["start_s", "stop_s", "event", "sensor"])
        events.to_parquet(tmp_path / "spans" / f"{name}.parquet")
        ratings = {"time_s": [0, 900, 1300], "feeling_scale": rng.integers(0, 5, 3)}
        write_study_table(pd.DataFrame(ratings), raw / "affect" / f"{name}.tsv")
        rows = rng.uniform(0.2, 0.3, (len(edges), len(MEASURE_KEYS)))
        windows = pd.DataFrame(rows, columns=list(MEASURE_KEYS))
        windows = windows.assign(run=name, start_s=edges[:, 0], stop_s=edges[:, 1], n_strides=40)
        whole = windows[list(MEASURE_KEYS)].mean().to_frame().T
        whole = whole.assign(run=name, participant=name[:3], n_strides=1000, n_rejected=3)
        n_rows = None if name != "P06_01" else 0
        windows.iloc[:n_rows].to_parquet(tmp_path / "measured" / "windows" / f"{name}.parquet")
        whole.iloc[:n_rows].to_parquet(tmp_path / "measured" / "runs" / f"{name}.parquet")
    (tmp_path / "parameters.json").write_text(json.dumps(PARAMETERS))
    return tmp_path


@pytest.fixture
def run(monkeypatch, folder):
    def of(script, **options):
        words = [f"--parameters={folder / 'parameters.json'}"]
        for key, value in options.items():
            words += [f"--{key}", *value] if isinstance(value, list) else [f"--{key}={value}"]
        path = REPOSITORY / "scripts" / f"experience_{script}.py"
        monkeypatch.setattr(sys, "argv", [str(path), *words])
        runpy.run_path(str(path), run_name="__main__")

    return of


def test_from_answers_to_associations(run, folder, capsys):
    answers = {name: folder / "answers" / f"{name}.parquet" for name in ("affect", "scores")}
    inputs = {name: folder / name for name in ("raw", "quality", "spans")}
    run("answers", **inputs, **answers, findings=folder / "findings.csv")
    assert "5 runs, 15 ratings" in capsys.readouterr().out
    findings = pd.read_csv(folder / "findings.csv", dtype=str)
    assert findings["run"].tolist() == NAMES[:5]
    assert set(findings["check"]) == {"no_score"}
    observed = {name: folder / f"{name}.parquet" for name in ("runs", "windows")}
    run("observations", names=NAMES, cohort=folder, variant=folder / "measured", **observed)
    assert "5 runs (5 aerial, 0 intermediate" in capsys.readouterr().out
    assert pd.read_parquet(observed["runs"])["run"].tolist() == NAMES[:5]
    output = folder / "associations.parquet"
    run("associations", observations=observed["runs"], output=output)
    table = pd.read_parquet(output)
    assert len(table) == 222
    assert table.loc[table["scale"] == "activity_enjoyment", "r"].isna().all()
    assert table.loc[table["scale"] == "flow", "r"].notna().all()
    results = {name: folder / f"{name}.parquet" for name in ("output", "excluded", "summary")}
    run("within_runs", **observed, **results)
    within, excluded = (pd.read_parquet(results[name]) for name in ("output", "excluded"))
    assert within["run"].nunique() + len(excluded) == 5
    assert len(pd.read_parquet(results["summary"])) == 37 * 3


def test_wrong_answers_are_printed_one_line_each(run, folder, capsys):
    path = folder / "raw" / "questionnaires.tsv"
    path.write_text(path.read_text() + "P01\t01\tpaces\t5\nP09\t01\tfss\t50\n")
    names = ("raw", "quality", "spans", "affect", "scores", "findings")
    with pytest.raises(SystemExit):
        run("answers", **{name: folder / name for name in names})
    lines = capsys.readouterr().err.splitlines()
    assert lines[0].startswith("error: questionnaires.tsv: line 8: score outside its scale")
    assert lines[1].startswith("questionnaires.tsv: line 9: run is not in runs.tsv")
    assert not (folder / "scores").exists()


def test_settings_that_the_code_does_not_take_are_refused():
    errors = {**MODEL["within"], "errors": ["independent", "garch"]}
    with pytest.raises(ConfigurationError, match=r"unknown kind of errors; .* found garch"):
        within_rules({**MODEL, "within": errors})
    with pytest.raises(ConfigurationError, match="keys do not match"):
        pattern_rules({**MODEL, "patterns": {"pattern_by": "run_mean"}})
