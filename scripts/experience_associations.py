"""Associations of all measures with all scales between runs."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.studies.experience.between_runs import associations
from swaystride.studies.experience.settings import between_rules


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--observations", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    rules = between_rules(arguments.parameters["model"])
    table = associations(pd.read_parquet(arguments.observations), rules)
    table.to_parquet(arguments.output, index=False)
    print(f"{int(table['r'].notna().sum())} of {len(table)} associations estimated")


if __name__ == "__main__":
    run_script(main)
