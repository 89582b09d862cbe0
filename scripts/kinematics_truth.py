"""Hold the estimates of one simulated participant against the truth."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import run_script, script_parser
from swaystride.simulate.kinematics_truth import read_truth
from swaystride.studies.kinematics.estimate_files import load_estimates, usable_trials
from swaystride.studies.kinematics.participant_measures import joined_tables, named
from swaystride.studies.kinematics.truth import (
    ANGLE_ERROR_COLUMNS,
    STRIDE_ERROR_COLUMNS,
    angle_errors,
    stride_errors,
)


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--participant", required=True)
    parser.add_argument("--estimates", type=Path, required=True)
    parser.add_argument("--strides", type=Path, required=True)
    parser.add_argument("--truth", type=Path, required=True)
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("--output-strides", type=Path, required=True)
    arguments = parser.parse_args()
    truth, participant = read_truth(arguments.truth), arguments.participant
    strides = pd.read_parquet(arguments.strides).astype({"trial": "str"})
    angles, measures = [], []
    for trial in usable_trials(arguments.estimates):
        own = strides[strides["trial"] == trial]
        known = truth.recording(trial)
        estimates = load_estimates(arguments.estimates, trial)
        angles.append(named(angle_errors(estimates, own, known), participant, trial))
        measures.append(named(stride_errors(own, known), participant, trial))
    joined_tables(angles, ANGLE_ERROR_COLUMNS).to_parquet(arguments.output, index=False)
    joined_tables(measures, STRIDE_ERROR_COLUMNS).to_parquet(arguments.output_strides, index=False)
    print(f"{participant}: {len(angles)} trials")


if __name__ == "__main__":
    run_script(main)
