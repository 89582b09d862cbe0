"""The page of the validation on public real recordings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pandas as pd

from swaystride.findings import FINDING_COLUMNS
from swaystride.report.assemble import study_content
from swaystride.report.page_text import load_page_text
from swaystride.report.study_page import render_study_page


def render_validation_page(
    text_file: Path | str,
    results_dir: Path | str,
    available: Sequence[str],
    skipped: Sequence[str],
) -> str:
    """HTML of the validation page: tables and figures of each data set at hand.

    Parameters
    ----------
    text_file : path or str
        Words of the page; the files of a data set lie in the folder of its name.
    results_dir : path or str
        Folder with one subfolder per data set.
    available, skipped : sequence of str
        Data sets that were at hand, and those that were not.
    """
    text = load_page_text(text_file)
    items = tuple(item for item in text.items if item.file.split("/")[0] in available)
    notes = tuple(f"Skipped, because the recordings are not at hand: {name}." for name in skipped)
    content = study_content(
        replace(text, items=items, notes=(*text.notes, *notes)),
        slug="validation",
        cohort="public recordings",
        variant="recommended",
        scale="as recorded",
        simulated=False,
        flow=(),
        findings=pd.DataFrame(columns=list(FINDING_COLUMNS)),
        parameters=(),
        results_dir=results_dir,
        printed_dir="data/published",
        command="make validation",
    )
    return render_study_page(content)
