"""Whether the markers of a segment in motion are those of the static trial."""

from __future__ import annotations

from itertools import combinations
from typing import Final

import numpy as np
from numpy.typing import NDArray

from swaystride.findings import Finding
from swaystride.marker_recording import MarkerRecording
from swaystride.mocap.marker_set import SIDES, MarkerSet, points

#: Change of a distance within a segment that soft tissue does not explain [N]; the markers of the
#: pelvis of two real runners change by up to 10 mm.
_LARGEST_CHANGE_M: Final = 0.015


def segment_findings(
    recording: MarkerRecording, static: MarkerRecording, markers: MarkerSet
) -> list[Finding]:
    """Find exchanged labels and markers that were moved between static trial and motion.

    The median distance of two markers of a segment should be that of the static trial.

    Parameters
    ----------
    recording, static : MarkerRecording
    markers : MarkerSet

    Returns
    -------
    list of Finding
        One warning per segment, with the pair that changes most.
    """
    found = []
    for names in segments_of(markers):
        pairs = list(combinations(range(len(names)), 2))
        one, two = (_distances(points(source, names), pairs) for source in (static, recording))
        worst = int(np.argmax(np.abs(two - one)))
        if abs(two[worst] - one[worst]) > _LARGEST_CHANGE_M:
            a, b = (names[row] for row in pairs[worst])
            found.append(
                Finding(
                    check="segment_changed_its_shape",
                    severity="warning",
                    file=str(recording.attrs["source_file"]),
                    place=f"{a} - {b}",
                    expected=f"{one[worst]:.3f} m, as in the static trial; labels not exchanged",
                    found=f"{two[worst]:.3f} m",
                )
            )
    return found


def segments_of(markers: MarkerSet) -> list[tuple[str, ...]]:
    """Markers of pelvis, thighs, shanks and feet, those of a segment together.

    Parameters
    ----------
    markers : MarkerSet
    """
    legs = [markers.leg(side) for side in SIDES]
    groups = [markers.pelvis, *(g for leg in legs for g in (leg.thigh, leg.shank, leg.foot))]
    return [group for group in groups if len(group) > 1]


def _distances(position: NDArray[np.float64], pairs: list[tuple[int, int]]) -> NDArray[np.float64]:
    """Median distance of each pair."""
    return np.array(
        [np.nanmedian(np.linalg.norm(position[a] - position[b], axis=1)) for a, b in pairs]
    )
