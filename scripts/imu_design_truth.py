"""Write the errors of stride length and angle of a simulated cohort, by method and gait."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import run_script, script_parser
from swaystride.studies.imu_design.table_styles import TABLE_STYLES
from swaystride.studies.imu_design.truth import error_table


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("errors", type=Path, nargs="+")
    arguments = parser.parse_args()
    strides = pd.concat([pd.read_parquet(path) for path in arguments.errors], ignore_index=True)
    TABLE_STYLES["truth"].write(error_table(strides), arguments.output, simulated=True)


if __name__ == "__main__":
    run_script(main)
