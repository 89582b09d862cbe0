"""Estimate the effects of one whole simulated cohort from its raw files, for the recovery table."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.simulate.feedback_cohort import design_tables
from swaystride.simulate.feedback_parameters import cohort_from_config
from swaystride.simulate.feedback_recordings import write_participant
from swaystride.studies.feedback.design import with_trial_names
from swaystride.studies.feedback.models import observations
from swaystride.studies.feedback.plan import FEATURES, ModelPlan
from swaystride.studies.feedback.recovery import cohort_estimates
from swaystride.sway.trial_import import RecordingRules, import_trials
from swaystride.sway.trial_measures import MeasurementMethod, measure_trial


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
    method = from_mapping(MeasurementMethod, given["measurement"], place="analysis.measurement")
    plan = from_mapping(ModelPlan, given["model"], place="analysis.model")
    participants, trials = design_tables(cohort, arguments.seed)
    trials = with_trial_names(trials)
    measured, excluded = [], []
    for participant in participants["participant"]:
        own = trials[trials["participant"] == participant]
        # one participant's files at a time
        with TemporaryDirectory() as name:
            folder = Path(name)
            write_participant(
                participant,
                participants=participants,
                trials=trials.drop(columns="trial"),
                cohort=cohort,
                seed=arguments.seed,
                folder=folder,
                truth_file=folder / "truth.tsv",
            )
            files = dict(zip(own["trial"], map(Path, own["file"]), strict=True))
            imported = import_trials(files, folder, rules, {})
        excluded.append(imported.exclusions.assign(participant=participant))
        measured += [
            {"participant": participant, "trial": trial, **measure_trial(recording, method)}
            for trial, recording in imported.recordings.items()
        ]
    frame = observations(
        participants,
        trials,
        pd.DataFrame(measured),
        pd.concat(excluded, ignore_index=True),
        plan,
    )
    estimates = cohort_estimates(frame, np.log(frame[list(FEATURES)]), plan)
    estimates.assign(seed=arguments.seed).to_parquet(arguments.output, index=False)
    print(f"seed {arguments.seed}: {len(frame)} trials")


if __name__ == "__main__":
    run_script(main)
