"""Draw one figure of the IMU-design study."""

from functools import partial
from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.presentation.figure_style import figure_style, save_figure
from swaystride.presentation.table_files import read_table
from swaystride.studies.imu_design import figures
from swaystride.studies.imu_design.experiments import ExperimentName
from swaystride.studies.imu_design.plan import ImuDesignPlan

TITLES = {
    "accelerometer_range": "Accelerometer",
    "gyro_range": "Gyroscope",
    "downsampling": "Samples left out",
    "decimation": "Decimation",
}


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--figure", required=True)
    parser.add_argument("--results", type=Path, required=True)
    parser.add_argument("--printed", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--simulated", action="store_true")
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    given = arguments.parameters
    plan = from_mapping(ImuDesignPlan, given["model"], place="analysis.model")
    models = arguments.results / "models"
    observations = pd.read_parquet(models / "observations.parquet")
    limit = plan.distance_error_limit_pct

    def over_loss(experiment: ExperimentName, quantity: str) -> Figure:
        printed = read_table(arguments.printed).set_index("quantity")["value"]
        return figures.figure_error_over_loss(
            observations, experiment, limit, float(printed[quantity])
        )

    speed = partial(figures.figure_error_over_speed, observations, limit_pct=limit)
    spread = partial(figures.figure_stride_differences, observations)
    draw = {
        "figure_3": lambda: speed("accelerometer_range"),
        "figure_5": lambda: over_loss("accelerometer_range", "accelerometer_loss_limit"),
        "figure_6": lambda: spread("accelerometer_range"),
        "figure_7": lambda: speed("gyro_range"),
        "figure_9": lambda: over_loss("gyro_range", "gyro_loss_limit"),
        "figure_10": lambda: spread("gyro_range"),
        "figure_11": lambda: spread("downsampling"),
        "figure_12": lambda: spread("decimation"),
        "figure_residuals": lambda: figures.figure_residuals(
            pd.read_parquet(models / "residuals.parquet"), TITLES
        ),
    }
    with figure_style():
        save_figure(
            draw[arguments.figure](),
            arguments.output.with_suffix(""),
            simulated=arguments.simulated,
        )


if __name__ == "__main__":
    run_script(main)
