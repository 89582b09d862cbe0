"""Compute the sway measures of every usable standing trial of one participant."""

from pathlib import Path

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.sway.trial_measures import MeasurementMethod, measure_participant


def main() -> None:
    """Parse paths, call the library, write the file."""
    parser = script_parser(__doc__)
    parser.add_argument("--participant", required=True)
    parser.add_argument("--recordings", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    method = from_mapping(
        MeasurementMethod, arguments.parameters["measurement"], place="analysis.measurement"
    )
    measures = measure_participant(arguments.participant, arguments.recordings, method)
    measures.to_parquet(arguments.output, index=False)
    print(f"{arguments.participant}: {len(measures)} trials measured")


if __name__ == "__main__":
    run_script(main)
