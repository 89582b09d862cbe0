"""Validate the library on one public data set: checks, table of trials, figure."""

from collections.abc import Callable
from pathlib import Path
from typing import Final

import pandas as pd
from matplotlib.figure import Figure

from swaystride.command_line import run_script, script_parser
from swaystride.presentation.figure_style import figure_style, save_figure
from swaystride.validation import (
    chest_strap_ecg,
    force_plate_models,
    lower_limb_checks,
    lumbar_imu_standing,
    reliability_and_mixed_models,
    standing_force_plate,
)
from swaystride.validation.figures import (
    figure_force_plate,
    figure_heart_rate,
    figure_lumbar,
    figure_reliability,
)
from swaystride.validation.summary import Check, summary_frame

Validated = tuple[pd.DataFrame, list[Check], Callable[[pd.DataFrame], Figure]]


def force_plate(folder: Path) -> Validated:
    """Trials, checks and figure of the force-plate recordings."""
    trials = standing_force_plate.force_plate_trials(folder)
    table = standing_force_plate.force_plate_table(folder)
    comparison = force_plate_models.force_plate_comparison(table)
    checks = standing_force_plate.force_plate_checks(trials, comparison)
    return trials, checks, figure_force_plate


def lumbar(folder: Path) -> Validated:
    """Trials, checks and figure of the lumbar recordings."""
    trials = lumbar_imu_standing.lumbar_trials(folder)
    return trials, lumbar_imu_standing.lumbar_checks(trials), figure_lumbar


def reliability(folder: Path) -> Validated:
    """Compared values, checks and figure of the tables of ratings."""
    comparison = reliability_and_mixed_models.reliability_comparison(folder)
    name = reliability_and_mixed_models.DATASET
    checks = reliability_and_mixed_models.comparison_checks(name, comparison)
    return comparison, checks, figure_reliability


def chest_strap(folder: Path) -> Validated:
    """Minutes, checks and figure of the electrocardiogram."""
    minutes = chest_strap_ecg.heart_rate_table(folder)
    return minutes, chest_strap_ecg.heart_rate_checks(minutes, folder), figure_heart_rate


def lower_limb(folder: Path) -> Validated:
    """Errors, checks and figure of the walking trial with seven sensors."""
    errors = lower_limb_checks.walking_table(folder)
    return errors, lower_limb_checks.walking_checks(errors), lower_limb_checks.figure_walking


DATASETS: Final[dict[str, Callable[[Path], Validated]]] = {
    standing_force_plate.DATASET: force_plate,
    lumbar_imu_standing.DATASET: lumbar,
    reliability_and_mixed_models.DATASET: reliability,
    chest_strap_ecg.DATASET: chest_strap,
    lower_limb_checks.DATASET: lower_limb,
}


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--dataset", choices=list(DATASETS), required=True)
    parser.add_argument("--real-data", type=Path, required=True)
    parser.add_argument("--checks", type=Path, required=True)
    parser.add_argument("--trials", type=Path, required=True)
    parser.add_argument("--figure", type=Path, required=True)
    arguments = parser.parse_args()
    trials, checks, draw = DATASETS[arguments.dataset](arguments.real_data)
    with figure_style():
        save_figure(draw(trials), arguments.figure.with_suffix(""), simulated=False)
    summary = summary_frame(checks)
    summary.to_csv(arguments.checks, index=False, float_format="%.12g", lineterminator="\n")
    trials.to_csv(arguments.trials, index=False, float_format="%.12g", lineterminator="\n")
    counts = summary["within"].value_counts()
    print(f"{arguments.dataset}: " + ", ".join(f"{n} {name}" for name, n in counts.items()))


if __name__ == "__main__":
    run_script(main)
