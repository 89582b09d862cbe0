"""From the study's configuration to the rules of import and measures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, Final

from swaystride.configuration import from_mapping
from swaystride.errors import ConfigurationError
from swaystride.gait.event_checks import EventLimits
from swaystride.gait.foot_methods import FootMethod
from swaystride.gait.push_off import PushOffRule
from swaystride.gait.rating_windows import WindowRule
from swaystride.gait.running_events import OffRule, RunningEventRule
from swaystride.gait.sensor_alignment import AlignmentRule
from swaystride.gait.sensors_in_step import StepRule
from swaystride.gait.spatiotemporal import StrideRule
from swaystride.gait.steady_parts import SteadyRule
from swaystride.gait.toe_off import ToeOffRule
from swaystride.gait.unloading import UnloadingRule
from swaystride.studies.experience.equipment import Equipment, equipment
from swaystride.studies.experience.measure_settings import measure_rules
from swaystride.studies.experience.measuring import MetricRules
from swaystride.studies.experience.run_checks import ClippingRule
from swaystride.studies.experience.run_import import ImportRules, RunRules
from swaystride.units import RAD_PER_DEG

Section = Mapping[str, Any]


def import_rules(given: Section) -> ImportRules:
    """Rules of the import.

    Parameters
    ----------
    given : mapping
        Plain values of ``recording``, ``sensors``, ``alignment`` and ``steady``.

    Returns
    -------
    ImportRules
    """
    recording, place = given["recording"], "analysis.recording"
    return ImportRules(
        run=from_mapping(RunRules, recording["run"], place=f"{place}.run"),
        steps=from_mapping(StepRule, recording["steps"], place=f"{place}.steps"),
        clipping=from_mapping(ClippingRule, recording["clipping"], place=f"{place}.clipping"),
        equipment=worn_equipment(given),
        alignment=_alignment(given["alignment"]),
        warm_up_s=steady_rule(given["steady"]).warm_up_s,
    )


def worn_equipment(given: Section) -> Equipment:
    """Labels and mounting of the sensors.

    Parameters
    ----------
    given : mapping
        Plain values of ``sensors`` and ``alignment``.
    """
    return equipment(given["sensors"], given["alignment"]["mounting"])


def metric_rules(given: Section) -> MetricRules:
    """Rules of the measures.

    Parameters
    ----------
    given : mapping
        Plain values of ``events``, ``trajectory``, ``measures``, ``steady`` and ``windows``.

    Returns
    -------
    MetricRules
    """
    events, windows = dict(given["events"]), dict(given["windows"])
    strides, limits = events.pop("strides"), events.pop("limits")
    place = "analysis.events"
    events["toe_off"] = toe_off_rule(events["toe_off"])
    least = windows.pop("least_strides")
    return MetricRules(
        events=from_mapping(RunningEventRule, events, place=place),
        strides=from_mapping(StrideRule, strides, place=f"{place}.strides"),
        limits=from_mapping(EventLimits, limits, place=f"{place}.limits"),
        trajectory=from_mapping(FootMethod, given["trajectory"], place="analysis.trajectory"),
        measures=measure_rules(given["measures"]),
        steady=steady_rule(given["steady"]),
        windows=from_mapping(WindowRule, windows, place="analysis.windows"),
        least_strides=int(least),
    )


#: What each rule of toe-off reads besides its window and its cut-off.
_OFF_RULES: Final[dict[str, tuple[type, tuple[str, ...]]]] = {
    "pitch_minimum": (ToeOffRule, ()),
    "resultant_minimum": (ToeOffRule, ()),
    "push_off_end": (PushOffRule, ("flat_share",)),
    "unloading": (UnloadingRule, ("high_g", "low_g")),
}


def toe_off_rule(given: Section) -> OffRule:
    """Rule of the toe-off.

    Parameters
    ----------
    given : mapping
        Plain values of ``analysis.events.toe_off``: ``rule`` (``pitch_minimum``,
        ``resultant_minimum``, ``push_off_end`` or ``unloading``), window and cut-off, and what only
        one of the rules reads.

    Raises
    ------
    ConfigurationError
        If there is no such rule.
    """
    rule, place = str(given["rule"]), "analysis.events.toe_off"
    if rule not in _OFF_RULES:
        raise ConfigurationError(
            "no such rule of toe-off", place=place, expected=", ".join(_OFF_RULES), found=rule
        )
    cls, own = _OFF_RULES[rule]
    values = {name: given[name] for name in ("from_share", "to_share", "cutoff_hz", *own)}
    if cls is ToeOffRule:
        values["signal"] = rule
    made: OffRule = from_mapping(cls, values, place=place)
    return made


def steady_rule(given: Section) -> SteadyRule:
    """What does not count as steady running.

    Parameters
    ----------
    given : mapping
        Plain values of ``analysis.steady``; the turn is in degrees.
    """
    values = dict(given)
    values["turn_rad"] = values.pop("turn_deg") * RAD_PER_DEG
    return from_mapping(SteadyRule, values, place="analysis.steady")


def _alignment(given: Section) -> AlignmentRule:
    """How sensors are aligned; angles of the configuration are in degrees."""
    values = {name: value for name, value in given.items() if name != "mounting"}
    for field in fields(AlignmentRule):
        in_degrees = field.name.replace("_rad", "_deg")
        if in_degrees != field.name and in_degrees in values:
            values[field.name] = values.pop(in_degrees) * RAD_PER_DEG
    return from_mapping(AlignmentRule, values, place="analysis.alignment")
