"""Correlate the sway with the therapists' ratings, and predict the ratings from it."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.studies.intensity.kinematics import correlations, predictions
from swaystride.studies.intensity.plan import IntensityPlan


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--ratings", type=Path, required=True)
    parser.add_argument("--sway", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--folder", type=Path, required=True)
    arguments = parser.parse_args()
    plan = from_mapping(IntensityPlan, arguments.parameters["model"], place="analysis.model")
    ratings, sway = pd.read_parquet(arguments.ratings), pd.read_parquet(arguments.sway)
    found = {"correlations": correlations(ratings, sway, plan), **predictions(ratings, sway, plan)}
    for name, table in found.items():
        table.to_parquet(arguments.folder / f"{name}.parquet", index=False)
    print(f"{len(found['correlations'])} correlations, {len(found['results'])} predictions")


if __name__ == "__main__":
    run_script(main)
