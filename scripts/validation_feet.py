"""Validate foot trajectories on one public data set: checks, strides, tables, figures."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

from swaystride.command_line import run_script, script_parser
from swaystride.presentation.figure_style import figure_style, save_figure
from swaystride.validation import foot_imu_mocap_walk, foot_imu_vicon
from swaystride.validation.foot_checks import mocap_checks, vicon_checks
from swaystride.validation.foot_errors import comparison_table, trial_table
from swaystride.validation.foot_figures import figure_errors, figure_sheet, figure_trial
from swaystride.validation.foot_method_choice import choice_checks
from swaystride.validation.foot_peers import peer_lengths
from swaystride.validation.foot_recording import FootRecording
from swaystride.validation.foot_strides import FootTrial, all_strides, foot_trial
from swaystride.validation.summary import Check, summary_frame

DATASETS: Final = (foot_imu_vicon.DATASET, foot_imu_mocap_walk.DATASET)
GAITS: Final = ("run", "walk", "other")


def recordings(dataset: str, folder: Path) -> list[FootRecording]:
    """Recordings of a data set."""
    if dataset == foot_imu_vicon.DATASET:
        return foot_imu_vicon.vicon_recordings(folder)
    return foot_imu_mocap_walk.mocap_recordings(folder)


def checks(dataset: str, trials: list[FootTrial], folder: Path) -> list[Check]:
    """Verdicts on a data set."""
    if dataset == foot_imu_vicon.DATASET:
        chosen = choice_checks(dataset, [one.recording for one in trials])
        return vicon_checks(trials, folder) + chosen
    return mocap_checks(trials)


def by_gait(trials: list[FootTrial]) -> Mapping[str, list[FootTrial]]:
    """Trials of each gait that occurs."""
    split = {gait: [one for one in trials if one.recording.gait == gait] for gait in GAITS}
    return {gait: chosen for gait, chosen in split.items() if chosen}


def draw(trials: list[FootTrial], folder: Path) -> None:
    """Summary, one sheet per gait, and one figure per trial."""
    with figure_style():
        save_figure(figure_errors(all_strides(trials)), folder / "figure", simulated=False)
        for gait, chosen in by_gait(trials).items():
            save_figure(figure_sheet(chosen), folder / f"trials_{gait}", simulated=False)
        for one in trials:
            stem = folder / "trial_figures" / one.recording.trial
            save_figure(figure_trial(one), stem, simulated=False)


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--dataset", choices=DATASETS, required=True)
    parser.add_argument("--real-data", type=Path, required=True)
    parser.add_argument("--gaitmap", type=Path, help="table by scripts/peers_gaitmap.py, if any")
    parser.add_argument("--checks", type=Path, required=True, help="the rest goes beside it")
    arguments = parser.parse_args()
    found = recordings(arguments.dataset, arguments.real_data)
    theirs = peer_lengths(arguments.gaitmap, found)
    trials = [foot_trial(recording, theirs) for recording in found]
    draw(trials, arguments.checks.parent)
    strides = all_strides(trials)
    summary = summary_frame(checks(arguments.dataset, trials, arguments.real_data))
    for name, table in {
        "checks": summary,
        "trials": strides,
        "comparison": comparison_table(strides, list(by_gait(trials))),
        "by_trial": trial_table(trials),
    }.items():
        path = arguments.checks.parent / f"{name}.csv"
        table.to_csv(path, index=False, float_format="%.12g", lineterminator="\n")
    counts = summary["within"].value_counts()
    print(f"{arguments.dataset}: " + ", ".join(f"{n} {name}" for name, n in counts.items()))


if __name__ == "__main__":
    run_script(main)
