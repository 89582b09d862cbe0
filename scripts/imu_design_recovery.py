"""Hold the slopes of many simulated IMU-design cohorts against the printed Tables A1 to A4."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import run_script, script_parser
from swaystride.presentation.table_files import read_table
from swaystride.studies.imu_design.plan import TABLES
from swaystride.studies.imu_design.recovery import recovery_table, slopes_by_seed

#: The paper's significance level.
ALPHA = 0.05


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--printed", type=Path, required=True)
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("--slopes", type=Path, required=True)
    parser.add_argument("cohorts", type=Path, nargs="+")
    arguments = parser.parse_args()
    cohorts = pd.concat([pd.read_parquet(path) for path in arguments.cohorts], ignore_index=True)
    printed = {name: read_table(arguments.printed / f"{name}.csv") for name in TABLES.values()}
    slopes = slopes_by_seed(cohorts, printed, "subject")
    slopes.to_csv(arguments.slopes, index=False, float_format="%.3f", lineterminator="\n")
    table = recovery_table(cohorts, printed, ALPHA)
    table.to_csv(arguments.output, index=False, float_format="%.6f", lineterminator="\n")
    judged = table[table["within"] != "reported"]
    held = (judged["within"] == "yes").sum()
    print(f"{cohorts['seed'].nunique()} cohorts: {held} of {len(judged)} expectations hold")


if __name__ == "__main__":
    run_script(main)
