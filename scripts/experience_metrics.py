"""Measure one run: stride by stride, in sliding windows, and as a whole."""

import json
from pathlib import Path

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.studies.experience.design import read_design
from swaystride.studies.experience.measuring_files import RunInputs, measured_files
from swaystride.studies.experience.recording_settings import metric_rules, worn_equipment


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--raw", type=Path, required=True)
    parser.add_argument("--run", required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    for name in ("recordings", "heart-rate", "spans", "run-json"):
        parser.add_argument(f"--{name}", type=Path, required=True)
    for name in ("strides", "windows", "runs", "findings"):
        parser.add_argument(f"--{name}", type=Path, required=True)
    arguments = parser.parse_args()
    design = read_design(arguments.raw)
    run = design.run(arguments.run)
    tables, findings = measured_files(
        run,
        RunInputs(
            arguments.recordings,
            arguments.heart_rate,
            arguments.spans,
            json.loads(arguments.run_json.read_text(encoding="utf-8")),
        ),
        mass_kg=float(design.person(run.participant)["mass_kg"]),
        equipment=worn_equipment(arguments.parameters),
        rules=metric_rules(arguments.parameters),
    )
    for name, table in tables.items():
        table.to_parquet(getattr(arguments, name), index=False)
    findings.to_csv(arguments.findings, index=False, lineterminator="\n")
    print(f"{run.name}: {int(tables['runs']['n_strides'].sum())} strides, {len(findings)} findings")


if __name__ == "__main__":
    run_script(main)
