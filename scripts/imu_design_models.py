"""Fit the mixed models of the distance error, of all four experiments."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.studies.imu_design.experiments import EXPERIMENTS
from swaystride.studies.imu_design.models import effects, residuals, variance_components
from swaystride.studies.imu_design.plan import ImuDesignPlan


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--observations", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--folder", type=Path, required=True)
    arguments = parser.parse_args()
    plan = from_mapping(ImuDesignPlan, arguments.parameters["model"], place="analysis.model")
    table = pd.read_parquet(arguments.observations)
    parts = {
        "effects": [effects(table, name, plan) for name in EXPERIMENTS],
        "components": [variance_components(table, name) for name in EXPERIMENTS],
        "residuals": [residuals(table, name, plan) for name in EXPERIMENTS],
    }
    for name, tables in parts.items():
        joined = pd.concat(tables, ignore_index=True)
        joined.to_parquet(arguments.folder / f"{name}.parquet", index=False)
    print(f"{2 * len(EXPERIMENTS)} models fitted")


if __name__ == "__main__":
    run_script(main)
