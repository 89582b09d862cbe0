"""The words of a study's page, read from a YAML file and checked before anything is drawn.

The keys are described in ``workflow/report/README.md``; ``page_text.json`` is the schema.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from jsonschema import Draft202012Validator
from jsonschema.exceptions import ValidationError

from swaystride.configuration import load_yaml
from swaystride.errors import ConfigurationError
from swaystride.presentation.number_format import parse_format
from swaystride.report.attainability import Unattainable
from swaystride.report.comparison import Value


@dataclass(frozen=True)
class ItemText:
    """Words and wiring of one table or figure.

    Parameters
    ----------
    id, kind, title, caption : str
        Identifier; ``table``, ``agreement``, ``listing``, ``claims``, ``figure`` or
        ``assumption``; heading; caption.
    file : str
        The result, relative to the folder of the variant: a CSV, or a figure without suffix.
    printed : str
        File in ``data/published``; empty without a printed counterpart.
    alt : str
        Words for those who do not see the figure.
    keys, columns : tuple of str
        Key columns; columns of words (agreement) or shown columns (listing, claims).
    group : str or None
        Key whose values become headings.
    values : tuple of Value
        Quantities of a ``table``.
    unattainable : tuple of Unattainable
        Printed values that cannot be had.
    verdict : str
        Column of a claims table that says yes, partly, no or not testable.
    formats, labels : mapping
        Column formats of a listing; words for identifiers.
    notes : tuple of str
        Remarks below.
    simulated_only : bool
        Whether only simulated cohorts have the result.
    """

    id: str
    kind: str
    title: str
    caption: str
    file: str
    printed: str = ""
    alt: str = ""
    keys: tuple[str, ...] = ()
    columns: tuple[str, ...] = ()
    group: str | None = None
    values: tuple[Value, ...] = ()
    unattainable: tuple[Unattainable, ...] = ()
    verdict: str = "reproduced"
    formats: Mapping[str, str | int] = field(default_factory=dict)
    labels: Mapping[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    simulated_only: bool = False


@dataclass(frozen=True)
class PageText:
    """Words of a page.

    Parameters
    ----------
    title, source, question : str
        Heading; where the study is printed; what it asks.
    design : tuple of str
        Paragraphs.
    items : tuple of ItemText
        Tables and figures in the order of the page.
    notes : tuple of str
        Remarks on the whole study.
    """

    title: str
    source: str
    question: str
    design: tuple[str, ...]
    items: tuple[ItemText, ...]
    notes: tuple[str, ...] = ()


def load_page_text(path: Path | str) -> PageText:
    r"""Read and check the words of a page.

    Parameters
    ----------
    path : path or str
        The YAML file.

    Raises
    ------
    ConfigurationError
        With the place in the file, if a key is unknown, missing, twice or of the wrong kind.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder) / "balance.yaml"
    ...     _ = file.write_text("title: Balance\nsource: ch. 2\nquestion: Does it?\n"
    ...                         "design: [Nineteen people.]\nitems: []\n")
    ...     load_page_text(file).design
    ('Nineteen people.',)
    """
    file = Path(path)
    raw = load_yaml(file)
    _check(raw, "page", file, ())
    for position, item in enumerate(raw["items"]):
        _check(item, item["kind"], file, ("items", position))
    common = raw.get("labels", {})
    items = tuple(_item(item, common, file, n) for n, item in enumerate(raw["items"]))
    ids = [item.id for item in items]
    twice = sorted({name for name in ids if ids.count(name) > 1})
    if twice:
        raise ConfigurationError("item occurs twice", file=file.name, found=", ".join(twice))
    return PageText(
        title=raw["title"],
        source=raw["source"],
        question=raw["question"],
        design=tuple(raw["design"]),
        items=items,
        notes=tuple(raw.get("notes", ())),
    )


@cache
def _validators() -> dict[str, Draft202012Validator]:
    """One validator for the page and one for each kind of item."""
    text = files("swaystride.report").joinpath("page_text.json").read_text(encoding="utf-8")
    schema = json.loads(text)
    kinds = schema["properties"]["items"]["items"]["properties"]["kind"]["enum"]
    named = {kind: {"$defs": schema["$defs"], "$ref": f"#/$defs/{kind}"} for kind in kinds}
    return {name: Draft202012Validator(part) for name, part in ({"page": schema} | named).items()}


def _check(raw: Any, schema: str, file: Path, place: tuple[str | int, ...]) -> None:
    errors = sorted(
        _validators()[schema].iter_errors(raw),
        key=lambda error: [str(part) for part in error.absolute_path],
    )
    for error in errors:
        expected, found = _explain(error)
        where = (*place, *error.absolute_path)
        name = f" ({raw['id']})" if place and isinstance(raw.get("id"), str) else ""
        raise ConfigurationError(
            "page text",
            file=file.name,
            place=(_path(where) or "top level") + name,
            expected=expected,
            found=found,
        )


def _explain(error: ValidationError) -> tuple[str, str]:
    """Expected and found, in plain words, of one schema error."""
    found: Any = error.instance
    rule: Any = error.validator_value
    if error.validator == "required":
        missing = [name for name in rule if name not in found]
        return f"the key {missing[0]!r}", "no such key"
    if error.validator == "additionalProperties":
        schema: Any = error.schema
        known = schema["properties"]
        unknown = sorted(name for name in found if name not in known)
        return f"only {', '.join(known)}", ", ".join(unknown)
    if error.validator == "minLength":
        return "some text", "an empty text"
    if error.validator == "pattern":
        return "lower-case letters, digits and underscores", repr(found)
    if error.validator == "enum":
        return f"one of {', '.join(rule)}", repr(found)
    if error.validator == "type":
        return f"type {rule if isinstance(rule, str) else ' or '.join(rule)}", repr(found)
    return f"{error.validator} {rule}", repr(found)


def _path(parts: tuple[str | int, ...]) -> str:
    text = ""
    for part in parts:
        text += f"[{part}]" if isinstance(part, int) else f".{part}"
    return text.lstrip(".")


def _item(raw: Mapping[str, Any], common: Mapping[str, str], file: Path, number: int) -> ItemText:
    place = f"items[{number}] ({raw['id']})"
    group = raw.get("group")
    if group is not None and group not in raw["keys"]:
        raise ConfigurationError(
            "page text",
            file=file.name,
            place=f"{place}.group",
            expected=f"one of the keys {', '.join(raw['keys'])}",
            found=repr(group),
        )
    formats = raw.get("formats", {})
    for form in [*formats.values(), *(value["format"] for value in raw.get("values", ()))]:
        try:
            parse_format(form)
        except ConfigurationError as error:
            raise ConfigurationError(
                error.problem,
                file=file.name,
                place=place,
                expected=error.expected,
                found=error.found,
            ) from None
    return ItemText(
        id=raw["id"],
        kind=raw["kind"],
        title=raw["title"],
        caption=raw["caption"],
        file=raw["file"],
        printed=raw.get("printed", ""),
        alt=raw.get("alt", ""),
        keys=tuple(raw.get("keys", ())),
        columns=tuple(raw.get("columns", ())),
        group=group,
        values=tuple(_value(value) for value in raw.get("values", ())),
        unattainable=tuple(_rule(rule) for rule in raw.get("unattainable", ())),
        verdict=raw.get("verdict", "reproduced"),
        formats=formats,
        labels={**common, **raw.get("labels", {})},
        notes=tuple(raw.get("notes", ())),
        simulated_only=raw.get("simulated_only", False),
    )


def _value(raw: Mapping[str, Any]) -> Value:
    ci = raw.get("ci")
    return Value(**{**raw, "ci": None if ci is None else (ci[0], ci[1])})


def _rule(raw: Mapping[str, Any]) -> Unattainable:
    where = {name: str(value) for name, value in raw["where"].items()}
    return Unattainable(where, raw["reason"], tuple(raw.get("quantities", ())))
