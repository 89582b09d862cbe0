"""Compute the sway measures of every usable trial of one participant."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.recording import list_recordings, load_recording
from swaystride.sway.trial_measures import TRIAL_MEASURES, MeasurementMethod, measure_trial


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
    rows = [
        {
            "participant": arguments.participant,
            "trial": trial,
            **measure_trial(load_recording(arguments.recordings, trial), method),
        }
        for trial in list_recordings(arguments.recordings)
    ]
    columns = ["participant", "trial", *TRIAL_MEASURES]
    pd.DataFrame(rows, columns=columns).to_parquet(arguments.output, index=False)
    print(f"{arguments.participant}: {len(rows)} trials measured")


if __name__ == "__main__":
    run_script(main)
