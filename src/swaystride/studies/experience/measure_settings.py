"""From the study's configuration to the rules of what is measured in a stride."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from swaystride.configuration import from_mapping
from swaystride.gait.impact_peaks import ImpactWindow
from swaystride.gait.run_measures import MeasureRules
from swaystride.gait.segment_ranges import RollWindow
from swaystride.gait.segment_signals import SignalFilters
from swaystride.gait.vector_coding import VectorCoding

Section = Mapping[str, Any]


def measure_rules(given: Section) -> MeasureRules:
    """Rules of what is measured in a stride.

    Parameters
    ----------
    given : mapping
        Plain values of ``analysis.measures``.
    """
    values, place = dict(given), "analysis.measures"
    for name, cls in (
        ("filters", SignalFilters),
        ("impact", ImpactWindow),
        ("roll", RollWindow),
        ("coding", VectorCoding),
    ):
        values[name] = from_mapping(cls, values[name], place=f"{place}.{name}")
    return from_mapping(MeasureRules, values, place=place)
