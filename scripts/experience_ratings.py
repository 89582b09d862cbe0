"""Draw the ratings of a simulated cohort from the true measures of its runs."""

from pathlib import Path

import numpy as np
import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.presentation.table_files import read_table
from swaystride.simulate.experience_parameters import cohort_from_config
from swaystride.simulate.experience_population import attainable_population, distance
from swaystride.simulate.experience_rated_runs import as_tabled, rated_runs, true_run_measures
from swaystride.simulate.experience_rating_parameters import ratings_from_config
from swaystride.simulate.experience_rating_truth import (
    RatingTruth,
    printed_associations,
    write_answers,
    write_truth,
)
from swaystride.simulate.experience_ratings import draw_ratings, run_scores
from swaystride.studies.experience.plan import MEASURE_KEYS, MEASURES, QUESTIONNAIRES


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--printed", type=Path, required=True)
    parser.add_argument("--folder", type=Path, required=True)
    arguments = parser.parse_args()
    section = arguments.parameters["simulation"]
    cohort, model = cohort_from_config(section), ratings_from_config(section["ratings"])
    runs, truth_folder = rated_runs(cohort), arguments.folder / "truth"
    measures = as_tabled(true_run_measures(truth_folder, runs.names, MEASURE_KEYS), cohort)
    printed = printed_associations(
        read_table(arguments.printed / "table_5_3.csv"),
        read_table(arguments.printed / "study5_text.csv"),
        {measure.name: measure.key for measure in MEASURES},
        model.association.reversed_measures,
    )
    population = attainable_population(measures.to_numpy(), printed, model.association)
    truth = RatingTruth(runs, MEASURE_KEYS, population, printed.between_scales)
    ratings = draw_ratings(
        model,
        runs,
        population.signal,
        population.residual,
        seed=arguments.seed,
        cohort="ratings",
    )
    null = draw_ratings(
        model,
        runs,
        np.zeros_like(population.signal),
        printed.between_scales,
        seed=arguments.seed,
        cohort="null",
    )
    write_answers(arguments.folder, runs, ratings, tuple(QUESTIONNAIRES))
    write_truth(truth_folder / "population.json", truth, printed, ratings)
    scores: pd.DataFrame = run_scores(null, runs, start_s=runs.settled_s, mean="time_weighted")
    scores.to_parquet(truth_folder / "null.parquet", index=False)
    away = distance(population.correlation, printed)
    print(
        f"{len(runs.names)} runs rated; attainable correlations {away.rms:.3f} from the printed "
        f"ones (RMS; {away.rms_standard_errors:.2f} standard errors), at most "
        f"{away.largest_significant:.2f} in significant rows"
    )


if __name__ == "__main__":
    run_script(main)
