"""Parameters of the simulated ratings of experience; their values stand in ``config/``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final, Literal

from swaystride.configuration import from_mapping
from swaystride.errors import ConfigurationError

#: Scales of experience, in the order of Tables 5.3 and 5.4.
SCALES: Final = ("affective_valence", "activity_enjoyment", "flow")

Distance = Literal["standard_errors", "plain"]


@dataclass(frozen=True)
class AssociationModel:
    """How experience hangs together with the way a run was run.

    Parameters
    ----------
    distance : {"standard_errors", "plain"}
        In what the distance to the printed correlations is measured: each deviation in its printed
        standard error (1 - r²)/√(n - 3), or as it is.
    unexplained_share : float
        Least share of the variance of every scale that no measure of the run explains.
    runner_share : float
        Share of the unexplained variance that all runs of a runner have in common.
    reversed_measures : tuple of str
        Keys of measures whose printed correlations are aimed at with the opposite sign.
    """

    distance: Distance
    unexplained_share: float
    runner_share: float
    reversed_measures: tuple[str, ...]

    def __post_init__(self) -> None:
        """Refuse shares that are none."""
        for name, share, least in (
            ("unexplained_share", self.unexplained_share, 0.0),
            ("runner_share", self.runner_share, -1.0),
        ):
            if not (least < share <= 1.0 and share >= 0.0):
                raise ConfigurationError(
                    "not a share", place=name, expected="0 to 1", found=f"{share:g}"
                )


@dataclass(frozen=True)
class ScaleMargins:
    """Distribution of one scale over the runs.

    Parameters
    ----------
    mean, sd : float
        Mean and standard deviation in points of the scale.
    lowest, highest : float
        Ends that no answer leaves.
    """

    mean: float
    sd: float
    lowest: float
    highest: float


@dataclass(frozen=True)
class AffectCourse:
    """Ratings of affect in the course of a run, given when the runner likes.

    Parameters
    ----------
    least_ratings, most_ratings : int
        Every number of ratings between them is as likely as another.
    first_within_s : float
        The first rating is given in this time from the begin of the run.
    shortest_gap_s : float
        Least time between two ratings.
    steady_share : float
        Share of the runs in which the rating never changes.
    drift_sd : float
        Standard deviation over the runs of the change of felt affect in ten minutes, points.
    sway_sd, sway_memory_s : float
        Standard deviation of its slow ups and downs in points, and the time in which their
        correlation falls to 1/e.
    """

    least_ratings: int
    most_ratings: int
    first_within_s: float
    shortest_gap_s: float
    steady_share: float
    drift_sd: float
    sway_sd: float
    sway_memory_s: float

    def __post_init__(self) -> None:
        """Refuse numbers of ratings that leave none."""
        if not 1 <= self.least_ratings <= self.most_ratings:
            raise ConfigurationError(
                "no number of ratings fits",
                place="least_ratings, most_ratings",
                expected="1 or more, in rising order",
                found=f"{self.least_ratings}, {self.most_ratings}",
            )


@dataclass(frozen=True)
class RatingModel:
    """All that the ratings of a simulated cohort are drawn from.

    Parameters
    ----------
    association : AssociationModel
        How they hang together with the runs.
    affective_valence, activity_enjoyment, flow : ScaleMargins
        Feeling Scale (mean of a run), sum of PACES, sum of the Flow Short Scale.
    course : AffectCourse
        Ratings of affect within a run.
    """

    association: AssociationModel
    affective_valence: ScaleMargins
    activity_enjoyment: ScaleMargins
    flow: ScaleMargins
    course: AffectCourse

    @property
    def margins(self) -> tuple[ScaleMargins, ...]:
        """Margins in the order of :data:`SCALES`."""
        return (self.affective_valence, self.activity_enjoyment, self.flow)


def ratings_from_config(values: Mapping[str, Any]) -> RatingModel:
    """Build the parameters from the plain values of the section ``simulation.ratings``.

    Parameters
    ----------
    values : mapping
        Groups ``association``, one of each scale, and ``course``.

    Raises
    ------
    ConfigurationError
        If keys are missing or unknown.
    """
    groups: dict[str, type] = {
        "association": AssociationModel,
        **dict.fromkeys(SCALES, ScaleMargins),
        "course": AffectCourse,
    }
    place = "simulation.ratings"
    parts = {
        name: from_mapping(groups[name], group, place=f"{place}.{name}")
        if name in groups
        else group
        for name, group in values.items()
    }
    return from_mapping(RatingModel, parts, place=place)
