"""Recover the true effects of the feedback study over many simulated cohorts."""

from collections.abc import Iterator
from pathlib import Path

import pandas as pd
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
from swaystride.studies.feedback.design import model_variables, with_trial_names
from swaystride.studies.feedback.identities import attainability
from swaystride.studies.feedback.plan import ModelPlan
from swaystride.studies.feedback.recovery import cohort_estimates, recovery_table
from swaystride.studies.feedback.truth import true_effects

#: What the recovery of an attainable effect must reach over 200 cohorts.
LARGEST_BIAS_IN_SE = 0.25
COVERAGE = (0.91, 0.98)


def main() -> None:
    """Parse paths, call the library, write the file."""
    parser = script_parser(__doc__)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--printed", type=Path, required=True)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--cohorts", type=int, required=True)
    parser.add_argument("--raw", type=Path, nargs="*", default=[])
    parser.add_argument("--variant", required=True)
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    cohort = cohort_from_config(arguments.parameters["simulation"])
    plan = from_mapping(ModelPlan, arguments.parameters["model"], place="analysis.model")
    participants, trials = design_tables(cohort, arguments.seed)
    trials = with_trial_names(trials)
    design = design_rows(participants, trials, cohort).sort_values(["participant", "session_trial"])
    variables = model_variables(participants, trials, trial_number_coding=plan.trial_number_coding)
    expected = expected_log_features(design, cohort.population)
    truth = true_effects(variables, expected, plan, variance_ratios(cohort.population))
    marks = attainability(read_table(arguments.printed), plan.last_training_trial)

    def drawn() -> Iterator[pd.DataFrame]:
        for number in tqdm(range(arguments.cohorts), disable=None):
            rng = generator(arguments.seed, "recovery", str(number))
            features = draw_features(design, cohort.population, rng)
            yield cohort_estimates(variables, features, plan)

    tables = [recovery_table(drawn(), truth, marks, f"{arguments.variant}, features")]
    if arguments.raw:
        raw = (pd.read_parquet(path) for path in arguments.raw)
        tables.append(recovery_table(raw, truth, marks, f"{arguments.variant}, raw files"))
    table = pd.concat(tables, ignore_index=True)
    judged = table["attainable"].eq("yes") & table["variant"].str.endswith("features")
    passed = table["bias_in_se"].abs().lt(LARGEST_BIAS_IN_SE) & table["coverage"].between(*COVERAGE)
    table["within"] = passed.map({True: "yes", False: "no"}).where(judged, "reported")
    table.to_csv(arguments.output, index=False, float_format="%.6f", lineterminator="\n")
    shown = table[judged]
    print(
        f"{len(shown)} attainable effects, {arguments.cohorts} cohorts: largest bias "
        f"{shown['bias_in_se'].abs().max():.2f} SE, coverage "
        f"{100 * shown['coverage'].min():.1f} to {100 * shown['coverage'].max():.1f} %; "
        f"{passed[judged].sum()} of {len(shown)} within limits"
    )


if __name__ == "__main__":
    run_script(main)
