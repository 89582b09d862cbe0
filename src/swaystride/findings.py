"""Findings: what the checks of a recording saw, kept as data beside the results."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from typing import Any, Literal

from swaystride.errors import RecordingError

Severity = Literal["info", "warning", "error"]

FINDING_COLUMNS = ("check", "severity", "file", "place", "expected", "found")


@dataclass(frozen=True)
class Finding:
    """One observation of one check.

    Parameters
    ----------
    check : str
        Name of the check, snake_case, for example ``packet_loss``.
    severity : {"info", "warning", "error"}
        An ``error`` stops the unit; a ``warning`` is listed in the report.
    file : str
        Name of the file, as a lab would recognise it (no machine-specific folder).
    place : str
        Line, column, sensor or time inside the file; empty if the whole file is meant.
    expected, found : str
        What the check asked for and what it saw.

    Examples
    --------
    >>> finding = Finding("packet_loss", "warning", "P01_01.txt", "t = 3.20 s", "no gap", "4 packets")
    >>> finding.severity
    'warning'
    """

    check: str
    severity: Severity
    file: str
    place: str
    expected: str
    found: str

    def as_error(self, problem: str | None = None) -> RecordingError:
        """Turn the finding into the error that stops its unit."""
        return RecordingError(
            problem or self.check.replace("_", " "),
            file=self.file,
            place=self.place or None,
            expected=self.expected,
            found=self.found,
        )


def findings_to_json(findings: Iterable[Finding]) -> str:
    """Serialise findings, in their order, for the attributes of a recording."""
    return json.dumps([asdict(finding) for finding in findings], ensure_ascii=False)


def findings_from_json(text: str) -> list[Finding]:
    """Read back what :func:`findings_to_json` wrote.

    Parameters
    ----------
    text : str
        JSON list.

    Examples
    --------
    >>> findings_from_json("[]")
    []
    """
    rows: list[Mapping[str, Any]] = json.loads(text)
    return [Finding(**row) for row in rows]
