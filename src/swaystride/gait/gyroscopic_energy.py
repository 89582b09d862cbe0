"""Zero velocity of a running foot whose contacts are known: least gyroscopic energy in stance.

:mod:`swaystride.gait.zero_velocity` finds stances by itself and serves every gait; here the stance
is given by its initial contact (dissertation, §4.3.4.2; methods §3.4).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError
from swaystride.gait.zero_velocity import energy_threshold, gyro_energy

Array = NDArray[np.float64]
WindowLabel = Literal["start", "centre"]


@dataclass(frozen=True)
class EnergyRule:
    """Which samples of a stance count as still.

    Parameters
    ----------
    window_s : float
        Window of the energy, both ends included.
    label : {"start", "centre"}
        Sample to which the energy of a window belongs: its first one, as printed, which leads by
        half a window, or its middle.
    time_per_stride_s : float
        Time below the threshold, on average over the strides: five samples at 200 Hz.
    stance_share : float
        Candidates lie within this share of the stride time after initial contact.
    """

    window_s: float
    label: WindowLabel
    time_per_stride_s: float
    stance_share: float


#: Dissertation, §4.3.4.2; the share of the stride from methods §3.4.
PRINTED_ENERGY: Final = EnergyRule(0.02, "start", 0.025, 0.35)
#: The same without the lead.
CENTRED_ENERGY: Final = EnergyRule(0.02, "centre", 0.025, 0.35)


@dataclass(frozen=True, eq=False)
class StanceStillness:
    """Still samples of one foot.

    Parameters
    ----------
    flags : ndarray of bool, shape (n_samples,)
    threshold_rad2_s2 : float
        Energy below which a sample of a stance is still.
    n_fallback : int
        Stances without such a sample, of which the one of least energy was taken.
    """

    flags: NDArray[np.bool_]
    threshold_rad2_s2: float
    n_fallback: int


def gyroscopic_energy(
    gyr_rad_s: ArrayLike, rate_hz: float, window_s: float, label: WindowLabel
) -> Array:
    """Sum of the squared angular rate over a window.

    Parameters
    ----------
    gyr_rad_s : array_like, shape (3, n_samples) or (n_samples,)
        Angular rate, or its size.
    rate_hz : float
        Sampling rate.
    window_s : float
        Length, both ends included: 0.02 s are five samples at 200 Hz.
    label : {"start", "centre"}
        Sample to which a window belongs.

    Returns
    -------
    ndarray, shape (n_samples,)
        (rad/s)²; cut at the ends of the recording.

    Examples
    --------
    >>> turning = [0.0, 1.0, 2.0, 0.0, 0.0]
    >>> gyroscopic_energy(turning, 100.0, 0.02, "start").tolist()
    [5.0, 5.0, 4.0, 0.0, 0.0]
    >>> gyroscopic_energy(turning, 100.0, 0.02, "centre").tolist()
    [1.0, 5.0, 5.0, 4.0, 0.0]
    """
    gyr = np.atleast_2d(np.asarray(gyr_rad_s, dtype=np.float64))
    lead = max(1, round(0.5 * window_s * rate_hz))
    padded = np.pad(gyr, ((0, 0), (0, lead)))
    energy = gyro_energy(padded, 2 * lead + 1)
    return energy[lead:] if label == "start" else energy[:-lead]


def energy_zero_velocity(
    gyr_rad_s: ArrayLike, rate_hz: float, contacts: ArrayLike, rule: EnergyRule
) -> StanceStillness:
    """Samples of each stance at which the foot turns least.

    The threshold is the smallest below which five samples per stride lie on average (at 200 Hz; the
    same time at other rates), exactly: the energy of that rank among all candidates.

    Parameters
    ----------
    gyr_rad_s : array_like, shape (3, n_samples) or (n_samples,)
        Angular rate of the foot, or its size.
    rate_hz : float
        Sampling rate.
    contacts : array_like of int, shape (n_contacts,)
        Samples of initial contact, rising; at least two. A stance that the recording cuts has no
        still samples.
    rule : EnergyRule

    Returns
    -------
    StanceStillness

    Raises
    ------
    RecordingError
        If there are fewer than two contacts, or the stances are too short for the time wanted.

    Examples
    --------
    >>> phase = (np.arange(700) / 200.0 % 0.7) / 0.7
    >>> gyr = 6.0 - 6.0 * np.cos(2 * np.pi * (phase - 0.15))
    >>> still = energy_zero_velocity(gyr, 200.0, [0, 140, 280, 420], CENTRED_ENERGY)
    >>> int(still.flags.sum()), np.flatnonzero(still.flags)[:5].tolist()
    (20, [19, 20, 21, 22, 23])
    """
    energy = gyroscopic_energy(gyr_rad_s, rate_hz, rule.window_s, rule.label)
    at = np.asarray(contacts, dtype=np.int64)
    if at.size < 2 or np.any(np.diff(at) <= 0):
        raise RecordingError(
            "no strides for the threshold of gyroscopic energy",
            expected="two rising contacts or more",
            found=str(at.tolist()[:10]),
        )
    stride = np.diff(at)
    # a missed contact must not stretch the stance, and the last stride is not known
    reach = np.minimum(np.append(stride, np.median(stride)), np.median(stride))
    length = np.maximum(np.floor(rule.stance_share * reach).astype(np.int64), 1)
    whole = (at >= 0) & (at + length < energy.size)
    at, length = at[whole], length[whole]
    samples = at[:, None] + np.arange(int(length.max(initial=1)))
    inside = np.arange(samples.shape[1]) < length[:, None]
    own = np.where(inside, energy[np.minimum(samples, energy.size - 1)], np.inf)
    wanted = int(np.ceil(rule.time_per_stride_s * rate_hz * at.size - 1e-9))
    threshold = energy_threshold(own[np.isfinite(own)], wanted)
    still = own < threshold
    empty = ~still.any(axis=1)
    still[empty, np.argmin(own[empty], axis=1)] = True
    flags = np.zeros(energy.size, dtype=np.bool_)
    flags[samples[still]] = True
    return StanceStillness(flags, threshold, int(empty.sum()))
