"""Page texts: read, checked, and refused with the place in the file."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from swaystride.errors import ConfigurationError
from swaystride.report.page_text import load_page_text

README = Path(__file__).resolve().parents[2] / "workflow" / "report" / "README.md"


def good():
    return {
        "title": "Balance",
        "source": "chapter 2",
        "question": "Does it?",
        "design": ["Nineteen people."],
        "labels": {"x": "X"},
        "items": [
            {
                "id": "table_1",
                "kind": "table",
                "title": "Table 1",
                "caption": "Effects.",
                "file": "tables/table_1.csv",
                "printed": "table_1.csv",
                "keys": ["g", "k"],
                "group": "g",
                "values": [
                    {"estimate": "b", "format": 3, "ci": ["low", "high"], "confidence": 0.95}
                ],
                "unattainable": [{"where": {"k": 0.4}, "reason": "No."}],
                "labels": {"k": "Key"},
            },
            {
                "id": "figure_1",
                "kind": "figure",
                "title": "Figure 1",
                "caption": "Sway.",
                "alt": "A line.",
                "file": "figures/figure_1",
            },
        ],
    }


def load(tmp_path, content):
    file = tmp_path / "balance.yaml"
    text = content if isinstance(content, str) else yaml.safe_dump(content)
    file.write_text(text, encoding="utf-8")
    return load_page_text(file)


def test_good_text_is_read(tmp_path):
    text = load(tmp_path, good())
    table, figure = text.items
    assert table.values[0].ci == ("low", "high")
    assert table.labels == {"x": "X", "k": "Key"}
    assert table.unattainable[0].where == {"k": "0.4"}
    assert figure.alt == "A line."


def change(path, value):
    """Copy of the good text with one entry set, or removed if value is None."""
    content = good()
    place = content
    for part in path[:-1]:
        place = place[part]
    if value is None:
        del place[path[-1]]
    else:
        place[path[-1]] = value
    return content


@pytest.mark.parametrize(
    ("path", "value", "line"),
    [
        (("question",), None, "top level: page text; expected the key 'question'; found no such"),
        (("title",), "", "title: page text; expected some text; found an empty text"),
        (("author",), "x", "top level: page text; expected only title, .*; found author"),
        (("design",), "text", "design: page text; expected type array; found 'text'"),
        (("items", 0, "kind"), "tabel", r"items\[0\].kind: .* one of table, .*; found 'tabel'"),
        (("items", 1, "alt"), None, r"items\[1\] \(figure_1\): .* the key 'alt'; found no such"),
        (("items", 0, "id"), "Table 1", r"items\[0\].id: .* lower-case letters, .* 'Table 1'"),
        (("items", 0, "groups"), "g", r"items\[0\] \(table_1\): .* expected only .*; found groups"),
        (("items", 0, "group"), "q", r"items\[0\] \(table_1\).group: .* one of the keys g, k"),
        (
            ("items", 0, "values", 0, "format"),
            "3 digits",
            r"items\[0\] \(table_1\): column format; .* found '3 digits'",
        ),
        (
            ("items", 0, "values", 0, "confidence"),
            95,
            r"items\[0\].values\[0\].confidence \(table_1\): .* exclusiveMaximum 1; found 95",
        ),
        (("items", 1, "id"), "table_1", "item occurs twice; found table_1"),
    ],
)
def test_wrong_text_is_refused_with_its_place(tmp_path, path, value, line):
    with pytest.raises(ConfigurationError, match=rf"^balance.yaml: {line}"):
        load(tmp_path, change(path, value))


def test_keys_are_unique_texts(tmp_path):
    with pytest.raises(ConfigurationError, match=r"line 2: key 'title' stands twice"):
        load(tmp_path, "title: a\ntitle: b\n")
    with pytest.raises(ConfigurationError, match=r"line 2: key 'no' is not a text"):
        load(tmp_path, "labels:\n  no: never\n")


def test_broken_yaml_and_absent_files_are_named(tmp_path):
    with pytest.raises(ConfigurationError, match=r"balance.yaml: .* not valid YAML"):
        load(tmp_path, "a: [1\n")
    with pytest.raises(ConfigurationError, match=r"none.yaml: no such file"):
        load_page_text(tmp_path / "none.yaml")
    with pytest.raises(ConfigurationError, match=r"balance.yaml: not a mapping"):
        load(tmp_path, "- a\n")


def test_the_documented_example_is_valid(tmp_path):
    example = README.read_text(encoding="utf-8").split("```yaml\n")[1].split("```")[0]
    kinds = [item.kind for item in load(tmp_path, example).items]
    assert set(kinds) == {"table", "agreement", "listing", "claims", "figure", "assumption"}
