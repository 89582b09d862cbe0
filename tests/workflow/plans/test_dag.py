"""The DAG, by dry runs: expected jobs, variants, readable refusals.

A folder of its own, so that another process runs these while the demo cohort is built.
"""

import pytest

FEEDBACK = {
    "feedback_design": 1,
    "feedback_quality": 1,
    "feedback_observations": 1,
    "feedback_model": 6,
    "feedback_table": 7,
    "feedback_truth": 1,
    "feedback_figure": 6,
}
INTENSITY = {
    "intensity_design": 1,
    "intensity_quality": 1,
    "intensity_ratings": 1,
    "intensity_sway": 1,
    "intensity_reliability": 1,
    "intensity_difficulty": 1,
    "intensity_self_ratings": 1,
    "intensity_kinematics": 1,
    "intensity_table": 11,
    "intensity_figure": 6,
    "intensity_population": 1,
    "intensity_truth": 1,
}
IMU_DESIGN = {
    "imu_design_design": 1,
    "imu_design_quality": 1,
    "imu_design_observations": 1,
    "imu_design_models": 1,
    "imu_design_table": 13,
    "imu_design_figure": 9,
    "imu_design_raw_figure": 2,
    "imu_design_truth": 1,
}
KINEMATICS = {
    "kinematics_design": 1,
    "kinematics_quality": 1,
    "kinematics_table": 14,
    "kinematics_figure": 9,
    "kinematics_truth_table": 3,
}
SHARED = {
    "parameter_sections": 5 + 4 + 9 + 7,
    "study_parameters": 4,
    "study_page": 4,
    "cohort_page": 1,
    "provenance": 1,
    "all": 1,
}


#: Stages of the kinematics study that each participant has.
STAGES = ("simulate", "import", "estimate", "measure", "perturbation", "course", "truth")


def per_participant(study, n):
    return {f"{study}_{stage}": n for stage in ("simulate", "import", "metrics")}


@pytest.mark.parametrize(
    ("cohort", "n_feedback", "n_intensity", "n_runners"),
    [("synthetic", 19, 10, 6), ("synthetic_demo", 6, 4, 2)],
)
def test_all_has_the_expected_jobs(sandbox, cohort, n_feedback, n_intensity, n_runners):
    planned = sandbox.planned("--config", f"cohort={cohort}", "--", "all")
    assert planned == {
        **FEEDBACK,
        **INTENSITY,
        **IMU_DESIGN,
        **SHARED,
        **per_participant("feedback", n_feedback),
        **per_participant("intensity", n_intensity),
        **per_participant("imu_design", n_runners),
        "imu_design_stride_errors": n_runners,
        **KINEMATICS,
        **{f"kinematics_{stage}": n_runners for stage in STAGES},
    }
    assert sum(planned.values()) < 300


STUDIES = ("feedback", "intensity", "imu_design", "kinematics")


@pytest.mark.parametrize("study", STUDIES)
def test_one_study_is_built_without_the_others_and_the_page_of_the_cohort(sandbox, study):
    planned = sandbox.planned(study)
    assert "cohort_page" not in planned
    assert planned["study_page"] == 1
    others = tuple(name for name in STUDIES if name != study)
    assert not [rule for rule in planned if rule.startswith(others)]


def test_variants_share_the_stages_before_their_first_own(sandbox):
    planned = sandbox.planned("variants")
    assert planned["study_page"] == 3 + 2 + 2 + 4
    assert planned["feedback_import"] == 19
    # printed and recommended measure anew; n_coding_reset shares the measures of printed
    assert planned["feedback_metrics"] == 2 * 19
    assert planned["feedback_model"] == 3 * 6
    assert planned["intensity_import"] == 10
    assert planned["intensity_metrics"] == 2 * 10
    assert planned["imu_design_import"] == 6
    assert planned["imu_design_metrics"] == 2 * 6
    # the errors of all methods stand on every page
    assert planned["imu_design_stride_errors"] == 6


def test_one_table_can_be_asked_for_alone(sandbox):
    target = "results/synthetic_demo/feedback/printed/tables/table_2_1.csv"
    planned = sandbox.planned(target)
    assert planned["feedback_table"] == 1
    assert "feedback_figure" not in planned


def test_a_table_of_ratings_needs_no_recording(sandbox):
    planned = sandbox.planned("results/synthetic_demo/intensity/printed/tables/table_3_2.csv")
    assert planned == {
        "parameter_sections": 2,
        "intensity_design": 1,
        "intensity_ratings": 1,
        "intensity_difficulty": 1,
        "intensity_table": 1,
    }


@pytest.mark.parametrize(
    ("file", "old", "new", "line"),
    [
        (
            "config/config.yaml",
            "seed: 1",
            "sead: 1",
            "config/config.yaml: unknown key 'sead'; expected 'seed'",
        ),
        (
            "config/studies/feedback.yaml",
            "cutoff_hz:",
            "cutof_hz:",
            "analysis.measurement: unknown key 'cutof_hz'; expected 'cutoff_hz'",
        ),
        (
            "config/studies/feedback.yaml",
            "value: 2.0\n      unit: Hz",
            "value: -2.0\n      unit: Hz",
            "cutoff_hz.value: value out of range; expected more than 0; found -2.0",
        ),
        (
            "config/studies/feedback.yaml",
            "value: 2.0\n      unit: Hz",
            "value: 2.0\n      unit: kHz",
            'cutoff_hz.unit: wrong value; expected "Hz"; found "kHz"',
        ),
    ],
)
def test_a_wrong_configuration_is_refused_in_one_line(sandbox, file, old, new, line):
    path = sandbox.root / file
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    process = sandbox.snakemake("--dry-run", "all")
    assert process.returncode != 0
    assert line in process.stdout


def test_a_variant_cannot_change_what_earlier_stages_share(sandbox):
    path = sandbox.root / "config/studies/feedback.yaml"
    text = path.read_text(encoding="utf-8")
    old = "      analysis.model.trial_number_coding:"
    path.write_text(
        text.replace(old, old.replace("model.trial_number_coding", "measurement.cutoff_hz"))
    )
    output = sandbox.snakemake("--dry-run", "all").stdout
    assert "variants.n_coding_reset: 'analysis.measurement.cutoff_hz' is used before" in output
    assert "expected first_stage metrics; found first_stage models" in output


def test_a_cohort_without_tables_is_refused_in_one_line(sandbox):
    path = sandbox.root / "config" / "config.yaml"
    text = path.read_text(encoding="utf-8").replace("cohort: synthetic\n", "cohort: lab\n")
    text = text.replace("cohorts:\n", "cohorts:\n  lab: {simulated: false, folder: data/raw/lab}\n")
    path.write_text(text, encoding="utf-8")
    output = sandbox.snakemake("--dry-run", "all").stdout
    assert "data/raw/lab/feedback/trials.tsv: the cohort has no trials.tsv" in output
