"""Import the standing trials of one participant: read, check, apply the exclusion rules."""

from pathlib import Path

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.recording import save_recordings
from swaystride.studies.feedback.design import read_design
from swaystride.sway.trial_import import RecordingRules, import_trials


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
    _, trials = read_design(arguments.raw)
    own = trials[trials["participant"] == arguments.participant].set_index("trial")
    imported = import_trials(
        {str(trial): Path(file) for trial, file in own["file"].items()},
        arguments.raw,
        rules,
        own.loc[own["exclude"] != "", "exclude"].to_dict(),
    )
    save_recordings(arguments.recordings, imported.recordings)
    for table, path in (
        (imported.findings, arguments.findings),
        (imported.exclusions, arguments.exclusions),
    ):
        table.insert(0, "participant", arguments.participant)
        table.to_csv(path, index=False, lineterminator="\n")
    print(
        f"{arguments.participant}: {len(own)} trials, {len(imported.recordings)} usable, "
        f"{len(imported.exclusions)} excluded, {len(imported.findings)} findings"
    )


if __name__ == "__main__":
    run_script(main)
