"""The marker recording: what the readers of motion capture return.

A marker recording is an :class:`xarray.Dataset` with

* ``position`` in m over ``marker``, ``axis`` (x, y, z of the laboratory) and ``time`` (s from the
  first frame, uniformly spaced); a marker that was not seen is NaN;
* optionally ``analog`` over ``channel`` and ``analog_time`` (s from the first frame), in the unit that
  the coordinate ``analog_unit`` names for each channel, as the file has it;
* attributes ``rate_hz``, ``rate_source``, ``file_unit`` (unit of the positions in the file),
  ``subject``, ``first_frame``, ``device``, ``source_file``, ``source_sha256``, ``findings`` (JSON).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError
from swaystride.findings import Finding, findings_to_json
from swaystride.recording import AXES

MarkerRecording = xr.Dataset


def make_marker_recording(
    position_m: ArrayLike,
    *,
    markers: Sequence[str],
    rate_hz: float,
    rate_source: str,
    analog: ArrayLike | None = None,
    analog_rate_hz: float | None = None,
    channels: Sequence[str] = (),
    analog_units: Sequence[str] = (),
    file_unit: str = "m",
    subject: str = "",
    first_frame: int = 0,
    device: str = "unknown",
    source_file: str = "",
    source_sha256: str = "",
    findings: Iterable[Finding] = (),
) -> MarkerRecording:
    """Assemble a marker recording from plain arrays.

    Parameters
    ----------
    position_m : array_like, shape (n_markers, 3, n_frames)
        NaN where a marker was not seen.
    markers : sequence of str
        One name per marker, each once.
    rate_hz : float
    rate_source : str
        Where the rate was learnt.
    analog : array_like, shape (n_channels, n_analog), optional
    analog_rate_hz : float, optional
        Needed with `analog`.
    channels, analog_units : sequence of str
        Name and unit of each analog channel.
    file_unit, subject, device, source_file, source_sha256 : str
        Provenance.
    first_frame : int
        Number of the first frame in the file, from zero.
    findings : iterable of Finding

    Returns
    -------
    MarkerRecording

    Raises
    ------
    RecordingError
        If a rate is not positive, names repeat, or shapes disagree.

    Examples
    --------
    >>> markers = make_marker_recording(np.zeros((1, 3, 5)), markers=["L.Heel"], rate_hz=200.0,
    ...                                 rate_source="header")
    >>> markers["position"].sel(marker="L.Heel", axis="z").sizes["time"]
    5
    """
    position = np.asarray(position_m, dtype=np.float64)
    sizes = (len(markers), len(AXES))
    if position.ndim != 3 or position.shape[:2] != sizes or len(set(markers)) != len(markers):
        raise RecordingError(
            "positions and names of the markers do not fit together",
            file=source_file or None,
            expected=f"shape ({sizes[0]}, {sizes[1]}, n) and every name once",
            found=f"{position.shape} and {len(set(markers))} different names",
        )
    for rate in (rate_hz, *([] if analog is None else [analog_rate_hz or 0.0])):
        if not (np.isfinite(rate) and rate > 0):
            raise RecordingError(
                "sampling rate is not a positive number",
                file=source_file or None,
                expected="a rate above 0 Hz",
                found=str(rate),
            )
    variables: dict[str, object] = {
        "position": (("marker", "axis", "time"), position, {"units": "m"})
    }
    coords: dict[str, object] = {
        "marker": list(markers),
        "axis": list(AXES),
        "time": np.arange(position.shape[2]) / rate_hz,
    }
    attributes: dict[str, object] = {"rate_hz": float(rate_hz), "rate_source": rate_source}
    if analog is not None and analog_rate_hz is not None:
        values = np.asarray(analog, dtype=np.float64)
        variables["analog"] = (("channel", "analog_time"), values)
        coords["channel"] = list(channels)
        coords["analog_unit"] = ("channel", list(analog_units))
        coords["analog_time"] = np.arange(values.shape[1]) / analog_rate_hz
        attributes["analog_rate_hz"] = float(analog_rate_hz)
    return xr.Dataset(
        variables,
        coords=coords,
        attrs={
            **attributes,
            "file_unit": file_unit,
            "subject": subject,
            "first_frame": first_frame,
            "device": device,
            "source_file": source_file,
            "source_sha256": source_sha256,
            "findings": findings_to_json(findings),
        },
    )


def marker_positions(recording: MarkerRecording, markers: Sequence[str]) -> NDArray[np.float64]:
    """Positions of named markers.

    Parameters
    ----------
    recording : MarkerRecording
    markers : sequence of str
        Names, in the order wanted.

    Returns
    -------
    ndarray, shape (n_markers, 3, n_frames)
        In m.

    Raises
    ------
    RecordingError
        If a marker is absent; the line names those that are there.

    Examples
    --------
    >>> there = make_marker_recording(np.zeros((1, 3, 5)), markers=["L.Heel"], rate_hz=200.0,
    ...                               rate_source="header", source_file="run.c3d")
    >>> marker_positions(there, ["R.Heel"])
    Traceback (most recent call last):
    ...
    swaystride.errors.RecordingError: run.c3d: no such marker; expected one of L.Heel; found 'R.Heel'
    """
    names = recording["marker"].values.tolist()
    for marker in markers:
        if marker not in names:
            raise RecordingError(
                "no such marker",
                file=recording.attrs["source_file"] or None,
                expected="one of " + ", ".join(names),
                found=repr(marker),
            )
    return recording["position"].to_numpy()[[names.index(marker) for marker in markers]]
