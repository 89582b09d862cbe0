"""Write one result table of the intensity study, in all renderings."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.studies.intensity import tables
from swaystride.studies.intensity.claims import claims_table
from swaystride.studies.intensity.design import read_design
from swaystride.studies.intensity.model_files import all_results, model_table
from swaystride.studies.intensity.plan import IntensityPlan
from swaystride.studies.intensity.table_styles import TABLE_STYLES

#: Tables with printed values.
PRINTED = ("table_3_2", "table_3_3", "study3_text")


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--table", choices=sorted(set(TABLE_STYLES) - {"truth"}), required=True)
    parser.add_argument("--raw", type=Path, required=True)
    parser.add_argument("--models", type=Path, required=True)
    parser.add_argument("--printed", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--simulated", action="store_true")
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    plan = from_mapping(IntensityPlan, arguments.parameters["model"], place="analysis.model")

    folder = arguments.models

    def predictions() -> pd.DataFrame:
        parts = [("self_ratings", "predictions"), ("kinematics", "left_out")]
        return pd.concat([model_table(folder, *part) for part in parts], ignore_index=True)

    def coverage() -> pd.DataFrame:
        found = all_results(folder)
        ours = {name: getattr(tables, name)(found) for name in PRINTED}
        printed = {name: pd.read_csv(arguments.printed / f"{name}.csv") for name in PRINTED}
        return tables.coverage_table(ours, printed)

    build = {
        "table_3_1": tables.table_3_1,
        "table_3_2": lambda: tables.table_3_2(model_table(folder, "difficulty", "results")),
        "table_3_3": lambda: tables.table_3_3(model_table(folder, "kinematics", "correlations")),
        "study3_text": lambda: tables.study3_text(all_results(folder)),
        "cohort": lambda: tables.cohort_table(read_design(arguments.raw)),
        "rating_counts": lambda: tables.rating_counts(read_design(arguments.raw)),
        "variance_components": lambda: model_table(folder, "reliability", "components"),
        "prediction": predictions,
        "dropped_features": lambda: model_table(folder, "kinematics", "dropped"),
        "coverage": coverage,
        "claims": lambda: claims_table(all_results(folder), plan.significance_level),
    }
    TABLE_STYLES[arguments.table].write(
        build[arguments.table](),
        arguments.output,
        simulated=arguments.simulated,
    )


if __name__ == "__main__":
    run_script(main)
