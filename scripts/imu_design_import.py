"""Import the foot recordings of one participant: read, check, apply the exclusion rules."""

from pathlib import Path

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.studies.imu_design.design import read_design
from swaystride.studies.imu_design.importing import import_participant
from swaystride.studies.imu_design.sensors import sensor_specifications
from swaystride.sway.trial_import import RecordingRules


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--raw", type=Path, required=True)
    parser.add_argument("--participant", required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--recordings", type=Path, required=True)
    parser.add_argument("--findings", type=Path, required=True)
    parser.add_argument("--exclusions", type=Path, required=True)
    parser.add_argument("--ranges", type=Path, required=True)
    arguments = parser.parse_args()
    given = arguments.parameters
    tables = import_participant(
        arguments.participant,
        read_design(arguments.raw),
        arguments.raw,
        from_mapping(RecordingRules, given["recording"], place="analysis.recording"),
        sensor_specifications(given["sensors"]),
        arguments.recordings,
    )
    for name in ("findings", "exclusions", "ranges"):
        getattr(tables, name).to_csv(getattr(arguments, name), index=False, lineterminator="\n")
    print(f"{arguments.participant}: {tables.summary}")


if __name__ == "__main__":
    run_script(main)
