"""Course of a trial from rest to rest: speed of the body, and the instants of the steps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.simulate.foot_anchors import GaitAnchors

Array = NDArray[np.float64]


@dataclass(frozen=True)
class CourseParameters:
    """How people start, go and stop.

    Parameters
    ----------
    distance_m : float
        From rest to rest.
    start_time_s, start_time_per_speed : float
        Time constant of the exponential rise of the speed: a constant, and what each m/s of mean
        speed adds.
    stop_time_s, stop_time_per_speed : float
        Duration of the braking, likewise.
    slow_stride_time : float
        By how much strides last longer at speed 0 than at the plateau, as a share.
    slow_gait : float
        The foot moves at speed 0 as it does at this share of the plateau speed.
    rest_s : tuple of float
        Shortest and longest rest before and after the movement.
    """

    distance_m: float
    start_time_s: float
    start_time_per_speed: float
    stop_time_s: float
    stop_time_per_speed: float
    slow_stride_time: float
    slow_gait: float
    rest_s: tuple[float, float]


@dataclass(frozen=True)
class Course:
    """Way of the body: the speed rises exponentially and falls, ever faster, as a quarter cosine.

    Parameters
    ----------
    plateau_m_s, rise_s : float
        Speed that the rise tends to, and its time constant.
    brake_s, stop_s : float
        When the braking begins and ends.
    """

    plateau_m_s: float
    rise_s: float
    brake_s: float
    stop_s: float

    def speed_m_s(self, time_s: ArrayLike) -> Array:
        """Speed at any times; before 0 and after the stop it is zero."""
        time = np.clip(np.asarray(time_s, dtype=np.float64), 0.0, self.stop_s)
        braking = np.clip((time - self.brake_s) / (self.stop_s - self.brake_s), 0.0, 1.0)
        rise = 1.0 - np.exp(-np.minimum(time, self.brake_s) / self.rise_s)
        slowing = np.where(time < self.stop_s, np.cos(np.pi / 2.0 * braking), 0.0)
        return np.asarray(self.plateau_m_s * rise * slowing)

    def way_m(self, time_s: ArrayLike) -> Array:
        """Distance done at any times."""
        time = np.clip(np.asarray(time_s, dtype=np.float64), 0.0, self.stop_s)
        early = np.minimum(time, self.brake_s)
        lasts = self.stop_s - self.brake_s
        braking = np.clip((time - self.brake_s) / lasts, 0.0, 1.0)
        rise = 1.0 - np.exp(-self.brake_s / self.rise_s)
        going = early - self.rise_s * (1.0 - np.exp(-early / self.rise_s))
        braked = rise * lasts * np.sin(np.pi / 2.0 * braking) * 2.0 / np.pi
        return np.asarray(self.plateau_m_s * (going + braked))


def course_of(parameters: CourseParameters, mean_speed_m_s: float, stop_s: float) -> Course:
    """Course that ends at a time and has gone the whole distance then.

    Parameters
    ----------
    parameters : CourseParameters
        How people start and stop.
    mean_speed_m_s : float
        Mean speed of the trial, on which starting and braking depend.
    stop_s : float
        When the body is at rest again.

    Returns
    -------
    Course
    """
    rise_s = parameters.start_time_s + parameters.start_time_per_speed * mean_speed_m_s
    lasts = parameters.stop_time_s + parameters.stop_time_per_speed * mean_speed_m_s
    unit = Course(1.0, rise_s, stop_s - lasts, stop_s)
    plateau = parameters.distance_m / float(unit.way_m(stop_s))
    return Course(plateau, rise_s, stop_s - lasts, stop_s)


@dataclass(frozen=True)
class StepTimes:
    """First contacts of the steps of both feet in turn, and what belongs to each.

    Parameters
    ----------
    contact_s : ndarray, shape (n_steps,)
        First touch; time 0 is when the first heel rises.
    speed_m_s : ndarray, shape (n_steps,)
        Speed of the body then.
    gait_speed_m_s : ndarray, shape (n_steps,)
        Speed of the steady gait whose foot motion the step has.
    first_push_s : float
        From the rise of the first heel to its toe-off.
    stop_s : float
        When the foot that closes the last step lies flat.
    course : Course
        Way of the body.
    """

    contact_s: Array
    speed_m_s: Array
    gait_speed_m_s: Array
    first_push_s: float
    stop_s: float
    course: Course


def step_times(
    parameters: CourseParameters,
    anchors: GaitAnchors,
    mean_speed_m_s: float,
    *,
    stride_time_scale: float,
    stride_time_cv: float,
    rng: np.random.Generator,
) -> StepTimes:
    """Instants of the steps of a trial of prescribed mean speed.

    The movement begins with the rise of the first heel and ends when the foot that closes the last
    step lies flat; in between exactly ``distance / mean speed`` pass.

    Parameters
    ----------
    parameters : CourseParameters
        How people start, go and stop.
    anchors : GaitAnchors
        Stride times and the like by speed.
    mean_speed_m_s : float
        Mean speed.
    stride_time_scale : float
        Stride time of this person over that of the table.
    stride_time_cv : float
        Coefficient of variation of the stride time from stride to stride.
    rng : numpy.random.Generator
        Source of that variation.

    Returns
    -------
    StepTimes
    """
    total_s = parameters.distance_m / mean_speed_m_s
    slow = anchors.at(parameters.slow_gait * mean_speed_m_s)
    flat_s = float(slow["flat_delay_s"])
    course = course_of(parameters, mean_speed_m_s, total_s - flat_s)
    plateau_stride_s = stride_time_scale * float(anchors.at(course.plateau_m_s)["stride_time_s"])

    def share(time_s: float) -> float:
        return float(course.speed_m_s(time_s)) / course.plateau_m_s

    lengthening = 1.0 + parameters.slow_stride_time
    first_stride_s = plateau_stride_s * lengthening
    push_s = min(
        float((1.0 - slow["heel_off"]) * slow["duty_factor"]) * first_stride_s,
        float(longest_push_s(-slow["toe_off_pitch_rad"], slow["toe_off_pitch_rate_rad_s"])),
    )
    contacts = [push_s + (1.0 - float(slow["duty_factor"])) * first_stride_s]
    last_s = total_s - flat_s
    while contacts[-1] < last_s:
        step_s = (
            0.5
            * plateau_stride_s
            * (lengthening - parameters.slow_stride_time * share(contacts[-1]))
        )
        # Two steps in a row make a stride: their scatter is larger by the root of two.
        contacts.append(
            contacts[-1] + step_s * (1.0 + np.sqrt(2.0) * stride_time_cv * rng.standard_normal())
        )
    if len(contacts) > 4 and contacts[-1] - last_s > last_s - contacts[-2]:
        contacts.pop()
    scale = last_s / contacts[-1]
    contact = scale * np.array(contacts)
    speed = course.speed_m_s(contact)
    gait = course.plateau_m_s * parameters.slow_gait + (1.0 - parameters.slow_gait) * speed
    return StepTimes(contact, speed, gait, scale * push_s, total_s, course)


def longest_push_s(turn_rad: ArrayLike, toe_off_rate_rad_s: ArrayLike) -> Array:
    """Longest time from heel-off to toe-off in which the heel rises without dipping first.

    From rest to a steady rate r after a turn of Δ the quintic never turns back if it takes at most
    2.5 Δ/r; a little less keeps clear of that limit.

    Parameters
    ----------
    turn_rad : array_like
        Pitch from heel-off to toe-off, positive.
    toe_off_rate_rad_s : array_like
        Rate at toe-off, of either sign.
    """
    return np.asarray(2.2 * np.asarray(turn_rad) / np.abs(toe_off_rate_rad_s))
