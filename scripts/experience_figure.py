"""Draw one figure of the experience study."""

from pathlib import Path

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.gait.rating_windows import WindowRule
from swaystride.presentation.figure_style import figure_style, save_figure
from swaystride.studies.experience import exemplars, rating_figures, series_figures, summary_figure
from swaystride.studies.experience.claims import GROUPS
from swaystride.studies.experience.table_inputs import StageTables
from swaystride.studies.experience.table_options import table_options
from swaystride.studies.experience.tables import association_table
from swaystride.studies.experience.truth_figure import figure_truth


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--figure", required=True)
    parser.add_argument("--runs", nargs="+", required=True)
    parser.add_argument("--cohort-results", type=Path, required=True)
    parser.add_argument("--measured", type=Path, required=True, help="tables of single runs")
    parser.add_argument("--models", type=Path, required=True, help="observations and models")
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--simulated", action="store_true")
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    given = arguments.parameters
    options = table_options(given["tables"], given["model"]["cutoffs"])
    lengths = {name: given["windows"][name] for name in ("length_s", "step_s")}
    windows = from_mapping(WindowRule, lengths, place="analysis.windows")
    stages = StageTables(
        arguments.cohort_results, arguments.models, arguments.runs, arguments.measured
    )

    def of_run(table, run):
        joined = stages.joined(table)
        return joined[joined["run"] == run]

    def duty_factors():
        strides = {run: stages.of_run("strides", run) for run in arguments.runs}
        strides = {run: table for run, table in strides.items() if len(table)}
        chosen = exemplars.four_runs(strides)
        return series_figures.figure_5_2({run: strides[run] for run in chosen})

    def sliding_windows():
        measured = list(dict.fromkeys(stages.joined("observations/windows")["run"]))
        if not measured:
            return series_figures.empty_figure("no run was measured")
        run = exemplars.most_rated_run(stages.joined("answers/affect"), measured)
        return series_figures.figure_5_3(
            run,
            stages.of_run("strides", run),
            of_run("observations/windows", run),
            of_run("answers/affect", run),
            windows,
        )

    def confounded():
        result = exemplars.confounded_run(stages.joined("models/within_runs"))
        if result is None:
            return series_figures.empty_figure("no run with ratings that vary")
        run = str(result["run"])
        return series_figures.figure_5_9(
            run,
            of_run("observations/windows", run),
            of_run("answers/affect", run),
            stages.of_run("strides", run),
            result,
        )

    def associations():
        rows = stages.joined("models/associations")
        return {
            group: association_table(rows, group, options.significance_level) for group in GROUPS
        }

    draw = {
        "figure_5_2": duty_factors,
        "figure_5_3": sliding_windows,
        "figure_5_4": lambda: rating_figures.figure_5_4(
            stages.joined("answers/affect"), stages.checks()
        ),
        "figure_5_5": lambda: rating_figures.figure_5_5(stages.joined("answers/affect")),
        "figure_5_6": lambda: rating_figures.figure_5_6(stages.joined("answers/scores")),
        "figure_5_7": lambda: summary_figure.figure_5_7(associations()),
        "figure_5_8": lambda: summary_figure.figure_5_8(stages.joined("models/within_runs")),
        "figure_5_9": confounded,
        "figure_truth": lambda: figure_truth(stages.of_runs("truth"), options.limits),
    }
    with figure_style():
        save_figure(
            draw[arguments.figure](),
            arguments.output.with_suffix(""),
            simulated=arguments.simulated,
        )


if __name__ == "__main__":
    run_script(main)
