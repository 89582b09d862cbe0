"""Fit the models of one feature: printed, and searched (exponent and terms)."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.studies.feedback.models import analyse_feature
from swaystride.studies.feedback.plan import FEATURES, ModelPlan


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--observations", type=Path, required=True)
    parser.add_argument("--feature", choices=list(FEATURES), required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--folder", type=Path, required=True)
    arguments = parser.parse_args()
    plan = from_mapping(ModelPlan, arguments.parameters["model"], place="analysis.model")
    frame = pd.read_parquet(arguments.observations)
    analysis = analyse_feature(frame, arguments.feature, plan)
    for name, table in analysis.items():
        table.to_parquet(arguments.folder / f"{name}.parquet", index=False)
    searched = analysis["fixed_effects"].query("model == 'searched'")
    print(
        f"{arguments.feature}: searched exponent {searched['exponent'].iloc[0]:g}, "
        f"{len(searched) - 1} terms"
    )


if __name__ == "__main__":
    run_script(main)
