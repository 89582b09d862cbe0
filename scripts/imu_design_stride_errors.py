"""Hold the strides of one simulated participant against the truth, by every method of the study."""

from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.gait.foot_methods import FootMethod
from swaystride.recording import list_recordings
from swaystride.simulate.imu_design_truth import FootTruth, read_truth
from swaystride.studies.imu_design.design import read_design, usable_trials
from swaystride.studies.imu_design.metrics import foot_estimate
from swaystride.studies.imu_design.signals_file import load_signals
from swaystride.studies.imu_design.truth import STRIDE_ERROR_COLUMNS, gait_of, true_strides


def main() -> None:
    """Parse paths, call the library, write the file."""
    parser = script_parser(__doc__)
    parser.add_argument("--raw", type=Path, required=True)
    parser.add_argument("--participant", required=True)
    parser.add_argument("--recordings", type=Path, required=True)
    parser.add_argument("--truth", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--methods", type=json_file, nargs="+", required=True)
    parser.add_argument("--variants", nargs="+", required=True)
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    methods = {
        name: from_mapping(FootMethod, given["measurement"], place="analysis.measurement")
        for name, given in zip(arguments.variants, arguments.methods, strict=True)
    }
    sprint_m_s = arguments.parameters["gaits"]["sprint_speed_m_s"]
    truth = read_truth(arguments.truth)
    trials = read_design(arguments.raw).trials
    own = trials[trials["participant"] == arguments.participant]
    tables = []
    for row in usable_trials(own, list_recordings(arguments.recordings)).to_dict("records"):
        foot = truth.foot(row["trial"], row["foot"])
        signals, _ = load_signals(arguments.recordings, row["recording"])
        gait = gait_of(duty_factor(foot), foot.mean_speed_m_s, sprint_m_s)
        for name, method in methods.items():
            strides = foot_estimate(signals, method).strides
            errors = true_strides(strides, partial(foot.sensor_position_m, row["imu"]))
            keys = {key: row[key] for key in ("participant", "trial", "foot", "imu")}
            known = {"method": name, "gait": gait, "speed_m_s": foot.mean_speed_m_s}
            tables.append(errors.assign(**keys, **known))
    joined = pd.concat(tables, ignore_index=True)[list(STRIDE_ERROR_COLUMNS)]
    joined.to_parquet(arguments.output, index=False)
    print(f"{arguments.participant}: {len(joined)} strides against the truth")


def duty_factor(foot: FootTruth) -> float:
    """Median stance over stride, of the strides between two whole stances."""
    contact_s, toe_off_s = foot.contact_s, foot.toe_off_s
    return float(np.median((toe_off_s[1:] - contact_s[:-1]) / np.diff(contact_s)))


if __name__ == "__main__":
    run_script(main)
