"""Estimate the slopes of one whole simulated cohort from its raw files, for the recovery table."""

from pathlib import Path
from tempfile import TemporaryDirectory

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.gait.foot_methods import FootMethod
from swaystride.recording import list_recordings
from swaystride.simulate.imu_design_cohort import imu_design_tables
from swaystride.simulate.imu_design_parameters import cohort_from_config
from swaystride.simulate.imu_design_recordings import write_participant
from swaystride.studies.imu_design.design import ImuDesign, usable_trials, with_recording_names
from swaystride.studies.imu_design.experiments import EXPERIMENTS, ExperimentSettings
from swaystride.studies.imu_design.importing import import_participant
from swaystride.studies.imu_design.metrics import measure_participant
from swaystride.studies.imu_design.models import effects
from swaystride.studies.imu_design.observations import observations, usable_metrics
from swaystride.studies.imu_design.plan import ImuDesignPlan
from swaystride.studies.imu_design.sensors import sensor_specifications
from swaystride.sway.trial_import import RecordingRules


def main() -> None:
    """Parse paths, call the library, write the file."""
    parser = script_parser(__doc__)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    given = arguments.parameters
    cohort = cohort_from_config(given["simulation"])
    rules = from_mapping(RecordingRules, given["recording"], place="analysis.recording")
    sensors = sensor_specifications(given["sensors"])
    method = from_mapping(FootMethod, given["measurement"], place="analysis.measurement")
    settings = from_mapping(ExperimentSettings, given["experiments"], place="analysis.experiments")
    plan = from_mapping(ImuDesignPlan, given["model"], place="analysis.model")
    tables = imu_design_tables(cohort, arguments.seed)
    design = ImuDesign(tables.participants, with_recording_names(tables.trials))
    measured = []
    for participant in tables.participants["participant"]:
        # one participant's files at a time
        with TemporaryDirectory() as name:
            folder = Path(name)
            write_participant(
                participant,
                tables=tables,
                cohort=cohort,
                seed=arguments.seed,
                folder=folder,
                truth_file=folder / "truth.json",
            )
            recordings = folder / "recordings.nc"
            import_participant(participant, design, folder, rules, sensors, recordings)
            own = design.trials[design.trials["participant"] == participant]
            usable = usable_trials(own, list_recordings(recordings))
            measures = measure_participant(usable, recordings, method, settings)
            measured.append(measures.conditions)
    table = observations(usable_metrics(pd.concat(measured, ignore_index=True)))
    found = pd.concat([effects(table, name, plan) for name in EXPERIMENTS], ignore_index=True)
    found.assign(seed=arguments.seed).to_parquet(arguments.output, index=False)
    print(f"seed {arguments.seed}: {len(table)} observations")


if __name__ == "__main__":
    run_script(main)
