"""Write one table of errors against the truth of a simulated cohort."""

from pathlib import Path

from swaystride.command_line import run_script, script_parser
from swaystride.studies.kinematics import truth_tables
from swaystride.studies.kinematics.table_inputs import StageTables
from swaystride.studies.kinematics.table_styles import TABLE_STYLES

TABLES = {
    "truth_angles": ("truth", truth_tables.truth_angles),
    "truth_summary": ("truth", truth_tables.truth_summary),
    "truth_strides": ("truth_strides", truth_tables.truth_strides),
}


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--table", choices=sorted(TABLES), required=True)
    parser.add_argument("--participants", nargs="+", required=True)
    parser.add_argument("--results", type=Path, required=True)
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    kind, build = TABLES[arguments.table]
    errors = StageTables(arguments.results, arguments.participants).read(kind)
    TABLE_STYLES[arguments.table].write(build(errors), arguments.output, simulated=True)


if __name__ == "__main__":
    run_script(main)
