"""Draw one figure of the intensity study."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import run_script, script_parser
from swaystride.presentation.figure_style import figure_style, save_figure
from swaystride.studies.intensity import figures


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--figure", required=True)
    parser.add_argument("--results", type=Path, required=True)
    parser.add_argument("--printed", type=Path, required=True)
    parser.add_argument("--simulated", action="store_true")
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()

    def model(name: str) -> pd.DataFrame:
        return pd.read_parquet(arguments.results / "models" / f"{name}.parquet")

    draw = {
        "figure_3_3a": lambda: figures.figure_self_ratings(model("ratings"), "per_trial"),
        "figure_3_3b": lambda: figures.figure_self_ratings(model("ratings"), "per_exercise"),
        "figure_3_4a": lambda: figures.figure_predicted_ratings(
            model("kinematics/predicted"), "per_trial"
        ),
        "figure_3_4b": lambda: figures.figure_predicted_ratings(
            model("kinematics/predicted"), "per_exercise"
        ),
        "figure_difficulty": lambda: figures.figure_difficulty(
            pd.read_csv(arguments.results / "tables" / "table_3_2.csv"),
            pd.read_csv(arguments.printed),
        ),
        "figure_residuals": lambda: figures.figure_residuals(model("difficulty/residuals")),
    }
    with figure_style():
        save_figure(
            draw[arguments.figure](),
            arguments.output.with_suffix(""),
            simulated=arguments.simulated,
        )


if __name__ == "__main__":
    run_script(main)
