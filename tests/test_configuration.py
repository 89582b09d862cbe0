"""Configuration: readable errors, overlays, and schemas that agree with the files."""

from dataclasses import dataclass

import pytest

from import_graph import REPOSITORY
from project import Project
from study_parameters import SCHEMAS, load_study, resolve
from swaystride.configuration import (
    from_mapping,
    iter_parameters,
    load_yaml,
    overlay,
    plain_values,
    validate,
)
from swaystride.errors import ConfigurationError

STUDIES = sorted(path.stem for path in (REPOSITORY / "config" / "studies").glob("*.yaml"))
CONFIG = load_yaml(REPOSITORY / "config" / "config.yaml")
TREE = {"filter": {"cutoff_hz": {"value": 2.0, "unit": "Hz", "source": "D§2.3.3"}}}


def write(tmp_path, text):
    path = tmp_path / "study.yaml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("a: 1\na: 2\n", "key 'a' stands twice"),
        ("a: [1\n", "not valid YAML"),
        ("- a\n", "not a mapping"),
    ],
)
def test_unusable_yaml_is_one_line_with_the_file(tmp_path, text, line):
    with pytest.raises(ConfigurationError) as caught:
        load_yaml(write(tmp_path, text))
    assert line in str(caught.value)
    assert "study.yaml" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(ConfigurationError, match=r"absent\.yaml: no such file"):
        load_yaml(tmp_path / "absent.yaml")


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"sead": 1}, "config.yaml: unknown key 'sead'; expected 'seed'"),
        ({"seed": "one"}, 'config.yaml: seed: wrong type; expected integer; found "one"'),
        ({"seed": -1}, "config.yaml: seed: value out of range; expected at least 0; found -1"),
        ({"studies": ["balance"]}, 'studies.0: unknown value; expected one of "feedback"'),
        ({"cohort": "nowhere"}, "cohort: unknown cohort; expected one of synthetic"),
        ({"cohorts": {"lab": {"simulated": False}}}, "cohorts.lab: key 'folder' is missing"),
    ],
)
def test_a_wrong_key_says_what_would_be_right(changes, expected):
    with pytest.raises(ConfigurationError) as caught:
        Project({**CONFIG, **changes})
    assert expected in str(caught.value)


def test_a_missing_key_is_explained():
    config = {key: value for key, value in CONFIG.items() if key != "seed"}
    with pytest.raises(ConfigurationError, match=r"key 'seed' is missing; expected root of all"):
        Project(config)


def test_an_overlay_replaces_a_value_and_keeps_unit_and_original():
    change = {"filter.cutoff_hz": {"value": 3.0, "source": "D§3.3"}}
    changed = overlay(TREE, change, file="study.yaml", name="recommended")
    assert plain_values(changed) == {"filter": {"cutoff_hz": 3.0}}
    assert changed["filter"]["cutoff_hz"]["unit"] == "Hz"
    assert changed["filter"]["cutoff_hz"]["changed_by"] == "recommended"
    assert plain_values(TREE) == {"filter": {"cutoff_hz": 2.0}}


def test_an_overlay_of_an_unknown_parameter_suggests_the_right_one():
    change = {"filter.cutof_hz": {"value": 3.0, "source": "D§3.3"}}
    with pytest.raises(ConfigurationError, match=r"not a parameter; expected 'filter.cutoff_hz'"):
        overlay(TREE, change, file="study.yaml", name="recommended")


def test_parameters_fill_a_dataclass_strictly():
    @dataclass(frozen=True)
    class Filter:
        cutoff_hz: float

    assert from_mapping(Filter, {"cutoff_hz": 2.0}, place="filter") == Filter(2.0)
    with pytest.raises(ConfigurationError, match="expected cutoff_hz; found cutoff"):
        from_mapping(Filter, {"cutoff": 2.0}, place="filter")


@pytest.mark.parametrize("study", STUDIES)
def test_every_parameter_has_a_unit_and_a_source(study):
    tree = load_study(study)
    parameters = dict(iter_parameters({k: tree[k] for k in ("analysis", "simulation")}))
    assert len(parameters) > 20
    for path, parameter in parameters.items():
        assert set(parameter) == {"value", "unit", "source"}, path


@pytest.mark.parametrize("study", STUDIES)
def test_schema_and_defaults_do_not_drift_apart(study):
    """Every key of the schema is required and used, and every section forbids others."""
    schema = load_yaml(SCHEMAS / f"{study}.schema.yaml")
    tree = load_study(study)

    def walk(rules, node, place):
        if "properties" in rules and "$ref" not in rules:
            assert rules["additionalProperties"] is False, place
            assert set(rules["required"]) == set(rules["properties"]) == set(node), place
            for key, rule in rules["properties"].items():
                walk(rule, node[key], f"{place}.{key}")
        else:
            assert rules.get("description"), f"{place} has no description"

    for section in ("analysis", "simulation"):
        walk(schema["properties"][section], tree[section], section)


@pytest.mark.parametrize("study", STUDIES)
def test_an_unknown_key_in_any_section_is_refused(study):
    schema = load_yaml(SCHEMAS / f"{study}.schema.yaml")
    tree = load_study(study)
    for section in ("analysis", "simulation"):
        for name in tree[section]:
            spoilt = {**tree, section: {**tree[section], name: {**tree[section][name], "zzz": 1}}}
            with pytest.raises(ConfigurationError, match="unknown key 'zzz'"):
                validate(spoilt, schema, file="study.yaml")


@pytest.mark.parametrize("study", STUDIES)
def test_variants_and_scales_resolve(study):
    tree = load_study(study)
    for variant in tree["variants"]:
        for scale in tree["scales"]:
            resolved = resolve(study, variant, scale)
            changed = [p for p, leaf in iter_parameters(resolved) if "changed_by" in leaf]
            named = {*tree["variants"][variant]["changes"], *tree["scales"][scale]["changes"]}
            assert set(changed) == named
