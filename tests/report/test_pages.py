"""Pages: well-formed, self-contained, escaped, the same every time, loud where simulated."""

from __future__ import annotations

import base64
import dataclasses
import re
from html.parser import HTMLParser
from pathlib import Path

import pandas as pd
import pytest

from swaystride.errors import ConfigurationError, DesignError
from swaystride.findings import FINDING_COLUMNS
from swaystride.report import page as page_module
from swaystride.report.cohort_page import render_cohort_page
from swaystride.report.content import Exclusion, Flow, Parameter, summarise_findings
from swaystride.report.inline_figure import inline_figure
from swaystride.report.study_page import render_study_page

VOID = {"meta", "link", "img", "br", "hr", "input"}
HOSTILE = """<script>alert('x')</script><img src="http://evil.example/x.png"> & "q" </style>"""
SIMULATED = "Simulated cohort: not measurements."


class Checker(HTMLParser):
    """Follows open tags, and collects ids, links, resources and what a reader sees."""

    def __init__(self):
        super().__init__()
        self.open, self.ids, self.targets = [], [], []
        self.resources, self.tags, self.seen, self.headings = [], [], [], []

    def handle_starttag(self, tag, attrs):
        self.handle_startendtag(tag, attrs)
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        values = dict(attrs)
        assert len(values) == len(attrs), f"attribute twice in <{tag}>"
        self.tags.append((tag, values))
        self.ids += [values["id"]] if "id" in values else []
        self.resources += [values[name] for name in ("src", "srcset", "data") if name in values]
        if tag == "link":
            self.resources.append(values["href"])
        elif values.get("href", "").startswith("#"):
            self.targets.append(values["href"][1:])
        self.targets += values.get("aria-labelledby", "").split()
        if re.fullmatch(r"h[1-6]", tag):
            self.headings.append(int(tag[1]))

    def handle_endtag(self, tag):
        assert self.open, f"</{tag}> closes nothing"
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open and self.open[-1] not in ("style", "script"):
            self.seen.append(data)

    @property
    def text(self):
        return " ".join(" ".join(self.seen).split())


def checked(html):
    checker = Checker()
    checker.feed(html)
    checker.close()
    assert checker.open == []
    return checker


@pytest.fixture(params=["study", "cohort"])
def rendered(request, make_content):
    """Both kinds of page, each as a function of its content."""

    def render(**options):
        content = make_content(**options)
        if request.param == "study":
            return render_study_page(content)
        other = dataclasses.replace(content, slug="second", title="Second")
        return render_cohort_page([content, other])

    return render


def test_page_is_well_formed_and_its_anchors_meet(rendered):
    page = checked(rendered())
    assert len(page.ids) == len(set(page.ids))
    assert set(page.targets) <= set(page.ids)
    assert page.headings[0] == 1
    steps = [b - a for a, b in zip(page.headings, page.headings[1:], strict=False)]
    assert max(steps) == 1
    assert page.headings.count(1) == 1


def test_every_heading_of_a_section_has_an_id(rendered):
    page = checked(rendered())
    bare = [tag for tag, values in page.tags if re.fullmatch("h[2-6]", tag) and "id" not in values]
    assert bare == []


def test_page_needs_no_network_and_no_script(rendered):
    html = rendered()
    page = checked(html)
    assert all(resource.startswith("data:") for resource in page.resources)
    tags = {tag for tag, _ in page.tags}
    assert not tags & {"script", "iframe", "object", "embed", "base"}
    assert not [name for _, values in page.tags for name in values if name.startswith("on")]
    assert not re.search(r"https?://|url\(|@import", html)
    assert "default-src 'none'" in html


def test_same_content_gives_the_same_bytes(rendered):
    assert rendered() == rendered()


def test_page_knows_no_machine_and_no_date(rendered, repository):
    html = rendered()
    assert str(repository) not in html
    assert not re.search(r"\b20\d\d-\d\d-\d\d\b|/(home|tmp|root|work)/", html)


def test_simulated_cohort_is_called_so_everywhere(rendered):
    html = rendered()
    page = checked(html)
    n_items = sum(tag in ("caption", "figcaption") for tag, _ in page.tags)
    assert page.text.count(SIMULATED) >= 1 + 5
    assert n_items >= 5
    assert "(simulated cohort)</title>" in html
    assert "SIMULATED COHORT" in html  # head of every printed sheet


def test_real_cohort_is_called_so_and_nothing_is_simulated(rendered):
    html = rendered(simulated=False, cohort="clinic")
    page = checked(html)
    assert "simulated" not in page.text.lower()
    assert "SIMULATED" not in html
    assert "Real recordings." in page.text


def test_hostile_text_stays_text(rendered):
    text = {
        "title": HOSTILE,
        "source": HOSTILE,
        "question": HOSTILE,
        "design": [HOSTILE],
        "notes": [HOSTILE],
    }
    findings = pd.DataFrame([[HOSTILE, "error", *[HOSTILE] * 4]], columns=FINDING_COLUMNS)
    parameters = [Parameter(HOSTILE, HOSTILE, HOSTILE, HOSTILE, HOSTILE, True)]
    flow = [Flow(HOSTILE, 1, 1, (Exclusion(HOSTILE, 1),), 0)]
    html = rendered(
        text=text,
        findings=findings,
        parameters=parameters,
        flow=flow,
        cohort=HOSTILE,
        variant=HOSTILE,
        scale=HOSTILE,
        command=HOSTILE,
    )
    page = checked(html)
    tags = {tag for tag, _ in page.tags}
    assert "script" not in tags
    assert html.count("</style>") == 1
    assert all(resource.startswith("data:") for resource in page.resources)
    assert " ".join(HOSTILE.split()) in page.text


def test_every_part_is_on_the_page(make_content):
    page = checked(render_study_page(make_content()))
    for part in (
        "Does it work?",
        "Nineteen people stood.",
        "19 participants analysed",
        "2 too short",
        "packet loss",
        "results/toy/tables/table_2_3.csv",
        "snakemake --cores all results/toy/figures/figure_1.svg",
        "cutoff_hz",
        "changed by the variant",
        "One note.",
        "[−0.046, −0.014]",
        "<0.001",
    ):
        assert part in page.text, part
    images = [values for tag, values in page.tags if tag == "img"]
    assert [image["alt"] for image in images] == ["A rising line.", "Points on a line."]
    assert all(int(image["width"]) > 0 for image in images)


def test_tables_have_captions_and_scopes(make_content):
    page = checked(render_study_page(make_content()))
    heads = [values for tag, values in page.tags if tag == "th"]
    assert all(values.get("scope") in {"col", "row", "colgroup", "rowgroup"} for values in heads)
    assert ("main", {"id": "content"}) in page.tags
    assert "content" in page.targets


def test_inlined_svg_is_the_file(make_content, repository):
    page = checked(render_study_page(make_content()))
    image = next(values for tag, values in page.tags if tag == "img")
    kind, data = image["src"].split(",")
    assert kind == "data:image/svg+xml;base64"
    file = repository / "results" / "toy" / "figures" / "figure_1.svg"
    assert base64.b64decode(data) == file.read_bytes()


def test_large_svg_gives_way_to_the_png(tmp_path):
    svg = '<svg width="72pt" height="36pt">' + "x" * 700_000 + "</svg>"
    (tmp_path / "f.svg").write_text(svg)
    (tmp_path / "f.png").write_bytes(b"picture")
    uri, width, height = inline_figure(tmp_path / "f")
    assert uri == "data:image/png;base64," + base64.b64encode(b"picture").decode()
    assert (width, height) == (96, 48)


def test_absent_or_odd_figures_are_named(tmp_path):
    with pytest.raises(DesignError, match=r"^f.svg: no such figure"):
        inline_figure(tmp_path / "f")
    (tmp_path / "f.svg").write_text("<svg>")
    (tmp_path / "f.png").write_bytes(b"")
    with pytest.raises(DesignError, match=r"^f.svg: size of a figure"):
        inline_figure(tmp_path / "f")


def test_missing_result_is_named_with_its_item(make_content):
    with pytest.raises(DesignError, match=r"^table_2_3.csv: table table_2_3: no such table"):
        make_content(results_dir="results/none")


def test_wrong_columns_are_named_with_their_item(make_content, toy_text):
    items = [{**item} for item in toy_text["items"]]
    items[1]["columns"] = ["sexx"]
    with pytest.raises(
        ConfigurationError,
        match=r"^agreement table_2_2: the reproduced table lacks a column; expected sexx",
    ):
        make_content(text={"items": items})


def test_flow_must_add_up():
    with pytest.raises(DesignError, match=r"flow of trials does not add up; .* found 9 analysed"):
        Flow("trials", None, 10, (Exclusion("too short", 2),), 9)


def test_content_refuses_unfit_names(make_content):
    with pytest.raises(DesignError, match=r"identifier on a page; .* found Balance 2"):
        make_content(slug="Balance 2")
    with pytest.raises(DesignError, match=r"columns of the findings; .* found check"):
        make_content(findings=pd.DataFrame(columns=["check"]))
    content = make_content()
    with pytest.raises(DesignError, match=r"item occurs twice on a page; found table_2_3"):
        dataclasses.replace(content, items=(content.items[0], content.items[0]))


def test_cohort_page_holds_one_cohort_and_each_study_once(make_content):
    content = make_content()
    with pytest.raises(DesignError, match=r"study occurs twice on a page; found balance"):
        render_cohort_page([content, content])
    real = dataclasses.replace(content, slug="b", cohort="clinic", simulated=False)
    with pytest.raises(DesignError, match=r"found clinic \(real\), synthetic \(simulated\)"):
        render_cohort_page([content, real])


def test_cohort_page_shows_every_study_and_the_provenance(make_content):
    content = make_content()
    other = dataclasses.replace(content, slug="second", title="Second study")
    record = {
        "commit": "abc123",
        "config_sha256": "f00",
        "seed": 7,
        "versions": {"python": "3.11"},
        "inputs": [],
        "outputs": [],
    }
    page = checked(render_cohort_page([content, other], title="All", provenance=record))
    for part in ("All", "Balance", "Second study", "abc123", "python 3.11"):
        assert part in page.text
    assert {"balance.table_2_3", "second.table_2_3"} <= set(page.ids)


def test_findings_are_summarised_errors_first_and_none_is_lost():
    rows = [
        ("b", "warning", "1", "", "", ""),
        ("a", "info", "1", "", "", ""),
        ("c", "error", "2", "", "", None),
        ("b", "warning", "1", "", "", ""),
        ("d", "odd", "1", "", "", ""),
    ]
    lines = summarise_findings(pd.DataFrame(rows, columns=FINDING_COLUMNS), limit=1)
    assert [(x.check, x.count, x.n_files, len(x.rows)) for x in lines] == [
        ("c", 1, 1, 1),
        ("b", 2, 1, 1),
        ("a", 1, 1, 1),
        ("d", 1, 1, 1),
    ]


def test_empty_study_is_a_page_too(make_content):
    content = dataclasses.replace(
        make_content(),
        items=(),
        flow=(),
        parameters=(),
        notes=(),
        findings=pd.DataFrame(columns=FINDING_COLUMNS),
    )
    page = checked(render_study_page(content))
    for heading in ("Participant flow", "Data quality", "Parameters", "Tables"):
        assert heading not in page.text


def test_recordings_without_findings_are_said_to_be_so(make_content):
    content = dataclasses.replace(make_content(), findings=pd.DataFrame(columns=FINDING_COLUMNS))
    assert "found nothing to report" in checked(render_study_page(content)).text


def test_templates_belong_to_the_module_by_name():
    """The import graph takes ``page.*`` for the data of ``page.py``."""
    folder = Path(page_module.__file__).parent
    names = {file.name for file in folder.iterdir() if file.suffix in {".html", ".css"}}
    assert names == {"page.html", "page.blocks.html", "page.css"}
