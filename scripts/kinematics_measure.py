"""Measure the estimates of one participant: strides, agreement, mean curves, planar angles."""

from dataclasses import asdict
from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.findings import FINDING_COLUMNS
from swaystride.studies.kinematics.estimate_files import load_estimates, usable_trials
from swaystride.studies.kinematics.measures import measure_parameters
from swaystride.studies.kinematics.participant_measures import participant_measures

TABLES = ("strides", "agreement", "curves", "planar")


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--participant", required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--estimates", type=Path, required=True)
    for table in TABLES:
        parser.add_argument(f"--{table}", type=Path, required=True)
    parser.add_argument("--findings", type=Path, required=True)
    arguments = parser.parse_args()
    given = arguments.parameters
    trials = {
        trial: load_estimates(arguments.estimates, trial)
        for trial in usable_trials(arguments.estimates)
    }
    tables, findings = participant_measures(
        arguments.participant, trials, measure_parameters(given["contacts"], given["measures"])
    )
    for name in TABLES:
        tables[name].to_parquet(getattr(arguments, name), index=False)
    rows = [{"participant": arguments.participant, "trial": t, **asdict(f)} for t, f in findings]
    columns = ["participant", "trial", *FINDING_COLUMNS]
    pd.DataFrame(rows, columns=columns).to_csv(arguments.findings, index=False, lineterminator="\n")
    print(f"{arguments.participant}: {len(trials)} trials measured")


if __name__ == "__main__":
    run_script(main)
