"""Write the table of the effects of a simulated cohort beside their truth."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.studies.feedback.design import model_variables, read_design
from swaystride.studies.feedback.model_results import collect
from swaystride.studies.feedback.plan import ModelPlan
from swaystride.studies.feedback.table_styles import TABLE_STYLES
from swaystride.studies.feedback.tables import table_truth
from swaystride.studies.feedback.truth import true_effects


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--raw", type=Path, required=True)
    parser.add_argument("--models", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    plan = from_mapping(ModelPlan, arguments.parameters["model"], place="analysis.model")
    variables = model_variables(
        *read_design(arguments.raw), trial_number_coding=plan.trial_number_coding
    )
    keys = ["participant", "session_trial"]
    expected = pd.read_csv(arguments.raw / "truth" / "expected.tsv", sep="\t")
    expected = variables[keys].merge(expected, on=keys, how="left", validate="one_to_one")
    ratios = pd.read_csv(arguments.raw / "truth" / "variance_ratios.tsv", sep="\t")
    weights = dict(zip(ratios["feature"], ratios["variance_ratio"], strict=True))
    truth = true_effects(variables, expected, plan, weights)
    TABLE_STYLES["truth"].write(
        table_truth(collect(arguments.models, "contrasts"), truth),
        arguments.output,
        simulated=True,
    )


if __name__ == "__main__":
    run_script(main)
