"""Write the results of a simulated intensity cohort beside the values of its population."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import run_script, script_parser
from swaystride.studies.intensity.model_files import all_results
from swaystride.studies.intensity.table_styles import TABLE_STYLES
from swaystride.studies.intensity.truth import truth_table


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--models", type=Path, required=True)
    parser.add_argument("--population", type=Path, required=True)
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    TABLE_STYLES["truth"].write(
        truth_table(all_results(arguments.models), pd.read_csv(arguments.population, sep="\t")),
        arguments.output,
        simulated=True,
    )


if __name__ == "__main__":
    run_script(main)
