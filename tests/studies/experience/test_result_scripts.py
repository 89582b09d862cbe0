"""Result scripts: from the files of the stages to tables, figures and the flow."""

import json
import runpy
import sys

import experience_results as made
import numpy as np
import pandas as pd
import pytest

from experience_rules import FIGURE_INPUTS, TABLE_INPUTS, TRUTH_TABLES
from import_graph import REPOSITORY
from study_parameters import resolve
from swaystride.configuration import plain_values
from swaystride.findings import FINDING_COLUMNS
from swaystride.io.study_tables import write_study_table
from swaystride.presentation.table_files import read_table
from swaystride.report.page_text import load_page_text
from swaystride.studies.experience.plan import MEASURE_KEYS, SCALES
from swaystride.studies.experience.table_styles import TABLE_STYLES


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Files of the stages, the lab's tables, the truth of a simulated cohort."""
    root = tmp_path_factory.mktemp("experience")
    raw, results = root / "raw", root / "results"
    (raw / "truth").mkdir(parents=True)
    made.write_stages(results, results / "printed")
    write_study_table(made.PEOPLE, raw / "participants.tsv")
    runs = made.lab_runs().assign(imu=[f"{name}.h5" for name in made.RUNS])
    write_study_table(runs, raw / "runs.tsv")
    for run in made.RUNS:
        measured = run if run in made.MEASURED else made.MEASURED[0]
        known = {"duty_factor": made.duty_factor(measured)}
        tree = {"measures": known, "pattern": made.pattern(measured)}
        (raw / "truth" / f"{run}.json").write_text(json.dumps(tree), encoding="utf-8")
    values = {measure: dict.fromkeys(SCALES, 0.5) for measure in MEASURE_KEYS}
    (raw / "truth" / "population.json").write_text(
        json.dumps({"printed": values, "attainable": values}), encoding="utf-8"
    )
    null = pd.DataFrame({"run": made.RUNS, **{scale: np.arange(7.0) ** 2 for scale in SCALES}})
    null.to_parquet(raw / "truth" / "null.parquet")
    parameters = plain_values(resolve("experience", "printed", "published"))["analysis"]
    (root / "parameters.json").write_text(json.dumps(parameters), encoding="utf-8")
    return root


def call(name, *options):
    """Run a script within this process, as a rule does."""
    before = sys.argv
    sys.argv = [name, *map(str, options)]
    try:
        runpy.run_path(str(REPOSITORY / "scripts" / f"{name}.py"), run_name="__main__")
    finally:
        sys.argv = before


def stages(folder):
    results = folder / "results"
    return [
        "--runs", *made.RUNS,
        "--cohort-results", results,
        "--measured", results / "printed",
        "--models", results / "printed",
        "--parameters", folder / "parameters.json",
    ]  # fmt: skip


@pytest.mark.parametrize("table", TABLE_INPUTS)
def test_every_table_has_a_script(folder, table):
    output = folder / f"{table}.csv"
    call(
        "experience_table", "--table", table, "--raw", folder / "raw", *stages(folder),
        "--simulated", "--output", output,
    )  # fmt: skip
    written = read_table(output)
    assert len(written) > 0
    assert "data" in written


def test_true_patterns_are_read_from_the_truth(folder):
    output = folder / "classes_with_truth.csv"
    call(
        "experience_table", "--table", "classes", "--raw", folder / "raw", *stages(folder),
        "--simulated", "--output", output,
    )  # fmt: skip
    assert (read_table(output)["agrees"] == 1).all()


@pytest.mark.parametrize("table", TRUTH_TABLES)
def test_every_table_of_the_truth_has_a_script(folder, table):
    output = folder / f"{table}.csv"
    call(
        "experience_truth_table", "--table", table, "--truth", folder / "raw" / "truth",
        *stages(folder), "--published", REPOSITORY / "data" / "published", "--output", output,
    )  # fmt: skip
    assert (read_table(output)["data"] == "simulated").all()


@pytest.mark.parametrize("figure", ["figure_5_9"])
def test_figures_are_written(folder, figure):
    output = folder / f"{figure}.svg"
    call("experience_figure", "--figure", figure, *stages(folder), "--output", output)
    assert {file.suffix for file in folder.glob(f"{figure}.*")} == {".svg", ".png", ".pdf"}


def test_findings_of_all_stages_are_joined(folder):
    results = folder / "results"
    row = ["a check", "warning", "", "", "", ""]
    columns = ["run", *FINDING_COLUMNS]
    for place in ("quality/findings", "quality/exclusions", "printed/findings", "printed/runs"):
        (results / place).mkdir(parents=True, exist_ok=True)
    for run in made.RUNS:
        found = pd.DataFrame([[run, *row]], columns=columns)
        found.to_csv(results / "quality" / "findings" / f"{run}.csv", index=False)
        found.iloc[:0].to_csv(results / "printed" / "findings" / f"{run}.csv", index=False)
        out = [[run, "too short"]] if run not in made.MEASURED else []
        pd.DataFrame(out, columns=["run", "reason"]).to_csv(
            results / "quality" / "exclusions" / f"{run}.csv", index=False
        )
        own = made.run_observations()
        own[own["run"] == run].to_parquet(results / "printed" / "runs" / f"{run}.parquet")
    pd.DataFrame([["P01_01", *row]], columns=columns).to_csv(folder / "answers.csv", index=False)
    call(
        "experience_quality", "--raw", folder / "raw", "--runs", *made.RUNS,
        "--cohort-results", results, "--measured", results / "printed",
        "--answer-findings", folder / "answers.csv", "--findings", folder / "findings.csv",
        "--exclusions", folder / "exclusions.csv", "--flow", folder / "flow.json",
    )  # fmt: skip
    assert len(read_table(folder / "findings.csv")) == len(made.RUNS)
    flow = json.loads((folder / "flow.json").read_text(encoding="utf-8"))["flow"]
    assert flow[1]["excluded"] == [{"reason": "too short", "count": 1}]


def test_the_page_shows_every_result():
    page = load_page_text(REPOSITORY / "workflow" / "report" / "experience.yaml")
    shown = {item.file.split("/")[1].removesuffix(".csv") for item in page.items}
    assert shown == {*TABLE_INPUTS, *TRUTH_TABLES, *FIGURE_INPUTS}
    assert set(TABLE_STYLES) == {*TABLE_INPUTS, *TRUTH_TABLES}
