"""Rate the runs of a simulated cohort many times: correlations found against those of the population."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.presentation.table_files import read_table
from swaystride.simulate.experience_rated_runs import true_run_measures
from swaystride.simulate.experience_rating_parameters import ratings_from_config
from swaystride.simulate.experience_rating_truth import read_truth
from swaystride.studies.experience.plan import MEASURE_KEYS
from swaystride.studies.experience.recovery import recovery_table
from swaystride.studies.experience.recovery_rows import RecoveryPlan


def main() -> None:
    """Parse paths, call the library, write the table."""
    parser = script_parser(__doc__)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--runs", type=Path, required=True)
    parser.add_argument("--truth-folder", type=Path, required=True)
    parser.add_argument("--printed", type=Path, required=True)
    parser.add_argument("--variant", required=True)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--cohorts", type=int, required=True)
    parser.add_argument("--resamples", type=int, required=True)
    parser.add_argument("--start-s", type=float, required=True)
    parser.add_argument("--mean", choices=("time_weighted", "simple"), required=True)
    parser.add_argument(
        "--reported",
        action="store_true",
        help="call what is not within limits beyond them, not wrong",
    )
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    truth = read_truth(arguments.truth_folder / "population.json")
    table = recovery_table(
        pd.read_parquet(arguments.runs),
        true_run_measures(arguments.truth_folder, truth.runs.names, MEASURE_KEYS),
        {
            group: read_table(arguments.printed / f"table_5_{number}.csv")
            for group, number in (("all", 3), ("aerial", 4))
        },
        truth,
        ratings_from_config(arguments.parameters["simulation"]["ratings"]),
        RecoveryPlan(
            seeds=range(arguments.seed, arguments.seed + arguments.cohorts),
            n_resamples=arguments.resamples,
            bootstrap_seed=arguments.seed,
            start_s=arguments.start_s,
            mean=arguments.mean,
        ),
    )
    if arguments.reported:
        table["within"] = table["within"].replace("no", "beyond")
    table.insert(0, "variant", arguments.variant)
    table.to_csv(arguments.output, index=False, float_format="%.6f", lineterminator="\n")
    print(table.loc[table["within"] != "reported", "within"].value_counts().to_dict())


if __name__ == "__main__":
    run_script(main)
