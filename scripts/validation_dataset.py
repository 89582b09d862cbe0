"""Validate the library on one public data set: checks, table of trials, figure."""

from pathlib import Path

from swaystride.command_line import run_script, script_parser
from swaystride.presentation.figure_style import figure_style, save_figure
from swaystride.validation import lumbar_imu_standing, standing_force_plate
from swaystride.validation.figures import figure_force_plate, figure_lumbar
from swaystride.validation.summary import summary_frame


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument(
        "--dataset",
        choices=[standing_force_plate.DATASET, lumbar_imu_standing.DATASET],
        required=True,
    )
    parser.add_argument("--real-data", type=Path, required=True)
    parser.add_argument("--checks", type=Path, required=True)
    parser.add_argument("--trials", type=Path, required=True)
    parser.add_argument("--figure", type=Path, required=True)
    arguments = parser.parse_args()
    folder = arguments.real_data
    with figure_style():
        if arguments.dataset == standing_force_plate.DATASET:
            trials = standing_force_plate.force_plate_trials(folder)
            table = standing_force_plate.force_plate_table(folder)
            checks = standing_force_plate.force_plate_checks(trials, table)
            figure = figure_force_plate(trials)
        else:
            trials = lumbar_imu_standing.lumbar_trials(folder)
            checks = lumbar_imu_standing.lumbar_checks(trials)
            figure = figure_lumbar(trials)
        save_figure(figure, arguments.figure.with_suffix(""), simulated=False)
    summary = summary_frame(checks)
    summary.to_csv(arguments.checks, index=False, float_format="%.12g", lineterminator="\n")
    trials.to_csv(arguments.trials, index=False, float_format="%.12g", lineterminator="\n")
    counts = summary["within"].value_counts()
    print(f"{arguments.dataset}: " + ", ".join(f"{n} {name}" for name, n in counts.items()))


if __name__ == "__main__":
    run_script(main)
