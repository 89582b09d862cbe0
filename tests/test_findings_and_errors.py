"""Findings as data, errors as one line."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from swaystride import errors
from swaystride.findings import FINDING_COLUMNS, Finding, findings_from_json, findings_to_json

TEXTS = st.text(max_size=20)
FINDINGS = st.builds(
    Finding, TEXTS, st.sampled_from(["info", "warning", "error"]), TEXTS, TEXTS, TEXTS, TEXTS
)


@given(st.lists(FINDINGS, max_size=5))
def test_findings_survive_json_in_their_order(findings: list[Finding]) -> None:
    assert findings_from_json(findings_to_json(findings)) == findings


def test_the_columns_are_the_fields() -> None:
    assert tuple(Finding.__dataclass_fields__) == FINDING_COLUMNS


def test_json_stays_readable() -> None:
    text = findings_to_json([Finding("a", "info", "f", "", "9.8 m/s²", "1 g")])
    assert "m/s²" in text


def test_a_finding_becomes_an_error_of_one_line() -> None:
    finding = Finding("packet_loss", "error", "a.txt", "line 3", "no gap", "4 packets")
    assert str(finding.as_error()) == "a.txt: line 3: packet loss; expected no gap; found 4 packets"
    assert str(finding.as_error("too many lost")).startswith("a.txt: line 3: too many lost;")
    nowhere = Finding("packet_loss", "error", "a.txt", "", "no gap", "4 packets")
    assert str(nowhere.as_error()) == "a.txt: packet loss; expected no gap; found 4 packets"


@pytest.mark.parametrize(
    "kind",
    [errors.RecordingError, errors.DesignError, errors.ConfigurationError, errors.ModelError],
)
def test_every_error_is_ours_and_one_line(kind: type[errors.SwaystrideError]) -> None:
    error = kind(
        "bad\nthing", file=Path("raw") / "a.tsv", place="row 2", expected="x", found="y\nz"
    )
    assert isinstance(error, errors.SwaystrideError)
    assert str(error) == "raw/a.tsv: row 2: bad thing; expected x; found y z"
    assert (error.file, error.place, error.expected) == ("raw/a.tsv", "row 2", "x")


def test_parts_that_are_not_given_are_left_out() -> None:
    assert str(errors.SwaystrideError("alone")) == "alone"
    assert str(errors.SwaystrideError("with place", place="row 2")) == "row 2: with place"
