"""Trajectory of a foot from one IMU: orientation, velocity, position, zero-velocity epochs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from swaystride.findings import Finding, findings_to_json
from swaystride.gait.epoch_smoother import smoothed_states
from swaystride.gait.foot_checks import check_gravity, check_signals, foot_findings
from swaystride.gait.foot_methods import FootMethod
from swaystride.gait.linear_drift import epochs_of_movement, linear_drift_states
from swaystride.gait.zero_velocity import ZeroVelocity, find_zero_velocity
from swaystride.recording import AXES, QUATERNION_COMPONENTS
from swaystride.signals.gaps import fill_short_gaps, missing_runs

Array = NDArray[np.float64]
Index = NDArray[np.int64]

#: Missing samples up to this duration are interpolated; a longer gap cuts the recording in two.
LONGEST_FILLED_GAP_S: Final = 0.02
#: A shorter piece between two gaps holds no stride.
_SHORTEST_PIECE_S: Final = 0.5


def foot_trajectory(
    acc_m_s2: ArrayLike, gyr_rad_s: ArrayLike, rate_hz: float, method: FootMethod
) -> xr.Dataset:
    """Estimate the trajectory of a foot from a recording of any length.

    Rests, stances, and the start and stop of the movement are found. The sensor may be mounted in
    any orientation. A gap of more than 20 ms cuts the recording: no stride spans it, and the
    position after it continues where it was.

    Parameters
    ----------
    acc_m_s2 : array_like, shape (3, n_samples)
        Proper acceleration in the sensor frame (at rest it points up); missing samples are NaN.
    gyr_rad_s : array_like, shape (3, n_samples)
        Angular rate in the sensor frame.
    rate_hz : float
        Sampling rate, at least 50 Hz.
    method : FootMethod
        :data:`~swaystride.gait.foot_methods.RECOMMENDED`,
        :data:`~swaystride.gait.foot_methods.PRINTED`, or your own.

    Returns
    -------
    Dataset
        * ``orientation`` (component, time): ``q_world_from_sensor``, scalar first; world z up, the
          heading of the start is arbitrary;
        * ``velocity``, ``position`` (axis, time): m/s and m in world axes, from the first sample;
        * ``zero_velocity`` (time): samples that count as still;
        * ``epoch_index``, ``epoch_is_rest``, ``epoch_piece`` (epoch): the samples between which the
          foot moves: both ends of every rest, one sample of every stance, and the uninterrupted
          piece to which each belongs;
        * attributes ``rate_hz``, ``estimator``, ``motion_start_s``, ``motion_stop_s`` (NaN if the
          recording does not start or stop at rest) and ``findings``.

    Raises
    ------
    RecordingError
        If the signals cannot be those of a foot in m/s² and rad/s, or the rate is below 50 Hz.

    References
    ----------
    Methods, §2; Potter et al. (2019), Sensors 19(11):2601.

    Examples
    --------
    >>> from swaystride.gait.foot_methods import RECOMMENDED
    >>> still = np.tile([[0.0], [0.0], [9.80665]], 300)
    >>> trajectory = foot_trajectory(still, 0 * still, 100.0, RECOMMENDED)
    >>> float(abs(trajectory["position"]).max()) < 1e-6
    True
    """
    acc = np.ascontiguousarray(acc_m_s2, dtype=np.float64)
    gyr = np.ascontiguousarray(gyr_rad_s, dtype=np.float64)
    check_signals(acc, gyr, rate_hz)
    signals, findings = _pieces(acc, gyr, rate_hz)
    pieces: list[_Piece] = []
    for first, piece_acc, piece_gyr in signals:
        where = f"from {first / rate_hz:.2f} s" if len(signals) > 1 else ""
        found = find_zero_velocity(piece_acc, piece_gyr, rate_hz, method)
        check_gravity(piece_acc, found.flags, has_rest=len(found.rests) > 0)
        if not found.flags.any():
            none = "no still instant, no trajectory"
            findings.append(
                Finding("no_zero_velocity", "warning", "", where, "stances or rest", none)
            )
            continue
        start_m = pieces[-1].position[-1] if pieces else np.zeros(3)
        piece, n_doubted = _piece(first, piece_acc, piece_gyr, rate_hz, found, method, start_m)
        pieces.append(piece)
        findings += foot_findings(piece_acc, piece_gyr, found, n_doubted, where)
    return _dataset(pieces, acc.shape[1], rate_hz, method, findings)


@dataclass(frozen=True)
class _Piece:
    """Result of one uninterrupted piece, from its first sample on; epochs count from there."""

    first: int
    orientation: Array
    velocity: Array
    position: Array
    zero_velocity: NDArray[np.bool_]
    epochs: Index
    epoch_is_rest: NDArray[np.bool_]


def _pieces(
    acc: Array, gyr: Array, rate_hz: float
) -> tuple[list[tuple[int, Array, Array]], list[Finding]]:
    """Uninterrupted pieces (first sample, acceleration, rate), and what was seen of the gaps."""
    if np.isfinite(acc.sum() + gyr.sum()):
        return [(0, acc, gyr)], []
    signals = np.concatenate([acc, gyr])
    longest = max(1, round(LONGEST_FILLED_GAP_S * rate_hz))
    filled = fill_short_gaps(signals, longest_gap=longest)
    runs = missing_runs(filled).to_numpy(dtype=np.int64).tolist()
    findings = [
        Finding(
            "gap",
            "warning",
            "",
            f"at {start / rate_hz:.2f} s",
            f"no gap longer than {LONGEST_FILLED_GAP_S:g} s",
            f"{length / rate_hz:.2f} s missing: no stride spans it",
        )
        for start, length in runs
    ]
    edges = [0]
    for start, length in runs:
        edges += [start, start + length]
    edges.append(signals.shape[1])
    shortest = round(_SHORTEST_PIECE_S * rate_hz)
    pieces = [
        (
            first,
            np.ascontiguousarray(filled[:3, first:stop]),
            np.ascontiguousarray(filled[3:, first:stop]),
        )
        for first, stop in zip(edges[::2], edges[1::2], strict=True)
        if stop - first >= shortest
    ]
    return pieces, findings


def _piece(
    first: int,
    acc: Array,
    gyr: Array,
    rate_hz: float,
    found: ZeroVelocity,
    method: FootMethod,
    start_m: Array,
) -> tuple[_Piece, int]:
    """Estimate one piece, from its position at the start; also the number of doubted stances."""
    epochs, is_rest = epochs_of_movement(found)
    doubted = np.empty(0, dtype=np.int64)
    if method.estimator == "smoother":
        smoothed = smoothed_states(acc, gyr, rate_hz, found, method)
        orientation, velocity = smoothed.orientation, smoothed.velocity
        doubted = smoothed.epochs[~smoothed.believed]
    else:
        orientation, velocity = linear_drift_states(acc, gyr, rate_hz, found, method)
    position = np.empty_like(velocity)
    position[0] = start_m
    np.cumsum(0.5 / rate_hz * (velocity[1:] + velocity[:-1]), axis=0, out=position[1:])
    position[1:] += start_m
    flags = found.flags
    flags[doubted] = False
    kept = ~np.isin(epochs, doubted)
    piece = _Piece(first, orientation, velocity, position, flags, epochs[kept], is_rest[kept])
    return piece, len(doubted)


def _joined(pieces: list[_Piece], name: str, shape: tuple[int, ...]) -> Array:
    """One state of the whole recording; samples outside the pieces are missing."""
    parts = [getattr(piece, name) for piece in pieces]
    if len(parts) == 1 and parts[0].shape == shape:
        return np.asarray(parts[0])
    whole = np.full(shape, np.nan)
    for piece, part in zip(pieces, parts, strict=True):
        whole[piece.first : piece.first + len(part)] = part
    return whole


def _dataset(
    pieces: list[_Piece], n: int, rate_hz: float, method: FootMethod, findings: list[Finding]
) -> xr.Dataset:
    """Assemble the result."""
    empty = np.empty(0, dtype=np.int64)
    index = np.concatenate([empty, *(p.epochs + p.first for p in pieces)])
    is_rest = np.concatenate([empty.astype(bool), *(p.epoch_is_rest for p in pieces)])
    number = np.concatenate([empty, *(np.full(len(p.epochs), i) for i, p in enumerate(pieces))])
    still = np.zeros(n, dtype=np.bool_)
    for piece in pieces:
        still[piece.first : piece.first + len(piece.zero_velocity)] = piece.zero_velocity
    start_s, stop_s = _movement(index, is_rest, still, rate_hz)
    return xr.Dataset(
        {
            "orientation": (("component", "time"), _joined(pieces, "orientation", (n, 4)).T),
            "velocity": (("axis", "time"), _joined(pieces, "velocity", (n, 3)).T, {"units": "m/s"}),
            "position": (("axis", "time"), _joined(pieces, "position", (n, 3)).T, {"units": "m"}),
            "zero_velocity": (("time",), still),
            "epoch_index": (("epoch",), index),
            "epoch_is_rest": (("epoch",), is_rest),
            "epoch_piece": (("epoch",), number),
        },
        coords={
            "time": np.arange(n) / rate_hz,
            "axis": list(AXES),
            "component": list(QUATERNION_COMPONENTS),
        },
        attrs={
            "rate_hz": float(rate_hz),
            "estimator": method.estimator,
            "motion_start_s": start_s,
            "motion_stop_s": stop_s,
            "findings": findings_to_json(findings),
        },
    )


def _movement(
    index: Index, is_rest: NDArray[np.bool_], still: NDArray[np.bool_], rate_hz: float
) -> tuple[float, float]:
    """End of the rest at the start and begin of the rest at the end, in s; NaN where there is none."""
    starts = len(index) > 1 and still[0] and is_rest[0] and is_rest[1]
    stops = len(index) > 1 and still[-1] and is_rest[-1] and is_rest[-2]
    return (
        float(index[1] / rate_hz) if starts else float("nan"),
        float(index[-2] / rate_hz) if stops else float("nan"),
    )
