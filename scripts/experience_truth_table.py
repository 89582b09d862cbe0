"""Write one table that only a simulated cohort can have: errors, attainable correlations, chance."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.presentation.table_files import read_table
from swaystride.studies.experience import chance_tables, truth_tables
from swaystride.studies.experience.population_truth import null_associations, read_population
from swaystride.studies.experience.table_inputs import StageTables
from swaystride.studies.experience.table_options import table_options
from swaystride.studies.experience.table_styles import TABLE_STYLES
from swaystride.studies.experience.tables import GROUP_TABLES


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--table", required=True)
    parser.add_argument("--truth", type=Path, required=True, help="folder of the truth")
    parser.add_argument("--runs", nargs="+", required=True)
    parser.add_argument("--cohort-results", type=Path, required=True)
    parser.add_argument("--measured", type=Path, required=True, help="tables of single runs")
    parser.add_argument("--models", type=Path, required=True, help="observations and models")
    parser.add_argument("--published", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    given = arguments.parameters
    options = table_options(given["tables"], given["model"]["cutoffs"])
    stages = StageTables(
        arguments.cohort_results, arguments.models, arguments.runs, arguments.measured
    )

    def attainable():
        return chance_tables.attainable_table(
            read_population(arguments.truth / "population.json"),
            stages.joined("models/associations"),
            options.significance_level,
        )

    def null_cohort():
        scores = pd.read_parquet(arguments.truth / "null.parquet")
        printed = {
            group: read_table(arguments.published / f"{table}.csv")
            for group, table in GROUP_TABLES.items()
        }
        return chance_tables.null_cohort_table(
            stages.joined("models/associations"),
            null_associations(stages.joined("observations/runs"), scores, given["model"]["level"]),
            chance_tables.printed_associations(printed),
            options.significance_level,
        )

    build = {
        "truth_errors": lambda: truth_tables.truth_errors(stages.of_runs("truth"), options.limits),
        "truth_summary": lambda: truth_tables.truth_summary(
            stages.of_runs("truth"), options.limits
        ),
        "attainable": attainable,
        "null_cohort": null_cohort,
    }
    TABLE_STYLES[arguments.table].write(build[arguments.table](), arguments.output, simulated=True)


if __name__ == "__main__":
    run_script(main)
