"""Lay the simulated runner over real ones; our angles, events and variability over others' own."""

from pathlib import Path

from swaystride.command_line import run_script, script_parser
from swaystride.presentation.figure_style import figure_style, save_figure
from swaystride.validation.running_body import compare_runners
from swaystride.validation.running_checks import joint_table, runner_checks, timing_table
from swaystride.validation.running_figures import figure_feet, figure_joints
from swaystride.validation.running_measure_checks import measure_report
from swaystride.validation.running_optical_checks import optical_report
from swaystride.validation.running_real import FULL_BODY, MARKERS
from swaystride.validation.summary import summary_frame


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--dataset", choices=(MARKERS, FULL_BODY), required=True)
    parser.add_argument("--real-data", type=Path, required=True)
    parser.add_argument("--checks", type=Path, required=True, help="the rest goes beside it")
    arguments = parser.parse_args()
    comparison = compare_runners(arguments.real_data, arguments.dataset)
    makers = (optical_report, measure_report) if arguments.dataset == MARKERS else ()
    reports = [make(arguments.real_data) for make in makers]
    folder = arguments.checks.parent
    # Real and simulated curves share the figures, and the legend says which is which.
    with figure_style():
        save_figure(figure_joints(comparison), folder / "joints", simulated=False)
        save_figure(figure_feet(comparison), folder / "feet", simulated=False)
        for report in reports:
            for name, draw in report.figures.items():
                save_figure(draw(), folder / name, simulated=False)
    found = [check for report in reports for check in report.checks]
    summary = summary_frame(runner_checks(comparison) + found)
    tables = {
        "checks": summary,
        "trials": timing_table(comparison),
        "joints": joint_table(comparison),
    }
    for report in reports:
        tables |= report.tables
    for name, table in tables.items():
        path = folder / f"{name}.csv"
        table.to_csv(path, index=False, float_format="%.12g", lineterminator="\n")
    counts = summary["within"].value_counts()
    print(f"{arguments.dataset}: " + ", ".join(f"{n} {name}" for name, n in counts.items()))


if __name__ == "__main__":
    run_script(main)
