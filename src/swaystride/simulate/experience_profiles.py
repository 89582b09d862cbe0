"""Speed and manner over a training run: pace, warm-up, slow changes, fatigue, and the turn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from swaystride.errors import ConfigurationError
from swaystride.simulate.running_manner import RunProfile
from swaystride.simulate.running_scatter import MOST_SD

Array = NDArray[np.float64]


@dataclass(frozen=True)
class TrainingPace:
    """Self-selected moderate speed by current level.

    Parameters
    ----------
    recreational_m_s, recreationally_competitive_m_s, college_m_s : float
        Mean speed of men of this level.
    female_share : float
        Speed of women over that of men of the same level.
    terrestrial_share : float
        Speed of terrestrial runs over that of aerial ones.
    person_log_sd, run_log_sd : float
        Scatter of the logarithm between people and between the runs of one.
    range_m_s : tuple of float
        Slowest and fastest; what is drawn beyond counts as these.
    """

    recreational_m_s: float
    recreationally_competitive_m_s: float
    college_m_s: float
    female_share: float
    terrestrial_share: float
    person_log_sd: float
    run_log_sd: float
    range_m_s: tuple[float, float]


@dataclass(frozen=True)
class RunCourse:
    """What changes during a run; speeds as shares of the mean one.

    Parameters
    ----------
    turn_s, turn_sd_s : float
        Middle of the turn.
    turn_lasts_s : tuple of float
        Shortest and longest duration of the turn.
    turn_speed, turn_ramp_s : float
        Speed in the turn, and time to slow down and to speed up again.
    turn_least_m_s : float
        Nobody turns more slowly than this: the simulator would begin to walk.
    turn_margin_s : float
        What is not steady running before and after the turn.
    bend_rad, bend_time_s : float
        Standard deviation and time of the bends of the path.
    speed_warm_up, speed_warm_up_sd : float
        By how much a run begins more slowly.
    warm_up_time_s : float
        Time constant of all that changes with the warm-up.
    speed_slow_sd, slow_time_s : float
        Slow changes of the speed, and the time over which all slow changes are alike.
    speed_fatigue_sd : float
        Change of the speed from the warm-up to the end, in runs that change.
    change_share : float
        Probability that a run changes after the warm-up.
    manner_warm_up, manner_slow, manner_fatigue : float
        Likewise of every part of the manner, in standard deviations between people.
    """

    turn_s: float
    turn_sd_s: float
    turn_lasts_s: tuple[float, float]
    turn_speed: float
    turn_ramp_s: float
    turn_least_m_s: float
    turn_margin_s: float
    bend_rad: float
    bend_time_s: float
    speed_warm_up: float
    speed_warm_up_sd: float
    warm_up_time_s: float
    speed_slow_sd: float
    slow_time_s: float
    speed_fatigue_sd: float
    change_share: float
    manner_warm_up: float
    manner_slow: float
    manner_fatigue: float


#: Distance of the knots of a profile, s [N]: slow changes take minutes.
_KNOT_S = 10.0


def pace_m_s(
    pace: TrainingPace, *, level: str, sex: str, is_terrestrial: bool, z: tuple[float, float]
) -> float:
    """Mean speed of a run over its steady part.

    Parameters
    ----------
    pace : TrainingPace
        Distribution.
    level : str
        Current level of performance, as in Table 5.1.
    sex : {"F", "M"}
        Sex.
    is_terrestrial : bool
        Pattern of the run.
    z : tuple of float
        Unit normal numbers of the person and of the run.

    Returns
    -------
    float

    Raises
    ------
    ConfigurationError
        If there is no speed for this level.
    """
    usual = getattr(pace, level.replace(" ", "_") + "_m_s", None)
    if usual is None:
        raise ConfigurationError(
            "no speed for this level of performance",
            place="cohort.pace",
            expected="recreational, recreationally competitive or college",
            found=repr(level),
        )
    scatter = pace.person_log_sd * z[0] + pace.run_log_sd * z[1]
    speed = float(usual) * float(np.exp(scatter))
    speed *= pace.female_share if sex == "F" else 1.0
    speed *= pace.terrestrial_share if is_terrestrial else 1.0
    return float(np.clip(speed, *pace.range_m_s))


def drawn_turn(course: RunCourse, rng: np.random.Generator) -> tuple[float, float]:
    """Begin and end of the turn.

    Parameters
    ----------
    course : RunCourse
        When and how long.
    rng : numpy.random.Generator
        Of the run.
    """
    middle = course.turn_s + course.turn_sd_s * float(np.clip(rng.standard_normal(), -2.0, 2.0))
    half = float(rng.uniform(*course.turn_lasts_s)) / 2.0
    return middle - half, middle + half


def run_profile(
    course: RunCourse,
    speed_m_s: float,
    scales: dict[str, float],
    turn: tuple[float, float],
    *,
    duration_s: float,
    warm_up_s: float,
    rng: np.random.Generator,
) -> RunProfile:
    """Profile of a run.

    Parameters
    ----------
    course : RunCourse
        What changes.
    speed_m_s : float
        Mean over the steady part.
    scales : dict of str to float
        Standard deviation of every part of the manner between people.
    turn : tuple of float
        Begin and end of the turn.
    duration_s, warm_up_s : float
        Of the run.
    rng : numpy.random.Generator
        Of the run.

    Returns
    -------
    RunProfile
        The runner turns to the left, by 180°.
    """
    ramp = course.turn_ramp_s
    corners = [turn[0] - ramp, turn[0], turn[1], turn[1] + ramp]
    regular = np.linspace(0.0, duration_s, max(int(duration_s / _KNOT_S), 1) + 1)
    time = np.unique(np.concatenate([regular, corners]))
    fading = np.exp(-time / course.warm_up_time_s)
    late = np.clip((time - warm_up_s) / (duration_s - warm_up_s), 0.0, 1.0)
    changes = float(rng.random() < course.change_share)
    z = np.clip(rng.standard_normal(2), -MOST_SD, MOST_SD)
    share = 1.0 - (course.speed_warm_up + course.speed_warm_up_sd * z[0]) * fading
    share += course.speed_slow_sd * _slow(time, course.slow_time_s, rng)
    share += course.speed_fatigue_sd * changes * z[1] * late
    left_out = (turn[0] - course.turn_margin_s, turn[1] + course.turn_margin_s)
    fine = np.arange(warm_up_s, duration_s, 0.5)
    steady = fine[(fine < left_out[0]) | (fine > left_out[1])]
    speed = speed_m_s * share / np.interp(steady, time, share).mean()
    slowest = np.maximum(course.turn_speed * speed, np.minimum(course.turn_least_m_s, speed))
    slowed = np.interp(time, corners, [0.0, 1.0, 1.0, 0.0])
    manner = {}
    for name, scale in scales.items():
        z = np.clip(rng.standard_normal(2), -MOST_SD, MOST_SD)
        change = course.manner_warm_up * z[0] * fading
        change += course.manner_fatigue * changes * z[1] * late
        change += course.manner_slow * _slow(time, course.slow_time_s, rng)
        manner[name] = scale * change
    bends = course.bend_rad * _slow(time, course.bend_time_s, rng)
    heading = bends + np.pi * np.interp(time, turn, [0.0, 1.0])
    return RunProfile(time, speed + slowed * (slowest - speed), manner, heading)


def _slow(time_s: Array, alike_s: float, rng: np.random.Generator) -> Array:
    """Smooth random course of unit variance that forgets over some time."""
    step = alike_s / 8.0
    n = int(np.ptp(time_s) / step) + 2
    sigma = 4.0
    smooth = gaussian_filter1d(rng.standard_normal(n + 64), sigma)[32 : 32 + n]
    # Variance that a Gaussian leaves of white noise.
    smooth *= np.sqrt(2.0 * sigma * np.sqrt(np.pi))
    return np.asarray(np.interp(time_s, time_s[0] + step * np.arange(n), smooth))
