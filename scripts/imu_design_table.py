"""Write one result table of the IMU-design study, in all renderings."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.studies.imu_design import tables
from swaystride.studies.imu_design.claims import claims_table
from swaystride.studies.imu_design.design import read_design
from swaystride.studies.imu_design.plan import TABLES, ImuDesignPlan
from swaystride.studies.imu_design.recommendation import recommendation_table
from swaystride.studies.imu_design.requirements import requirements
from swaystride.studies.imu_design.sensors import sensor_specifications
from swaystride.studies.imu_design.table_styles import TABLE_STYLES


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--table", choices=sorted(set(TABLE_STYLES) - {"truth"}), required=True)
    parser.add_argument("--raw", type=Path, required=True)
    parser.add_argument("--ranges", type=Path, nargs="+", required=True)
    parser.add_argument("--models", type=Path, required=True)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--simulated", action="store_true")
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    given = arguments.parameters
    plan = from_mapping(ImuDesignPlan, given["model"], place="analysis.model")

    def model(name: str) -> pd.DataFrame:
        return pd.read_parquet(arguments.models / f"{name}.parquet")

    def needs() -> pd.DataFrame:
        return requirements(model("observations"), model("effects"), plan)

    def specifications() -> pd.DataFrame:
        files = [pd.read_csv(path, dtype={"trial": str}) for path in arguments.ranges]
        sensors = sensor_specifications(given["sensors"])
        return tables.table_1(pd.concat(files, ignore_index=True), sensors)

    experiments = {table: experiment for experiment, table in TABLES.items()}
    build = {
        "table_1": specifications,
        **{
            table: lambda name=name: tables.effect_table(model("effects"), name, plan.model)
            for table, name in experiments.items()
        },
        "imu_design_text": lambda: tables.imu_design_text(model("observations"), needs(), plan),
        "model_comparison": lambda: tables.model_comparison(model("effects")),
        "variance_components": lambda: model("components"),
        "requirements": needs,
        "recommendation": lambda: recommendation_table(
            needs(), float(model("observations")["speed_m_s"].max()), plan
        ),
        "cohort": lambda: tables.cohort_table(read_design(arguments.raw)),
        "speeds": lambda: tables.speed_table(model("observations")),
        "claims": lambda: claims_table(model("observations"), model("effects"), plan),
    }
    TABLE_STYLES[arguments.table].write(
        build[arguments.table](), arguments.output, simulated=arguments.simulated
    )


if __name__ == "__main__":
    run_script(main)
