"""Write one result table of the kinematics study, in all renderings."""

from pathlib import Path

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.erkf.noise import WALKING
from swaystride.presentation.table_files import read_table
from swaystride.studies.kinematics import tables
from swaystride.studies.kinematics.claims import claims_table
from swaystride.studies.kinematics.design import read_design
from swaystride.studies.kinematics.evidence import collect_evidence
from swaystride.studies.kinematics.literature_tables import read_literature, table_4_9, table_4_10
from swaystride.studies.kinematics.range_tests import table_4_4
from swaystride.studies.kinematics.table_inputs import StageTables, planned_trials
from swaystride.studies.kinematics.table_options import TableOptions
from swaystride.studies.kinematics.table_styles import TABLE_STYLES
from swaystride.studies.kinematics.text_table import study4_text

#: Most of their rows are literature: where a row comes from stands in the row.
LITERATURE = {"table_4_9": table_4_9, "table_4_10": table_4_10}


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--table", required=True)
    parser.add_argument("--raw", type=Path, required=True)
    parser.add_argument("--participants", nargs="+", required=True)
    parser.add_argument("--results", type=Path, required=True)
    parser.add_argument("--published", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--simulated", action="store_true")
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    given, name = arguments.parameters, arguments.table
    options = from_mapping(TableOptions, given["tables"], place="analysis.tables")
    stages = StageTables(arguments.results, arguments.participants)

    def people():
        return read_design(arguments.raw).participants

    def text():
        by_energy = given["erkf"]["zero_velocity"] == "gyroscopic_energy"
        return study4_text(
            planned_trials(read_design(arguments.raw).trials),
            *(stages.read(kind) for kind in ("strides", "agreement", "planar", "course")),
            energy_window_s=given["zero_velocity"]["window_s"] if by_energy else None,
        )

    def literature():
        duration_min = stages.read("course")["duration_s"].median() / 60.0
        printed = read_literature(arguments.published / f"{name}.csv")
        return LITERATURE[name](
            printed, stages.read("agreement"), duration_min, simulated=arguments.simulated
        )

    def published_4_4():
        return read_table(arguments.published / "table_4_4.csv")

    build = {
        "table_4_1": lambda: tables.table_4_1(people()),
        "table_4_2": lambda: tables.table_4_2(given["erkf"]["noise"], WALKING),
        "table_4_3": lambda: tables.table_4_3(stages.read("agreement")),
        "table_4_4": lambda: table_4_4(stages.read("strides"), published_4_4(), options),
        "table_4_5": lambda: tables.table_4_5(stages.read("strides")),
        "table_4_6": lambda: tables.table_4_6(stages.read("strides"), options),
        "table_4_7": lambda: tables.table_4_7(stages.read("strides")),
        "table_4_8": lambda: tables.table_4_8(
            stages.read("perturbation"), stages.read("truth") if arguments.simulated else None
        ),
        **dict.fromkeys(LITERATURE, literature),
        "study4_text": text,
        "cohort": lambda: tables.cohort_table(people()),
        "agreement_by_trial": lambda: tables.agreement_by_trial(stages.read("agreement")),
        "claims": lambda: claims_table(collect_evidence(stages, published_4_4(), options)),
    }
    TABLE_STYLES[name].write(
        build[name](),
        arguments.output,
        simulated=arguments.simulated and name not in LITERATURE,
    )


if __name__ == "__main__":
    run_script(main)
