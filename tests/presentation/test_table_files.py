"""Table files: the four renderings hold the same cells, and the CSV joins."""

from __future__ import annotations

import csv
import html
import io
import re
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from swaystride.errors import ConfigurationError, DesignError
from swaystride.presentation.number_format import MINUS
from swaystride.presentation.table_files import SIMULATED_NOTE, read_table, write_table
from swaystride.presentation.table_text import (
    TextTable,
    markdown_escape,
    tex_escape,
    to_html,
    to_markdown,
    to_tex,
)

PUBLISHED = Path(__file__).resolve().parents[2] / "data" / "published"
HOSTILE = r"""<script>alert("x")</script> & 50% $a_b^2$ {c} #1 ~ \d | *e* `f` [g] 'h'"""


def rows_of_markdown(text):
    """Cells of a pipe table, escapes undone."""
    lines = [line for line in text.splitlines() if line.startswith("|")]
    cells = [re.split(r"(?<!\\)\|", line)[1:-1] for line in lines]
    table = [[re.sub(r"\\(.)", r"\1", cell.strip()) for cell in row] for row in cells]
    return [table[0], *table[2:]]


def rows_of_tex(text):
    """Cells between the booktabs rules, the escapes of these tests undone."""
    inside = text.split(r"\toprule")[1].split(r"\bottomrule")[0].replace(r"\midrule", "")
    rows = [line.removesuffix(r" \\") for line in inside.strip().splitlines() if line.strip()]
    plain = {"$-$": MINUS, "$<$": "<", "$>$": ">", r"\_": "_", "{}": ""}
    escaped = re.compile("|".join(re.escape(key) for key in plain))
    return [
        [escaped.sub(lambda found: plain[found[0]], cell).strip() for cell in row.split(" & ")]
        for row in rows
    ]


class _Cells(HTMLParser):
    """Collects the cells of a table."""

    def __init__(self):
        super().__init__()
        self.rows, self.inside = [], False

    def handle_starttag(self, tag, attrs):
        if tag == "tr":
            self.rows.append([])
        self.inside = tag in ("td", "th")
        if self.inside:
            self.rows[-1].append("")

    def handle_endtag(self, tag):
        self.inside = self.inside and tag not in ("td", "th")

    def handle_data(self, data):
        if self.inside:
            self.rows[-1][-1] += data


def rows_of_html(text):
    parser = _Cells()
    parser.feed(text)
    return parser.rows


numbers = st.one_of(st.floats(-1e6, 1e6), st.just(float("nan")))
words = st.text("abcdefgh_<>-*. ", max_size=8).map(lambda text: " ".join(text.split()))


@st.composite
def frames(draw):
    n = draw(st.integers(1, 5))
    lists = {"name": words, "x": numbers, "n": st.integers(-99, 99), "p": st.floats(0, 1)}
    return pd.DataFrame(
        {key: draw(st.lists(kind, min_size=n, max_size=n)) for key, kind in lists.items()}
    )


@given(frames())
def test_renderings_hold_the_same_cells(tmp_path_factory, frame):
    stem = tmp_path_factory.mktemp("t") / "table"
    files = write_table(
        frame, stem, caption="c", formats={"x": 3, "p": "p"}, simulated=True, notes=["n"]
    )
    text = {file.suffix: file.read_text(encoding="utf-8") for file in files}
    cells = rows_of_html(text[".html"])
    assert rows_of_markdown(text[".md"]) == cells
    assert rows_of_tex(text[".tex"]) == cells
    marked = list(csv.reader(io.StringIO(text[".csv"])))
    assert [row[-1] for row in marked] == ["data"] + ["simulated"] * len(frame)
    plain = [row[:-1] for row in marked]
    without_p = [[cell.replace(MINUS, "-") for cell in row[:-1]] for row in cells]
    assert [row[:-1] for row in plain] == without_p
    for shown, (_, exact) in zip(cells[1:], enumerate(plain[1:]), strict=True):
        assert shown[-1][0] in "<>" or abs(float(shown[-1]) - float(exact[-1])) <= 0.000501


@given(st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=6), st.integers(0, 6))
def test_csv_reads_back_within_half_a_unit(tmp_path_factory, values, decimals):
    stem = tmp_path_factory.mktemp("t") / "table"
    frame = pd.DataFrame({"x": values})
    csv_file = write_table(frame, stem, caption="c", formats={"x": decimals}, simulated=False)[0]
    back = read_table(csv_file)["x"].to_numpy(float)
    np.testing.assert_allclose(back, values, rtol=1e-15, atol=0.5 * 10**-decimals + 1e-10)


def test_csv_is_plain_and_joins_with_the_printed_table(tmp_path):
    printed = read_table(PUBLISHED / "table_2_3.csv")
    formats = {"exponent": 1, "estimate": 3, "ci_low": 3, "ci_high": 3, "p": "number:3"}
    files = write_table(printed, tmp_path / "t", caption="c", formats=formats, simulated=False)
    raw = files[0].read_bytes()
    assert raw.splitlines()[0].decode() == ",".join(printed.columns)
    assert b"\r" not in raw
    assert SIMULATED_NOTE.encode() not in raw
    # the print keeps the sign of a rounded zero; ours does not, and nothing else differs
    source = (PUBLISHED / "table_2_3.csv").read_bytes().replace(b"\r", b"")
    assert raw == source.replace(b"-0.000,", b"0.000,")


@pytest.mark.parametrize("suffix", [".md", ".tex", ".html"])
def test_simulated_line_is_there_exactly_when_simulated(tmp_path, suffix):
    frame = pd.DataFrame({"n": [1]})
    for simulated in (True, False):
        write_table(frame, tmp_path / "t", caption="c", formats={}, simulated=simulated)
        text = (tmp_path / f"t{suffix}").read_text(encoding="utf-8")
        assert (SIMULATED_NOTE in text) is simulated


def test_hostile_text_stays_text(tmp_path):
    frame = pd.DataFrame({"a": [HOSTILE], "b": ["x"]})
    write_table(
        frame, tmp_path / "t", caption=HOSTILE, notes=[HOSTILE], formats={}, simulated=False
    )
    page = (tmp_path / "t.html").read_text(encoding="utf-8")
    assert "<script" not in page
    assert rows_of_html(page)[1][0] == HOSTILE
    assert page.count(html.escape(HOSTILE)) == 3
    assert rows_of_markdown((tmp_path / "t.md").read_text(encoding="utf-8"))[1][0] == HOSTILE
    assert read_table(tmp_path / "t.csv")["a"].tolist() == [HOSTILE]


def test_every_tex_special_character_is_escaped():
    assert tex_escape(r"\{}$&#%_^~") == (
        r"\textbackslash{}\{\}\$\&\#\%\_\textasciicircum{}\textasciitilde{}"
    )
    assert (
        tex_escape("a < b > c | −1 × 2°") == r"a $<$ b $>$ c \textbar{} $-$1 $\times$ 2$^{\circ}$"
    )
    assert tex_escape("two\nlines") == "two lines"


@given(st.text(max_size=40))
def test_tex_escape_leaves_no_active_character(text):
    bare = re.sub(r"\\[{}$&#%_]|\\[a-zA-Z]+\{\}|\$[^$]*\$", "", tex_escape(text))
    assert not set(bare) & set(r"\{}$&#%_^<>|" + '"')


@given(st.text(max_size=40))
def test_markdown_escape_can_be_undone(text):
    escaped = markdown_escape(text)
    assert re.sub(r"\\(.)", r"\1", escaped) == " ".join(text.split())
    assert "\n" not in escaped


def test_tex_arrangement():
    table = TextTable(["a", "n"], [["x", "1"]], [False, True], "C.", ["N."], simulated=True)
    lines = to_tex(table).splitlines()
    assert r"\begin{tabular}{lr}" in lines
    rules = [line for line in lines if line.endswith("rule")]
    assert rules == [r"\toprule", r"\midrule", r"\bottomrule"]
    assert lines[lines.index(r"\toprule") + 1] == r"a & n \\"
    assert lines.index(r"\caption{C.}") < lines.index(r"\toprule")


@pytest.mark.parametrize("cell", ["[0.1, 0.2]", "*"])
def test_tex_row_is_not_read_as_an_argument_of_the_row_before(cell):
    lines = to_tex(TextTable(["a"], [["x"], [cell]], [False], "C.")).splitlines()
    assert lines[lines.index(r"x \\") + 1] == "{}" + cell + r" \\"


def test_html_marks_headings_for_readers_who_listen():
    text = to_html(TextTable(["a", "n"], [["x", "1"]], [False, True], "C."))
    assert text.count('scope="col"') == 2
    assert text.count('scope="row"') == 1
    assert "<caption>C.</caption>" in text


def test_markdown_aligns_numbers_to_the_right():
    text = to_markdown(TextTable(["a", "n"], [["x", "1"]], [False, True], "C."))
    assert "| :-- | --: |" in text


def test_labels_are_for_people_only(tmp_path):
    frame = pd.DataFrame({"feature": ["phi_rms"], "n": [3]})
    labels = {"feature": "Feature", "phi_rms": "Sway angle RMS"}
    write_table(frame, tmp_path / "t", caption="c", formats={}, simulated=False, labels=labels)
    assert (tmp_path / "t.csv").read_text() == "feature,n\nphi_rms,3\n"
    assert rows_of_html((tmp_path / "t.html").read_text()) == [
        ["Feature", "n"],
        ["Sway angle RMS", "3"],
    ]


def test_repetition_gives_the_same_bytes(tmp_path):
    frame = pd.DataFrame({"x": np.linspace(-1, 1, 7)})
    for folder in ("one", "two"):
        write_table(frame, tmp_path / folder / "t", caption="c", formats={"x": 4}, simulated=True)
    for suffix in ("csv", "md", "tex", "html"):
        one, two = ((tmp_path / folder / f"t.{suffix}").read_bytes() for folder in ("one", "two"))
        assert one == two


def test_stem_may_contain_a_dot(tmp_path):
    files = write_table(
        pd.DataFrame({"n": [1]}), tmp_path / "t.v2", caption="c", formats={}, simulated=False
    )
    assert [file.name for file in files] == ["t.v2.csv", "t.v2.md", "t.v2.tex", "t.v2.html"]


def test_float_column_without_format_is_refused(tmp_path):
    with pytest.raises(ConfigurationError, match=r"no format for the column 'x'"):
        write_table(
            pd.DataFrame({"x": [0.5]}), tmp_path / "t", caption="c", formats={}, simulated=False
        )


def test_format_for_an_absent_column_is_refused(tmp_path):
    with pytest.raises(ConfigurationError, match=r"does not have; expected n; found m"):
        write_table(
            pd.DataFrame({"n": [1]}), tmp_path / "t", caption="c", formats={"m": 1}, simulated=False
        )


def test_notes_must_be_a_list(tmp_path):
    with pytest.raises(ConfigurationError, match=r"expected a list of texts; found one text"):
        write_table(
            pd.DataFrame({"n": [1]}),
            tmp_path / "t",
            caption="c",
            notes="note",
            formats={},
            simulated=False,
        )


def test_column_twice_is_refused_on_both_ways(tmp_path):
    frame = pd.DataFrame([[1, 2]], columns=["a", "a"])
    with pytest.raises(DesignError, match=r"column name occurs twice; .* found a"):
        write_table(frame, tmp_path / "t", caption="c", formats={}, simulated=False)
    (tmp_path / "t.csv").write_text("a,a\n1,2\n")
    with pytest.raises(DesignError, match=r"t.csv: column name occurs twice"):
        read_table(tmp_path / "t.csv")


def test_absent_and_empty_tables_are_named(tmp_path):
    with pytest.raises(DesignError, match=r"^none.csv: no such table"):
        read_table(tmp_path / "none.csv")
    (tmp_path / "empty.csv").write_text("")
    with pytest.raises(DesignError, match=r"^empty.csv: empty table"):
        read_table(tmp_path / "empty.csv")


def test_identifiers_can_stay_text(tmp_path):
    (tmp_path / "t.csv").write_text("unit,x\n01,\n02,1.5\n")
    frame = read_table(tmp_path / "t.csv", text_columns=["unit"])
    assert frame["unit"].tolist() == ["01", "02"]
    assert np.isnan(frame["x"].iloc[0])


@pytest.mark.parametrize("file", sorted(PUBLISHED.glob("*.csv")), ids=lambda file: file.name)
def test_every_printed_table_is_readable(file):
    with file.open(encoding="utf-8", newline="") as stream:
        rows = list(csv.reader(stream))
    frame = read_table(file)
    assert list(frame.columns) == rows[0]
    assert len(frame) == len(rows) - 1


def test_people_may_see_the_same_numbers_arranged_otherwise(tmp_path):
    frame = pd.DataFrame({"row": ["a", "a"], "column": ["x", "y"], "value": [0.25, 0.5]})
    wide = pd.DataFrame({"row": ["a"], "x": [0.25], "y": [0.5]})
    write_table(
        frame,
        tmp_path / "table",
        caption="Values.",
        formats={"value": 2},
        simulated=False,
        shown=wide,
        shown_formats={"x": 1, "y": 2},
    )
    assert len(read_table(tmp_path / "table.csv")) == 2
    assert "| a | 0.2 | 0.50 |" in (tmp_path / "table.md").read_text(encoding="utf-8")
