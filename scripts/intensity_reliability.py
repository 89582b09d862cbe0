"""Estimate the inter-rater reliability of the therapists' ratings."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.studies.intensity.plan import IntensityPlan
from swaystride.studies.intensity.reliability import reliability


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--ratings", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--folder", type=Path, required=True)
    arguments = parser.parse_args()
    plan = from_mapping(IntensityPlan, arguments.parameters["model"], place="analysis.model")
    found = reliability(pd.read_parquet(arguments.ratings), plan)
    for name, table in found.items():
        table.to_parquet(arguments.folder / f"{name}.parquet", index=False)
    icc = found["results"].set_index("quantity")["estimate"]
    print(", ".join(f"{name} {value:.3f}" for name, value in icc.items()))


if __name__ == "__main__":
    run_script(main)
