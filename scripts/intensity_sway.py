"""Join the sway measures with the exercises: one row per measured trial."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.studies.intensity.design import read_design
from swaystride.studies.intensity.observations import analysed_sway
from swaystride.studies.intensity.plan import IntensityPlan


def main() -> None:
    """Parse paths, call the library, write the file."""
    parser = script_parser(__doc__)
    parser.add_argument("--raw", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("metrics", nargs="+", type=Path)
    arguments = parser.parse_args()
    plan = from_mapping(IntensityPlan, arguments.parameters["model"], place="analysis.model")
    measures = pd.concat([pd.read_parquet(path) for path in arguments.metrics], ignore_index=True)
    sway = analysed_sway(read_design(arguments.raw), measures, plan)
    sway.to_parquet(arguments.output, index=False)
    print(f"{len(sway)} trials of {sway['participant'].nunique()} patients")


if __name__ == "__main__":
    run_script(main)
