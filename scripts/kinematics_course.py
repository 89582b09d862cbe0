"""Drift, convergence and midstance of every trial of one participant."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.studies.kinematics.course import COURSE_COLUMNS, trial_course
from swaystride.studies.kinematics.estimate_files import load_estimates
from swaystride.studies.kinematics.representative import trial_contacts
from swaystride.studies.kinematics.table_options import TableOptions


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--participant", required=True)
    parser.add_argument("--estimates", type=Path, required=True)
    parser.add_argument("--strides", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    options = from_mapping(TableOptions, arguments.parameters["tables"], place="analysis.tables")
    strides = pd.read_parquet(arguments.strides).astype({"trial": "str"})
    tables = []
    for trial, own in strides.groupby("trial", sort=False):
        estimates = load_estimates(arguments.estimates, str(trial))
        course = trial_course(estimates, trial_contacts(own), options)
        course.insert(0, "trial", str(trial))
        course.insert(0, "participant", arguments.participant)
        tables.append(course)
    empty = pd.DataFrame(columns=list(COURSE_COLUMNS))
    joined = pd.concat(tables, ignore_index=True) if tables else empty
    joined.to_parquet(arguments.output, index=False)
    print(f"{arguments.participant}: {len(tables)} trials")


if __name__ == "__main__":
    run_script(main)
