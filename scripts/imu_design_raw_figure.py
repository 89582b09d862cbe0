"""Draw what truncation takes from a walking and a running trial of the IMU-design study."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.presentation.figure_style import figure_style, save_figure
from swaystride.studies.imu_design.experiments import ExperimentName, ExperimentSettings
from swaystride.studies.imu_design.observations import sample_trials
from swaystride.studies.imu_design.plan import ImuDesignPlan
from swaystride.studies.imu_design.raw_figures import SampleTrial, figure_truncated
from swaystride.studies.imu_design.signals_file import load_signals
from swaystride.studies.imu_design.stance import stance_intervals

EXPERIMENTS: dict[str, ExperimentName] = {
    "figure_4": "accelerometer_range",
    "figure_8": "gyro_range",
}


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--figure", choices=sorted(EXPERIMENTS), required=True)
    parser.add_argument("--observations", type=Path, required=True)
    parser.add_argument("--strides", type=Path, required=True)
    parser.add_argument("--recordings", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--simulated", action="store_true")
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    given = arguments.parameters
    plan = from_mapping(ImuDesignPlan, given["model"], place="analysis.model")
    settings = from_mapping(ExperimentSettings, given["experiments"], place="analysis.experiments")
    observations = pd.read_parquet(arguments.observations)
    samples = [
        sample(row, arguments.recordings, arguments.strides)
        for row in sample_trials(observations, plan).to_dict("records")
    ]
    with figure_style():
        save_figure(
            figure_truncated(samples, EXPERIMENTS[arguments.figure], settings),
            arguments.output.with_suffix(""),
            simulated=arguments.simulated,
        )


def sample(row: dict[str, object], recordings: Path, strides: Path) -> SampleTrial:
    """One example trial: the right foot, as in the paper, or the left where there is no other."""
    participant, trial = row["participant"], row["trial"]
    table = pd.read_parquet(strides / f"{participant}.parquet")
    own = table[(table["trial"] == trial) & (table["imu"] == "imu_1")]
    foot = "right" if (own["foot"] == "right").any() else "left"
    own = own[own["foot"] == foot].reset_index(drop=True)
    file = recordings / f"{participant}.nc"
    signals, _ = load_signals(file, f"trial_{trial}_{foot}_imu_1")
    letter, gait = ("a", "Walking") if row["gait"] == "walking" else ("b", "Running")
    title = f"{letter}  {gait}, {row['speed_m_s']:.1f} m/s"
    return SampleTrial(title, signals, own, stance_intervals(signals, own))


if __name__ == "__main__":
    run_script(main)
