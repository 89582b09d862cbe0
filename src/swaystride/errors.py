"""Errors that a person can act on: one line with file, place, expected and found."""

from __future__ import annotations

from pathlib import Path


class SwaystrideError(Exception):
    """Base of every error that this library raises on purpose.

    Parameters
    ----------
    problem : str
        What is wrong, in plain words.
    file : path or str, optional
        The file in which it was found.
    place : str, optional
        Where in the file: line, column, key, trial.
    expected, found : str, optional
        What would have been right, and what stands there instead.

    Examples
    --------
    >>> print(RecordingError("no sampling rate", file="P01.txt", place="header",
    ...                      expected="'// Update Rate:' or the argument rate_hz", found="neither"))
    P01.txt: header: no sampling rate; expected '// Update Rate:' or the argument rate_hz; found neither
    """

    def __init__(
        self,
        problem: str,
        *,
        file: Path | str | None = None,
        place: str | None = None,
        expected: str | None = None,
        found: str | None = None,
    ) -> None:
        self.problem = problem
        self.file = None if file is None else str(file)
        self.place = place
        self.expected = expected
        self.found = found
        super().__init__(str(self))

    def __str__(self) -> str:
        where = [part for part in (self.file, self.place) if part]
        line = ": ".join([*where, self.problem])
        if self.expected is not None:
            line += f"; expected {self.expected}"
        if self.found is not None:
            line += f"; found {self.found}"
        return " ".join(line.split())


class RecordingError(SwaystrideError):
    """A recording cannot be read, or is not what it claims to be."""


class DesignError(SwaystrideError):
    """A study table (participants.tsv, trials.tsv, …) contradicts itself or its files."""


class ConfigurationError(SwaystrideError):
    """A configuration file has an unknown key, a missing key or a value out of range."""


class ModelError(SwaystrideError):
    """A statistical model cannot be formulated or fitted as asked."""
