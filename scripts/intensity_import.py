"""Import the standing trials of one patient: read, check, apply the exclusion rules."""

from pathlib import Path

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.studies.intensity.design import read_design
from swaystride.sway.participant_import import ImportFiles, import_participant
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
    arguments = parser.parse_args()
    rules = from_mapping(
        RecordingRules, arguments.parameters["recording"], place="analysis.recording"
    )
    trials = read_design(arguments.raw).trials
    files = ImportFiles(arguments.recordings, arguments.findings, arguments.exclusions)
    imported = import_participant(
        arguments.participant,
        trials.assign(trial=trials["recording"]),
        arguments.raw,
        rules,
        files,
    )
    print(f"{arguments.participant}: {imported.summary}")


if __name__ == "__main__":
    run_script(main)
