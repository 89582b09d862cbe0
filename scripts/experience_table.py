"""Write one result table of the experience study, in all renderings."""

import json
from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.studies.experience import run_tables, tables
from swaystride.studies.experience.claims import claims_table
from swaystride.studies.experience.design import read_design
from swaystride.studies.experience.evidence import collect_evidence
from swaystride.studies.experience.table_inputs import StageTables
from swaystride.studies.experience.table_options import table_options
from swaystride.studies.experience.table_styles import TABLE_STYLES
from swaystride.studies.experience.text_table import study5_text


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--table", required=True)
    parser.add_argument("--raw", type=Path, required=True)
    parser.add_argument("--runs", nargs="+", required=True)
    parser.add_argument("--cohort-results", type=Path, required=True)
    parser.add_argument("--measured", type=Path, required=True, help="tables of single runs")
    parser.add_argument("--models", type=Path, required=True, help="observations and models")
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--simulated", action="store_true")
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    given, name = arguments.parameters, arguments.table
    options = table_options(given["tables"], given["model"]["cutoffs"])
    stages = StageTables(
        arguments.cohort_results, arguments.models, arguments.runs, arguments.measured
    )

    def design():
        return read_design(arguments.raw)

    def associations(group):
        return tables.association_table(
            stages.joined("models/associations"), group, options.significance_level
        )

    def truth():
        if not arguments.simulated:
            return None
        rows = []
        for run in arguments.runs:
            file = arguments.raw / "truth" / f"{run}.json"
            known = json.loads(file.read_text(encoding="utf-8"))
            duty_factor = known["measures"]["duty_factor"]
            rows.append({"run": run, "duty_factor": duty_factor, "pattern": known["pattern"]})
        return pd.DataFrame(rows)

    build = {
        "table_5_1": lambda: tables.table_5_1(design().participants),
        "table_5_2": tables.table_5_2,
        "table_5_3": lambda: associations("all"),
        "table_5_4": lambda: associations("aerial"),
        "study5_text": lambda: study5_text(
            design().runs,
            *(
                stages.joined(table)
                for table in ("observations/runs", "answers/affect", "answers/scores")
            ),
            options,
        ),
        "cohort": lambda: tables.cohort_table(design().participants, design().runs),
        "runs": lambda: run_tables.runs_table(
            *(
                stages.joined(table)
                for table in ("observations/runs", "observations/windows", "answers/scores")
            ),
            stages.checks(),
        ),
        "within_runs": lambda: run_tables.within_runs_table(stages.joined("models/within_runs")),
        "classes": lambda: run_tables.classes_table(stages.joined("observations/runs"), truth()),
        "claims": lambda: claims_table(collect_evidence(stages, design().runs, options)),
    }
    TABLE_STYLES[name].write(
        build[name](),
        arguments.output,
        simulated=arguments.simulated,
    )


if __name__ == "__main__":
    run_script(main)
