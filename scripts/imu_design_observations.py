"""Join the measures of all participants into one row per trial and condition."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import run_script, script_parser
from swaystride.studies.imu_design.observations import observations, usable_metrics


def main() -> None:
    """Parse paths, call the library, write the file."""
    parser = script_parser(__doc__)
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("metrics", type=Path, nargs="+")
    arguments = parser.parse_args()
    metrics = pd.concat([pd.read_parquet(path) for path in arguments.metrics], ignore_index=True)
    table = observations(usable_metrics(metrics))
    table.to_parquet(arguments.output, index=False)
    print(f"{len(table)} observations")


if __name__ == "__main__":
    run_script(main)
