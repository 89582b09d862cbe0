"""What a caller knows about a recording that its file may not say."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, get_args

import numpy as np

from swaystride.errors import RecordingError
from swaystride.units import FACTORS_TO_SI

DuplicatePackets = Literal["error", "keep_first"]

#: Signal name in a recording -> quantity in :data:`swaystride.units.FACTORS_TO_SI`.
QUANTITY_OF = {"acc": "acceleration", "gyr": "angular_rate", "mag": "magnetic_field"}

#: Sampling rates from two sources agree within this share of each other.
RATE_TOLERANCE = 1e-3


@dataclass(frozen=True)
class ReadHints:
    """Arguments of :func:`swaystride.io.reading.read_recording`, checked.

    Parameters
    ----------
    rate_hz : float, optional
        Sampling rate.
    units : mapping of str to str
        Unit of ``acc``, ``gyr``, ``mag`` as spelled in :data:`swaystride.units.FACTORS_TO_SI`.
    sensors : tuple of str
        Label of the sensor (formats with one sensor), or labels to keep (several sensors).
    duplicate_packets : {"error", "keep_first"}
        What to do with rows that repeat the packet counter of the row before.

    Examples
    --------
    >>> ReadHints(units={"acc": "furlong"})
    Traceback (most recent call last):
    ...
    swaystride.errors.RecordingError: argument units: unknown unit of acc; expected one of m/s^2, m/s², m/s2, g, mg; found 'furlong'
    """

    rate_hz: float | None = None
    units: Mapping[str, str] = field(default_factory=dict)
    sensors: tuple[str, ...] = ()
    duplicate_packets: DuplicatePackets = "error"

    def __post_init__(self) -> None:
        if self.rate_hz is not None and not (np.isfinite(self.rate_hz) and self.rate_hz > 0):
            raise RecordingError(
                "the sampling rate is not a positive number",
                place="argument rate_hz",
                expected="rate_hz > 0",
                found=str(self.rate_hz),
            )
        if self.duplicate_packets not in get_args(DuplicatePackets):
            raise RecordingError(
                "unknown choice",
                place="argument duplicate_packets",
                expected=" or ".join(get_args(DuplicatePackets)),
                found=repr(self.duplicate_packets),
            )
        for signal, unit in self.units.items():
            if signal not in QUANTITY_OF:
                raise RecordingError(
                    "unknown signal",
                    place="argument units",
                    expected="one of " + ", ".join(QUANTITY_OF),
                    found=repr(signal),
                )
            accepted = FACTORS_TO_SI[QUANTITY_OF[signal]]
            if unit not in accepted:
                raise RecordingError(
                    f"unknown unit of {signal}",
                    place="argument units",
                    expected="one of " + ", ".join(accepted),
                    found=repr(unit),
                )

    def require_units(self, signals: tuple[str, ...], *, file: str) -> dict[str, str]:
        """Units of signals that a format does not state.

        Raises
        ------
        RecordingError
            If the argument `units` lacks one of them.
        """
        missing = [signal for signal in signals if signal not in self.units]
        if missing:
            example = ", ".join(
                f"'{signal}': '{next(iter(FACTORS_TO_SI[QUANTITY_OF[signal]]))}'"
                for signal in missing
            )
            raise RecordingError(
                "the file does not state its units",
                file=file,
                expected=f"the argument units with {', '.join(missing)}, such as {{{example}}}",
                found="units of " + (", ".join(self.units) or "nothing"),
            )
        return {signal: self.units[signal] for signal in signals}

    def confirm_units(self, units_of_file: Mapping[str, str], *, file: str) -> None:
        """Compare the argument `units` with what the file or its vendor states.

        Raises
        ------
        RecordingError
            If they contradict each other, or the file states a unit that is not known.
        """
        for signal, stated in units_of_file.items():
            argued = self.units.get(signal, stated)
            factors = FACTORS_TO_SI[QUANTITY_OF[signal]]
            if stated not in factors:
                raise RecordingError(
                    f"unknown unit of {signal}",
                    file=file,
                    expected="one of " + ", ".join(factors),
                    found=repr(stated),
                )
            same = factors[argued] == factors[stated] and (argued == "a.u.") == (stated == "a.u.")
            if not same:
                raise RecordingError(
                    f"the argument units contradicts the unit of {signal}",
                    file=file,
                    expected=f"{stated}, as the file or its vendor defines it",
                    found=argued,
                )


def rates_agree(first_hz: float, second_hz: float, tolerance: float = RATE_TOLERANCE) -> bool:
    """Tell whether two rates agree within a relative tolerance.

    Parameters
    ----------
    first_hz, second_hz : float
        Two statements of one rate.

    Examples
    --------
    >>> rates_agree(100.0, 100.05), rates_agree(100.0, 102.4)
    (True, False)
    """
    return bool(abs(first_hz - second_hz) <= tolerance * max(first_hz, second_hz))
