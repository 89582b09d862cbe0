"""From the words of a page and the result files to the content of the page."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from swaystride.errors import SwaystrideError
from swaystride.presentation.table_files import SIMULATED_COLUMN, read_table
from swaystride.report.comparison import Summary, compare_numbers, compare_words, summarise
from swaystride.report.comparison_view import number_view, word_view
from swaystride.report.content import (
    FigureItem,
    Flow,
    Item,
    Parameter,
    StudyContent,
    TableItem,
)
from swaystride.report.inline_figure import inline_figure
from swaystride.report.page_text import ItemText, PageText
from swaystride.report.table_join import require_columns
from swaystride.report.table_view import TableView, claims_view, listing_view


def study_content(
    text: PageText,
    *,
    slug: str,
    cohort: str,
    variant: str,
    scale: str,
    simulated: bool,
    flow: Sequence[Flow],
    findings: pd.DataFrame,
    parameters: Sequence[Parameter],
    results_dir: Path | str,
    printed_dir: Path | str,
    root: Path | str = ".",
    command: str = "snakemake --cores all {path}",
) -> StudyContent:
    """Content of the page of one study, cohort and variant.

    Parameters
    ----------
    text : PageText
        From :func:`swaystride.report.page_text.load_page_text`.
    slug, cohort, variant, scale : str
        Names as in the configuration.
    simulated : bool
        Whether the cohort is simulated.
    flow, findings, parameters
        See :class:`swaystride.report.content.StudyContent`.
    results_dir : path or str
        Folder of the variant, relative to ``root``; ``file`` of an item is relative to it.
    printed_dir : path or str
        Folder of the printed tables, relative to ``root``.
    root : path or str
        The repository; it appears nowhere on the page.
    command : str
        How one file is made again; ``{path}`` is the file relative to ``root``.

    Raises
    ------
    SwaystrideError
        With the item's name, if one of its files is missing or does not fit.
    """
    return StudyContent(
        slug=slug,
        title=text.title,
        source=text.source,
        question=text.question,
        cohort=cohort,
        variant=variant,
        scale=scale,
        simulated=simulated,
        design=text.design,
        flow=tuple(flow),
        findings=findings,
        items=build_items(
            text,
            simulated=simulated,
            results_dir=results_dir,
            printed_dir=printed_dir,
            root=root,
            command=command,
        ),
        parameters=tuple(parameters),
        notes=text.notes,
    )


def build_items(
    text: PageText,
    *,
    simulated: bool,
    results_dir: Path | str,
    printed_dir: Path | str,
    root: Path | str = ".",
    command: str = "snakemake --cores all {path}",
) -> tuple[Item, ...]:
    """Tables and figures of a page, with their files read.

    Parameters
    ----------
    text, simulated, results_dir, printed_dir, root, command
        See :func:`study_content`.
    """
    base = Path(root)
    items: list[Item] = []
    for item in text.items:
        if item.simulated_only and not simulated:
            continue
        path = Path(results_dir) / item.file
        try:
            if item.kind in ("figure", "assumption"):
                items.append(_figure(item, base, path, command))
            else:
                items.append(_table(item, base, path, Path(printed_dir), command))
        except SwaystrideError as error:
            raise type(error)(
                error.problem,
                file=error.file,
                place=f"{item.kind} {item.id}" + (f", {error.place}" if error.place else ""),
                expected=error.expected,
                found=error.found,
            ) from error
    return tuple(items)


def _figure(item: ItemText, base: Path, path: Path, command: str) -> FigureItem:
    stem = path.with_suffix("") if path.suffix in (".svg", ".png", ".pdf") else path
    uri, width, height = inline_figure(base / stem)
    shown = f"{stem.as_posix()}.svg"
    return FigureItem(
        id=item.id,
        title=item.title,
        caption=item.caption,
        alt=item.alt,
        section="assumptions" if item.kind == "assumption" else "figures",
        data_uri=uri,
        width_px=width,
        height_px=height,
        path=shown,
        command=command.format(path=shown),
        notes=item.notes,
    )


def _table(item: ItemText, base: Path, path: Path, printed_dir: Path, command: str) -> TableItem:
    # the page says "simulated" in its own ways
    frame = read_table(base / path).drop(columns=SIMULATED_COLUMN, errors="ignore")
    if item.columns:
        require_columns(frame, item.columns, "reproduced")
    printed = read_table(base / printed_dir / item.printed) if item.printed else None
    view, summary = _view(item, frame, printed)
    return TableItem(
        id=item.id,
        title=item.title,
        caption=item.caption,
        section="claims" if item.kind == "claims" else "tables",
        view=view,
        summary=summary,
        path=path.as_posix(),
        command=command.format(path=path.as_posix()),
        notes=item.notes,
    )


def _view(
    item: ItemText, frame: pd.DataFrame, printed: pd.DataFrame | None
) -> tuple[TableView, Summary | None]:
    shown = frame.loc[:, list(item.columns)] if item.columns and printed is None else frame
    if item.kind == "claims":
        view = claims_view(shown, verdict=item.verdict, labels=item.labels)
        counts = shown[item.verdict].value_counts()
        yes, partly, no = (int(counts.get(word, 0)) for word in ("yes", "partly", "no"))
        return view, Summary(yes, partly, no, unattainable=0, one_table_only=0)
    if printed is None:
        return listing_view(shown, formats=item.formats, labels=item.labels), None
    rules = item.unattainable
    if item.kind == "agreement":
        words = compare_words(
            printed, frame, keys=item.keys, columns=item.columns, unattainable=rules
        )
        return word_view(words, keys=item.keys, labels=item.labels), summarise(words)
    numbers = compare_numbers(
        printed, frame, keys=item.keys, values=item.values, unattainable=rules
    )
    view = number_view(
        numbers, keys=item.keys, values=item.values, group=item.group, labels=item.labels
    )
    return view, summarise(numbers)
