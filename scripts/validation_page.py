"""Join the checks of all public data sets, say what was skipped, and render the page."""

from pathlib import Path

import pandas as pd

from swaystride.command_line import run_script, script_parser
from swaystride.report.validation_page import render_validation_page
from swaystride.validation.summary import SUMMARY_COLUMNS


def main() -> None:
    """Parse names, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--available", nargs="*", default=[])
    parser.add_argument("--skipped", nargs="*", default=[])
    parser.add_argument("--summary", type=Path, required=True)
    parser.add_argument("--page", type=Path, required=True)
    arguments = parser.parse_args()
    folder = Path("results/validation")
    checks = [pd.read_csv(folder / name / "checks.csv") for name in arguments.available]
    summary = pd.concat([pd.DataFrame(columns=list(SUMMARY_COLUMNS)), *checks], ignore_index=True)
    summary.to_csv(arguments.summary, index=False, float_format="%.12g", lineterminator="\n")
    page = render_validation_page(
        "workflow/report/validation.yaml", folder, arguments.available, arguments.skipped
    )
    arguments.page.write_text(page, encoding="utf-8", newline="")
    for name in arguments.skipped:
        print(f"skipped {name}: not in the folder with real recordings (SWAYSTRIDE_REAL_DATA)")
    counts = summary["within"].value_counts()
    print("validation: " + (", ".join(f"{n} {k}" for k, n in counts.items()) or "nothing to do"))


if __name__ == "__main__":
    run_script(main)
