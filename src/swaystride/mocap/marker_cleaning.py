"""From the markers of a file to clean ones: gaps filled, low-passed, everything listed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from swaystride.findings import findings_from_json, findings_to_json
from swaystride.marker_recording import MarkerRecording
from swaystride.mocap.marker_filter import Realisation, filter_markers
from swaystride.mocap.marker_gaps import PRINTED_LIMITS, GapLimits, fill_gaps, gap_findings
from swaystride.mocap.marker_set import SIDES, MarkerSet, points


@dataclass(frozen=True)
class Cleaning:
    """How markers are cleaned.

    Parameters
    ----------
    limits : GapLimits
        Longest gaps.
    cutoff_hz : float
        Of the low-pass.
    realisation : {"net_fourth_order", "fourth_order_twice"}
        Of the low-pass, see :func:`swaystride.mocap.marker_filter.filter_markers`.
    """

    limits: GapLimits
    cutoff_hz: float
    realisation: Realisation


#: D§4.3.4.1: limits and 10 Hz; the realisation of the filter is [N] (methods §5.1).
PRINTED_CLEANING: Final = Cleaning(PRINTED_LIMITS, 10.0, "net_fourth_order")


def clean_markers(
    recording: MarkerRecording,
    markers: MarkerSet,
    cleaning: Cleaning,
    *,
    names: tuple[str, ...] | None = None,
) -> MarkerRecording:
    """Fill gaps and low-pass; a marker exactly at the origin of the laboratory counts as lost.

    Parameters
    ----------
    recording : MarkerRecording
    markers : MarkerSet
        Says which markers are on one segment.
    cleaning : Cleaning
    names : tuple of str, optional
        Markers to clean and keep; by default those that track the segments in motion.

    Returns
    -------
    MarkerRecording
        With these markers only; every gap is added to its findings.

    Raises
    ------
    RecordingError
        If a marker is missing throughout.
    """
    chosen = names or markers.motion_markers()
    seen = points(recording, chosen)
    rate_hz = float(recording.attrs["rate_hz"])
    filled, gaps = fill_gaps(
        seen,
        chosen,
        limits=cleaning.limits,
        rigid=_rigid_bodies(markers),
        patterns=_segments(markers),
    )
    smooth = filter_markers(
        filled, rate_hz=rate_hz, cutoff_hz=cleaning.cutoff_hz, realisation=cleaning.realisation
    )
    out = recording.sel(marker=list(chosen)).copy()
    out["position"] = out["position"].copy(data=smooth.transpose(0, 2, 1))
    before = findings_from_json(recording.attrs["findings"])
    here = gap_findings(gaps, rate_hz, str(recording.attrs["source_file"]))
    out.attrs["findings"] = findings_to_json([*before, *here])
    return out


def _rigid_bodies(markers: MarkerSet) -> tuple[tuple[str, ...], ...]:
    """The pelvis (D§4.3.4.1), and the clusters of plates if there are any."""
    clusters = [
        segment
        for side in SIDES
        for segment in (markers.leg(side).thigh, markers.leg(side).shank, markers.leg(side).foot)
        if len(segment) >= 4
    ]
    return (markers.pelvis, *clusters)


def _segments(markers: MarkerSet) -> tuple[tuple[str, ...], ...]:
    """Markers that move alike: one segment each, and for two-marker segments the leg's chain."""
    groups = [markers.pelvis]
    for side in SIDES:
        leg = markers.leg(side)
        groups += [leg.thigh, leg.shank, leg.foot]
        if markers.tracking == "trio":
            # the epicondyle moves with the top of the shank, the malleolus with the heel
            groups += [(leg.knee, *leg.shank[:1]), (leg.ankle, leg.heel)]
    return tuple(groups)
