"""Compute what the printed quantities are in the simulated population of the intensity study."""

from pathlib import Path

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.simulate.intensity_parameters import cohort_from_config
from swaystride.simulate.intensity_population import population_values

#: Patients of the population; the standard error of the ICC is then near .001.
N_PATIENTS = 4000


def main() -> None:
    """Parse paths, call the library, write the file."""
    parser = script_parser(__doc__)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    cohort = cohort_from_config(arguments.parameters["simulation"])
    values = population_values(
        cohort.population, cohort.protocol, n_patients=N_PATIENTS, seed=arguments.seed
    )
    values.to_csv(arguments.output, sep="\t", index=False, float_format="%.9g", lineterminator="\n")
    print(f"{len(values)} quantities of {N_PATIENTS} patients")


if __name__ == "__main__":
    run_script(main)
