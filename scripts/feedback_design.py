"""Write participants.tsv, trials.tsv and the true effects of the simulated feedback cohort."""

from pathlib import Path

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.io.study_tables import write_study_table
from swaystride.simulate.feedback_cohort import design_rows, design_tables
from swaystride.simulate.feedback_parameters import cohort_from_config
from swaystride.simulate.feedback_population import expected_log_features, variance_ratios
from swaystride.studies.feedback.design import model_variables, read_design
from swaystride.studies.feedback.plan import ModelPlan
from swaystride.studies.feedback.truth import true_effects


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--folder", type=Path, required=True)
    parser.add_argument("--truth", type=Path, required=True)
    arguments = parser.parse_args()
    cohort = cohort_from_config(arguments.parameters["simulation"])
    plan = from_mapping(ModelPlan, arguments.parameters["model"], place="analysis.model")
    participants, trials = design_tables(cohort, arguments.seed)
    write_study_table(participants, arguments.folder / "participants.tsv")
    write_study_table(trials, arguments.folder / "trials.tsv")
    expected = expected_log_features(design_rows(participants, trials, cohort), cohort.population)
    variables = model_variables(*read_design(arguments.folder), trial_number_coding="continue")
    truth = true_effects(variables, expected, plan, variance_ratios(cohort.population))
    truth.to_csv(arguments.truth, index=False, float_format="%.9g", lineterminator="\n")


if __name__ == "__main__":
    run_script(main)
