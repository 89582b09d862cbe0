"""A lab's own cohort: bad files stop their participant with one line, the others go on."""

import json
import shutil

import pandas as pd
import pytest

PAGE = "results/my_lab/report.html"


def as_lab(sandbox, demo, study):
    """Put the demo's raw files of one study under a lab's name, and name the cohort."""
    folder = sandbox.root / "data/raw/my_lab" / study
    shutil.copytree(demo.root / "data/raw/synthetic_demo" / study, folder)
    shutil.rmtree(folder / "truth")
    path = sandbox.root / "config/config.yaml"
    text = path.read_text(encoding="utf-8").replace("cohort: synthetic\n", "cohort: my_lab\n")
    text = text.replace("  # my_lab:", "  my_lab:")
    text = text.replace(
        "studies: [feedback, intensity, imu_design, kinematics, experience]",
        f"studies: [{study}]",
    )
    path.write_text(text, encoding="utf-8")
    return sandbox


@pytest.fixture(scope="module")
def lab(demo, new_checkout):
    """A checkout whose cohort is the feedback study of a lab."""
    return as_lab(new_checkout("lab"), demo, "feedback")


def test_bad_recordings_are_named_and_the_others_finish(lab):
    folder = lab.root / "data/raw/my_lab/feedback"
    truncated = folder / "P02/P02_05.txt"
    missing = folder / "P03/P03_01.txt"
    wrong_unit = folder / "P04/P04_02.txt"
    text = truncated.read_text(encoding="utf-8")
    truncated.write_text(text[: text.index("\n", len(text) // 2) + 20], encoding="utf-8")
    missing.unlink()
    rows = wrong_unit.read_text(encoding="utf-8").splitlines()
    start = next(i for i, row in enumerate(rows) if row.startswith("PacketCounter")) + 1
    for i in range(start, len(rows)):
        cells = rows[i].split("\t")
        cells[2:5] = [f"{float(cell) / 9.80665:.6f}" for cell in cells[2:5]]
        rows[i] = "\t".join(cells)
    wrong_unit.write_text("\n".join(rows) + "\n", encoding="utf-8")

    process = lab.snakemake("--quiet", "rules", "--keep-going", "--", "all")
    assert process.returncode != 0
    errors = [line for line in process.stdout.splitlines() if line.startswith("error: ")]
    assert len(errors) == 3, process.stdout
    by_file = {line.split(": ")[1]: line for line in errors}
    assert "no such file" in by_file["P03/P03_01.txt"]
    assert "fields" in by_file["P02_05.txt"]
    assert "g, not m/s²" in by_file["P04_02.txt"]
    assert "Traceback" not in process.stdout
    done = {path.stem for path in (lab.root / "results/my_lab/feedback/recordings").glob("*.nc")}
    assert done == {"P01", "P05", "P06"}


def test_after_excluding_them_the_cohort_is_complete_and_called_real(lab):
    """A participant of whom no trial is usable, already imported, is left out and counted."""
    path = lab.root / "data/raw/my_lab/feedback/trials.tsv"
    trials = pd.read_csv(path, sep="\t", dtype=str, keep_default_na=False)
    bad = trials["file"].isin(["P02/P02_05.txt", "P03/P03_01.txt", "P04/P04_02.txt"])
    trials["exclude"] = bad.map({True: "recording damaged", False: ""})
    trials.loc[trials["participant"] == "P01", "exclude"] = "fell ill"
    trials.to_csv(path, sep="\t", index=False)
    process = lab.snakemake("--quiet", "rules", "--keep-going", "--", "all")
    assert process.returncode == 0, process.stdout
    excluded = pd.read_csv(lab.root / "results/my_lab/feedback/quality/exclusions.csv")
    assert (excluded["reason"] == "recording damaged").sum() == 3
    page = (lab.root / PAGE).read_text(encoding="utf-8")
    assert "Simulated cohort" not in page
    assert "recording damaged" in page
    table = pd.read_csv(lab.root / "results/my_lab/feedback/printed/tables/table_2_3.csv")
    assert (table["n"] < 223 - 35).all()
    flow = (lab.root / "results/my_lab/feedback/quality/flow.json").read_text(encoding="utf-8")
    assert "no usable trial" in flow


def test_a_lab_with_ratings(demo, new_checkout):
    """Wide ratings are an error with the way out; what is missing is found, counted and kept."""
    sandbox = as_lab(new_checkout("ratings"), demo, "intensity")
    path = sandbox.root / "data/raw/my_lab/intensity/ratings.tsv"
    ratings = pd.read_csv(path, sep="\t", dtype=str, keep_default_na=False)
    wide = ratings.pivot_table(
        index=["participant", "exercise", "trial"],
        columns="rater",
        values="rating",
        aggfunc="first",
    )
    wide.to_csv(path, sep="\t")
    frame = "results/my_lab/intensity/printed/models/ratings.parquet"
    process = sandbox.snakemake("--quiet", "rules", "--", frame)
    assert process.returncode != 0
    assert "ratings.tsv: line 1: ratings are in wide form" in process.stdout
    assert "Traceback" not in process.stdout

    ratings.loc[ratings["rater"] == "self", "rating"] = ratings["rating"].where(
        ratings["participant"] != "P02", ""
    )
    ratings.to_csv(path, sep="\t", index=False)
    quality = "results/my_lab/intensity/quality"
    process = sandbox.snakemake("--quiet", "rules", "--", frame, f"{quality}/findings.csv")
    assert process.returncode == 0, process.stdout
    findings = pd.read_csv(sandbox.root / quality / "findings.csv", keep_default_na=False)
    missing = findings[findings["check"] == "missing_self_rating"]
    assert missing["participant"].tolist() == ["P02"]
    flow = json.loads((sandbox.root / quality / "flow.json").read_text(encoding="utf-8"))["flow"]
    counts = {row["unit"]: (row["recorded"], row["analysed"]) for row in flow}
    assert counts["trials"] == (120, 120)
    assert counts["self-ratings of trials"] == (120, 90)
    kept = pd.read_parquet(sandbox.root / frame)
    assert kept["rating"].notna().all()
    assert (kept["self_rating"].isna() == (kept["participant"] == "P02")).all()


def test_a_lab_with_foot_recordings(demo, new_checkout):
    """A file that is not there stops its participant; a foot without recordings is a finding."""
    sandbox = as_lab(new_checkout("feet"), demo, "imu_design")
    folder = sandbox.root / "data/raw/my_lab/imu_design"
    quality = "results/my_lab/imu_design/quality"
    (folder / "P01/P01_02_left_imu_2.csv").unlink()
    process = sandbox.snakemake("--quiet", "rules", "--keep-going", "--", f"{quality}/flow.json")
    assert process.returncode != 0
    errors = [line for line in process.stdout.splitlines() if line.startswith("error: ")]
    assert errors == [
        "error: P01/P01_02_left_imu_2.csv: no such file; expected the file named in trials.tsv"
    ]
    assert "Traceback" not in process.stdout

    path = folder / "trials.tsv"
    trials = pd.read_csv(path, sep="\t", dtype=str, keep_default_na=False)
    gone = (trials["participant"] == "P01") & (trials["trial"] == "02") & (trials["foot"] == "left")
    trials[~gone].to_csv(path, sep="\t", index=False)
    process = sandbox.snakemake("--quiet", "rules", "--", f"{quality}/flow.json")
    assert process.returncode == 0, process.stdout
    findings = pd.read_csv(sandbox.root / quality / "findings.csv", keep_default_na=False)
    missing = findings[findings["check"] == "missing_foot"]
    assert missing["place"].tolist() == ["trial 02, left foot"]
    flow = json.loads((sandbox.root / quality / "flow.json").read_text(encoding="utf-8"))["flow"]
    counts = {row["unit"]: (row["planned"], row["recorded"], row["analysed"]) for row in flow}
    assert counts["recordings"] == (32, 30, 30)
    assert counts["trials"][1:] == (8, 8)
