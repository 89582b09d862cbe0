"""Regress the therapists' ratings on each dimension of difficulty."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.studies.intensity.difficulty import difficulty, residuals
from swaystride.studies.intensity.plan import IntensityPlan


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--ratings", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--folder", type=Path, required=True)
    arguments = parser.parse_args()
    plan = from_mapping(IntensityPlan, arguments.parameters["model"], place="analysis.model")
    ratings = pd.read_parquet(arguments.ratings)
    effects = difficulty(ratings, plan)
    effects.to_parquet(arguments.folder / "results.parquet", index=False)
    residuals(ratings, plan).to_parquet(arguments.folder / "residuals.parquet", index=False)
    print(f"{len(effects)} effects of difficulty")


if __name__ == "__main__":
    run_script(main)
