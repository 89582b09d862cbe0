"""Associations of all measures with affect within runs."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.studies.experience.settings import within_rules
from swaystride.studies.experience.within_runs import significant_within, within_runs


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--runs", type=Path, required=True)
    parser.add_argument("--windows", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("--excluded", type=Path, required=True)
    parser.add_argument("--summary", type=Path, required=True)
    arguments = parser.parse_args()
    given = arguments.parameters
    within, excluded = within_runs(
        pd.read_parquet(arguments.windows),
        pd.read_parquet(arguments.runs),
        within_rules(given["model"]),
        step_s=given["windows"]["step_s"],
    )
    within.to_parquet(arguments.output, index=False)
    excluded.to_parquet(arguments.excluded, index=False)
    significant_within(within).to_parquet(arguments.summary, index=False)
    print(f"{within['run'].nunique()} runs, {len(excluded)} left out")


if __name__ == "__main__":
    run_script(main)
