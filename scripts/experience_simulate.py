"""Simulate one run of the experience cohort: raw files and truth, without ratings."""

from pathlib import Path

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.presentation.table_files import read_table
from swaystride.simulate.experience_cohort import experience_tables
from swaystride.simulate.experience_parameters import cohort_from_config
from swaystride.simulate.experience_runs import write_run
from swaystride.studies.experience.measure_settings import measure_rules


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--run", required=True)
    parser.add_argument("--people", type=Path, required=True, help="the printed Table 5.1")
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--folder", type=Path, required=True)
    parser.add_argument("--truth", type=Path, required=True, help="folder of the truth")
    arguments = parser.parse_args()
    given = arguments.parameters
    cohort = cohort_from_config(given)
    truth = write_run(
        arguments.run,
        tables=experience_tables(cohort, read_table(arguments.people), arguments.seed),
        cohort=cohort,
        rules=measure_rules(given["measures"]),
        seed=arguments.seed,
        folder=arguments.folder,
        truth_folder=arguments.truth,
    )
    print(f"{arguments.run}: {truth['pattern']}, {truth['n_strides']} steady strides simulated")


if __name__ == "__main__":
    run_script(main)
