"""Recover the true effects of the feedback study over many simulated cohorts of features."""

from pathlib import Path

from tqdm import tqdm

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.presentation.table_files import read_table
from swaystride.simulate.feedback_cohort import design_rows, design_tables
from swaystride.simulate.feedback_parameters import cohort_from_config
from swaystride.simulate.feedback_population import (
    draw_features,
    expected_log_features,
    variance_ratios,
)
from swaystride.simulate.seeds import generator
from swaystride.studies.feedback.design import model_variables
from swaystride.studies.feedback.identities import attainability
from swaystride.studies.feedback.plan import ModelPlan
from swaystride.studies.feedback.recovery import cohort_estimates, recovery_table
from swaystride.studies.feedback.truth import true_effects


def main() -> None:
    """Parse paths, call the library, write the file."""
    parser = script_parser(__doc__)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--printed", type=Path, required=True)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--cohorts", type=int, required=True)
    parser.add_argument("--variant", required=True)
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    cohort = cohort_from_config(arguments.parameters["simulation"])
    plan = from_mapping(ModelPlan, arguments.parameters["model"], place="analysis.model")
    participants, trials = design_tables(cohort, arguments.seed)
    design = design_rows(participants, trials, cohort)
    named = trials.assign(trial=[f"trial_{number:02d}" for number in trials["session_trial"]])
    variables = model_variables(participants, named, trial_number_coding=plan.trial_number_coding)
    truth = true_effects(
        variables,
        expected_log_features(design, cohort.population),
        plan,
        variance_ratios(cohort.population),
    )
    estimates = (
        cohort_estimates(
            variables,
            draw_features(
                design, cohort.population, generator(arguments.seed, "recovery", str(number))
            ),
            plan,
        )
        for number in tqdm(range(arguments.cohorts), disable=None)
    )
    marks = attainability(read_table(arguments.printed), plan.last_training_trial)
    table = recovery_table(estimates, truth, marks, arguments.variant)
    table.to_csv(arguments.output, index=False, float_format="%.6f", lineterminator="\n")


if __name__ == "__main__":
    run_script(main)
