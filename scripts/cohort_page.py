"""Render the page of a cohort: all its studies in one file."""

from pathlib import Path

from swaystride.command_line import run_script, script_parser
from swaystride.report.cohort_page import render_cohort_page
from swaystride.report.results_on_disk import PageSource, load_study_content


def main() -> None:
    """Parse names, call the library, write the page."""
    parser = script_parser(__doc__)
    parser.add_argument("--cohort", required=True)
    parser.add_argument("--variant", required=True)
    parser.add_argument("--scale", required=True)
    parser.add_argument("--simulated", action="store_true")
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("studies", nargs="+")
    arguments = parser.parse_args()
    contents = [
        load_study_content(
            PageSource(
                study,
                arguments.cohort,
                arguments.variant,
                arguments.scale,
                arguments.simulated,
            )
        )
        for study in arguments.studies
    ]
    arguments.output.write_text(render_cohort_page(contents), encoding="utf-8", newline="")


if __name__ == "__main__":
    run_script(main)
