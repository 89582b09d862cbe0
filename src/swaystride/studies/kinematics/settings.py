"""From the study's configuration to the parameters of its steps."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from swaystride.configuration import from_mapping
from swaystride.erkf.imu_initialisation import CentreSearch
from swaystride.erkf.noise import NoiseSet
from swaystride.erkf.options import FilterOptions
from swaystride.erkf.start import StartUncertainty
from swaystride.gait.gyroscopic_energy import EnergyRule
from swaystride.gait.initial_contact import InitialContactRule
from swaystride.mocap.marker_cleaning import Cleaning
from swaystride.mocap.marker_gaps import GapLimits
from swaystride.mocap.static_calibration import OpticalOptions
from swaystride.studies.kinematics.alignment_in_time import ClockRules
from swaystride.studies.kinematics.equipment import Markers, SensorLabels
from swaystride.studies.kinematics.estimation import FilterMethod
from swaystride.studies.kinematics.initialisation import Initialisation
from swaystride.studies.kinematics.optics import OpticalMethod
from swaystride.studies.kinematics.trial_import import ImportRules, TrialRules
from swaystride.units import RAD_PER_DEG

Section = Mapping[str, Any]


def import_rules(given: Section) -> ImportRules:
    """Rules of the import.

    Parameters
    ----------
    given : mapping
        Plain values of ``recording``, ``sensors``, ``markers`` and ``contacts``.

    Returns
    -------
    ImportRules
    """
    recording, place = given["recording"], "analysis.recording"
    cleaning = dict(recording["cleaning"])
    limits = from_mapping(GapLimits, cleaning.pop("limits"), place=f"{place}.cleaning.limits")
    return ImportRules(
        trial=from_mapping(TrialRules, recording["trial"], place=f"{place}.trial"),
        clocks=from_mapping(ClockRules, recording["clocks"], place=f"{place}.clocks"),
        cleaning=from_mapping(Cleaning, {**cleaning, "limits": limits}, place=f"{place}.cleaning"),
        labels=sensor_labels(given["sensors"]),
        markers=markers(given["markers"]),
        contacts=contact_rule(given["contacts"]),
    )


def sensor_labels(given: Section) -> SensorLabels:
    """Labels of the sensors.

    Parameters
    ----------
    given : mapping
        Plain values of ``analysis.sensors``.
    """
    return from_mapping(SensorLabels, given, place="analysis.sensors")


def markers(given: Section) -> Markers:
    """Markers on the sensors and the size of all.

    Parameters
    ----------
    given : mapping
        Plain values of ``analysis.markers``.
    """
    faces = from_mapping(SensorLabels, given["faces"], place="analysis.markers.faces")
    return from_mapping(Markers, {**given, "faces": faces}, place="analysis.markers")


def optical_method(given: Section) -> OpticalMethod:
    """How markers become joint angles.

    Parameters
    ----------
    given : mapping
        Plain values of ``analysis.optics``.
    """
    values = dict(given)
    recipe = values.pop("axis_recipe")
    options = from_mapping(OpticalOptions, values, place="analysis.optics")
    return OpticalMethod(options, recipe)


def contact_rule(given: Section) -> InitialContactRule:
    """Which peak of the acceleration is initial contact.

    Parameters
    ----------
    given : mapping
        Plain values of ``analysis.contacts``.
    """
    return from_mapping(InitialContactRule, given, place="analysis.contacts")


def filter_method(given: Section, contacts: Section, zero_velocity: Section) -> FilterMethod:
    """One variant of the filter; angles of the configuration are in degrees.

    Parameters
    ----------
    given, contacts, zero_velocity : mapping
        Plain values of ``analysis.erkf``, ``analysis.contacts`` and ``analysis.zero_velocity``.
    """
    place = "analysis.erkf"
    noise = dict(given["noise"])
    noise["gyr_sd_rad_s"] = noise.pop("gyr_sd_deg_s") * RAD_PER_DEG
    for joint in ("hip", "knee"):
        degrees = noise.pop(f"{joint}_axis_sd_deg")
        noise[f"{joint}_axis_sd"] = None if degrees is None else degrees * RAD_PER_DEG
    start = dict(given["start"])
    for name, unit in (("tilt", ""), ("heading", ""), ("gyr_bias", "_s")):
        start[f"{name}_rad{unit}"] = start.pop(f"{name}_deg{unit}") * RAD_PER_DEG
    options = dict(given["options"])
    for name in ("gate", "longest_refusal_s"):
        options[name] = float("inf") if options[name] is None else options[name]
    parts = {
        "initialisation": (Initialisation, given["initialisation"]),
        "centres": (CentreSearch, given["centres"]),
        "start": (StartUncertainty, start),
        "noise": (NoiseSet, noise),
        "options": (FilterOptions, options),
    }
    made: dict[str, Any] = {
        name: from_mapping(cls, values, place=f"{place}.{name}")
        for name, (cls, values) in parts.items()
    }
    made["contacts"] = contact_rule(contacts)
    made["energy"] = from_mapping(EnergyRule, zero_velocity, place="analysis.zero_velocity")
    simple = {name: given[name] for name in given if name not in parts}
    return from_mapping(FilterMethod, {**simple, **made}, place=place)
