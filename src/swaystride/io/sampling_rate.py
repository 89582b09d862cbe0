"""The sampling rate of a file: header, time stamps and argument must not contradict each other."""

from __future__ import annotations

from typing import NamedTuple

from swaystride.errors import RecordingError
from swaystride.findings import Finding
from swaystride.io.hints import RATE_TOLERANCE, ReadHints, rates_agree


class SamplingRate(NamedTuple):
    """A rate, where it was learnt, and what the comparison of the sources saw."""

    rate_hz: float
    source: str
    findings: list[Finding]


def resolve_rate(
    hints: ReadHints,
    *,
    file: str,
    header_hz: float | None,
    header_place: str,
    measured_hz: float | None,
    measured_tolerance: float = RATE_TOLERANCE,
) -> SamplingRate:
    """Settle the sampling rate; it is never guessed.

    The header wins over time stamps, which win over the argument.

    Parameters
    ----------
    hints : ReadHints
    file : str
        Name for errors and findings.
    header_hz : float or None
        Rate that the file states.
    header_place : str
        Where the format states its rate, for errors.
    measured_hz : float or None
        Rate that its time stamps show.
    measured_tolerance : float
        Relative uncertainty of the measured rate, at least that of every comparison.

    Returns
    -------
    SamplingRate
        With a warning ``sampling_rate`` if header and time stamps contradict each other.

    Raises
    ------
    RecordingError
        If there is no rate at all, or the argument contradicts the file.

    Examples
    --------
    >>> resolve_rate(ReadHints(rate_hz=50.0), file="a.txt", header_hz=100.0,
    ...              header_place="line 2", measured_hz=None)
    Traceback (most recent call last):
    ...
    swaystride.errors.RecordingError: a.txt: line 2: the argument rate_hz contradicts the file; expected 100 Hz; found 50 Hz
    """
    tolerance = max(RATE_TOLERANCE, measured_tolerance)
    findings = []
    if header_hz is not None:
        rate, source, place, limit = header_hz, "header", header_place, RATE_TOLERANCE
        if measured_hz is not None and not rates_agree(header_hz, measured_hz, tolerance):
            findings.append(
                Finding(
                    "sampling_rate",
                    "warning",
                    file,
                    header_place,
                    f"time stamps at the stated {header_hz:.7g} Hz",
                    f"time stamps at {measured_hz:.7g} Hz",
                )
            )
    elif measured_hz is not None:
        rate, source, place, limit = measured_hz, "time stamps", "time stamps", tolerance
    elif hints.rate_hz is not None:
        return SamplingRate(hints.rate_hz, "argument", [])
    else:
        raise RecordingError(
            "no sampling rate",
            file=file,
            place="header",
            expected=f"{header_place} or the argument rate_hz",
            found="neither",
        )
    if hints.rate_hz is not None and not rates_agree(hints.rate_hz, rate, limit):
        raise RecordingError(
            "the argument rate_hz contradicts the file",
            file=file,
            place=place,
            expected=f"{rate:.7g} Hz",
            found=f"{hints.rate_hz:.7g} Hz",
        )
    return SamplingRate(rate, source, findings)
