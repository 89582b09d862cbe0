"""Errors of one simulated run against its truth."""

import json
from pathlib import Path

import pandas as pd

from swaystride.command_line import run_script, script_parser
from swaystride.simulate.experience_truth import read_run_truth
from swaystride.studies.experience.truth import truth_rows


def main() -> None:
    """Parse paths, call the library, write the table."""
    parser = script_parser(__doc__)
    parser.add_argument("--run", required=True)
    parser.add_argument("--truth-folder", type=Path, required=True)
    parser.add_argument("--strides", type=Path, required=True)
    parser.add_argument("--runs", type=Path, required=True)
    parser.add_argument("--alignment", type=Path, required=True)
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    stem = arguments.truth_folder / arguments.run
    rows = truth_rows(
        arguments.run,
        whole=pd.read_parquet(arguments.runs),
        strides=pd.read_parquet(arguments.strides),
        alignment=pd.read_parquet(arguments.alignment),
        true_values=json.loads(stem.with_suffix(".json").read_text(encoding="utf-8")),
        true_strides=pd.read_parquet(f"{stem}_strides.parquet"),
        motion=read_run_truth(stem.with_suffix(".npz")).motion,
    )
    rows.to_parquet(arguments.output, index=False)


if __name__ == "__main__":
    run_script(main)
