"""Import one run: sensors read, checked and turned into anatomical axes; beats, events, findings."""

from pathlib import Path

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.studies.experience.design import read_design
from swaystride.studies.experience.importing import RunOutputs, import_run_files
from swaystride.studies.experience.recording_settings import import_rules

OUTPUTS = ("recordings", "alignment", "heart-rate", "spans", "run-json", "findings", "exclusions")


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--raw", type=Path, required=True)
    parser.add_argument("--run", required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    for name in OUTPUTS:
        parser.add_argument(f"--{name}", type=Path, required=True)
    arguments = parser.parse_args()
    names = [name.replace("-", "_") for name in OUTPUTS]
    summary = import_run_files(
        arguments.run,
        read_design(arguments.raw),
        arguments.raw,
        import_rules(arguments.parameters),
        RunOutputs(**{name: getattr(arguments, name) for name in names}),
    )
    print(summary)


if __name__ == "__main__":
    run_script(main)
