"""Draw one figure of the feedback study."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.presentation.figure_style import figure_style, save_figure
from swaystride.recording import list_recordings, load_recording
from swaystride.studies.feedback import figures
from swaystride.studies.feedback.models import collect
from swaystride.studies.feedback.plan import ModelPlan
from swaystride.sway.trial_measures import MeasurementMethod, filtered_sway

#: Instant at which the concurrent display of Figure 2.1 is shown: the middle of a 30 s trial.
DISPLAY_INSTANT_S = 15.0


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
    exemplar = arguments.recordings.stem
    own = observed[observed["participant"] == exemplar]

    def displays() -> figures.Figure:
        method = from_mapping(
            MeasurementMethod, arguments.parameters["measurement"], place="analysis.measurement"
        )
        recording = load_recording(arguments.recordings, list_recordings(arguments.recordings)[0])
        ap_deg, ml_deg = filtered_sway(recording, method)
        return figures.figure_feedback_displays(
            ap_deg, ml_deg, recording.attrs["rate_hz"], instant_s=DISPLAY_INSTANT_S
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
