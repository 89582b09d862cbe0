"""Write participants.tsv and runs.tsv of the simulated experience cohort."""

from pathlib import Path

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.io.study_tables import write_study_table
from swaystride.presentation.table_files import read_table
from swaystride.simulate.experience_cohort import experience_tables
from swaystride.simulate.experience_parameters import cohort_from_config


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--people", type=Path, required=True, help="the printed Table 5.1")
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--folder", type=Path, required=True)
    arguments = parser.parse_args()
    cohort = cohort_from_config(arguments.parameters)
    tables = experience_tables(cohort, read_table(arguments.people), arguments.seed)
    for name in ("participants", "runs"):
        write_study_table(getattr(tables, name), arguments.folder / f"{name}.tsv")
    print(f"{len(tables.participants)} participants, {len(tables.runs)} runs")


if __name__ == "__main__":
    run_script(main)
