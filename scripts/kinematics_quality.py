"""Join findings and exclusions of all participants, and count the flow."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import run_script, script_parser
from swaystride.report.provenance import write_json
from swaystride.studies.kinematics.design import read_design
from swaystride.studies.kinematics.flow import named_findings, study_flow
from swaystride.studies.kinematics.table_inputs import StageTables, planned_trials
from swaystride.sway.participant_import import read_quality_tables


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--raw", type=Path, required=True)
    parser.add_argument("--parts", type=Path, required=True)
    parser.add_argument("--measured", type=Path, required=True)
    parser.add_argument("--participants", nargs="+", required=True)
    parser.add_argument("--findings", type=Path, required=True)
    parser.add_argument("--exclusions", type=Path, required=True)
    parser.add_argument("--flow", type=Path, required=True)
    arguments = parser.parse_args()
    names = arguments.participants
    planned = planned_trials(read_design(arguments.raw).trials)
    findings = named_findings(
        pd.concat(
            [
                read_quality_tables(arguments.parts / "findings", names),
                read_quality_tables(arguments.measured / "findings" / "estimate", names),
                read_quality_tables(arguments.measured / "findings" / "measure", names),
            ],
            ignore_index=True,
        )
    )
    exclusions = read_quality_tables(arguments.parts / "exclusions", names)
    strides = StageTables(arguments.measured, names).read("strides")
    findings.to_csv(arguments.findings, index=False, lineterminator="\n")
    exclusions.to_csv(arguments.exclusions, index=False, lineterminator="\n")
    write_json({"flow": study_flow(planned, exclusions, strides)}, arguments.flow)
    print(f"{len(findings)} findings, {len(exclusions)} excluded trials")


if __name__ == "__main__":
    run_script(main)
