"""One line of the participant flow that a study's page shows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def flow_line(
    unit: str, recorded: int, excluded: Mapping[str, int], *, planned: int | None = None
) -> dict[str, Any]:
    """Count one kind of unit on its way to the analysis.

    Parameters
    ----------
    unit : str
        What is counted, for example ``trials``.
    recorded : int
        How many there are.
    excluded : mapping of str to int
        How many are left out, by reason; a reason without a case is not listed.
    planned : int, optional
        How many there should be, where the plan says so.

    Returns
    -------
    dict
        ``unit``, ``planned``, ``recorded``, ``excluded`` (list of reason and count), ``analysed``.

    Examples
    --------
    >>> line = flow_line("trials", 12, {"marker missing": 2, "too short": 0}, planned=12)
    >>> line["excluded"], line["analysed"]
    ([{'reason': 'marker missing', 'count': 2}], 10)
    """
    return {
        "unit": unit,
        "planned": planned,
        "recorded": recorded,
        "excluded": [{"reason": reason, "count": n} for reason, n in excluded.items() if n],
        "analysed": recorded - sum(excluded.values()),
    }
