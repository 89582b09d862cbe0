"""The page of a cohort: all its studies in one file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from swaystride.errors import DesignError
from swaystride.report.content import StudyContent
from swaystride.report.page import Page, render_page


def render_cohort_page(
    contents: Sequence[StudyContent],
    *,
    title: str | None = None,
    provenance: Mapping[str, Any] | None = None,
) -> str:
    """One self-contained HTML file with a chapter for each study.

    Parameters
    ----------
    contents : sequence of StudyContent
        Studies of one cohort, in the order of the page.
    title : str, optional
        Heading; by default the name of the cohort.
    provenance : mapping, optional
        What :func:`swaystride.report.provenance.collect_provenance` returned.

    Raises
    ------
    DesignError
        If there is no study, a study comes twice, or the studies are of different cohorts.

    Examples
    --------
    >>> render_cohort_page([])
    Traceback (most recent call last):
    ...
    swaystride.errors.DesignError: page of a cohort; expected at least one study; found none
    """
    if not contents:
        raise DesignError("page of a cohort", expected="at least one study", found="none")
    cohorts = sorted({(content.cohort, content.simulated) for content in contents})
    if len(cohorts) > 1:
        raise DesignError(
            "studies of different cohorts on one page",
            expected="one cohort, simulated or real",
            found=", ".join(
                f"{cohort} ({'simulated' if simulated else 'real'})"
                for cohort, simulated in cohorts
            ),
        )
    slugs = [content.slug for content in contents]
    twice = sorted({slug for slug in slugs if slugs.count(slug) > 1})
    if twice:
        raise DesignError("study occurs twice on a page", found=", ".join(twice))
    cohort, simulated = cohorts[0]
    return render_page(
        Page(
            title=title or f"Cohort {cohort}",
            kicker="Cohort report",
            cohort=cohort,
            simulated=simulated,
            studies=tuple(contents),
            several=True,
            provenance=provenance,
        )
    )
