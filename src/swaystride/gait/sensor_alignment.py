"""Anatomical axes of all sensors of a runner, from quiet standing and walking (methods §4)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.findings import Finding
from swaystride.gait.segment_signals import SegmentSignals, lowpassed_parts
from swaystride.signals.segment_alignment import (
    MainAxis,
    anatomical_frame,
    main_axis,
    pointing_right,
    standing_vertical,
    straight_samples,
)
from swaystride.units import DEG_PER_RAD, RAD_PER_DEG

Array = NDArray[np.float64]

#: Sensor on the pelvis, which sees turns of the path.
PELVIS: Final = "lumbar"
#: Sensors whose medio-lateral axis is found by movement, the shank of each leg first: the swing of
#: thigh and foot is judged by it. Walking hardly turns trunk, head and arms about one axis.
_LEGS: Final = tuple(
    (f"shank_{side}", f"thigh_{side}", f"foot_{side}") for side in ("right", "left")
)


@dataclass(frozen=True)
class AlignmentRule:
    """How sensors are aligned, and what counts as good.

    Parameters
    ----------
    quiet_s : float
        Length of the quietest part of standing, over which gravity is averaged.
    cutoff_hz : float
        Low-pass of the rates before the main axis is sought.
    turn_cutoff_hz, turn_rad_s : float
        Turns of the path: low-pass and least size of the turning rate of the pelvis.
    least_share, least_thigh_share : float
        Part of the squared rate about the main axis, below which a warning is given.
    most_off_horizontal_rad : float
        Largest angle between the main axis and the horizontal without a warning.
    most_tilt_rad : float
        Largest angle between the measured vertical and that of the mounting: a sensor that is
        further away is turned over.
    """

    quiet_s: float
    cutoff_hz: float
    turn_cutoff_hz: float
    turn_rad_s: float
    least_share: float
    least_thigh_share: float
    most_off_horizontal_rad: float
    most_tilt_rad: float


#: 3 s: dissertation, §5.3.4.1, with methods §4.1; 15 Hz, shares and 15° from methods §4.2 [N]; turns
#: as for the lower limbs; 60° [N]: people lean by far less, and a sensor turned over by 180°.
STANDING_AND_WALKING: Final = AlignmentRule(
    quiet_s=3.0,
    cutoff_hz=15.0,
    turn_cutoff_hz=0.4,
    turn_rad_s=0.3,
    least_share=0.8,
    least_thigh_share=0.7,
    most_off_horizontal_rad=15.0 * RAD_PER_DEG,
    most_tilt_rad=60.0 * RAD_PER_DEG,
)


@dataclass(frozen=True, eq=False)
class SensorAlignment:
    """Axes of one sensor.

    Parameters
    ----------
    r_anatomical_from_sensor : ndarray, shape (3, 3)
        Rows x (forward), y (up in standing), z (right).
    main : MainAxis, or None
        The axis of turning that gave z; None where z comes from the mounting.
    """

    r_anatomical_from_sensor: Array
    main: MainAxis | None

    def turned(self, signals: SegmentSignals) -> SegmentSignals:
        """Signals of this sensor in anatomical axes.

        Parameters
        ----------
        signals : SegmentSignals
            In the axes of the sensor.

        Returns
        -------
        SegmentSignals
            Of the same precision.
        """
        acc, gyr = signals.acc_m_s2, signals.gyr_rad_s
        r = self.r_anatomical_from_sensor
        return SegmentSignals(r.astype(acc.dtype) @ acc, r.astype(gyr.dtype) @ gyr)


def align_sensors(
    standing: Mapping[str, SegmentSignals],
    walking: Mapping[str, SegmentSignals],
    mounting: Mapping[str, Array],
    *,
    rate_hz: float,
    rule: AlignmentRule,
) -> dict[str, SensorAlignment]:
    """Align sensors with their segments: up from standing, right from walking or the mounting.

    Parameters
    ----------
    standing : mapping of str to SegmentSignals
        Quiet standing, in the axes of the sensors, by their names: ``lumbar``, ``thigh_right``,
        ``shank_right``, ``foot_right``, … and any others.
    walking : mapping of str to SegmentSignals
        Straight walking; read for the pelvis and for thighs, shanks and feet.
    mounting : mapping of str to ndarray, shape (3, 3)
        How each sensor is meant to be worn, ``r_anatomical_from_sensor``. Legs need only agree with
        it roughly; the others get their medio-lateral axis from it.
    rate_hz : float
        Sampling rate.
    rule : AlignmentRule

    Returns
    -------
    dict of str to SensorAlignment
        For every sensor of `standing`.

    Raises
    ------
    RecordingError
        If standing is too short or samples are missing in it, a sensor is turned over, movement and
        mounting disagree, or there is no walking for a leg.
    """
    missing = sorted(set(standing) - set(mounting))
    if missing:
        raise RecordingError("no mounting is known", place=missing[0], expected="three axes")
    quiet = _quietest(standing, rate_hz, rule)
    up = {
        name: _upright(signals.acc_m_s2[:, quiet], mounting[name], name, rule)
        for name, signals in standing.items()
    }
    legs = [tuple(name for name in leg if name in standing) for leg in _LEGS]
    rates = _walking_rates(walking, [name for leg in legs for name in leg], up, rate_hz, rule)
    found: dict[str, SensorAlignment] = {}
    for leg in legs:
        swing: Array | None = None
        for name in leg:
            rate = rates[name]
            main = main_axis(rate, up[name], np.ones(rate.shape[1], dtype=np.bool_))
            if swing is None and not name.startswith("shank"):
                # without its shank the mounting alone says which side is right
                right = main.axis * np.sign(main.axis @ mounting[name][2])
            else:
                right = pointing_right(
                    main.axis, rate, shank_rate=swing, prior=mounting[name][2], place=name
                )
            if name.startswith("shank"):
                swing = right @ rate
            found[name] = SensorAlignment(anatomical_frame(up[name], right), main)
    for name in standing:
        if name not in found:
            found[name] = SensorAlignment(anatomical_frame(up[name], mounting[name][2]), None)
    return {name: found[name] for name in standing}


def _quietest(standing: Mapping[str, SegmentSignals], rate_hz: float, rule: AlignmentRule) -> slice:
    """Part of standing in which all sensors together turn least."""
    length = round(rule.quiet_s * rate_hz)
    square = sum(
        np.sum(signals.gyr_rad_s.astype(float) ** 2, axis=0) for signals in standing.values()
    )
    square = np.where(
        np.any([signals.missing() for signals in standing.values()], axis=0), np.nan, square
    )
    if square.size >= length:
        windows = np.lib.stride_tricks.sliding_window_view(square, length)
        turning = windows[:: max(1, length // 30)].sum(axis=1)
        if np.isfinite(turning).any():
            first = int(np.nanargmin(turning)) * max(1, length // 30)
            return slice(first, first + length)
    raise RecordingError(
        "standing is too short to find the vertical",
        expected=f"{rule.quiet_s:g} s without missing samples",
        found=f"{square.size / rate_hz:.1f} s, {int(np.isnan(square).sum())} samples missing",
    )


def _upright(
    acc_m_s2: NDArray[np.floating], mounting: Array, name: str, rule: AlignmentRule
) -> Array:
    """Vertical of a sensor, not too far from where its mounting puts it."""
    up = standing_vertical(np.asarray(acc_m_s2, dtype=np.float64))
    tilt = float(np.arccos(np.clip(up @ mounting[1], -1.0, 1.0)))
    if tilt > rule.most_tilt_rad:
        raise RecordingError(
            "the sensor is not mounted as said",
            place=name,
            expected=f"upright within {DEG_PER_RAD * rule.most_tilt_rad:.0f}° in standing",
            found=f"{DEG_PER_RAD * tilt:.0f}°",
        )
    return up


def _walking_rates(
    walking: Mapping[str, SegmentSignals],
    names: list[str],
    up: Mapping[str, Array],
    rate_hz: float,
    rule: AlignmentRule,
) -> dict[str, Array]:
    """Low-passed rates of the legs, without turns of the path and missing samples."""
    absent = [name for name in names if name not in walking]
    if absent:
        raise RecordingError(
            "no walking to find the medio-lateral axis",
            place=absent[0],
            expected="a calibration walk",
        )
    rates = {
        name: lowpassed_parts(walking[name].gyr_rad_s, rule.cutoff_hz, rate_hz) for name in names
    }
    known = [np.isfinite(rate).all(axis=0) for rate in rates.values()]
    if PELVIS in walking and PELVIS in up and names:
        pelvis = np.nan_to_num(np.asarray(walking[PELVIS].gyr_rad_s, dtype=np.float64))
        known.append(
            straight_samples(
                pelvis,
                up[PELVIS],
                rate_hz,
                cutoff_hz=rule.turn_cutoff_hz,
                limit_rad_s=rule.turn_rad_s,
            )
        )
    keep = np.logical_and.reduce(known) if known else np.empty(0, dtype=np.bool_)
    return {name: rate[:, keep] for name, rate in rates.items()}


def alignment_findings(
    alignments: Mapping[str, SensorAlignment], rule: AlignmentRule, *, file: str
) -> list[Finding]:
    """What is doubtful about the axes that were found by movement.

    Parameters
    ----------
    alignments : mapping of str to SensorAlignment
        From :func:`align_sensors`.
    rule : AlignmentRule
        Limits.
    file : str
        Of the calibration, for the findings.

    Returns
    -------
    list of Finding
        Warnings ``main_axis_weak`` and ``main_axis_not_horizontal``.
    """
    found: list[Finding] = []
    for name, alignment in alignments.items():
        main = alignment.main
        if main is None:
            continue
        least = rule.least_thigh_share if name.startswith("thigh") else rule.least_share
        if main.share < least:
            measured = f"{100 * main.share:.0f} % of the rate about one axis"
            found.append(
                Finding("main_axis_weak", "warning", file, name, f"{100 * least:.0f} %", measured)
            )
        if main.off_horizontal_rad > rule.most_off_horizontal_rad:
            limit = f"within {DEG_PER_RAD * rule.most_off_horizontal_rad:.0f}° of the horizontal"
            off = f"{DEG_PER_RAD * main.off_horizontal_rad:.0f}°"
            found.append(Finding("main_axis_not_horizontal", "warning", file, name, limit, off))
    return found
