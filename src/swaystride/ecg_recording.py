"""The electrocardiogram: what the readers of chest straps return.

An ECG is an :class:`xarray.Dataset` with

* ``ecg`` in V over ``time`` (s from the first sample, uniformly spaced; a lost sample is NaN);
* optionally, over ``report``, what the strap's own software said and when: ``strap_rr_s``,
  ``strap_hr_bpm`` (NaN where only the other was reported) and the coordinate ``report_time`` (s);
* attributes ``rate_hz``, ``rate_source``, ``start_ns`` (whole nanoseconds since ``clock_epoch``, of
  the first sample), ``device``, ``source_file``, ``source_sha256`` and ``findings`` (JSON).
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from swaystride.errors import RecordingError
from swaystride.findings import Finding, findings_to_json

EcgRecording = xr.Dataset

UNIX_EPOCH = "1970-01-01T00:00:00Z"
POLAR_EPOCH = "2000-01-01T00:00:00Z"


def make_ecg(
    ecg_v: ArrayLike,
    *,
    rate_hz: float,
    rate_source: str,
    start_ns: int,
    clock_epoch: str,
    report_time_s: ArrayLike = (),
    strap_rr_s: ArrayLike = (),
    strap_hr_bpm: ArrayLike = (),
    device: str = "unknown",
    source_file: str = "",
    source_sha256: str = "",
    findings: Iterable[Finding] = (),
) -> EcgRecording:
    """Assemble an electrocardiogram from plain arrays.

    Parameters
    ----------
    ecg_v : array_like, shape (n_samples,)
        In V; NaN where samples are lost.
    rate_hz : float
    rate_source : str
        Where the rate was learnt: ``time stamps`` or ``argument``.
    start_ns : int
        Time of the first sample, ns since `clock_epoch`.
    clock_epoch : str
        :data:`UNIX_EPOCH`, or :data:`POLAR_EPOCH` for the strap's own clock.
    report_time_s, strap_rr_s, strap_hr_bpm : array_like, shape (n_reports,)
        What the strap reported itself, if it did; all three of one length.
    device, source_file, source_sha256 : str
        Provenance.
    findings : iterable of Finding

    Returns
    -------
    EcgRecording

    Raises
    ------
    RecordingError
        If the rate is not positive.

    Examples
    --------
    >>> ecg = make_ecg(np.zeros(260), rate_hz=130.0, rate_source="argument", start_ns=0,
    ...                clock_epoch=UNIX_EPOCH)
    >>> float(ecg["time"][-1])
    1.9923076923076923
    """
    if not (np.isfinite(rate_hz) and rate_hz > 0):
        raise RecordingError(
            "sampling rate is not a positive number",
            file=source_file or None,
            expected="rate_hz > 0",
            found=str(rate_hz),
        )
    ecg = np.asarray(ecg_v, dtype=np.float64)
    variables = {"ecg": ("time", ecg, {"units": "V"})}
    coords: dict[str, object] = {"time": np.arange(len(ecg)) / rate_hz}
    if np.size(report_time_s):
        coords["report_time"] = ("report", np.asarray(report_time_s, dtype=np.float64))
        for name, values, unit in (
            ("strap_rr_s", strap_rr_s, "s"),
            ("strap_hr_bpm", strap_hr_bpm, "1/min"),
        ):
            variables[name] = ("report", np.asarray(values, dtype=np.float64), {"units": unit})
    return xr.Dataset(
        variables,
        coords=coords,
        attrs={
            "rate_hz": float(rate_hz),
            "rate_source": rate_source,
            "start_ns": int(start_ns),
            "clock_epoch": clock_epoch,
            "device": device,
            "source_file": source_file,
            "source_sha256": source_sha256,
            "findings": findings_to_json(findings),
        },
    )
