"""Join findings and exclusions of all patients and of the ratings, and count the flow."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import run_script, script_parser
from swaystride.report.provenance import write_json
from swaystride.studies.intensity.design import read_design
from swaystride.studies.intensity.flow import study_flow
from swaystride.studies.intensity.observations import rating_findings
from swaystride.sway.participant_import import read_quality_tables


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--raw", type=Path, required=True)
    parser.add_argument("--parts", type=Path, required=True)
    parser.add_argument("--participants", nargs="+", required=True)
    parser.add_argument("--findings", type=Path, required=True)
    parser.add_argument("--exclusions", type=Path, required=True)
    parser.add_argument("--flow", type=Path, required=True)
    arguments = parser.parse_args()
    names = arguments.participants
    design = read_design(arguments.raw)
    findings = pd.concat(
        [read_quality_tables(arguments.parts / "findings", names), rating_findings(design)],
        ignore_index=True,
    )
    exclusions = read_quality_tables(arguments.parts / "exclusions", names)
    findings.to_csv(arguments.findings, index=False, lineterminator="\n")
    exclusions.to_csv(arguments.exclusions, index=False, lineterminator="\n")
    write_json({"flow": study_flow(design, exclusions)}, arguments.flow)
    print(f"{len(findings)} findings, {len(exclusions)} excluded trials")


if __name__ == "__main__":
    run_script(main)
