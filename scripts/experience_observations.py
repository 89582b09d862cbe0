"""Join measures and answers of all runs and of their windows."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.studies.experience.observations import (
    pattern_counts,
    rows_of_runs,
    run_observations,
    window_observations,
)
from swaystride.studies.experience.settings import answer_rules, pattern_rules


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--cohort", type=Path, required=True, help="folder that holds answers")
    parser.add_argument("--variant", type=Path, required=True, help="folder of runs and windows")
    parser.add_argument("--names", nargs="+", required=True, help="names of the runs")
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--runs", type=Path, required=True)
    parser.add_argument("--windows", type=Path, required=True)
    arguments = parser.parse_args()
    given = arguments.parameters
    scores, affect = (
        pd.read_parquet(arguments.cohort / "answers" / f"{name}.parquet")
        for name in ("scores", "affect")
    )
    measured = {
        name: rows_of_runs(arguments.variant / name, arguments.names)
        for name in ("runs", "windows")
    }
    runs = run_observations(
        measured["runs"],
        scores,
        affect,
        warm_up_s=given["steady"]["warm_up_s"],
        mean=answer_rules(given["answers"]).mean,
        rules=pattern_rules(given["model"]),
    )
    windows = window_observations(measured["windows"], runs, scores, affect)
    runs.to_parquet(arguments.runs, index=False)
    windows.to_parquet(arguments.windows, index=False)
    counts = ", ".join(f"{n} {name}" for name, n in pattern_counts(runs["pattern"]).items())
    print(f"{len(runs)} runs ({counts}), {len(windows)} windows")


if __name__ == "__main__":
    run_script(main)
