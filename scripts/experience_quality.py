"""Join findings and exclusions of all runs, and count the flow."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import run_script, script_parser
from swaystride.report.provenance import write_json
from swaystride.studies.experience.design import read_design
from swaystride.studies.experience.flow import named_findings, study_flow
from swaystride.studies.experience.table_inputs import StageTables
from swaystride.sway.participant_import import read_quality_tables


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--raw", type=Path, required=True)
    parser.add_argument("--runs", nargs="+", required=True)
    parser.add_argument("--cohort-results", type=Path, required=True)
    parser.add_argument("--measured", type=Path, required=True)
    parser.add_argument("--answer-findings", type=Path, required=True)
    parser.add_argument("--findings", type=Path, required=True)
    parser.add_argument("--exclusions", type=Path, required=True)
    parser.add_argument("--flow", type=Path, required=True)
    arguments = parser.parse_args()
    names, quality = arguments.runs, arguments.cohort_results / "quality"
    stages = StageTables(arguments.cohort_results, arguments.measured, names)
    answers = pd.read_csv(arguments.answer_findings, dtype=str, keep_default_na=False)
    tables = [
        read_quality_tables(quality / "findings", names),
        read_quality_tables(arguments.measured / "findings", names),
        answers,
    ]
    findings = named_findings(pd.concat(tables, ignore_index=True).fillna(""))
    exclusions = read_quality_tables(quality / "exclusions", names)
    flow = study_flow(
        pd.DataFrame({"run": read_design(arguments.raw).run_names}),
        exclusions,
        stages.of_runs("runs"),
        stages.joined("answers/scores"),
    )
    findings.to_csv(arguments.findings, index=False, lineterminator="\n")
    exclusions.to_csv(arguments.exclusions, index=False, lineterminator="\n")
    write_json({"flow": flow}, arguments.flow)
    print(f"{len(findings)} findings, {len(exclusions)} excluded runs")


if __name__ == "__main__":
    run_script(main)
