"""What can be wrong with the recording of a foot, as errors and findings."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.findings import Finding
from swaystride.gait.epoch_smoother import LEAST_ACC_RANGE_M_S2, LEAST_GYR_RANGE_RAD_S
from swaystride.gait.zero_velocity import ZeroVelocity
from swaystride.signals.plateaus import flattened_share
from swaystride.units import GRAVITY_M_S2

Array = NDArray[np.float64]

#: Below this rate the impact and the turn of a stance (some 30 ms) fall between two samples.
LOWEST_RATE_HZ: Final = 50.0
#: A still accelerometer is this close to gravity, whatever its bias.
_GRAVITY_TOLERANCE_M_S2: Final = 2.0
#: In the stances of a run the foot rolls on: 12.3 m/s² in a simulated runner at 12.6 km/h.
_ROLLING_TOLERANCE_M_S2: Final = 5.0
#: Feet do not turn faster (2000 °/s is 35 rad/s): larger numbers are degrees.
_FASTEST_RATE_RAD_S: Final = 100.0
#: More flattened samples than smooth peaks have by themselves.
_FLATTENED_SHARE: Final = 0.1


def check_signals(acc_m_s2: Array, gyr_rad_s: Array, rate_hz: float) -> None:
    """Refuse signals of which no trajectory can be made.

    Parameters
    ----------
    acc_m_s2, gyr_rad_s : ndarray
        As given.
    rate_hz : float
        Sampling rate.

    Raises
    ------
    RecordingError
        If shapes disagree, the rate is below 50 Hz, or the angular rate cannot be in rad/s.
    """
    if acc_m_s2.ndim != 2 or acc_m_s2.shape[0] != 3 or acc_m_s2.shape != gyr_rad_s.shape:
        raise RecordingError(
            "signals of a foot have the wrong shape",
            expected="acceleration and angular rate of shape (3, n_samples)",
            found=f"{acc_m_s2.shape} and {gyr_rad_s.shape}",
        )
    if not (np.isfinite(rate_hz) and rate_hz >= LOWEST_RATE_HZ):
        raise RecordingError(
            "the sampling rate is too low for a foot",
            place="rate_hz",
            expected=f"at least {LOWEST_RATE_HZ:g} Hz",
            found=f"{rate_hz:g} Hz",
        )
    fastest = float(np.nanmax(np.abs(gyr_rad_s), initial=0.0))
    if fastest > _FASTEST_RATE_RAD_S:
        raise RecordingError(
            "no foot turns that fast: is the angular rate in degrees?",
            place="gyr_rad_s",
            expected=f"at most {_FASTEST_RATE_RAD_S:g} rad/s",
            found=f"{fastest:.1f}",
        )


def check_gravity(acc_m_s2: Array, still: NDArray[np.bool_], *, has_rest: bool) -> None:
    """Refuse an acceleration whose size while still is not that of gravity.

    Parameters
    ----------
    acc_m_s2 : ndarray, shape (3, n_samples)
    still : ndarray of bool, shape (n_samples,)
        Zero-velocity samples; without any nothing is checked.
    has_rest : bool
        Whether the foot rests at least once; in stances alone it is never quite still.

    Raises
    ------
    RecordingError
    """
    if not still.any():
        return
    size = float(np.median(np.linalg.norm(acc_m_s2[:, still], axis=0)))
    tolerance = _GRAVITY_TOLERANCE_M_S2 if has_rest else _ROLLING_TOLERANCE_M_S2
    if abs(size - GRAVITY_M_S2) > tolerance:
        raise RecordingError(
            "the acceleration of the still foot is not gravity: wrong unit or scale?",
            place="acc_m_s2",
            expected=f"{GRAVITY_M_S2:.2f} ± {tolerance:g} m/s²",
            found=f"{size:.2f}",
        )


def foot_findings(
    acc_m_s2: Array, gyr_rad_s: Array, zero_velocity: ZeroVelocity, n_doubted: int, place: str
) -> list[Finding]:
    """What is worth saying about one uninterrupted piece of a recording.

    Parameters
    ----------
    acc_m_s2, gyr_rad_s : ndarray, shape (3, n_samples)
    zero_velocity : ZeroVelocity
        What was found in the piece.
    n_doubted : int
        Stances that the smoother did not believe.
    place : str
        Which piece, in words; empty for the whole recording.
    """
    n_samples = acc_m_s2.shape[1]
    rests = zero_velocity.rests
    findings = []

    def add(check: str, expected: str, found: str) -> None:
        findings.append(Finding(check, "warning", "", place, expected, found))

    if not len(rests) or rests[0, 0] > 0:
        add("no_rest_at_start", "a still foot at the start", "movement")
    if not len(rests) or rests[-1, 1] < n_samples:
        add("no_rest_at_end", "a still foot at the end", "movement")
    if not len(zero_velocity.stances) and len(rests) < 2:
        add("no_strides", "at least one stance between two swings", "none")
    if n_doubted:
        add(
            "stances_not_believed",
            "stances that fit the integrated velocity",
            f"{n_doubted} do not",
        )
    moving = ~zero_velocity.flags
    for check, signal, level in (
        ("acceleration_flattened", acc_m_s2, LEAST_ACC_RANGE_M_S2),
        ("angular_rate_flattened", gyr_rad_s, LEAST_GYR_RANGE_RAD_S),
    ):
        share = flattened_share(signal, least_level=level) * n_samples / max(moving.sum(), 1)
        if share > _FLATTENED_SHARE:
            add(
                check,
                f"less than {_FLATTENED_SHARE:.0%} of the moving samples at the end of the range",
                f"{share:.0%}",
            )
    return findings
