"""Gaps in marker trajectories: a smooth piece, a rigid body, a neighbour's pattern (methods §5.1).

The order is that of the printed study: a smooth piece for short gaps, then the rigid body for
markers of a body that hardly deforms (the pelvis), then the pattern of a neighbour on the same
segment. What no method may fill stays missing. Every gap is listed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.findings import Finding
from swaystride.mocap.segment_frames import rigid_fit
from swaystride.signals.gaps import missing_runs

Array = NDArray[np.float64]

#: Degree of the smooth piece: that of the spline of Woltring (1986).
_DEGREE: Final = 5
#: Least number of frames that must be seen on each side of a gap.
_LEAST_BESIDE: Final = 3


@dataclass(frozen=True)
class GapLimits:
    """How long a gap each method may fill.

    Parameters
    ----------
    smooth_frames, rigid_frames, pattern_frames : int
        Longest gap; printed are 10, 20 and 20 (D§4.3.4.1).
    beside_frames : int
        Frames on each side that the fill looks at.
    """

    smooth_frames: int
    rigid_frames: int
    pattern_frames: int
    beside_frames: int


#: Limits as printed; five frames on each side [N].
PRINTED_LIMITS: Final = GapLimits(10, 20, 20, 5)


def fill_gaps(
    position_m: Array,
    names: tuple[str, ...],
    *,
    limits: GapLimits,
    rigid: tuple[tuple[str, ...], ...],
    patterns: tuple[tuple[str, ...], ...],
) -> tuple[Array, pd.DataFrame]:
    """Fill gaps of all markers.

    Parameters
    ----------
    position_m : ndarray, shape (n_markers, n_frames, 3)
        NaN where a marker was not seen.
    names : tuple of str
        Of the markers.
    limits : GapLimits
    rigid : tuple of tuple of str
        Bodies of at least four markers, in which one marker follows from the others.
    patterns : tuple of tuple of str
        Markers that move alike, among which a donor may be chosen.

    Returns
    -------
    filled_m : ndarray, shape (n_markers, n_frames, 3)
        A copy.
    gaps : DataFrame
        ``marker``, ``start`` (frame), ``length`` (frames), ``method`` (``smooth``, ``rigid``,
        ``pattern``, or empty where the gap stays).
    """
    filled = np.array(position_m)
    rows = [
        {"marker": name, "row": row, "start": start, "length": length}
        for row, name in enumerate(names)
        for start, length in missing_runs(filled[row].T).to_numpy(dtype=np.intp).tolist()
    ]
    gaps = pd.DataFrame(rows, columns=["marker", "row", "start", "length"])
    gaps["method"] = ""
    before = filled.copy()
    index = {name: row for row, name in enumerate(names)}
    bodies = [[index[name] for name in body if name in index] for body in rigid]
    donors = [[index[name] for name in group if name in index] for group in patterns]
    steps: tuple[tuple[str, int, Callable[[Array, int, slice], Array | None]], ...] = (
        ("smooth", limits.smooth_frames, lambda p, row, gap: _smooth(p[row], gap, limits)),
        ("rigid", limits.rigid_frames, lambda p, row, gap: _rigid(p, row, gap, bodies, limits)),
        ("pattern", limits.pattern_frames, lambda p, row, gap: _pattern(p, row, gap, donors)),
    )
    for method, longest, fill in steps:
        # what a step fills, later steps may look at; within a step the order does not matter
        for gap in gaps[(gaps["method"] == "") & (gaps["length"] <= longest)].itertuples():
            row, span = int(str(gap.row)), _span(int(str(gap.start)), int(str(gap.length)))
            values = fill(before, row, span)
            if values is not None:
                filled[row, span] = values
                gaps.loc[gap.Index, "method"] = method
        before = filled.copy()
    return filled, gaps.drop(columns="row")


def gap_findings(gaps: pd.DataFrame, rate_hz: float, file: str) -> list[Finding]:
    """One finding per gap: ``info`` if it was filled, ``warning`` if it stays.

    Parameters
    ----------
    gaps : DataFrame
        From :func:`fill_gaps`.
    rate_hz : float
        Frames per second.
    file : str
        Name of the recording.
    """
    return [
        Finding(
            check="marker_gap_filled" if method else "marker_gap_stays",
            severity="info" if method else "warning",
            file=file,
            place=f"{marker}, t = {start / rate_hz:.2f} s",
            expected="no gap",
            found=f"{length} frames, "
            + (f"filled ({method})" if method else "too long, at an end or without help"),
        )
        for marker, start, length, method in zip(
            *(gaps[name].tolist() for name in ("marker", "start", "length", "method")), strict=True
        )
    ]


def _span(start: int, length: int) -> slice:
    return slice(start, start + length)


def _smooth(marker: Array, gap: slice, limits: GapLimits) -> Array | None:
    """One quintic, fitted by least squares to the frames beside the gap."""
    width = limits.beside_frames
    left = np.arange(max(gap.start - width, 0), gap.start)
    right = np.arange(gap.stop, min(gap.stop + width, len(marker)))
    left, right = (side[np.isfinite(marker[side]).all(axis=1)] for side in (left, right))
    if min(len(left), len(right)) < _LEAST_BESIDE:
        return None
    beside = np.r_[left, right]
    middle, half = (gap.start + gap.stop - 1) / 2.0, (gap.stop - gap.start) / 2.0 + width
    known = np.polynomial.chebyshev.chebvander((beside - middle) / half, _DEGREE)
    wanted = np.polynomial.chebyshev.chebvander(
        (np.arange(gap.start, gap.stop) - middle) / half, _DEGREE
    )
    return np.asarray(wanted @ np.linalg.lstsq(known, marker[beside], rcond=None)[0])


def _rigid(
    position: Array, row: int, gap: slice, bodies: list[list[int]], limits: GapLimits
) -> Array | None:
    """From the other markers of the body; what is left at both ends is taken off linearly."""
    for body in bodies:
        others = [other for other in body if other != row]
        if row not in body or len(others) < 3 or _at_an_end(position[row], gap):
            continue
        wide = slice(gap.start - 1, gap.stop + 1)
        near = slice(max(gap.start - limits.beside_frames, 0), gap.stop + limits.beside_frames)
        if not np.isfinite(position[others, wide]).all():
            continue
        whole = np.isfinite(position[:, near][[row, *others]]).all(axis=(0, 2))
        template = _mean_shape(position[[row, *others], near][:, whole])
        rotation, origin, _ = rigid_fit(position[others, wide], template[1:])
        return _closed(rotation @ template[0] + origin, position[row], wide)
    return None


def _pattern(position: Array, row: int, gap: slice, groups: list[list[int]]) -> Array | None:
    """From the neighbour whose distance changes least over the gap."""
    if _at_an_end(position[row], gap):
        return None
    wide = slice(gap.start - 1, gap.stop + 1)
    candidates = {
        other
        for group in groups
        if row in group
        for other in group
        if other != row and np.isfinite(position[other, wide]).all()
    }
    if not candidates:
        return None
    ends = [wide.start, wide.stop - 1]

    def change(other: int) -> float:
        apart = position[row, ends] - position[other, ends]
        return float(np.linalg.norm(apart[1] - apart[0]))

    donor = min(sorted(candidates), key=change)
    return _closed(position[donor, wide], position[row], wide)


def _at_an_end(marker: Array, gap: slice) -> bool:
    """Whether a frame before or after the gap is lacking."""
    return bool(gap.start < 1 or gap.stop >= len(marker))


def _closed(path: Array, marker: Array, wide: slice) -> Array:
    """A path moved so that it meets the marker on both sides of the gap; without these two."""
    miss = marker[[wide.start, wide.stop - 1]] - path[[0, -1]]
    weight = np.linspace(0.0, 1.0, len(path))[:, None]
    return np.asarray((path + miss[0] + weight * (miss[1] - miss[0]))[1:-1])


def _mean_shape(points: Array) -> Array:
    """Mean of a moving shape, (m, n, 3) to (m, 3), in the pose of its first frame."""
    rotation, origin, _ = rigid_fit(points, points[:, 0])
    local = np.einsum("nba,mnb->mna", rotation, points - origin)
    return np.asarray(local.mean(axis=1))
