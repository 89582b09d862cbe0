"""A study's page as data: what is said, what is shown and where it came from.

Nothing here knows HTML, files or a particular study.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any, Literal

import pandas as pd

from swaystride.errors import DesignError
from swaystride.findings import FINDING_COLUMNS
from swaystride.report.comparison import Summary
from swaystride.report.table_view import TableView

Section = Literal["tables", "figures", "claims", "assumptions"]


@dataclass(frozen=True)
class Exclusion:
    """How many units were left out, and why.

    Examples
    --------
    >>> Exclusion("no static recording", 1).count
    1
    """

    reason: str
    count: int


@dataclass(frozen=True)
class Flow:
    """The way of one kind of unit from the plan to the analysis.

    Parameters
    ----------
    unit : str
        What is counted, in the plural: "participants", "trials".
    planned : int or None
        Planned by the design; None if the source does not say.
    recorded : int
        Recordings that arrived.
    excluded : tuple of Exclusion
        Left out, with reasons.
    analysed : int
        What the analysis used.

    Raises
    ------
    DesignError
        If recorded minus excluded is not analysed.

    Examples
    --------
    >>> Flow("trials", 708, 708, (Exclusion("lost packets", 3),), 705).n_excluded
    3
    """

    unit: str
    planned: int | None
    recorded: int
    excluded: tuple[Exclusion, ...]
    analysed: int

    def __post_init__(self) -> None:
        if self.recorded - self.n_excluded != self.analysed:
            raise DesignError(
                f"flow of {self.unit} does not add up",
                expected=f"{self.recorded} recorded − {self.n_excluded} excluded",
                found=f"{self.analysed} analysed",
            )

    @property
    def n_excluded(self) -> int:
        """Units left out, over all reasons."""
        return sum(exclusion.count for exclusion in self.excluded)


@dataclass(frozen=True)
class Parameter:
    """One parameter of the analysis.

    Parameters
    ----------
    name, value, unit, source : str
        As the page shows them.
    group : str
        Heading under which it stands.
    changed_by_variant : bool
        Whether the variant of this page overrides the study's value.

    Examples
    --------
    >>> Parameter("cutoff_hz", "2", "Hz", "section 2.3", "Filtering").changed_by_variant
    False
    """

    name: str
    value: str
    unit: str
    source: str
    group: str = "Analysis"
    changed_by_variant: bool = False


@dataclass(frozen=True)
class TableItem:
    """One table of the page.

    Parameters
    ----------
    id, title, caption : str
        Identifier, heading and caption.
    section : {"tables", "claims"}
        Where it stands.
    view : TableView
        What is drawn.
    summary : Summary or None
        Count of agreement; None where there is nothing to compare with.
    path : str
        The CSV, relative to the repository.
    command : str
        Makes the CSV again.
    notes : tuple of str
        Remarks below.
    """

    id: str
    title: str
    caption: str
    section: Section
    view: TableView
    summary: Summary | None
    path: str
    command: str
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class FigureItem:
    """One figure of the page.

    Parameters
    ----------
    id, title, caption, alt : str
        Identifier, heading, caption, and the words for those who do not see the image.
    section : {"figures", "assumptions"}
        Where it stands.
    data_uri : str
        The image itself.
    width_px, height_px : int
        Natural size in CSS pixels.
    path : str
        The SVG, relative to the repository.
    command : str
        Makes the figure again.
    notes : tuple of str
        Remarks below.
    """

    id: str
    title: str
    caption: str
    alt: str
    section: Section
    data_uri: str
    width_px: int
    height_px: int
    path: str
    command: str
    notes: tuple[str, ...] = ()


Item = TableItem | FigureItem


@dataclass(frozen=True)
class StudyContent:
    """Everything that the page of one study, cohort and variant shows.

    Parameters
    ----------
    slug : str
        Short name: lower-case letters, digits, underscores.
    title, source, question : str
        Heading; where the study is printed; what it asks.
    cohort, variant, scale : str
        Names as in the configuration.
    simulated : bool
        Whether the cohort is simulated.
    design : tuple of str
        Paragraphs.
    flow : tuple of Flow
        Participants, trials.
    findings : pandas.DataFrame
        Columns of :class:`swaystride.findings.Finding`.
    items : tuple of TableItem or FigureItem
        In the order of the page.
    parameters : tuple of Parameter
        In the order of the page.
    notes : tuple of str
        Remarks on the whole study.

    Raises
    ------
    DesignError
        If the slug or an identifier is unfit or occurs twice, or the findings lack a column.
    """

    slug: str
    title: str
    source: str
    question: str
    cohort: str
    variant: str
    scale: str
    simulated: bool
    design: tuple[str, ...]
    flow: tuple[Flow, ...]
    findings: pd.DataFrame
    items: tuple[Item, ...]
    parameters: tuple[Parameter, ...]
    notes: tuple[str, ...] = field(default=())

    def __post_init__(self) -> None:
        names = [self.slug, *(item.id for item in self.items)]
        unfit = [name for name in names if not re.fullmatch(r"[a-z][a-z0-9_]*", name)]
        if unfit:
            raise DesignError(
                "identifier on a page",
                expected="lower-case letters, digits and underscores",
                found=", ".join(unfit),
            )
        ids = names[1:]
        twice = sorted({name for name in ids if ids.count(name) > 1})
        if twice:
            raise DesignError("item occurs twice on a page", found=", ".join(twice))
        missing = [name for name in FINDING_COLUMNS if name not in self.findings.columns]
        if missing:
            raise DesignError(
                "columns of the findings",
                expected=", ".join(FINDING_COLUMNS),
                found=", ".join(map(str, self.findings.columns)),
            )

    def section(self, name: Section) -> list[Item]:
        """Items of one section, in their order."""
        return [item for item in self.items if item.section == name]

    @property
    def compared(self) -> list[TableItem]:
        """Tables and claims with a printed counterpart."""
        return [
            item for item in self.items if isinstance(item, TableItem) and item.summary is not None
        ]


@dataclass(frozen=True)
class CheckSummary:
    """What one check found, over all recordings.

    Parameters
    ----------
    check, severity : str
        Name of the check and severity of its findings.
    count, n_files : int
        Findings, and files in which they occur.
    rows : tuple of dict
        The findings themselves, at most ``limit``.
    """

    check: str
    severity: str
    count: int
    n_files: int
    rows: tuple[dict[str, Any], ...]


def summarise_findings(findings: pd.DataFrame, *, limit: int = 200) -> list[CheckSummary]:
    """Findings by severity (errors first) and check.

    Parameters
    ----------
    findings : pandas.DataFrame
        Columns of :class:`swaystride.findings.Finding`.
    limit : int
        Findings kept in full for each check.

    Examples
    --------
    >>> rows = [("gap", "warning", "P01.txt", "t = 1 s", "none", "4"),
    ...         ("gap", "warning", "P02.txt", "t = 9 s", "none", "2")]
    >>> [(line.check, line.count, line.n_files)
    ...  for line in summarise_findings(pd.DataFrame(rows, columns=FINDING_COLUMNS))]
    [('gap', 2, 2)]
    """
    texts = findings.loc[:, list(FINDING_COLUMNS)].astype(object).fillna("").astype(str)
    summaries = []
    known = ("error", "warning", "info")
    for severity in [*known, *sorted(set(texts["severity"]) - set(known))]:
        chosen = texts[texts["severity"] == severity]
        for check in sorted(chosen["check"].unique()):
            rows = chosen[chosen["check"] == check]
            records = [{str(k): v for k, v in row.items()} for row in rows.to_dict("records")]
            summaries.append(
                CheckSummary(
                    check, severity, len(rows), rows["file"].nunique(), tuple(records[:limit])
                )
            )
    return summaries
