"""Shift the joint centres of one participant's trials and compute the optical angles again."""

from pathlib import Path

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.studies.kinematics import settings
from swaystride.studies.kinematics.design import read_design
from swaystride.studies.kinematics.equipment import measured_lengths
from swaystride.studies.kinematics.estimate_files import usable_trials
from swaystride.studies.kinematics.estimation import contact_times_s
from swaystride.studies.kinematics.imported_trials import load_trial
from swaystride.studies.kinematics.optics import calibrated_person
from swaystride.studies.kinematics.participant_measures import joined_tables, named
from swaystride.studies.kinematics.perturbation import (
    CURVE_COLUMNS,
    PERTURBATION_COLUMNS,
    PerturbationRule,
    trial_perturbation,
)


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--raw", type=Path, required=True)
    parser.add_argument("--participant", required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--recordings", type=Path, required=True)
    parser.add_argument("--perturbation", type=Path, required=True)
    parser.add_argument("--perturbation-curves", type=Path, required=True)
    arguments = parser.parse_args()
    given, participant = arguments.parameters, arguments.participant
    person = measured_lengths(
        read_design(arguments.raw).person(participant), settings.markers(given["markers"])
    )
    method = settings.optical_method(given["optics"])
    rule = from_mapping(PerturbationRule, given["perturbation"], place="analysis.perturbation")
    contacts = settings.contact_rule(given["contacts"])
    tables, curves = [], []
    for trial in usable_trials(arguments.recordings):
        recordings = load_trial(arguments.recordings, trial)
        shifted = trial_perturbation(
            recordings.markers,
            calibrated_person(recordings.standing_markers, person, method),
            contact_times_s(recordings.running, contacts),
            rule,
        )
        tables.append(named(shifted.table, participant, trial))
        curves.append(named(shifted.curves, participant, trial))
    joined_tables(tables, PERTURBATION_COLUMNS).to_parquet(arguments.perturbation, index=False)
    joined_tables(curves, CURVE_COLUMNS).to_parquet(arguments.perturbation_curves, index=False)
    print(f"{participant}: {len(tables)} trials")


if __name__ == "__main__":
    run_script(main)
