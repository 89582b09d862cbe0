"""Join the sway measures with the model variables: one row per analysed trial."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.studies.feedback.design import read_design
from swaystride.studies.feedback.models import observations
from swaystride.studies.feedback.plan import ModelPlan


def main() -> None:
    """Parse paths, call the library, write the file."""
    parser = script_parser(__doc__)
    parser.add_argument("--raw", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--exclusions", type=Path, required=True)
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("metrics", nargs="+", type=Path)
    arguments = parser.parse_args()
    plan = from_mapping(ModelPlan, arguments.parameters["model"], place="analysis.model")
    participants, trials = read_design(arguments.raw)
    measures = pd.concat([pd.read_parquet(path) for path in arguments.metrics], ignore_index=True)
    exclusions = pd.read_csv(arguments.exclusions, dtype=str, keep_default_na=False)
    frame = observations(participants, trials, measures, exclusions, plan)
    frame.to_parquet(arguments.output, index=False)
    print(f"{len(frame)} trials of {frame['participant'].nunique()} participants")


if __name__ == "__main__":
    run_script(main)
