"""Write participants.tsv and trials.tsv of the simulated kinematics cohort."""

from pathlib import Path

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.io.study_tables import write_study_table
from swaystride.simulate.kinematics_cohort import kinematics_tables
from swaystride.simulate.kinematics_parameters import cohort_from_config


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--folder", type=Path, required=True)
    arguments = parser.parse_args()
    cohort = cohort_from_config(arguments.parameters["simulation"])
    tables = kinematics_tables(cohort, arguments.seed)
    for name in ("participants", "trials"):
        write_study_table(getattr(tables, name), arguments.folder / f"{name}.tsv")
    print(f"{len(tables.participants)} participants, {len(tables.trials)} recordings")


if __name__ == "__main__":
    run_script(main)
