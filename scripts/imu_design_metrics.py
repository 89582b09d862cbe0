"""Measure every foot recording of one participant under every condition of the experiments."""

from pathlib import Path

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.gait.foot_methods import FootMethod
from swaystride.recording import list_recordings
from swaystride.studies.imu_design.design import read_design, usable_trials
from swaystride.studies.imu_design.experiments import ExperimentSettings
from swaystride.studies.imu_design.metrics import measure_participant


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--raw", type=Path, required=True)
    parser.add_argument("--participant", required=True)
    parser.add_argument("--recordings", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--metrics", type=Path, required=True)
    parser.add_argument("--strides", type=Path, required=True)
    parser.add_argument("--findings", type=Path, required=True)
    arguments = parser.parse_args()
    given = arguments.parameters
    trials = read_design(arguments.raw).trials
    own = trials[trials["participant"] == arguments.participant]
    measures = measure_participant(
        usable_trials(own, list_recordings(arguments.recordings)),
        arguments.recordings,
        from_mapping(FootMethod, given["measurement"], place="analysis.measurement"),
        from_mapping(ExperimentSettings, given["experiments"], place="analysis.experiments"),
    )
    measures.conditions.to_parquet(arguments.metrics, index=False)
    measures.strides.to_parquet(arguments.strides, index=False)
    measures.findings.to_csv(arguments.findings, index=False, lineterminator="\n")
    print(
        f"{arguments.participant}: {len(measures.strides)} strides, "
        f"{len(measures.conditions)} conditions measured"
    )


if __name__ == "__main__":
    run_script(main)
