"""A lab's own cohort: bad files stop their participant with one line, the others go on."""

import shutil

import pandas as pd
import pytest

PAGE = "results/my_lab/report.html"


@pytest.fixture(scope="module")
def lab(demo, new_checkout):
    """The demo's raw files under a lab's name, in a checkout whose config names the cohort."""
    sandbox = new_checkout("lab")
    folder = sandbox.root / "data/raw/my_lab/feedback"
    shutil.copytree(demo.root / "data/raw/synthetic_demo/feedback", folder)
    shutil.rmtree(folder / "truth")
    path = sandbox.root / "config/config.yaml"
    text = path.read_text(encoding="utf-8").replace("cohort: synthetic\n", "cohort: my_lab\n")
    text = text.replace("  # my_lab:", "  my_lab:")
    text = text.replace("studies: [feedback, intensity]", "studies: [feedback]")
    path.write_text(text, encoding="utf-8")
    return sandbox


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
    path = lab.root / "data/raw/my_lab/feedback/trials.tsv"
    trials = pd.read_csv(path, sep="\t", dtype=str, keep_default_na=False)
    bad = trials["file"].isin(["P02/P02_05.txt", "P03/P03_01.txt", "P04/P04_02.txt"])
    trials["exclude"] = bad.map({True: "recording damaged", False: ""})
    trials.to_csv(path, sep="\t", index=False)
    process = lab.snakemake("--quiet", "rules", "--keep-going", "--", "all")
    assert process.returncode == 0, process.stdout
    excluded = pd.read_csv(lab.root / "results/my_lab/feedback/quality/exclusions.csv")
    assert (excluded["reason"] == "recording damaged").sum() == 3
    page = (lab.root / PAGE).read_text(encoding="utf-8")
    assert "Simulated cohort" not in page
    assert "recording damaged" in page


def test_a_participant_without_usable_trials_is_left_out_and_counted(lab):
    path = lab.root / "data/raw/my_lab/feedback/trials.tsv"
    trials = pd.read_csv(path, sep="\t", dtype=str, keep_default_na=False)
    trials.loc[trials["participant"] == "P01", "exclude"] = "fell ill"
    trials.to_csv(path, sep="\t", index=False)
    process = lab.snakemake("--quiet", "rules", "--keep-going", "--", "all")
    assert process.returncode == 0, process.stdout
    table = pd.read_csv(lab.root / "results/my_lab/feedback/printed/tables/table_2_3.csv")
    assert (table["n"] < 223 - 35).all()
    flow = (lab.root / "results/my_lab/feedback/quality/flow.json").read_text(encoding="utf-8")
    assert "no usable trial" in flow
