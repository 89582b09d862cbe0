"""Import the trials of one participant: sensors and markers read, checked, put on one clock."""

from pathlib import Path

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.studies.kinematics.design import read_design
from swaystride.studies.kinematics.importing import import_participant
from swaystride.studies.kinematics.settings import import_rules


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--raw", type=Path, required=True)
    parser.add_argument("--participant", required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--recordings", type=Path, required=True)
    parser.add_argument("--findings", type=Path, required=True)
    parser.add_argument("--exclusions", type=Path, required=True)
    arguments = parser.parse_args()
    tables = import_participant(
        arguments.participant,
        read_design(arguments.raw),
        arguments.raw,
        import_rules(arguments.parameters),
        arguments.recordings,
    )
    for name in ("findings", "exclusions"):
        getattr(tables, name).to_csv(getattr(arguments, name), index=False, lineterminator="\n")
    print(f"{arguments.participant}: {tables.summary}")


if __name__ == "__main__":
    run_script(main)
