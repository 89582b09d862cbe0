"""The page of one study, one cohort and one variant."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from swaystride.report.content import StudyContent
from swaystride.report.page import Page, render_page


def render_study_page(content: StudyContent, *, provenance: Mapping[str, Any] | None = None) -> str:
    """One self-contained HTML file.

    Parameters
    ----------
    content : StudyContent
        What the page shows.
    provenance : mapping, optional
        What :func:`swaystride.report.provenance.collect_provenance` returned.

    Returns
    -------
    str
        The file; the same content gives the same bytes.

    Examples
    --------
    >>> import pandas as pd
    >>> from swaystride.findings import FINDING_COLUMNS
    >>> content = StudyContent(
    ...     slug="balance", title="Balance", source="chapter 2", question="Does it work?",
    ...     cohort="synthetic", variant="printed", scale="demo", simulated=True, design=(),
    ...     flow=(), findings=pd.DataFrame(columns=FINDING_COLUMNS), items=(), parameters=())
    >>> html = render_study_page(content)
    >>> "Simulated cohort: not measurements." in html, "<script" in html
    (True, False)
    """
    return render_page(
        Page(
            title=content.title,
            kicker="Study report",
            cohort=content.cohort,
            simulated=content.simulated,
            studies=(content,),
            several=False,
            provenance=provenance,
        )
    )
