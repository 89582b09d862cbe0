"""Join findings and exclusions of all participants, and count the flow."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import run_script, script_parser
from swaystride.report.provenance import write_json
from swaystride.studies.imu_design.design import design_findings, read_design
from swaystride.studies.imu_design.flow import study_flow
from swaystride.studies.imu_design.observations import recording_verdicts
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
    design = read_design(arguments.raw)
    findings = pd.concat(
        [
            design_findings(design),
            read_quality_tables(arguments.parts / "findings", names),
            read_quality_tables(arguments.measured / "findings", names),
        ],
        ignore_index=True,
    )
    exclusions = read_quality_tables(arguments.parts / "exclusions", names)
    files = [arguments.measured / "metrics" / f"{name}.parquet" for name in names]
    metrics = pd.concat([pd.read_parquet(file) for file in files], ignore_index=True)
    findings.to_csv(arguments.findings, index=False, lineterminator="\n")
    exclusions.to_csv(arguments.exclusions, index=False, lineterminator="\n")
    flow = study_flow(design, exclusions, recording_verdicts(metrics))
    write_json({"flow": flow}, arguments.flow)
    print(f"{len(findings)} findings, {len(exclusions)} excluded recordings")


if __name__ == "__main__":
    run_script(main)
