"""Parameter files of the studies: loading, checking, and the overlays of variants and scales."""

from __future__ import annotations

import json
from functools import cache
from typing import Any

from import_graph import REPOSITORY
from swaystride.configuration import (
    Tree,
    iter_parameters,
    load_yaml,
    overlay,
    plain_values,
    validate,
)
from swaystride.errors import ConfigurationError

SCHEMAS = REPOSITORY / "workflow" / "schemas"

#: Stages of a study, in order. A variant names the first one that it changes.
STAGES = ("metrics", "models")

#: Section of the parameters -> the first stage that uses it. Others belong to all variants.
STAGE_OF_SECTION = {
    "analysis.measurement": "metrics",
    "analysis.optics": "metrics",
    "analysis.erkf": "metrics",
    "analysis.zero_velocity": "metrics",
    "analysis.measures": "metrics",
    "analysis.events": "metrics",
    "analysis.trajectory": "metrics",
    "analysis.perturbation": "metrics",
    "analysis.model": "models",
}

#: The variant whose results the others share up to their first own stage.
BASE_VARIANT = "printed"


@cache
def load_study(study: str) -> Tree:
    """Read and check the parameter file of a study, its variants and scales included."""
    file = f"config/studies/{study}.yaml"
    tree = load_yaml(REPOSITORY / file)
    schema = load_yaml(SCHEMAS / f"{study}.schema.yaml")
    validate(tree, schema, file=file)
    for name, variant in tree["variants"].items():
        for path in variant["changes"]:
            stage = STAGE_OF_SECTION.get(".".join(path.split(".")[:2]))
            if stage is None or STAGES.index(stage) < STAGES.index(variant["first_stage"]):
                raise ConfigurationError(
                    f"{path!r} is used before the variant begins",
                    file=file,
                    place=f"variants.{name}",
                    expected=f"first_stage {stage}"
                    if stage
                    else "a parameter of " + " or ".join(STAGE_OF_SECTION),
                    found=f"first_stage {variant['first_stage']}",
                )
    for kind in ("variants", "scales"):
        for name in tree[kind]:
            changed = _apply(tree, kind, name, file)
            validate(_without_marks({**tree, **changed}), schema, file=f"{file} ({name})")
    return tree


@cache
def resolve(study: str, variant: str, scale: str) -> Tree:
    """Parameter sections of a study under a variant and a scale."""
    file = f"config/studies/{study}.yaml"
    tree = load_study(study)
    scaled = {**tree, **_apply(tree, "scales", scale, file)}
    return _apply(scaled, "variants", variant, file)


def _apply(tree: Tree, kind: str, name: str, file: str) -> Tree:
    """Sections ``analysis`` and ``simulation`` with one overlay applied."""
    sections = {section: tree[section] for section in ("analysis", "simulation")}
    return overlay(sections, tree[kind][name].get("changes", {}), file=file, name=name)


def _without_marks(tree: Tree) -> Tree:
    """Drop what an overlay adds to a parameter beyond its schema."""
    plain: Tree = json.loads(json.dumps(tree))
    for _, parameter in iter_parameters({k: plain[k] for k in ("analysis", "simulation")}):
        parameter.pop("changed_by", None)
    return plain


def sections_json(tree: Tree, sections: tuple[str, ...]) -> str:
    """Plain values of some sections as JSON, each under the last part of its path."""
    values = plain_values(tree)
    chosen: Tree = {}
    for section in sections:
        node: Any = values
        for part in section.split("."):
            node = node[part]
        chosen[section.rsplit(".", 1)[-1]] = node
    return json.dumps(chosen, sort_keys=True)
