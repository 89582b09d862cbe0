"""Render the page of one study, cohort and variant."""

from pathlib import Path

from swaystride.command_line import run_script, script_parser
from swaystride.report.results_on_disk import PageSource, load_study_content
from swaystride.report.study_page import render_study_page


def main() -> None:
    """Parse names, call the library, write the page."""
    parser = script_parser(__doc__)
    for name in ("study", "cohort", "variant", "scale"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--simulated", action="store_true")
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    source = PageSource(
        arguments.study,
        arguments.cohort,
        arguments.variant,
        arguments.scale,
        arguments.simulated,
    )
    page = render_study_page(load_study_content(source))
    arguments.output.write_text(page, encoding="utf-8", newline="")


if __name__ == "__main__":
    run_script(main)
