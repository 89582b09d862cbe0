"""Estimate the joint angles of one participant's trials, from the markers and from the filter."""

from dataclasses import asdict
from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.findings import FINDING_COLUMNS
from swaystride.studies.kinematics import settings
from swaystride.studies.kinematics.design import read_design
from swaystride.studies.kinematics.equipment import measured_lengths
from swaystride.studies.kinematics.estimate_files import (
    add_estimates,
    start_estimates,
    usable_trials,
)
from swaystride.studies.kinematics.estimation import estimate_trial
from swaystride.studies.kinematics.imported_trials import load_trial


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--raw", type=Path, required=True)
    parser.add_argument("--participant", required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--recordings", type=Path, required=True)
    parser.add_argument("--estimates", type=Path, required=True)
    parser.add_argument("--findings", type=Path, required=True)
    arguments = parser.parse_args()
    given, participant = arguments.parameters, arguments.participant
    design = read_design(arguments.raw)
    markers = settings.markers(given["markers"])
    person = measured_lengths(design.person(participant), markers)
    method = settings.filter_method(given["erkf"], given["contacts"], given["zero_velocity"])
    optics = settings.optical_method(given["optics"])
    trials, rows = usable_trials(arguments.recordings), []
    start_estimates(arguments.estimates)
    for trial in trials:
        estimates, findings = estimate_trial(
            load_trial(arguments.recordings, trial),
            person,
            design.belt_speed_m_s(participant, trial),
            optics,
            method,
            markers,
        )
        add_estimates(arguments.estimates, trial, estimates)
        rows += [{"participant": participant, "trial": trial, **asdict(f)} for f in findings]
    columns = ["participant", "trial", *FINDING_COLUMNS]
    pd.DataFrame(rows, columns=columns).to_csv(arguments.findings, index=False, lineterminator="\n")
    print(f"{participant}: {len(trials)} trials estimated")


if __name__ == "__main__":
    run_script(main)
