"""Plain text of one sensor under a line ``Acquisition frequency: 100 Hz``.

The layout in which Voisard et al. (IPOL 2023/497) published their Xsens recordings: the frequency,
a tab-separated row of Xsens column names, and a packet counter printed as a float. The file does
not state its units, so the caller must.
"""

from __future__ import annotations

import re
from itertools import islice

import numpy as np

from swaystride.errors import RecordingError
from swaystride.findings import Finding
from swaystride.io.assembly import SensorRows, assemble, single_label
from swaystride.io.hints import QUANTITY_OF, ReadHints
from swaystride.io.sample_index import index_from_counter
from swaystride.io.sampling_rate import resolve_rate
from swaystride.io.source_text import SourceText
from swaystride.io.table import Table, split_columns
from swaystride.io.xsens_columns import KNOWN_COLUMN, PACKET_COUNTER, read_signals
from swaystride.recording import Recording

_TITLE = "Acquisition frequency:"
_RATE = re.compile(r"Acquisition frequency:\s*(\d+(?:\.\d+)?)\s*Hz")


def is_acquisition_txt(source: SourceText) -> bool:
    """Tell whether a text begins with an acquisition frequency.

    Parameters
    ----------
    source : SourceText
        Opened file.
    """
    return source.first_text().startswith(_TITLE)


def read_acquisition_txt(source: SourceText, hints: ReadHints) -> Recording:
    """Read one file of this layout.

    Parameters
    ----------
    source : SourceText
    hints : ReadHints
        Units of every signal in the file are required; the sensor labels the recording.

    Returns
    -------
    Recording
        With attribute ``first_packet`` if the file counts packets.

    Raises
    ------
    RecordingError
        See :func:`swaystride.io.reading.read_recording`.
    """
    title, row = [*islice((x for x in source.lines() if x.text.strip()), 2), None][:2]
    if title is None or row is None:
        raise RecordingError(
            "the file ends before its column row",
            file=source.name,
            expected=f"a row of column names ({PACKET_COUNTER}, Acc_X, …)",
            found=source.first_text(),
        )
    *columns, delimiter = split_columns(
        row.text, file=source.name, line=row.number, known=KNOWN_COLUMN
    )
    table = Table(source, tuple(columns), delimiter, start=row.end, first_line=row.number + 1)
    others, signals = read_signals(table, (PACKET_COUNTER,))
    in_file = tuple(signal for signal in signals if signal in QUANTITY_OF)
    units = hints.require_units(in_file, file=source.name)
    match = _RATE.match(title.text.strip())
    rate = resolve_rate(
        hints,
        file=source.name,
        header_hz=float(match[1]) if match else None,
        header_place=f"line {title.number}",
        measured_hz=None,
    )
    attributes: dict[str, str | int] = {}
    if PACKET_COUNTER in others:
        index, findings = index_from_counter(
            others[PACKET_COUNTER],
            hints,
            file=source.name,
            first_line=table.first_line,
            column=PACKET_COUNTER,
        )
        attributes["first_packet"] = int(others[PACKET_COUNTER][0])
    else:
        index = np.arange(next(iter(signals.values())).shape[1])
        findings = [
            Finding(
                "no_packet_counter",
                "warning",
                source.name,
                f"line {row.number}",
                f"a column {PACKET_COUNTER}",
                "none; lost packets cannot be seen",
            )
        ]
    return assemble(
        source,
        [SensorRows(single_label(hints, "sensor", file=source.name), signals)],
        index=index,
        first_line=table.first_line,
        rate=rate,
        units=units,
        findings=findings,
        attributes=attributes,
    )
