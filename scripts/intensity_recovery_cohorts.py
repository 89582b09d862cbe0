"""Estimate all printed quantities of several simulated intensity cohorts, without files."""

from dataclasses import replace
from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.simulate.intensity_cohort import intensity_tables, participant_names, truth_of
from swaystride.simulate.intensity_parameters import IntensityCohort, cohort_from_config
from swaystride.simulate.intensity_sway import simulate_features
from swaystride.studies.intensity.design import IntensityDesign, with_recording_names
from swaystride.studies.intensity.estimates import cohort_estimates
from swaystride.studies.intensity.observations import analysed_ratings
from swaystride.studies.intensity.plan import IntensityPlan
from swaystride.studies.intensity.reliability import quick_icc

#: Resamples of patients in each cohort: enough for a standard error.
RESAMPLES = 300


def main() -> None:
    """Parse paths, call the library, write the file."""
    parser = script_parser(__doc__)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--first", type=int, required=True)
    parser.add_argument("--cohorts", type=int, required=True)
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    cohort = cohort_from_config(arguments.parameters["simulation"])
    plan = from_mapping(IntensityPlan, arguments.parameters["model"], place="analysis.model")
    plan = replace(plan, cluster_bootstrap_n=RESAMPLES)
    seeds = range(arguments.first, arguments.first + arguments.cohorts)
    tables = [one_cohort(cohort, plan, seed).assign(seed=seed) for seed in seeds]
    pd.concat(tables, ignore_index=True).to_parquet(arguments.output, index=False)
    print(f"{len(tables)} cohorts from seed {arguments.first}")


def one_cohort(cohort: IntensityCohort, plan: IntensityPlan, seed: int) -> pd.DataFrame:
    """Results of one cohort; the ICC also in its recommended form."""
    tables = intensity_tables(cohort, seed)
    trials = with_recording_names(tables.trials)
    design = IntensityDesign(tables.participants, tables.raters, trials, tables.ratings)
    ratings = analysed_ratings(design)
    people = tables.participants.set_index("participant")
    parts = []
    for name in participant_names(cohort):
        height_m, mass_kg = people.loc[[name], ["height_m", "mass_kg"]].to_numpy()[0].tolist()
        features = simulate_features(
            name, truth_of(name, cohort, seed),
            cohort=cohort, mass_kg=mass_kg, height_m=height_m, seed=seed,
        )  # fmt: skip
        own = trials.loc[
            trials["participant"] == name, ["participant", "exercise", "exercise_order", "trial"]
        ]
        parts.append(own.merge(features, on=["exercise_order", "trial"]))
    found = cohort_estimates(ratings, pd.concat(parts, ignore_index=True), plan)
    nested = quick_icc(ratings, replace(plan, icc_form="recommended"))
    nested["quantity"] += "_recommended"
    return pd.concat([found, nested], ignore_index=True)


if __name__ == "__main__":
    run_script(main)
