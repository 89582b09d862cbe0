"""Write the parameters in force for one study, cohort and variant, with units and sources."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_argument, run_script, script_parser
from swaystride.report.results_on_disk import PARAMETER_COLUMNS


def main() -> None:
    """Parse the rows, write the table."""
    parser = script_parser(__doc__)
    parser.add_argument("--rows", type=json_argument, required=True)
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    table = pd.DataFrame(arguments.rows, columns=list(PARAMETER_COLUMNS))
    table.to_csv(arguments.output, index=False, lineterminator="\n")


if __name__ == "__main__":
    run_script(main)
