"""Configuration: every number with its unit and source, checked against a schema, with overlays.

A study file (``config/studies/<study>.yaml``) is a tree whose leaves are *parameters*::

    cutoff_hz: {value: 2.0, unit: Hz, source: "D§2.3.3"}

A *variant* or a *scale* replaces the values of named parameters (dotted paths) and says why. The
resolved tree is what the workflow hands to the scripts, as plain values.
"""

from __future__ import annotations

import copy
import difflib
import json
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any, TypeVar

import yaml
from jsonschema import Draft202012Validator
from jsonschema.exceptions import ValidationError

from swaystride.errors import ConfigurationError

Tree = dict[str, Any]
T = TypeVar("T")


class _UniqueKeyLoader(yaml.CSafeLoader):
    """YAML loader that refuses a key that stands twice in one mapping; ten times as fast in C."""


def _mapping_without_duplicates(loader: yaml.CSafeLoader, node: yaml.MappingNode) -> Tree:
    seen: set[str] = set()
    for key_node, _ in node.value:
        if key_node.tag != "tag:yaml.org,2002:str":
            raise ConfigurationError(
                f"key {key_node.value!r} is not a text",
                place=f"line {key_node.start_mark.line + 1}",
                expected=f'"{key_node.value}" in quotes',
            )
        if key_node.value in seen:
            raise ConfigurationError(
                f"key {key_node.value!r} stands twice",
                place=f"line {key_node.start_mark.line + 1}",
                expected="each key once",
            )
        seen.add(key_node.value)
    return dict(loader.construct_pairs(node, deep=True))


_UniqueKeyLoader.add_constructor(
    yaml.resolver.BaseResolver.DEFAULT_MAPPING_TAG, _mapping_without_duplicates
)


def load_yaml(path: Path | str) -> Tree:
    """Read the YAML mapping at `path`; duplicate keys and syntax errors name file and line.

    Raises
    ------
    ConfigurationError
        If the file is missing, is not YAML, or is not a mapping.
    """
    path = Path(path)
    if not path.is_file():
        raise ConfigurationError("no such file", file=path)
    try:
        tree = yaml.load(path.read_text(encoding="utf-8"), _UniqueKeyLoader)
    except ConfigurationError as error:
        raise ConfigurationError(
            error.problem, file=path, place=error.place, expected=error.expected
        ) from None
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f"line {mark.line + 1}" if mark else None
        problem = getattr(error, "problem", None) or "cannot be parsed"
        raise ConfigurationError(f"not valid YAML: {problem}", file=path, place=place) from None
    if not isinstance(tree, dict):
        raise ConfigurationError("not a mapping", file=path, expected="keys and values")
    return tree


def validate(tree: Mapping[str, Any], schema: Mapping[str, Any], *, file: Path | str) -> None:
    """Check a tree against a JSON schema.

    Parameters
    ----------
    tree : mapping
        The configuration as loaded.
    schema : mapping
        JSON schema (draft 2020-12).
    file : path or str
        Named in the error.

    Raises
    ------
    ConfigurationError
        For the first fault in the order of the file: which key, what would be right, what stands
        there; with a suggestion for a misspelt key.

    Examples
    --------
    >>> schema = {"type": "object", "additionalProperties": False,
    ...           "properties": {"seed": {"type": "integer", "minimum": 0}}}
    >>> validate({"sead": 1}, schema, file="config.yaml")
    Traceback (most recent call last):
    ...
    swaystride.errors.ConfigurationError: config.yaml: unknown key 'sead'; expected 'seed'
    >>> validate({"seed": -1}, schema, file="config.yaml")
    Traceback (most recent call last):
    ...
    swaystride.errors.ConfigurationError: config.yaml: seed: value out of range; expected at least 0; found -1
    """
    faults = sorted(
        Draft202012Validator(schema).iter_errors(tree), key=lambda fault: list(map(str, fault.path))
    )
    if faults:
        raise _readable(_innermost(faults[0]), file)


def _innermost(fault: ValidationError) -> ValidationError:
    """The deepest cause of a failed ``anyOf``, which says more than the alternative itself."""
    while fault.context:
        fault = max(fault.context, key=lambda cause: len(cause.path))
    return fault


def _readable(fault: ValidationError, file: Path | str) -> ConfigurationError:
    """Say a schema fault in the words of someone who edits the file."""
    place = ".".join(str(part) for part in fault.absolute_path) or None
    problem: str
    expected: str | None
    found: str | None = json.dumps(fault.instance, ensure_ascii=False)
    rule: Any = fault.validator_value
    schema: Any = fault.schema
    instance: Any = fault.instance
    match fault.validator:
        case "additionalProperties":
            known = sorted(schema.get("properties", {}))
            unknown = sorted(set(instance) - set(known))[0]
            near = difflib.get_close_matches(unknown, known, n=1)
            expected = repr(near[0]) if near else "one of " + ", ".join(known)
            return ConfigurationError(
                f"unknown key {unknown!r}", file=file, place=place, expected=expected
            )
        case "required":
            missing = sorted(set(rule) - set(instance))[0]
            about = schema.get("properties", {}).get(missing, {}).get("description")
            return ConfigurationError(
                f"key {missing!r} is missing", file=file, place=place, expected=about
            )
        case "type":
            wanted = rule if isinstance(rule, str) else " or ".join(rule)
            problem, expected = "wrong type", wanted
        case "enum":
            problem, expected = "unknown value", "one of " + ", ".join(map(json.dumps, rule))
        case "const":
            problem, expected = "wrong value", json.dumps(rule, ensure_ascii=False)
        case "minimum":
            problem, expected = "value out of range", f"at least {rule:g}"
        case "maximum":
            problem, expected = "value out of range", f"at most {rule:g}"
        case "exclusiveMinimum":
            problem, expected = "value out of range", f"more than {rule:g}"
        case "exclusiveMaximum":
            problem, expected = "value out of range", f"less than {rule:g}"
        case "minLength" | "minItems" | "minProperties":
            problem, expected = "empty or too short", f"at least {rule}"
        case "pattern":
            problem, expected = "wrong form", f"the pattern {rule}"
        case _:
            problem, expected, found = fault.message, None, None
    return ConfigurationError(problem, file=file, place=place, expected=expected, found=found)


def is_parameter(node: object) -> bool:
    """Whether a `node` of the tree is a parameter: a mapping with value, unit and source."""
    return isinstance(node, Mapping) and "value" in node and "source" in node


def iter_parameters(tree: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Tree]]:
    """Yield the dotted path and the parameter of every leaf, in the order of the file.

    Parameters
    ----------
    tree : mapping
        Parameters, nested.
    prefix : str
        Put before every path.

    Examples
    --------
    >>> tree = {"filter": {"cutoff_hz": {"value": 2.0, "unit": "Hz", "source": "D§2.3.3"}}}
    >>> [path for path, _ in iter_parameters(tree)]
    ['filter.cutoff_hz']
    """
    for key, node in tree.items():
        path = f"{prefix}{key}"
        if is_parameter(node):
            yield path, node
        elif isinstance(node, Mapping):
            yield from iter_parameters(node, f"{path}.")


def overlay(
    tree: Mapping[str, Any],
    changes: Mapping[str, Mapping[str, Any]],
    *,
    file: Path | str,
    name: str,
) -> Tree:
    """Replace the values of named parameters.

    Parameters
    ----------
    tree : mapping
        Parameters, nested.
    changes : mapping
        Dotted path of a parameter to ``{value, source}``. The unit cannot change.
    file, name : str
        File, and variant or scale, named in errors.

    Returns
    -------
    dict
        A copy; changed leaves carry ``changed_by``.

    Raises
    ------
    ConfigurationError
        If a path does not name a parameter.
    """
    result = copy.deepcopy(dict(tree))
    known = [path for path, _ in iter_parameters(result)]
    for path, change in changes.items():
        if path not in known:
            near = difflib.get_close_matches(path, known, n=1)
            raise ConfigurationError(
                f"{path!r} is not a parameter",
                file=file,
                place=name,
                expected=repr(near[0]) if near else "the dotted path of a parameter",
            )
        node: Any = result
        for part in path.split("."):
            node = node[part]
        node.update(value=change["value"], source=change["source"], changed_by=name)
    return result


def plain_values(tree: Mapping[str, Any]) -> Tree:
    """Strip units and sources from `tree`: the values that a script receives.

    Examples
    --------
    >>> plain_values({"filter": {"order": {"value": 2, "unit": "1", "source": "D§2.3.3"}}})
    {'filter': {'order': 2}}
    """
    return {
        key: node["value"] if is_parameter(node) else plain_values(node)
        for key, node in tree.items()
    }


def from_mapping(cls: type[T], values: Mapping[str, Any], *, place: str) -> T:
    """Build a frozen parameter dataclass from plain values, strictly.

    Parameters
    ----------
    cls : dataclass type
        Its fields are the keys; lists become tuples.
    values : mapping
        Plain values.
    place : str
        Section of the configuration, named in errors.

    Raises
    ------
    ConfigurationError
        If keys and fields differ.
    """
    assert is_dataclass(cls)
    names = {field.name for field in fields(cls)}
    if names != set(values):
        raise ConfigurationError(
            "keys do not match what the code takes",
            place=place,
            expected=", ".join(sorted(names)),
            found=", ".join(sorted(values)),
        )
    frozen = {key: tuple(v) if isinstance(v, list) else v for key, v in values.items()}
    return cls(**frozen)
