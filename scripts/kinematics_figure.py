"""Draw one figure of the kinematics study."""

from pathlib import Path

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.presentation.figure_style import figure_style, save_figure
from swaystride.presentation.table_files import read_table
from swaystride.studies.kinematics import cycle_figures, figures, range_figures
from swaystride.studies.kinematics.estimate_files import load_estimates
from swaystride.studies.kinematics.range_tests import table_4_4
from swaystride.studies.kinematics.representative import (
    representative_trial,
    trial_contacts,
    trial_rows,
)
from swaystride.studies.kinematics.table_inputs import StageTables
from swaystride.studies.kinematics.table_options import TableOptions
from swaystride.studies.kinematics.truth_tables import truth_angles


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--figure", required=True)
    parser.add_argument("--participants", nargs="+", required=True)
    parser.add_argument("--results", type=Path, required=True)
    parser.add_argument("--published", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--simulated", action="store_true")
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    options = from_mapping(TableOptions, arguments.parameters["tables"], place="analysis.tables")
    stages = StageTables(arguments.results, arguments.participants)
    participant, trial = representative_trial(stages.read("agreement"))

    def own(kind):
        return trial_rows(stages.read_participant(kind, participant), participant, trial)

    def estimates():
        return load_estimates(arguments.results / "estimates" / f"{participant}.nc", trial)

    def contacts():
        return trial_contacts(own("strides"))

    def ranges():
        printed = read_table(arguments.published / "table_4_4.csv")
        return table_4_4(stages.read("strides"), printed, options)

    draw = {
        "figure_4_5": lambda: figures.figure_4_5(estimates(), contacts()),
        "figure_4_7": lambda: cycle_figures.figure_4_7(own("curves")),
        "figure_4_8": lambda: cycle_figures.figure_4_8(own("perturbation_curves")),
        "figure_4_8_hip": lambda: cycle_figures.figure_4_8(
            own("perturbation_curves"), joints=("hip",)
        ),
        "figure_4_9": lambda: figures.figure_4_9(estimates(), contacts()),
        "figure_4_10": lambda: figures.figure_4_10(estimates(), contacts()),
        "figure_4_11": lambda: cycle_figures.figure_4_11(own("curves")),
        "figure_4_12": lambda: range_figures.figure_4_12(ranges()),
        "figure_truth": lambda: range_figures.figure_truth(truth_angles(stages.read("truth"))),
    }
    with figure_style():
        save_figure(
            draw[arguments.figure](),
            arguments.output.with_suffix(""),
            simulated=arguments.simulated,
        )


if __name__ == "__main__":
    run_script(main)
