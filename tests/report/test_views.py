"""Views: what the cells of the page say."""

from __future__ import annotations

import pandas as pd
import pytest

from swaystride.errors import DesignError
from swaystride.report.attainability import Unattainable
from swaystride.report.comparison import Value, compare_numbers, compare_words, summarise
from swaystride.report.comparison_view import comparison_html, number_view, word_view
from swaystride.report.table_view import MARKS, claims_view, listing_view


def view_of(printed, ours, values, keys=("key",), **options):
    frame = compare_numbers(
        printed,
        ours,
        keys=list(keys),
        values=values,
        unattainable=options.pop("unattainable", ()),
    )
    return number_view(frame, keys=list(keys), values=values, **options)


def texts(view):
    return [[cell.text for cell in row] for group in view.groups for row in group.rows]


def test_symbols_differ_without_colour():
    assert len(set(MARKS.values())) == len(MARKS) == 3


def test_both_sides_with_intervals_and_the_difference():
    frame = pd.DataFrame({"key": ["a"], "x": [-0.030], "low": [-0.046], "high": [-0.014]})
    value = Value("x", 3, ci=("low", "high"), confidence=0.95)
    ours = frame.assign(x=-0.038)
    row = view_of(frame, ours, [value]).groups[0].rows[0]
    assert [cell.text for cell in row] == ["a", "−0.030", "−0.038", "−1.0"]
    assert row[1].detail == "[−0.046, −0.014]"
    assert row[3].mark == "agrees"
    assert row[3].strip == pytest.approx(-0.98, abs=0.01)


def test_lonely_rows_say_so_under_a_heading_of_their_own():
    printed = pd.DataFrame({"key": ["a"], "x": [1.0]})
    ours = pd.DataFrame({"key": ["b"], "x": [2.0]})
    view = view_of(printed, ours, [Value("x", 1)])
    assert texts(view) == [["a", "1.0", "not reproduced"], ["b", "not printed", "2.0"]]
    assert [group.label for group in view.groups] == ["", "Not in the printed table"]


def test_bounds_and_empty_prints():
    printed = pd.DataFrame({"key": ["a", "b"], "p": [0.001, None], "p_is_upper_bound": [1, 0]})
    ours = pd.DataFrame({"key": ["a", "b"], "p": [0.0004, 0.25]})
    assert texts(view_of(printed, ours, [Value("p", "p")])) == [
        ["a", "<0.001", "<0.001"],
        ["b", "–", "0.250"],
    ]


def test_many_quantities_take_a_line_each():
    names = ["w", "x", "y", "z"]
    frame = pd.DataFrame({"key": ["a"], **{name: [1.0] for name in names}})
    view = view_of(frame, frame, [Value(name, 0) for name in names])
    assert texts(view)[0] == ["a", "w", "1", "1"]
    assert texts(view)[1] == ["x", "1", "1"]
    assert view.groups[0].rows[0][0].rowspan == 4


def test_repeated_headings_are_merged():
    frame = pd.DataFrame({"f": ["a", "a", "b"], "e": ["x", "y", "x"], "v": [1, 2, 3]})
    view = view_of(frame, frame, [Value("v", 0)], keys=("f", "e"))
    assert [row[0].text for row in view.groups[0].rows] == ["a", "y", "b"]
    assert view.groups[0].rows[0][0].rowspan == 2


def test_groups_labels_and_footnotes():
    frame = pd.DataFrame({"g": ["one", "two"], "key": ["a", "a"], "v": [1, 2]})
    view = view_of(
        frame,
        frame,
        [Value("v", 0)],
        keys=("g", "key"),
        group="g",
        labels={"one": "First", "a": "Angle"},
        unattainable=[Unattainable({"g": "two"}, "Impossible.")],
    )
    assert [group.label for group in view.groups] == ["First", "two"]
    assert view.groups[0].rows[0][0].text == "Angle"
    assert view.footnotes == (("a", "Not attainable: Impossible."),)
    assert view.groups[1].rows[0][1].note == "a"
    assert view.groups[0].rows[0][1].note == ""


def test_what_is_not_attainable_is_shown_without_a_verdict():
    printed = pd.DataFrame({"key": ["a"], "x": [1.0]})
    ours = pd.DataFrame({"key": ["a"], "x": [9.0], "se": [1.0]})
    view = view_of(
        printed,
        ours,
        [Value("x", 1, se="se")],
        unattainable=[Unattainable({"key": "a"}, "Impossible.")],
    )
    cell = view.groups[0].rows[0][3]
    assert (cell.text, cell.mark, cell.strip) == ("+8.0", "", None)


def test_words_show_both_sides_only_where_they_differ():
    printed = pd.DataFrame({"f": ["a", "b"], "x": ["yes*", "no"]})
    ours = pd.DataFrame({"f": ["a", "c"], "x": ["yes", "no"]})
    frame = compare_words(printed, ours, keys=["f"], columns=["x"])
    assert texts(word_view(frame, keys=["f"])) == [
        ["a", "yes* → yes"],
        ["b", "no → not reproduced"],
        ["c", "not printed → no"],
    ]


def test_rendered_table_has_caption_scopes_and_symbols():
    frame = pd.DataFrame({"key": ["a"], "x": [1.0], "se": [0.5]})
    view = view_of(frame, frame.assign(x=5.0), [Value("x", 1, se="se")])
    html = comparison_html(view, "Effects & <more>.")
    assert "Effects &amp; &lt;more&gt;." in html
    for part in ("<caption>", 'scope="col"', 'scope="row"', MARKS["differs"], "(differs)"):
        assert part in html


def test_listing_and_claims():
    view = listing_view(pd.DataFrame({"g": ["a_b"], "x": [1.25]}), formats={"x": 1})
    assert texts(view) == [["a_b", "1.2"]]
    claims = pd.DataFrame({"claim": ["c"], "holds_for": ["1 of 2"], "reproduced": ["partly"]})
    view = claims_view(claims)
    assert [cell.text for cell in view.head[0]] == ["Claim", "Holds for", "Reproduced"]
    assert [cell.mark for cell in view.groups[0].rows[0]] == ["", "", "borderline"]
    with pytest.raises(DesignError, match=r"expected yes, partly, no or not testable; found maybe"):
        claims_view(claims.assign(reproduced="maybe"))
    with pytest.raises(DesignError, match=r"columns of a claims table; expected 'verdict'"):
        claims_view(claims, verdict="verdict")


def test_footnote_stands_on_the_compared_quantity():
    printed = pd.DataFrame({"key": ["a"], "x": [1.0], "p": [0.5]})
    ours = printed.assign(se=1.0, attainable=0, attainable_reason="Impossible.")
    values = [Value("x", 1, se="se"), Value("p", "p")]
    frame = compare_numbers(printed, ours, keys=["key"], values=values)
    row = number_view(frame, keys=["key"], values=values).groups[0].rows[0]
    assert [cell.note for cell in row] == ["", "a", "", "", "", ""]
    assert summarise(frame).unattainable == 1
