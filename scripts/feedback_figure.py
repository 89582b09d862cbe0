"""Draw one figure of the feedback study."""

from pathlib import Path

import numpy as np
import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.presentation.figure_style import figure_style, save_figure
from swaystride.studies.feedback import figures
from swaystride.studies.feedback.model_results import collect
from swaystride.studies.feedback.plan import ModelPlan


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--figure", required=True)
    parser.add_argument("--models", type=Path, required=True)
    parser.add_argument("--recordings", type=Path, required=True)
    parser.add_argument("--effects", type=Path, required=True)
    parser.add_argument("--printed", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--simulated", action="store_true")
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    plan = from_mapping(ModelPlan, arguments.parameters["model"], place="analysis.model")
    observed = pd.read_parquet(arguments.models / "observations.parquet")
    exemplar = observed["participant"].iloc[0]
    own = observed[observed["participant"] == exemplar]

    def displays() -> figures.Figure:
        # only this figure reads signals, and what filters them takes longest to load
        from swaystride.recording import load_recording
        from swaystride.sway.trial_measures import MeasurementMethod, filtered_sway

        method = from_mapping(
            MeasurementMethod, arguments.parameters["measurement"], place="analysis.measurement"
        )
        file = arguments.recordings / f"{exemplar}.nc"
        concurrent, terminal = (
            np.stack(filtered_sway(load_recording(file, trial), method))
            for trial in figures.display_trials(own)
        )
        # the middle of the trial
        return figures.figure_feedback_displays(
            concurrent, terminal, instant=concurrent.shape[1] // 2
        )

    def predicted() -> figures.Figure:
        table = collect(arguments.models, "predictions")
        chosen = table[(table["feature"] == "phi_rms") & (table["participant"] == exemplar)]
        return figures.figure_exemplar_predicted(
            chosen.merge(own, on=["participant", "trial"]), plan.confidence_level
        )

    draw = {
        "figure_2_1": displays,
        "figure_2_2": lambda: figures.figure_trial_structure(observed),
        "figure_2_3a": lambda: figures.figure_exemplar_measured(own),
        "figure_2_3b": predicted,
        "figure_effects": lambda: figures.figure_effects(
            pd.read_csv(arguments.effects), pd.read_csv(arguments.printed)
        ),
        "figure_residuals": lambda: figures.figure_residuals(
            collect(arguments.models, "predictions")
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
