"""Write the parameters in force for one study, cohort and variant, with units and sources."""

import csv
from pathlib import Path

from swaystride.command_line import json_argument, run_script, script_parser

#: The columns that :mod:`swaystride.report.results_on_disk` reads.
COLUMNS = ("group", "name", "value", "unit", "source", "changed")


def main() -> None:
    """Parse the rows, write the table."""
    parser = script_parser(__doc__)
    parser.add_argument("--rows", type=json_argument, required=True)
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    with arguments.output.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerows([COLUMNS, *arguments.rows])


if __name__ == "__main__":
    run_script(main)
