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
EXPERIENCE = {
    "experience_design": 1,
    "experience_ratings": 1,
    "experience_answers": 1,
    "experience_observations": 1,
    "experience_associations": 1,
    "experience_within_runs": 1,
    "experience_quality": 1,
    "experience_table": 10,
    "experience_figure": 9,
    "experience_truth_table": 4,
}
SHARED = {
    "parameter_sections": 5 + 4 + 9 + 7 + 11,
    "study_parameters": 5,
    "study_page": 5,
    "cohort_page": 1,
    "provenance": 1,
    "all": 1,
}


#: Stages of the kinematics study that each participant has.
STAGES = ("simulate", "import", "estimate", "measure", "perturbation", "course", "truth")


#: Stages of the experience study that each run has.
RUN_STAGES = ("simulate", "import", "metrics", "truth")


def per_participant(study, n):
    return {f"{study}_{stage}": n for stage in ("simulate", "import", "metrics")}


@pytest.mark.parametrize(
    ("cohort", "n_feedback", "n_intensity", "n_runners", "n_runs"),
    [("synthetic", 19, 10, 6, 23), ("synthetic_demo", 6, 4, 2, 5)],
)
def test_all_has_the_expected_jobs(sandbox, cohort, n_feedback, n_intensity, n_runners, n_runs):
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
        **EXPERIENCE,
        **{f"experience_{stage}": n_runs for stage in RUN_STAGES},
    }
    assert sum(planned.values()) < 450


STUDIES = ("feedback", "intensity", "imu_design", "kinematics", "experience")


@pytest.mark.parametrize("study", STUDIES)
def test_one_study_is_built_without_the_others_and_the_page_of_the_cohort(sandbox, study):
    planned = sandbox.planned(study)
    assert "cohort_page" not in planned
    assert planned["study_page"] == 1
    others = tuple(name for name in STUDIES if name != study)
    assert not [rule for rule in planned if rule.startswith(others)]


def test_variants_share_the_stages_before_their_first_own(sandbox):
    planned = sandbox.planned("variants")
    assert planned["study_page"] == 3 + 2 + 2 + 4 + 3
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
    # recordings of runs are deleted after use: all variants of a run are measured before
    assert planned["experience_import"] == 23
    assert planned["experience_metrics"] == 3 * 23


def test_a_lab_with_runs_is_imported_run_by_run(new_checkout):
    """Units and files come from runs.tsv; what is named and missing is the import's to say."""
    sandbox = new_checkout("runs")
    folder = sandbox.root / "data/raw/my_lab/experience"
    (folder / "A").mkdir(parents=True)
    people = "participant\tsex\tage_years\theight_m\tmass_kg\nA\tF\t30\t1.7\t60\n"
    (folder / "participants.tsv").write_text(people, encoding="utf-8")
    rows = ["participant\trun\timu\tstanding\twalking"]
    rows += [f"A\t{run}\tA/{run}.h5\tA/{run}_s.h5\tA/{run}_w.h5" for run in ("1", "2")]
    (folder / "runs.tsv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    (folder / "A/1.h5").touch()
    path = sandbox.root / "config/config.yaml"
    text = path.read_text(encoding="utf-8").replace("  # my_lab:", "  my_lab:")
    path.write_text(text, encoding="utf-8")
    target = "results/my_lab/experience/printed/models/associations.parquet"
    (folder / "questionnaires.tsv").touch()
    planned = sandbox.planned("--config", "cohort=my_lab", "--", target)
    assert planned["experience_import"] == planned["experience_metrics"] == 2
    assert not {"experience_simulate", "experience_ratings"} & set(planned)


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
