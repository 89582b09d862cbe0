"""Fit the population of the simulated intensity study to the printed numbers.

Run by hand; the values stand in config/studies/intensity.yaml. It starts from the values there,
compares quick statistics of many simulated cohorts with print, and moves the fitted parameters by
least squares. Every deviation counts in units of the scatter between cohorts of ten patients, so
that no cohort and no seed is fitted. With ``--steps 0`` it only reports where the values stand.

Sway is taken from a bank of simulated trials with inputs spread over their range: a trial of a
cohort is represented by one of the bank with nearly the same inputs.
"""

from collections.abc import Mapping
from dataclasses import fields, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.spatial import cKDTree
from tqdm import tqdm

from swaystride.command_line import run_script, script_parser
from swaystride.configuration import load_yaml, plain_values
from swaystride.simulate.intensity_cohort import participant_names, rater_assignment, truth_of
from swaystride.simulate.intensity_fit import (
    prediction_statistics,
    rated_rows,
    rating_statistics,
    sway_statistics,
    variance_difference,
)
from swaystride.simulate.intensity_parameters import IntensityCohort, cohort_from_config
from swaystride.simulate.intensity_recordings import MEASURES
from swaystride.simulate.intensity_sway import SwayInputs, simulate_trial, sway_inputs_of
from swaystride.simulate.standing_recordings import true_measures

#: Parameters that are fitted, by part of the population. Positive ones move on a log scale.
FITTED = {
    "latent": [
        "mean",
        "surface",
        "stance",
        "vision",
        "ability_sd",
        "patient_exercise_sd",
        "trial_sd",
        "planning_sd",
        "head_avoidance",
        "extreme_stance_avoidance",
    ],
    "therapist": ["rater_sd", "trial_noise_sd", "exercise_noise_sd"],
    "self_rating": [
        "trial_weight",
        "patient_sd",
        "patient_exercise_sd",
        "trial_noise_sd",
        "exercise_noise_sd",
    ],
    "sway": [
        "ln_noise_ap",
        "ln_noise_ml",
        "slope_ap",
        "slope_ml",
        "activity_slope",
        "patient_sd",
        "exercise_sd",
        "trial_sd",
        "direction_sd_ap",
        "direction_sd_ml",
        "activity_sd",
        "ln_weight_shift",
        "weight_shift_slope",
        "weight_shift_sd",
        "weight_shift_ml_share",
    ],
}
SIGNED = {"mean", "head_avoidance", "ln_noise_ap", "ln_noise_ml", "activity_slope"} | {
    "ln_weight_shift",
    "weight_shift_slope",
}
#: Our names of the printed quantities of the text, by kind of rating.
TEXT = {
    "icc": "icc_pt_{}",
    "mean_difference": "pt_minus_self_mean_difference_{}",
    "difference_sd": "difference_sd_{}",
    "self_accuracy": "self_predicts_pt_accuracy_{}_percent",
    "self_5_is_5": "self_5_agrees_with_pt_{}_percent",
    "self_4_is_5": "self_4_is_pt_5_{}_percent",
    "spearman_self": "spearman_self_vs_pt_{}",
    "spearman_sway": "spearman_kinematics_vs_pt_{}",
    "sway_accuracy": "kinematics_predicts_pt_accuracy_{}_percent",
    "sway_5_is_5": "kinematics_5_agrees_with_pt_{}_percent",
    "sway_4_is_5": "kinematics_4_is_pt_5_{}_percent",
    "sway_4_is_4": "kinematics_4_is_pt_4_{}_percent",
}
#: Trials of the bank, and weights of noise (AP, ML) and activity in the search for neighbours.
BANK_SIZE = 12_000
BANK_WEIGHTS = np.array([1.0, 1.0, 0.5])
N_NEIGHBOURS = 4

Array = NDArray[np.float64]


def main() -> None:
    """Simulate the bank, fit, report."""
    parser = script_parser(__doc__)
    parser.add_argument("--cohorts", type=int, default=60)
    parser.add_argument("--steps", type=int, default=0)
    parser.add_argument("--first-seed", type=int, default=500_001)
    arguments = parser.parse_args()
    section = plain_values(load_yaml("config/studies/intensity.yaml")["simulation"])
    start = cohort_from_config(section)
    bank = TrialBank(start)
    seeds = range(arguments.first_seed, arguments.first_seed + arguments.cohorts)
    printed = printed_values()
    base = statistics(start, bank, seeds)
    spread = base.std()[printed.index]

    def deviation(x: Array) -> Array:
        now = statistics(with_values(start, x), bank, seeds)
        return ((now.mean()[printed.index] - printed) / spread).to_numpy()

    cohort = start
    if arguments.steps:
        x0 = fitted_values(start)
        step = np.maximum(0.04, 0.06 / np.maximum(np.abs(x0), 1e-3))
        found = least_squares(
            lambda x: np.append(deviation(x), 0.1 * (x - x0)),
            x0,
            diff_step=step,
            max_nfev=arguments.steps,
            verbose=2,
        )
        cohort = with_values(start, found.x)
        for part, names in FITTED.items():
            for name in names:
                print(f"{part}.{name}: {getattr(getattr(cohort.population, part), name):.4g}")
    held_out = range(seeds.stop, seeds.stop + 2 * arguments.cohorts)
    now = statistics(cohort, bank, held_out)
    report = pd.DataFrame({"printed": printed, "mean": now.mean(), "sd": now.std()})
    report = report.loc[printed.index]
    report["z"] = (report["printed"] - report["mean"]) / report["sd"]
    print(report.round(3).to_string())


class TrialBank:
    """Simulated trials with inputs spread over their range, found again by their inputs."""

    def __init__(self, cohort: IntensityCohort) -> None:
        rng = np.random.default_rng(7)
        ap = rng.uniform(-7.8, -3.4, BANK_SIZE)
        ml = ap - 0.1 + 0.5 * rng.standard_normal(BANK_SIZE)
        activity = np.clip(0.6 * rng.standard_normal(BANK_SIZE), -1.5, 1.6)
        inputs = SwayInputs(ap[:, None], ml[:, None], activity[:, None], np.zeros((BANK_SIZE, 1)))
        rows = []
        for number in tqdm(range(BANK_SIZE), disable=None):
            trial = simulate_trial(
                inputs, number, 0, cohort=cohort, mass_kg=72.0, height_m=1.68, rng=rng
            )
            measures = true_measures(trial.motion, cohort.trial)
            rows.append([measures[name] for name in MEASURES])
        self.features = np.array(rows)
        self.tree = cKDTree(np.column_stack([ap, ml, activity]) * BANK_WEIGHTS)

    def measures(self, inputs: SwayInputs, share_ml: float, rng: np.random.Generator) -> Array:
        """Features of trials with these inputs, the shift of weight added in closed form."""
        points = np.stack([inputs.ln_noise_ap, inputs.ln_noise_ml, inputs.activity], axis=-1)
        _, near = self.tree.query(points * BANK_WEIGHTS, k=N_NEIGHBOURS)
        pick = rng.integers(0, N_NEIGHBOURS, size=near.shape[:-1])
        found = self.features[np.take_along_axis(near, pick[..., None], axis=-1)[..., 0]].copy()
        # A slow sinusoid has this RMS within half a period, by its phase.
        within = rng.choice([0.35, 0.7, 1.0, 1.3], size=(2, *pick.shape))
        ap, ml = inputs.weight_shift_deg * within[0], share_ml * inputs.weight_shift_deg * within[1]
        column = {name: k for k, name in enumerate(MEASURES)}
        a2, m2 = (found[..., column[name]] ** 2 for name in ("ap_rms", "ml_rms"))
        added = ap**2 * m2 + ml**2 * a2 + ap**2 * ml**2
        area = found[..., column["ellipse_area"]]
        found[..., column["ellipse_area"]] = np.sqrt(area**2 + (np.pi * 1.96**2) ** 2 * added)
        found[..., column["phi_rms"]] = np.sqrt(a2 + m2 + ap**2 + ml**2)
        found[..., column["ap_rms"]], found[..., column["ml_rms"]] = (
            np.sqrt(a2 + ap**2),
            np.sqrt(m2 + ml**2),
        )
        return found


def statistics(cohort: IntensityCohort, bank: TrialBank, seeds: range) -> pd.DataFrame:
    """Quick statistics of cohorts, one row per seed, named as the printed quantities."""
    return pd.DataFrame([cohort_statistics(cohort, bank, seed) for seed in seeds])


def cohort_statistics(cohort: IntensityCohort, bank: TrialBank, seed: int) -> dict[str, float]:
    """Quick statistics of one cohort."""
    names = participant_names(cohort)
    patients = [truth_of(name, cohort, seed) for name in names]
    assigned = rater_assignment(cohort, seed)
    share = cohort.population.sway.weight_shift_ml_share
    features = np.array(
        [
            bank.measures(
                sway_inputs_of(name, patient, cohort, seed),
                share,
                np.random.default_rng([seed, number]),
            )
            for number, (name, patient) in enumerate(zip(names, patients, strict=True))
        ]
    )
    values: dict[str, float] = {}
    for level in ("per_trial", "per_exercise"):
        rows = rated_rows(patients, assigned, trials=level == "per_trial")
        found = {**rating_statistics(rows), **prediction_statistics(rows, features)}
        for name, value in found.items():
            if name in TEXT:
                percent = TEXT[name].endswith("percent")
                values[TEXT[name].format(level)] = 100.0 * value if percent else value
            else:
                values[f"{name}/{level}"] = value
        if level == "per_trial":
            values.update(sway_statistics(rows, features, MEASURES))
    values["pt_minus_self_between_trial_variance_difference"] = variance_difference(
        patients, assigned
    )
    return values


def printed_values() -> pd.Series:
    """Printed estimates, and the standard errors that the printed intervals imply."""
    folder = "data/published"
    effects = pd.read_csv(f"{folder}/table_3_2.csv")
    features = pd.read_csv(f"{folder}/table_3_3.csv")
    text = pd.read_csv(f"{folder}/study3_text.csv")
    values = dict(zip(text["quantity"], text["value"], strict=True))
    for row in effects.to_dict("records"):
        key = f"{row['aspect']}", f"{row['rating']}"
        values["/".join(key)] = row["estimate"]
        values[f"{key[0]}_se/{key[1]}"] = (row["ci_high"] - row["ci_low"]) / 3.92
    for row in features.to_dict("records"):
        values[f"{row['feature']}/{row['transform']}"] = row["r"]
    return pd.Series(values)


def fitted_values(cohort: IntensityCohort) -> Array:
    """Fitted parameters as a vector, positive ones as logarithms."""
    values = []
    for part, names in FITTED.items():
        for name in names:
            value = getattr(getattr(cohort.population, part), name)
            values.append(value if name in SIGNED else np.log(value))
    return np.array(values)


def with_values(cohort: IntensityCohort, x: Array) -> IntensityCohort:
    """The cohort with other fitted parameters; both smaller biases follow that of the therapist."""
    rest = iter(x.tolist())
    parts: dict[str, object] = {}
    for part, names in FITTED.items():
        values = {name: next(rest) for name in names}
        values = {k: v if k in SIGNED else float(np.exp(v)) for k, v in values.items()}
        if part == "therapist":
            values["rater_patient_sd"] = values["rater_exercise_sd"] = 0.8 * values["rater_sd"]
        parts[part] = replace(getattr(cohort.population, part), **_known(values, cohort, part))
    return replace(cohort, population=replace(cohort.population, **parts))


def _known(values: Mapping[str, float], cohort: IntensityCohort, part: str) -> dict[str, float]:
    """Only what the part has: a misspelt name must not pass silently."""
    names = {field.name for field in fields(getattr(cohort.population, part))}
    unknown = set(values) - names
    if unknown:
        raise KeyError(", ".join(sorted(unknown)))
    return dict(values)


if __name__ == "__main__":
    run_script(main)
