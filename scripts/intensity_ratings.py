"""Write the analysed ratings: those of the therapists, with the patient's own beside."""

from pathlib import Path

from swaystride.command_line import run_script, script_parser
from swaystride.studies.intensity.design import read_design
from swaystride.studies.intensity.observations import analysed_ratings


def main() -> None:
    """Parse paths, call the library, write the file."""
    parser = script_parser(__doc__)
    parser.add_argument("--raw", type=Path, required=True)
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    ratings = analysed_ratings(read_design(arguments.raw))
    ratings.to_parquet(arguments.output, index=False)
    counts = ratings["rating_level"].value_counts()
    print(
        f"{counts.get('per_trial', 0)} ratings of trials and {counts.get('per_exercise', 0)} of "
        f"exercises by {ratings['rater'].nunique()} therapists"
    )


if __name__ == "__main__":
    run_script(main)
