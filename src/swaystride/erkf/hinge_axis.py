"""Axis of a hinge from the sensors on both of its segments alone (methods §1.13).

The parts of both angular rates that are perpendicular to the axis have the same size (Seel, Schauer
and Raisch 2012). While a segment moves slowly its accelerometer shows gravity, whose part along the
axis is the same on both segments (Olsson, Kok, Seel and Halvorsen 2020); this tells the signs of both
axes apart, which rates cannot.

For joints that are hinges. The study of running takes the mediolateral axes of the mounting instead.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from swaystride.erkf.hinge_residuals import (
    HingeSamples,
    Minimum,
    direction_variances,
    nearest_minimum,
    residuals,
)
from swaystride.errors import RecordingError
from swaystride.signals.filters import lowpass_without_lag
from swaystride.units import RAD_PER_DEG

Array = NDArray[np.float64]

#: Weight of a rate (rad/s) over that of an acceleration (m/s²) in the first round, w0 = 50 in the
#: published implementation.
FIRST_RATIO: Final = 50.0
#: Rounds in which each kind of residual is weighted by its own size; the third changes nothing more.
ROUNDS: Final = 3
#: Fewest slow samples that are used: one second at 50 Hz [N].
FEWEST_SLOW: Final = 50
#: Second over first singular value of slow accelerations below which all are one posture (within
#: about 12°), as in standing: they say one thing a thousand times, and are not used [N].
ONE_POSTURE: Final = 0.2
#: Movement contradicts the mounting when the other sign fits the accelerometers so many times better
#: (an axis at right angles to gravity fits equally well with both) [N].
CLEARLY_BETTER: Final = 2.0
#: Directions in which the search starts: axes and diagonals of a sensor, without opposites.
DIRECTIONS: Final = (
    np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1], [1, 1, -1], [1, -1, 1], [1, -1, -1]])
    / np.sqrt(np.array([1, 1, 1, 3, 3, 3, 3]))[:, None]
)


@dataclass(frozen=True)
class HingeSearch:
    """How the axes of a hinge are sought.

    Parameters
    ----------
    cutoff_hz : float
        Low-pass of all signals.
    most_samples : int or None
        So many informative samples are used of the rates, and of the accelerometers; None uses all.
    slow_rad_s : float
        Accelerometers are used where the root mean square of either rate stays below it; 0 leaves
        them out.
    window_s : float
        Over which the root mean square is taken.
    starts : int
        The search descends from so many of 49 pairs of directions, the best ones; with
        accelerometers from both signs of each, and from what gravity alone suggests.
    rate_sd_rad_s, acc_sd_m_s2 : float
        Smallest residuals that are believed in weighing rates against accelerometers.
    independent_s : float
        How much of the recording says something new, as in
        :func:`swaystride.erkf.joint_centres.joint_centre_of`; for the standard deviations.
    """

    cutoff_hz: float
    most_samples: int | None
    slow_rad_s: float
    window_s: float
    starts: int
    rate_sd_rad_s: float
    acc_sd_m_s2: float
    independent_s: float


#: Rates only, all of them. Low-pass as for joint centres (methods §1.13); about one stride is
#: independent; residuals of 1 °/s and 0.1 m/s² are noise of body-worn sensors [N].
SEEL_2012: Final = HingeSearch(
    cutoff_hz=10.0,
    most_samples=None,
    slow_rad_s=0.0,
    window_s=0.2,
    starts=12,
    rate_sd_rad_s=1.0 * RAD_PER_DEG,
    acc_sd_m_s2=0.1,
    independent_s=1.0,
)
#: With accelerometers; 1000 samples (methods §1.13), slow below 1 rad/s over 0.2 s as in the published
#: implementation (21 samples there). Made for joints that are hinges: in simulated running, whose knees
#: also rotate and abduct, 1000 selected samples draw the axis of the thigh off by 16°, all samples
#: by 3°.
OLSSON_2020: Final = HingeSearch(
    cutoff_hz=10.0,
    most_samples=1000,
    slow_rad_s=1.0,
    window_s=0.2,
    starts=12,
    rate_sd_rad_s=1.0 * RAD_PER_DEG,
    acc_sd_m_s2=0.1,
    independent_s=1.0,
)


class HingeAxisFit(NamedTuple):
    """Result of :func:`hinge_axis_of`.

    ``proximal`` and ``distal`` (3,), unit vectors to the right in the frames of the sensors;
    ``sd_rad`` (2,), standard deviation of the direction of each, per component, as if residuals
    were white; ``share`` (2,), part of each squared angular rate about the axis;
    ``rate_residual_rad_s`` and ``acc_residual_m_s2``, root mean square of what remains, the latter
    NaN without slow samples; ``agreeing``, share of the starts that end at the same axes within 1°;
    ``n_rates`` and ``n_accelerations``, samples used.
    """

    proximal: Array
    distal: Array
    sd_rad: Array
    share: Array
    rate_residual_rad_s: float
    acc_residual_m_s2: float
    agreeing: float
    n_rates: int
    n_accelerations: int


def hinge_axis_of(
    proximal: tuple[Array, Array],
    distal: tuple[Array, Array],
    rate_hz: float,
    *,
    right: tuple[Array, Array],
    search: HingeSearch,
    place: str = "",
) -> HingeAxisFit:
    """Axis of a hinge in the frames of the sensors on its two segments.

    Parameters
    ----------
    proximal, distal : (ndarray, ndarray), each of shape (3, n_samples)
        Accelerometer and gyroscope of both sensors; rates without bias.
    rate_hz : float
        Sampling rate.
    right : (ndarray, ndarray)
        Roughly to the right of the person in both frames, from the mounting; gives the signs.
    search : HingeSearch
    place : str
        Name of the joint, for errors.

    Returns
    -------
    HingeAxisFit

    Raises
    ------
    RecordingError
        If the joint does not move enough, or slow movement contradicts the mounting on the signs.

    References
    ----------
    Seel, Schauer & Raisch (2012), IEEE Int. Conf. on Control Applications, 45-49.
    Olsson, Kok, Seel & Halvorsen (2020), Sensors 20(12), 3534.
    """
    (a1, w1), (a2, w2) = (
        tuple(lowpass_without_lag(signal, search.cutoff_hz, rate_hz).T for signal in sensor)
        for sensor in (proximal, distal)
    )
    _require_movement((w1, w2), search, place)
    chosen = _informative_rates(w1, w2, search, rate_hz)
    slow = _informative_forces((a1, a2), (w1, w2), search, rate_hz)
    samples = HingeSamples((w1[chosen], w2[chosen]), (a1[slow], a2[slow]), 1.0, 1.0 / FIRST_RATIO)
    ends = [nearest_minimum(*start, samples) for start in _starts(samples, search.starts)]
    best, samples = min(
        (_reweighted(end, samples, search) for end in _distinct(ends + _by_gravity(samples))),
        key=lambda pair: _misfit(*pair),
    )
    axes = _to_the_right(best, right, samples, place)
    rate, acc = residuals(*axes, samples.rates, samples.forces)
    return HingeAxisFit(
        *axes,
        sd_rad=_uncertainty(axes, samples, search, rate_hz, len(w1)),
        share=np.array([_share(axes[0], w1), _share(axes[1], w2)]),
        rate_residual_rad_s=_rms(rate),
        acc_residual_m_s2=_rms(acc) if len(slow) else float("nan"),
        agreeing=float(np.mean([_same(end, best) for end in ends])),
        n_rates=len(chosen),
        n_accelerations=len(slow),
    )


def _distinct(ends: list[Minimum]) -> list[Minimum]:
    """One of each, the best ones first."""
    found: list[Minimum] = []
    for end in sorted(ends, key=lambda end: end.cost):
        if not any(_same(end, other) and _one_sided(end, other) for other in found):
            found.append(end)
    return found


def _reweighted(
    end: Minimum, samples: HingeSamples, search: HingeSearch
) -> tuple[Minimum, HingeSamples]:
    """Descend again, each kind of residual weighted by its own size."""
    for _ in range(ROUNDS if len(samples.forces[0]) else 0):
        rate, acc = residuals(*end[:2], samples.rates, samples.forces)
        samples = samples._replace(
            rate_weight=1.0 / max(_rms(rate), search.rate_sd_rad_s),
            acc_weight=1.0 / max(_rms(acc), search.acc_sd_m_s2),
        )
        end = nearest_minimum(*end[:2], samples)
    return end, samples


def _misfit(end: Minimum, samples: HingeSamples) -> float:
    """Negative logarithm of the likelihood, each kind of residual as large as its weight says."""
    sizes = len(samples.rates[0]) * np.log(samples.rate_weight)
    if len(samples.forces[0]):
        sizes += len(samples.forces[0]) * np.log(samples.acc_weight)
    return float(0.5 * end.cost - sizes)


def _rms(values: Array) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(np.square(values))))


def _share(axis: Array, rate: Array) -> float:
    """Part of the squared rate about an axis."""
    return float(np.sum((rate @ axis) ** 2) / np.sum(rate**2))


def _require_movement(rates: tuple[Array, Array], search: HingeSearch, place: str) -> None:
    """Segments that turn alike, or not at all, have no axis between them."""
    difference = np.linalg.norm(rates[0], axis=1) - np.linalg.norm(rates[1], axis=1)
    if not _rms(difference) > 10.0 * search.rate_sd_rad_s:
        raise RecordingError(
            "the joint moves too little to find its axis",
            place=place or None,
            expected=f"rates that differ by {np.degrees(10.0 * search.rate_sd_rad_s):.0f} °/s",
            found=f"{np.degrees(_rms(difference)):.1f} °/s (root mean square)",
        )


def _informative_rates(
    one: Array, two: Array, search: HingeSearch, rate_hz: float
) -> NDArray[np.int64]:
    """Samples at which either sensor turns faster than the other: half of the number each."""
    n = len(one)
    if search.most_samples is None or search.most_samples >= n:
        return np.arange(n)
    difference = np.linalg.norm(one, axis=1) - np.linalg.norm(two, axis=1)
    steady = uniform_filter1d(difference, max(1, round(search.window_s * rate_hz)))
    order = np.argsort(steady, kind="stable")
    half = search.most_samples // 2
    return np.sort(np.concatenate([order[:half], order[n - half :]]))


def _informative_forces(
    forces: tuple[Array, Array], rates: tuple[Array, Array], search: HingeSearch, rate_hz: float
) -> NDArray[np.int64]:
    """Slow samples; where there are many, those whose directions of gravity are the rarest."""
    width = max(1, round(search.window_s * rate_hz))
    energy = np.max([uniform_filter1d(np.sum(w**2, axis=1), width) for w in rates], axis=0)
    slow = np.flatnonzero(energy < search.slow_rad_s**2)
    if len(slow) < FEWEST_SLOW:
        return slow[:0]
    rows = np.concatenate([forces[0][slow], -forces[1][slow]], axis=1)
    size = np.linalg.svd(rows, compute_uv=False)
    if size[1] < ONE_POSTURE * size[0]:
        return slow[:0]
    if search.most_samples is None or search.most_samples >= len(slow):
        return slow
    leverage = np.einsum("ni,ij,nj->n", rows, np.linalg.pinv(rows.T @ rows), rows)
    order = np.argsort(leverage, kind="stable")
    return np.sort(slow[order[-search.most_samples :]])


def _starts(samples: HingeSamples, number: int) -> list[tuple[Array, Array]]:
    """The best pairs of directions by their rates; with accelerometers both signs of each."""
    pairs = [(one, two) for one in DIRECTIONS for two in DIRECTIONS]
    nothing = (np.zeros((0, 3)), np.zeros((0, 3)))
    cost = [np.sum(residuals(*pair, samples.rates, nothing)[0] ** 2) for pair in pairs]
    found = [pairs[k] for k in np.argsort(cost, kind="stable")[:number]]
    signs = (1.0, -1.0) if len(samples.forces[0]) else (1.0,)
    return [(one, sign * two) for one, two in found for sign in signs]


def _by_gravity(samples: HingeSamples) -> list[Minimum]:
    """Axes that the accelerometers alone suggest, if there are any: a linear problem."""
    if not len(samples.forces[0]):
        return []
    rows = np.concatenate([samples.forces[0], -samples.forces[1]], axis=1)
    both = np.linalg.eigh(rows.T @ rows)[1][:, 0]
    one, two = (half / max(float(np.linalg.norm(half)), 1e-12) for half in (both[:3], both[3:]))
    return [Minimum(one, two, np.inf)]


def _same(end: Minimum, best: Minimum) -> bool:
    """Whether two searches found the same axes within 1°, whatever their signs."""
    limit = np.cos(1.0 * RAD_PER_DEG)
    return all(abs(a @ b) > limit for a, b in zip(end[:2], best[:2], strict=True))


def _one_sided(end: Minimum, other: Minimum) -> bool:
    """Whether both axes or neither have the opposite sign."""
    return bool((end.proximal @ other.proximal) * (end.distal @ other.distal) > 0.0)


def _to_the_right(
    found: Minimum, right: tuple[Array, Array], samples: HingeSamples, place: str
) -> tuple[Array, Array]:
    """Signs from the mounting; slow movement, where it tells, has to agree."""
    one, two = (
        axis if axis @ prior > 0.0 else -axis for axis, prior in zip(found[:2], right, strict=True)
    )
    if len(samples.forces[0]):
        this, other = (_rms(residuals(one, s * two, *samples[:2])[1]) for s in (1.0, -1.0))
        if this > CLEARLY_BETTER * other:
            raise RecordingError(
                "movement and mounting disagree on which side is right",
                place=place or None,
                expected="axes of a joint that point to the same side",
                found=f"gravity along them differs by {this:.1f} m/s², otherwise by {other:.1f}",
            )
    return one, two


def _uncertainty(
    axes: tuple[Array, Array], samples: HingeSamples, search: HingeSearch, rate_hz: float, n: int
) -> Array:
    """Standard deviation of each direction; samples that say the same count once."""
    share = min(1.0, search.independent_s * rate_hz / n)
    effective = max(4.0, n * share * min(1.0, 2.0 * search.cutoff_hz / rate_hz))
    variance = direction_variances(*axes, samples)
    return np.asarray(np.sqrt(variance * max(1.0, len(samples.rates[0]) / effective)))
