"""Write how well the filter recovers the truth of a simulated cohort, all variants."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import run_script, script_parser
from swaystride.studies.kinematics.recovery import recovery_table
from swaystride.studies.kinematics.table_inputs import StageTables


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--participants", nargs="+", required=True)
    parser.add_argument("--variants", nargs="+", required=True)
    parser.add_argument("--results", type=Path, required=True)
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    tables = []
    for variant in arguments.variants:
        stages = StageTables(arguments.results / variant, arguments.participants)
        tables.append(recovery_table(stages.read("truth"), stages.read("truth_strides"), variant))
    joined = pd.concat(tables, ignore_index=True)
    joined.to_csv(arguments.output, index=False, float_format="%.6f", lineterminator="\n")
    print(f"{len(joined)} rows")


if __name__ == "__main__":
    run_script(main)
