"""Simulate one participant of the kinematics cohort: raw files and truth."""

from pathlib import Path

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.simulate.kinematics_cohort import kinematics_tables
from swaystride.simulate.kinematics_parameters import cohort_from_config
from swaystride.simulate.kinematics_recordings import write_participant


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--participant", required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--folder", type=Path, required=True)
    parser.add_argument("--truth", type=Path, required=True)
    arguments = parser.parse_args()
    cohort = cohort_from_config(arguments.parameters["simulation"])
    truth = write_participant(
        arguments.participant,
        tables=kinematics_tables(cohort, arguments.seed),
        cohort=cohort,
        seed=arguments.seed,
        folder=arguments.folder,
        truth_file=arguments.truth,
    )
    print(f"{arguments.participant}: {len(truth.trials)} trials simulated")


if __name__ == "__main__":
    run_script(main)
