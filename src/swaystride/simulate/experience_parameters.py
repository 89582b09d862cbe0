"""Parameters of the simulated experience study; their values stand in ``config/``."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, Final

from swaystride.configuration import from_mapping
from swaystride.errors import ConfigurationError
from swaystride.simulate.experience_beats import HeartBeats, StrapSignal
from swaystride.simulate.experience_profiles import RunCourse, TrainingPace
from swaystride.simulate.foot_course import CourseParameters
from swaystride.simulate.foot_trial import StrideScatter
from swaystride.simulate.running_manner import RunVariability
from swaystride.simulate.running_scatter import RunnerScatter
from swaystride.simulate.running_sensors import Mounting
from swaystride.simulate.running_standing import StandingManner

#: Name of the study, the first part of the key of all its random numbers.
STUDY: Final = "experience"

_RUN: Final = re.compile(r"P\d{2,}_\d{2,}")


@dataclass(frozen=True)
class RunProtocol:
    """Who runs how often, and what is recorded.

    Parameters
    ----------
    runs_per_participant : tuple of int
        Runs of each participant, in the order of Table 5.1; its length is that of the cohort.
    duration_s, warm_up_s : float
        Length of a run, which is already going on when the recording begins and still when it
        ends, and of the part of it that does not count.
    standing_s : float
        Length of the quiet standing before a run.
    walking_speed_m_s, walking_speed_sd_m_s : float
        Speed of the walk before a run.
    rate_hz : float
        Sampling rate of the IMUs.
    terrestrial_runs : tuple of str
        Runs, as ``P04_01``, of terrestrial pattern; all others are aerial. Here and below a run
        that is not in the cohort is passed over, so that cohorts of any size take the same lists.
    """

    runs_per_participant: tuple[int, ...]
    duration_s: float
    warm_up_s: float
    standing_s: float
    walking_speed_m_s: float
    walking_speed_sd_m_s: float
    rate_hz: float
    terrestrial_runs: tuple[str, ...]

    def __post_init__(self) -> None:
        """Refuse a participant without runs and names that no run has."""
        if not self.runs_per_participant or min(self.runs_per_participant) < 1:
            raise ConfigurationError(
                "everybody runs at least once",
                place="runs_per_participant",
                expected="whole numbers from 1",
                found=str(list(self.runs_per_participant)),
            )
        refuse_other_names("terrestrial_runs", self.terrestrial_runs)


@dataclass(frozen=True)
class PatternDuty:
    """Mean duty factor of a run over its steady part: normal, drawn anew while out of range.

    Parameters
    ----------
    aerial_mean, aerial_sd : float
        Of aerial runs.
    aerial_range : tuple of float
        Least and largest that is drawn.
    terrestrial_mean, terrestrial_sd : float
        Of terrestrial runs.
    terrestrial_range : tuple of float
        Least and largest that is drawn.
    """

    aerial_mean: float
    aerial_sd: float
    aerial_range: tuple[float, float]
    terrestrial_mean: float
    terrestrial_sd: float
    terrestrial_range: tuple[float, float]


@dataclass(frozen=True)
class PushOff:
    """How the runners of this cohort push off, beside the usual one of their speed.

    Parameters
    ----------
    toe_off_pitch_deg : float
        Added to the pitch of the foot at toe-off; people scatter about it.
    """

    toe_off_pitch_deg: float


@dataclass(frozen=True)
class LostData:
    """What is lost, and in which runs.

    Parameters
    ----------
    heart_rate_runs : tuple of str
        Runs without an electrocardiogram.
    head_lost_runs, head_loose_runs : tuple of str
        Runs in which the sensor of the head recorded nothing, and in which it was badly attached.
    ratings_runs : tuple of str
        Runs of which the last ratings are lost.
    ratings_lost_s : float
        Length of their end without ratings.
    loose_m_s2, loose_hz : float
        Size and frequency of the shaking of a badly attached sensor.
    """

    heart_rate_runs: tuple[str, ...]
    head_lost_runs: tuple[str, ...]
    head_loose_runs: tuple[str, ...]
    ratings_runs: tuple[str, ...]
    ratings_lost_s: float
    loose_m_s2: float
    loose_hz: float

    def __post_init__(self) -> None:
        """Refuse names that no run has."""
        for part in fields(LostData):
            if part.name.endswith("_runs"):
                refuse_other_names(part.name, getattr(self, part.name))


@dataclass(frozen=True)
class ExperienceCohort:
    """All parameters of the simulated cohort up to the ratings.

    Parameters
    ----------
    protocol : RunProtocol
        Who, how often and how long.
    duty : PatternDuty
        Duty factors by pattern.
    pace : TrainingPace
        Speeds.
    losses : LostData
        Lost data.
    person : RunnerScatter
        Between people, and between the runs of one.
    push_off : PushOff
        How this cohort pushes off.
    course : RunCourse
        What changes during a run, and the turn.
    stride : RunVariability
        From stride to stride.
    standing : StandingManner
        How people stand.
    walk : CourseParameters
        Way of the walk.
    walking_stride : StrideScatter
        From stride to stride of the walk.
    heart : HeartBeats
        When the heart beats.
    strap : StrapSignal
        What the chest strap shows.
    mounting : Mounting
        How sensors are put on.
    """

    protocol: RunProtocol
    duty: PatternDuty
    pace: TrainingPace
    losses: LostData
    person: RunnerScatter
    push_off: PushOff
    course: RunCourse
    stride: RunVariability
    standing: StandingManner
    walk: CourseParameters
    walking_stride: StrideScatter
    heart: HeartBeats
    strap: StrapSignal
    mounting: Mounting


_GROUPS: Final[dict[str, dict[str, type]]] = {
    "cohort": {
        "protocol": RunProtocol,
        "duty": PatternDuty,
        "pace": TrainingPace,
        "losses": LostData,
    },
    "runner": {
        "person": RunnerScatter,
        "push_off": PushOff,
        "course": RunCourse,
        "stride": RunVariability,
        "standing": StandingManner,
        "walk": CourseParameters,
        "walking_stride": StrideScatter,
        "heart": HeartBeats,
    },
    "equipment": {
        "mounting": Mounting,
        "strap": StrapSignal,
    },
}


def cohort_from_config(section: Mapping[str, Any]) -> ExperienceCohort:
    """Assemble the parameters from the section ``simulation`` of the study's configuration.

    Parameters
    ----------
    section : mapping
        Plain values (:func:`swaystride.configuration.plain_values`) with the keys ``cohort``,
        ``runner`` and ``equipment``; further ones, such as ``ratings``, belong to others.

    Returns
    -------
    ExperienceCohort

    Raises
    ------
    ConfigurationError
        If keys are missing or unknown, or a name is not one of a run.
    """
    parts: dict[str, Any] = {}
    for group, classes in _GROUPS.items():
        values = section.get(group, {})
        if set(values) != set(classes):
            raise ConfigurationError(
                "keys do not match what the code takes",
                place=group,
                expected=", ".join(sorted(classes)),
                found=", ".join(sorted(values)),
            )
        for name, cls in classes.items():
            parts[name] = from_mapping(cls, values[name], place=f"{group}.{name}")
    return from_mapping(ExperienceCohort, parts, place="simulation")


def refuse_other_names(place: str, names: tuple[str, ...]) -> None:
    """Refuse what is not the name of a run.

    Parameters
    ----------
    place : str
        Where the names stand.
    names : tuple of str
        Names.

    Raises
    ------
    ConfigurationError
        With the first name that is none.
    """
    bad = next((name for name in names if not _RUN.fullmatch(str(name))), None)
    if bad is not None:
        raise ConfigurationError(
            "not the name of a run",
            place=place,
            expected="P<number>_<run>, as P04_01",
            found=repr(bad),
        )
