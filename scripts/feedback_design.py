"""Write participants.tsv, trials.tsv and the expected features of the simulated feedback cohort."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.io.study_tables import write_study_table
from swaystride.simulate.feedback_cohort import design_rows, design_tables
from swaystride.simulate.feedback_parameters import cohort_from_config
from swaystride.simulate.feedback_population import expected_log_features, variance_ratios


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--folder", type=Path, required=True)
    parser.add_argument("--expected", type=Path, required=True)
    parser.add_argument("--variance-ratios", type=Path, required=True)
    arguments = parser.parse_args()
    cohort = cohort_from_config(arguments.parameters["simulation"])
    participants, trials = design_tables(cohort, arguments.seed)
    write_study_table(participants, arguments.folder / "participants.tsv")
    write_study_table(trials, arguments.folder / "trials.tsv")
    expected = expected_log_features(design_rows(participants, trials, cohort), cohort.population)
    named = pd.concat([trials[["participant", "session_trial"]], expected], axis=1)
    named.to_csv(
        arguments.expected, sep="\t", index=False, float_format="%.9g", lineterminator="\n"
    )
    ratios = pd.Series(variance_ratios(cohort.population), name="variance_ratio")
    ratios.rename_axis("feature").to_csv(
        arguments.variance_ratios, sep="\t", float_format="%.9g", lineterminator="\n"
    )


if __name__ == "__main__":
    run_script(main)
