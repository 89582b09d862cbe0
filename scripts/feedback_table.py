"""Write one result table of the feedback study, in all renderings."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.studies.feedback.claims import claims_table
from swaystride.studies.feedback.design import read_design
from swaystride.studies.feedback.model_results import collect
from swaystride.studies.feedback.plan import ModelPlan
from swaystride.studies.feedback.table_styles import TABLE_STYLES
from swaystride.studies.feedback.tables import (
    coverage_of_print,
    table_2_1,
    table_2_2,
    table_2_3,
    table_2_3_searched,
    table_2_4,
)


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--table", choices=sorted(set(TABLE_STYLES) - {"truth"}), required=True)
    parser.add_argument("--raw", type=Path, required=True)
    parser.add_argument("--models", type=Path, required=True)
    parser.add_argument("--printed", type=Path, required=True)
    parser.add_argument("--text", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--simulated", action="store_true")
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    plan = from_mapping(ModelPlan, arguments.parameters["model"], place="analysis.model")

    def contrasts() -> pd.DataFrame:
        return collect(arguments.models, "contrasts")

    def printed() -> pd.DataFrame:
        return pd.read_csv(arguments.printed)

    build = {
        "table_2_1": lambda: table_2_1(read_design(arguments.raw)[0]),
        "table_2_2": lambda: table_2_2(
            collect(arguments.models, "fixed_effects"), plan.significance_level
        ),
        "table_2_3": lambda: table_2_3(contrasts(), printed(), plan.last_training_trial),
        "coverage": lambda: coverage_of_print(
            table_2_3(contrasts(), printed(), plan.last_training_trial), printed()
        ),
        "table_2_3_searched": lambda: table_2_3_searched(contrasts(), printed()),
        "table_2_4": lambda: table_2_4(contrasts(), printed(), pd.read_csv(arguments.text)),
        "claims": lambda: claims_table(contrasts(), plan.significance_level),
    }
    TABLE_STYLES[arguments.table].write(
        build[arguments.table](),
        arguments.output,
        simulated=arguments.simulated,
    )


if __name__ == "__main__":
    run_script(main)
