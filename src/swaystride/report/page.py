"""The one template of all pages: what a page needs, and how it becomes HTML.

``page.html`` is the frame, ``page.blocks.html`` the building blocks, ``page.css`` the look. All
text is escaped, and a name that a template does not know is an error.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

from jinja2 import DictLoader, Environment, StrictUndefined
from markupsafe import Markup

from swaystride.presentation.table_text import SIMULATED_NOTE
from swaystride.report.content import Item, StudyContent, summarise_findings
from swaystride.report.table_view import MARKS, TableView

_TITLES = {
    "question": "Question",
    "glance": "Agreement at a glance",
    "design": "Design",
    "flow": "Participant flow and exclusions",
    "quality": "Data quality",
    "tables": "Tables",
    "figures": "Figures",
    "claims": "Claims of the source",
    "assumptions": "Model assumptions",
    "parameters": "Parameters",
    "regenerate": "How to regenerate each item",
    "notes": "Notes",
}


@dataclass(frozen=True)
class PageSection:
    """One section of a study: name in anchors, heading, and the items that stand in it."""

    key: str
    title: str
    items: tuple[Item, ...] = ()


@dataclass(frozen=True)
class Page:
    """One HTML file.

    Parameters
    ----------
    title, kicker : str
        Heading, and the line above it.
    cohort : str
        Name of the cohort.
    simulated : bool
        Whether the cohort is simulated.
    studies : tuple of StudyContent
        One, or several.
    several : bool
        Whether the page is that of a cohort, with a chapter for each study.
    provenance : mapping or None
        What :func:`swaystride.report.provenance.collect_provenance` returned.
    """

    title: str
    kicker: str
    cohort: str
    simulated: bool
    studies: tuple[StudyContent, ...]
    several: bool
    provenance: Mapping[str, Any] | None = None


def render_page(page: Page) -> str:
    """HTML of a page: one file, without a script and without anything from the network.

    Parameters
    ----------
    page : Page
        What the file shows.
    """
    html = _environment().get_template("page.html").render(page=page)
    lines = (line.rstrip() for line in html.splitlines())
    return "\n".join(line for line in lines if line) + "\n"


def render_table(view: TableView, caption: str) -> str:
    """HTML of one table, drawn as on the pages.

    Parameters
    ----------
    view : TableView
        The table.
    caption : str
        Its caption.
    """
    blocks: Any = _environment().get_template("page.blocks.html").module
    return str(blocks.table(view, caption))


def sections(study: StudyContent) -> list[PageSection]:
    """Sections of a study that have something to say, in the order of the page.

    Parameters
    ----------
    study : StudyContent
        What the page shows of a study.
    """
    filled = {
        "glance": bool(study.compared),
        # a page without recordings of its own has neither flow nor findings nor parameters
        "flow": bool(study.flow),
        "quality": bool(study.flow),
        "parameters": bool(study.parameters),
        "notes": bool(study.notes),
        "regenerate": bool(study.items),
    }
    found = []
    for key, title in _TITLES.items():
        if key in ("tables", "figures", "claims", "assumptions"):
            items = tuple(item for item in study.items if item.section == key)
            if items:
                found.append(PageSection(key, title, items))
        elif filled.get(key, True):
            found.append(PageSection(key, title))
    return found


@cache
def _environment() -> Environment:
    folder = files("swaystride.report")
    names = ("page.html", "page.blocks.html")
    environment = Environment(
        loader=DictLoader({name: folder.joinpath(name).read_text("utf-8") for name in names}),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.globals.update(
        css=Markup(folder.joinpath("page.css").read_text("utf-8").strip()),
        marks=MARKS,
        sections=sections,
        simulated_note=SIMULATED_NOTE,
        summarise_findings=summarise_findings,
    )
    return environment
