"""Parameters of the simulated kinematics study; their values stand in ``config/``."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from swaystride.configuration import from_mapping
from swaystride.errors import ConfigurationError
from swaystride.simulate.intensity_people import Bodies, PatientGroup
from swaystride.simulate.running_manner import RunVariability
from swaystride.simulate.running_markers import CameraErrors, marker_places
from swaystride.simulate.running_scatter import RunnerScatter
from swaystride.simulate.running_sensors import Mounting
from swaystride.simulate.running_standing import StandingManner

#: Name of the study, the first part of the key of all its random numbers.
STUDY: Final = "kinematics"

_TRIAL: Final = re.compile(r"P\d{2,}/\d{2,}")


@dataclass(frozen=True)
class TreadmillProtocol:
    """Who runs, how often, how fast, and what is recorded.

    Parameters
    ----------
    n_participants, n_trials : int
        People, and running trials of each.
    duration_s, standing_s : float
        Length of a running recording, and of the standing one before it. Both lie within the
        running and the standing: neither has a start or a stop.
    belt_speed_m_s : float
        Mean speed of the belt.
    belt_dip : tuple of float
        Least and largest share, between trials, by which the belt is slower in mid-stance.
    rate_hz : float
        Sampling rate of IMUs and cameras.
    sync_jitter_s : float
        Largest difference between the first sample of the IMUs and the first frame.
    failed_optics : tuple of str
        Trials, as ``P03/02``, in which one marker of the legs is lost throughout the run; who is
        not in the cohort is passed over, so that cohorts of any size take the same list.
    failed_markers : tuple of str
        Markers of which one is lost then.
    """

    n_participants: int
    n_trials: int
    duration_s: float
    standing_s: float
    belt_speed_m_s: float
    belt_dip: tuple[float, float]
    rate_hz: float
    sync_jitter_s: float
    failed_optics: tuple[str, ...]
    failed_markers: tuple[str, ...]

    def __post_init__(self) -> None:
        """Refuse trials that are no trials and markers that nobody wears."""
        for place, names, expected, fits in (
            ("failed_optics", self.failed_optics, "P<number>/<trial>, as P03/02", _TRIAL.fullmatch),
            ("failed_markers", self.failed_markers, "a marker of the body", marker_places().get),
        ):
            bad = next((name for name in names if not fits(name)), None)
            if bad is not None:
                raise ConfigurationError(
                    "not what stands here", place=place, expected=expected, found=repr(bad)
                )
        if self.failed_optics and not self.failed_markers:
            raise ConfigurationError(
                "optics fail, but no marker may be lost",
                place="failed_markers",
                expected="at least one marker",
                found="none",
            )


@dataclass(frozen=True)
class RunningHistory:
    """What the runners of the study report of their running.

    Parameters
    ----------
    years_median, years_log_sd : float
        Years of regular running; log-normal.
    years_at_most : int
        More is reported as "more than this".
    race_5km_mean_min, race_5km_sd_min : float
        Time over 5 km.
    slower_mean_min_per_km, slower_sd_min_per_km : float
        By how much the typical pace is slower than that of the race.
    pace_range_share, pace_range_s_per_km : float
        Share of people who report a range, and its half width.
    no_race_share : float
        Share of people who never raced over 5 km.
    """

    years_median: float
    years_log_sd: float
    years_at_most: int
    race_5km_mean_min: float
    race_5km_sd_min: float
    slower_mean_min_per_km: float
    slower_sd_min_per_km: float
    pace_range_share: float
    pace_range_s_per_km: float
    no_race_share: float


@dataclass(frozen=True)
class Measuring:
    """How well lengths and widths of the legs are measured, and what is under a marker.

    Parameters
    ----------
    leg_length_sd_m, width_sd_m : float
        Error of a tape and of a caliper, each side on its own.
    marker_radius_m, base_plate_m : float
        From the centre of a marker to the skin: the body of the model has its markers at given
        places, and the widths of its joints follow.
    """

    leg_length_sd_m: float
    width_sd_m: float
    marker_radius_m: float
    base_plate_m: float


@dataclass(frozen=True)
class KinematicsCohort:
    """All parameters of the simulated cohort.

    Parameters
    ----------
    protocol : TreadmillProtocol
        Who, how fast and how long.
    people : PatientGroup
        Number, ages and sexes of the printed participants.
    bodies : Bodies
        Statures and masses.
    history : RunningHistory
        What the runners report.
    measuring : Measuring
        Lengths and widths.
    person : RunnerScatter
        Between people.
    stride : RunVariability
        From stride to stride.
    standing : StandingManner
        How people stand.
    mounting : Mounting
        How sensors are put on.
    marker_place_sd_m : float
        Scatter of the places of the markers along each axis.
    cameras : CameraErrors
        What the optical system adds.
    """

    protocol: TreadmillProtocol
    people: PatientGroup
    bodies: Bodies
    history: RunningHistory
    measuring: Measuring
    person: RunnerScatter
    stride: RunVariability
    standing: StandingManner
    mounting: Mounting
    marker_place_sd_m: float
    cameras: CameraErrors


_GROUPS: Final[dict[str, dict[str, type]]] = {
    "cohort": {
        "protocol": TreadmillProtocol,
        "people": PatientGroup,
        "bodies": Bodies,
        "history": RunningHistory,
        "measuring": Measuring,
    },
    "runner": {
        "person": RunnerScatter,
        "stride": RunVariability,
        "standing": StandingManner,
    },
    "equipment": {
        "mounting": Mounting,
        "cameras": CameraErrors,
    },
}


def cohort_from_config(section: Mapping[str, Any]) -> KinematicsCohort:
    """Assemble the parameters from the section ``simulation`` of the study's configuration.

    Parameters
    ----------
    section : mapping
        Plain values (:func:`swaystride.configuration.plain_values`) with the keys ``cohort``,
        ``runner`` and ``equipment``.

    Returns
    -------
    KinematicsCohort

    Raises
    ------
    ConfigurationError
        If keys are missing or unknown, or a failed trial or marker cannot be one.
    """
    _require_keys("simulation", section, _GROUPS)
    parts: dict[str, Any] = {}
    for group, classes in _GROUPS.items():
        values = dict(section[group])
        if group == "equipment" and "marker_place_sd_m" in values:
            parts["marker_place_sd_m"] = values.pop("marker_place_sd_m")
        _require_keys(group, values, classes)
        for name, cls in classes.items():
            parts[name] = from_mapping(cls, values[name], place=f"{group}.{name}")
    return from_mapping(KinematicsCohort, parts, place="simulation")


def _require_keys(place: str, values: Mapping[str, Any], wanted: Mapping[str, Any]) -> None:
    if set(values) != set(wanted):
        raise ConfigurationError(
            "keys do not match what the code takes",
            place=place,
            expected=", ".join(sorted(wanted)),
            found=", ".join(sorted(values)),
        )
