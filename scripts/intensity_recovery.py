"""Hold many simulated intensity cohorts against the printed numbers and the population."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import run_script, script_parser
from swaystride.presentation.table_files import read_table
from swaystride.studies.intensity.recovery import (
    KNOWN_DEVIATIONS,
    printed_quantities,
    recovery_table,
)


def main() -> None:
    """Parse paths, call the library, write the file."""
    parser = script_parser(__doc__)
    parser.add_argument("--printed", type=Path, required=True)
    parser.add_argument("--population", type=Path, required=True)
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("cohorts", type=Path, nargs="+")
    arguments = parser.parse_args()
    drawn = pd.concat([pd.read_parquet(path) for path in arguments.cohorts], ignore_index=True)
    names = ("table_3_2", "table_3_3", "study3_text")
    printed = printed_quantities(*(read_table(arguments.printed / f"{n}.csv") for n in names))
    population = pd.read_csv(arguments.population, sep="\t").set_index("quantity")["value"]
    for level in ("per_trial", "per_exercise"):
        name = f"study3_text/icc_pt_{level}"
        population[f"{name}_recommended"] = population[name]
    cohorts = [table for _, table in drawn.groupby("seed")]
    table = recovery_table(cohorts, printed, population, KNOWN_DEVIATIONS)
    table.to_csv(arguments.output, index=False, float_format="%.6f", lineterminator="\n")
    counts = table.groupby("check")["within"].value_counts()
    print(f"{len(cohorts)} cohorts")
    for (check, verdict), n in counts.items():
        print(f"  {check}: {n} {verdict}")


if __name__ == "__main__":
    run_script(main)
