"""Whether the recordings of a trial are what they should be: running, standing, alike, at once."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from swaystride.errors import RecordingError
from swaystride.findings import Finding
from swaystride.gait.initial_contact import InitialContactRule, expected_stride_s
from swaystride.marker_recording import MarkerRecording
from swaystride.recording import Recording
from swaystride.signals.gaps import missing_runs
from swaystride.units import DEG_PER_RAD

#: Median angular rate that no sensor of a standing person has, rad/s [N]: sway turns a segment by
#: some 2°/s, running by more than 60°/s.
_STANDING_RATE_RAD_S: Final = 0.35
#: Markers that end earlier than the sensors by more are reported, s [N]: more than one stride.
_EARLY_END_S: Final = 1.0


class UnusableTrialError(RecordingError):
    """A trial that is left out by rule; the participant's others go on."""


def require_same_rate(
    sensors: Recording, markers: MarkerRecording, files: Mapping[str, str]
) -> None:
    """Refuse sensors and cameras that do not sample alike (D§4.3.2).

    Parameters
    ----------
    sensors : Recording
    markers : MarkerRecording
    files : mapping of str to str
        By kind, for the message.

    Raises
    ------
    RecordingError
        If rates differ by more than 0.1 %.
    """
    own, other = float(sensors.attrs["rate_hz"]), float(markers.attrs["rate_hz"])
    if abs(own / other - 1.0) > 1e-3:
        raise RecordingError(
            "sensors and cameras have different rates",
            file=files["running_markers"],
            expected=f"{own:g} Hz as in {files['running_imu']}",
            found=f"{other:g} Hz",
        )


def require_running(recording: Recording, file: str, contacts: InitialContactRule) -> None:
    """Leave a trial out unless both feet have the rhythm of a run.

    Parameters
    ----------
    recording : Recording
        Sensors named as the segments, without gaps.
    file : str
        For the message.
    contacts : InitialContactRule

    Raises
    ------
    UnusableTrialError
        If a foot has no rhythm.
    """
    for foot in ("right_foot", "left_foot"):
        rate = np.linalg.norm(recording["gyr"].sel(sensor=foot).to_numpy(), axis=0)
        try:
            expected_stride_s(
                rate,
                float(recording.attrs["rate_hz"]),
                contacts,
                place=foot.replace("_", " "),
            )
        except RecordingError as error:
            raise UnusableTrialError(
                "nobody runs in the trial",
                file=file,
                place=error.place,
                expected=error.expected,
                found=error.found,
            ) from None


def require_standing(recording: Recording, file: str) -> None:
    """Refuse a static trial of the sensors in which somebody moves.

    Parameters
    ----------
    recording : Recording
        Without gaps.
    file : str
        For the message.

    Raises
    ------
    RecordingError
        If a sensor turns for half of the time.
    """
    rate = np.median(np.linalg.norm(recording["gyr"].to_numpy(), axis=1), axis=1)
    worst = int(np.argmax(rate))
    if rate[worst] > _STANDING_RATE_RAD_S:
        raise RecordingError(
            "the static trial is not quiet standing",
            file=file,
            place=str(recording["sensor"].to_numpy()[worst]).replace("_", " "),
            expected=f"a median angular rate below {_STANDING_RATE_RAD_S * DEG_PER_RAD:.0f} deg/s",
            found=f"{rate[worst] * DEG_PER_RAD:.0f} deg/s",
        )


def require_overlap(
    sensors: Recording, markers: MarkerRecording, shortest_s: float, file: str
) -> list[Finding]:
    """Leave a trial out if too little of it was filmed, and report if the film ends early.

    Parameters
    ----------
    sensors : Recording
        The part that is used; its attribute ``start_s`` says where it begins.
    markers : MarkerRecording
        From the begin of the file of the sensors.
    shortest_s : float
        Least time with both.
    file : str
        Of the markers, for the message.

    Returns
    -------
    list of Finding

    Raises
    ------
    UnusableTrialError
        If both share less.
    """
    rate_hz = float(sensors.attrs["rate_hz"])
    start_s = float(sensors.attrs["start_s"])
    end_s, filmed_s = start_s + sensors.sizes["time"] / rate_hz, markers.sizes["time"] / rate_hz
    common_s = min(end_s, filmed_s) - start_s
    if common_s < shortest_s:
        raise UnusableTrialError(
            "too little is recorded by sensors and markers at once",
            file=file,
            expected=f"{shortest_s:g} s",
            found=f"{max(common_s, 0.0):.2f} s",
        )
    if end_s - filmed_s <= _EARLY_END_S:
        return []
    found = f"markers end at {filmed_s:.2f} s; later strides have none"
    whole = f"markers up to the end of the sensors at {end_s:.2f} s"
    return [Finding("markers_end_early", "warning", file, "whole recording", whole, found)]


def without_frozen(
    recording: Recording, longest_s: float, file: str
) -> tuple[Recording, list[Finding]]:
    """Take out samples at which a sensor repeats its last one: it has stopped.

    Parameters
    ----------
    recording : Recording
        With ``acc`` and ``gyr``.
    longest_s : float
        All six channels stay the same for longer only in a sensor that has stopped.
    file : str
        For the findings.

    Returns
    -------
    recording : Recording
        With NaN there.
    findings : list of Finding
        One per sensor that stops.
    """
    rate_hz = float(recording.attrs["rate_hz"])
    signals = np.concatenate([recording["acc"].to_numpy(), recording["gyr"].to_numpy()], axis=1)
    same = (np.diff(signals, axis=2) == 0.0).all(axis=1)
    out, findings = recording.copy(deep=True), []
    for row, name in enumerate(recording["sensor"].to_numpy()):
        runs = missing_runs(np.where(same[row], np.nan, 0.0))
        runs = runs[runs["length"] > longest_s * rate_hz]
        for start, length in runs.to_numpy():
            for signal in ("acc", "gyr"):
                out[signal].to_numpy()[row, :, start + 1 : start + 1 + length] = np.nan
        if len(runs):
            first = runs["start"].iloc[0] / rate_hz
            findings.append(
                Finding(
                    "sensor_frozen",
                    "warning",
                    file,
                    f"{str(name).replace('_', ' ')}, first at t = {first:.3f} s",
                    f"no sample repeated for longer than {longest_s:g} s",
                    f"{runs['length'].sum() / rate_hz:.3f} s of repeated samples, taken as missing",
                )
            )
    return out, findings
