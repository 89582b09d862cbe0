"""Simulate one participant of the IMU-design cohort: raw files and truth."""

from pathlib import Path

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.simulate.imu_design_cohort import imu_design_tables
from swaystride.simulate.imu_design_parameters import cohort_from_config
from swaystride.simulate.imu_design_recordings import write_participant


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
    trials = write_participant(
        arguments.participant,
        tables=imu_design_tables(cohort, arguments.seed),
        cohort=cohort,
        seed=arguments.seed,
        folder=arguments.folder,
        truth_file=arguments.truth,
    )
    print(f"{arguments.participant}: {len(trials)} trials simulated")


if __name__ == "__main__":
    run_script(main)
