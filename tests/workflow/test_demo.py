"""The demo cohort: truth recovered, same bytes on one and two cores, reruns only what changed."""

import json

import numpy as np
import pandas as pd
import pytest

DEMO = ("--config", "cohort=synthetic_demo", "--", "all")
RESULTS = "results/synthetic_demo"


def table(sandbox, name):
    return pd.read_csv(sandbox.root / RESULTS / "feedback/printed/tables" / f"{name}.csv")


def test_tables_agree_with_the_truth_put_in(demo):
    """42 effects of one small cohort: none further than four standard errors, most covered.

    The effects share their noise, so that one draw may miss many at once; half is far from what
    wrong signs or a wrong coding would leave.
    """
    truth = table(demo, "truth")
    assert len(truth) == 42
    assert truth["difference_in_se"].abs().max() < 4.0
    assert truth["covered"].mean() > 0.5


def with_truth(sandbox, study, trial_names):
    """Measures of all trials of the demo beside their truth."""
    folder = sandbox.root / RESULTS / study / "printed/metrics"
    raw = sandbox.root / "data/raw/synthetic_demo" / study / "truth"
    parts = []
    for path in sorted(folder.glob("*.parquet")):
        theirs = pd.read_csv(raw / f"{path.stem}.tsv", sep="\t")
        theirs = theirs.assign(recording=trial_names(theirs)).drop(
            columns=["participant", "trial"], errors="ignore"
        )
        ours = pd.read_parquet(path).rename(columns={"trial": "recording"})
        parts.append(ours.merge(theirs, on="recording", suffixes=("", "_true")))
    return pd.concat(parts, ignore_index=True)


def test_measures_agree_with_the_true_sway_of_every_trial(demo):
    """Through files, sensor errors, lost packets, fusion and filter: within a few percent."""
    both = with_truth(
        demo, "feedback", lambda truth: [f"trial_{number:02d}" for number in truth["session_trial"]]
    )
    assert len(both) > 200
    for name in ("ap_rms", "ml_rms", "phi_mv"):
        error = np.log(both[name] / both[f"true_{name}"])
        assert abs(error.mean()) < 0.02, name
        assert error.std() < 0.06, name


def test_measures_agree_with_the_true_sway_of_falls_and_short_trials(demo):
    """The intensity study keeps every trial, whether or not balance was lost in it."""
    both = with_truth(
        demo,
        "intensity",
        lambda truth: [
            f"exercise_{order:02d}_trial_{trial}"
            for order, trial in zip(truth["exercise_order"], truth["trial"], strict=True)
        ],
    )
    assert len(both) == 4 * 10 * 3
    assert (both["n_losses_of_balance"] > 0).any()
    assert both["duration_s"].to_numpy() == pytest.approx(
        both["duration_s_true"].to_numpy(), abs=0.02
    )
    for name in ("ap_rms", "ml_rms", "phi_mv"):
        error = np.log(both[name] / both[f"true_{name}"])
        assert abs(error.median()) < 0.03, name
        assert error.abs().quantile(0.9) < 0.15, name


def test_the_exclusion_is_the_trial_whose_link_was_lost(demo):
    excluded = pd.read_csv(demo.root / RESULTS / "feedback/quality/exclusions.csv")
    truth = pd.concat(
        pd.read_csv(path, sep="\t")
        for path in (demo.root / "data/raw/synthetic_demo/feedback/truth").glob("P*.tsv")
    )
    lost = truth[truth["n_lost_packets"] > 30]
    assert len(excluded) == len(lost) == 1
    assert excluded["participant"].tolist() == lost["participant"].tolist()
    assert excluded["trial"].tolist() == [f"trial_{lost['session_trial'].iloc[0]:02d}"]


def test_every_output_says_that_it_is_simulated(demo):
    folder = demo.root / RESULTS
    assert "Simulated cohort: not measurements." in (folder / "report.html").read_text()
    for suffix in ("csv", "md", "tex", "html"):
        for path in folder.glob(f"*/printed/tables/*.{suffix}"):
            assert "simulated" in path.read_text(encoding="utf-8").lower(), path.name


def test_provenance_lists_every_result_with_its_hash(demo):
    provenance = json.loads((demo.root / RESULTS / "provenance.json").read_text())
    listed = {row["path"]: row["sha256"] for row in provenance["outputs"]}
    on_disk = {f"{RESULTS}/{name}": value for name, value in demo.bytes_of(RESULTS).items()}
    assert listed.items() <= on_disk.items()
    shown = [name for name in on_disk if "/tables/" in name or "/figures/" in name]
    assert len(shown) > 40
    assert set(shown) <= set(listed)
    assert sum(name.endswith(".nc") for name in listed) == 6 + 4 + 2 + 2
    assert any(row["path"].endswith("P01_01.txt") for row in provenance["inputs"])
    assert provenance["seed"] == 1


def test_one_core_gives_the_same_bytes(demo, sandbox):
    """One study with all its pages, of the others what their participants leave."""
    measured = (
        "feedback",
        f"{RESULTS}/intensity/printed/metrics/P01.parquet",
        f"{RESULTS}/imu_design/printed/metrics/P01.parquet",
        f"{RESULTS}/kinematics/printed/strides/P02.parquet",
        f"{RESULTS}/experience/printed/runs/P02_01.parquet",
    )
    process = sandbox.snakemake("--quiet", "rules", *DEMO[:-1], *measured, cores=1)
    assert process.returncode == 0, process.stdout
    for folder in ("results", "data/raw"):
        built = sandbox.bytes_of(folder)
        assert built
        assert built.items() <= demo.bytes_of(folder).items()


def edited(sandbox, *files):
    """Plan after one more comment in each file; the files are restored."""
    texts = {sandbox.root / file: (sandbox.root / file).read_text("utf-8") for file in files}
    try:
        for path, text in texts.items():
            path.write_text(text + "\n# an edit\n", encoding="utf-8")
        return sandbox.planned(*DEMO)
    finally:
        for path, text in texts.items():
            path.write_text(text, encoding="utf-8")


def test_a_rerun_does_nothing(demo):
    """Nor after an edit of what the cohort does not need."""
    assert edited(demo, "src/swaystride/validation/figures.py") == {}


def test_an_edit_reruns_the_dependents_only(demo):
    """The first stage that reruns is the first that imports the module.

    A plan takes seconds: modules of two studies are edited at once where neither study needs the
    other's.
    """
    claims_and_clipping = edited(
        demo,
        "src/swaystride/studies/feedback/claims.py",
        "src/swaystride/signals/saturation.py",
    )
    assert claims_and_clipping["feedback_table"] == 7
    assert not {"feedback_simulate", "feedback_import", "feedback_metrics"} & set(
        claims_and_clipping
    )
    assert "feedback_model" not in claims_and_clipping
    assert claims_and_clipping["imu_design_metrics"] == 2
    assert not {"imu_design_simulate", "imu_design_import"} & set(claims_and_clipping)
    assert not [rule for rule in claims_and_clipping if rule.startswith("intensity")]

    design_and_sentences = edited(
        demo,
        "src/swaystride/studies/intensity/design.py",
        "src/swaystride/studies/imu_design/recommendation.py",
    )
    assert design_and_sentences["intensity_import"] == 4
    assert "intensity_simulate" not in design_and_sentences
    assert design_and_sentences["imu_design_table"] == 13
    assert not {"imu_design_metrics", "imu_design_models", "imu_design_figure"} & set(
        design_and_sentences
    )
    assert not [rule for rule in design_and_sentences if rule.startswith("feedback")]

    fusion = edited(demo, "src/swaystride/signals/orientation.py")
    assert fusion["feedback_metrics"] == 6
    assert fusion["intensity_metrics"] == 4
    assert not {"feedback_simulate", "feedback_import", "intensity_import"} & set(fusion)

    readers = edited(demo, "src/swaystride/io/reading.py")
    assert readers["feedback_import"] == 6
    assert readers["intensity_import"] == 4
    assert "feedback_simulate" not in readers


def test_a_changed_parameter_reruns_the_stages_that_use_it(demo):
    path = demo.root / "config/studies/feedback.yaml"
    text = path.read_text(encoding="utf-8")
    old = 'value: 3.0\n      unit: s\n      source: "spec §8.1; default of VQF"'
    assert old in text
    try:
        path.write_text(text.replace(old, old.replace("3.0", "4.0")), encoding="utf-8")
        planned = demo.planned(*DEMO)
    finally:
        path.write_text(text, encoding="utf-8")
    assert planned["feedback_metrics"] == 6
    assert not {"feedback_simulate", "feedback_import"} & set(planned)
    assert not [rule for rule in planned if rule.startswith("intensity")]
