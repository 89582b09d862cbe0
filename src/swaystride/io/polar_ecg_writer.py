"""Write what chest straps record, in the files of their applications; :mod:`swaystride.io.polar_ecg`.

Lost samples (NaN) between the first and the last are left out; the time stamps show them.
"""

from __future__ import annotations

import datetime
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.ecg_recording import POLAR_EPOCH, UNIX_EPOCH, EcgRecording
from swaystride.errors import RecordingError
from swaystride.io.polar_ecg import (
    ECG_LOGGER_COLUMNS,
    ECG_LOGGER_DIGITS,
    ECG_LOGGER_UNIT,
    SENSOR_TIME,
)
from swaystride.recording import Recording
from swaystride.units import FACTORS_TO_SI

#: Seconds from 1970 to 2000.
POLAR_EPOCH_UNIX_S = 946_684_800
_MISSING = "NA"


def write_ecg_logger(path: Path | str, ecg: EcgRecording) -> None:
    """Write an electrocardiogram as ECGLogger does: ``time,ecg,hr,rr``, mV to three decimals.

    Heart rate and RR intervals that the recording carries as the strap's own stand in the rows
    nearest to their time, as whole 1/min and ms.

    Parameters
    ----------
    path : path or str
        File to write; replaced if it exists.
    ecg : EcgRecording
        With ``start_ns`` since 1970.

    Raises
    ------
    RecordingError
        If its clock is another, or before the year 2001 (fewer than 19 digits).

    Examples
    --------
    >>> import tempfile
    >>> from swaystride.ecg_recording import make_ecg
    >>> path = Path(tempfile.mkdtemp(), "run.csv")
    >>> write_ecg_logger(path, make_ecg([1e-4, np.nan, -2e-4], rate_hz=125.0, rate_source="argument",
    ...     start_ns=1_714_920_600_000_000_000, clock_epoch=UNIX_EPOCH,
    ...     report_time_s=[0.016], strap_rr_s=[0.751], strap_hr_bpm=[80]))
    >>> print(path.read_text())
    time,ecg,hr,rr
    1714920600000000000,0.100,NA,NA
    1714920600016000000,-0.200,80,751
    <BLANKLINE>
    """
    path = Path(path)
    _require_clock(ecg.attrs, UNIX_EPOCH, path)
    start_ns = ecg.attrs["start_ns"]
    if len(str(start_ns)) != ECG_LOGGER_DIGITS or start_ns < 0:
        raise RecordingError(
            "the start does not fit the format",
            file=path.name,
            expected=f"{ECG_LOGGER_DIGITS} digits of ns since 1970",
            found=str(start_ns),
        )
    ecg_v = ecg["ecg"].values
    n = len(ecg_v)
    reports = {name: np.full(n, _MISSING, dtype=object) for name in ("hr", "rr")}
    kept = _kept(ecg_v[None])
    if "report" in ecg.sizes:
        rows = _rows_of_reports(ecg["report_time"].values, ecg.attrs["rate_hz"], n)
        for name, values in (("hr", ecg["strap_hr_bpm"]), ("rr", ecg["strap_rr_s"] * 1e3)):
            numbers = values.values
            said = np.isfinite(numbers)
            reports[name][rows[said]] = [f"{number:.0f}" for number in numbers[said]]
        kept[rows] = True
    printed = np.char.mod("%.3f", ecg_v / FACTORS_TO_SI["voltage"][ECG_LOGGER_UNIT]).astype(object)
    printed[np.isnan(ecg_v)] = _MISSING
    columns = [_stamps(ecg.attrs, n), printed, reports["hr"], reports["rr"]]
    _write(path, ",", ECG_LOGGER_COLUMNS, [column[kept] for column in columns])


def write_polar_ecg(path: Path | str, ecg: EcgRecording) -> None:
    """Write an electrocardiogram as Polar Sensor Logger does, in whole µV.

    Parameters
    ----------
    path : path or str
        File to write; replaced if it exists.
    ecg : EcgRecording
        With ``start_ns`` since 2000.

    Raises
    ------
    RecordingError
        If its clock is another.
    """
    path = Path(path)
    _require_clock(ecg.attrs, POLAR_EPOCH, path)
    microvolt = ecg["ecg"].values[None] / FACTORS_TO_SI["voltage"]["uV"]
    _write_sensor_logger(path, ecg.attrs, ["ecg [uV]"], microvolt)


def write_polar_acc(path: Path | str, recording: Recording, *, start_ns: int) -> None:
    """Write the acceleration of a chest strap as Polar Sensor Logger does, in whole mg.

    Parameters
    ----------
    path : path or str
        File to write; replaced if it exists.
    recording : Recording
        Of one sensor, with ``acc``.
    start_ns : int
        First time stamp, ns since 2000.

    Raises
    ------
    RecordingError
        If the recording has several sensors or no acceleration.
    """
    path = Path(path)
    if "acc" not in recording or recording.sizes["sensor"] != 1:
        raise RecordingError(
            "not the recording of a chest strap",
            file=path.name,
            expected="acc of one sensor",
            found=f"{', '.join(map(str, recording.data_vars))} of {recording.sizes['sensor']}",
        )
    attributes = {"start_ns": start_ns, "rate_hz": recording.attrs["rate_hz"]}
    acc_mg = recording["acc"].values[0] / FACTORS_TO_SI["acceleration"]["mg"]
    _write_sensor_logger(path, attributes, ["X [mg]", "Y [mg]", "Z [mg]"], acc_mg)


def _write_sensor_logger(
    path: Path, attributes: dict[str, object], names: list[str], values: NDArray[np.float64]
) -> None:
    kept = _kept(values)
    stamps = _stamps(attributes, values.shape[1])[kept]
    phone = [_phone_stamp(int(stamp)) for stamp in stamps]
    printed = np.char.mod("%.0f", values[:, kept]).astype(object)
    printed[np.isnan(values[:, kept])] = ""
    _write(path, ";", ["Phone timestamp", SENSOR_TIME, *names], [phone, stamps, *printed])


def _phone_stamp(stamp_ns: int) -> str:
    """Time of day in ms, as if the strap's clock were right and the packet came at once."""
    moment = datetime.datetime.fromtimestamp(
        POLAR_EPOCH_UNIX_S + stamp_ns // 1_000_000_000, tz=datetime.UTC
    )
    return f"{moment:%Y-%m-%dT%H:%M:%S}.{stamp_ns // 1_000_000 % 1000:03d}"


def _stamps(attributes: dict[str, object], n: int) -> NDArray[np.int64]:
    rate_hz, start_ns = float(str(attributes["rate_hz"])), int(str(attributes["start_ns"]))
    stamps: NDArray[np.int64] = np.rint(np.arange(n) * (1e9 / rate_hz)).astype(np.int64)
    return stamps + np.int64(start_ns)


def _kept(values: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Rows with a number, and the first and the last."""
    kept: NDArray[np.bool_] = np.logical_or.reduce(np.isfinite(values), axis=0)
    kept[[0, -1]] = True
    return kept


def _rows_of_reports(time_s: ArrayLike, rate_hz: float, n: int) -> NDArray[np.int64]:
    """Row of each report: the nearest, or the next that is free."""
    nearest = np.rint(np.asarray(time_s) * rate_hz).astype(np.int64)
    count = np.arange(len(nearest))
    rows: NDArray[np.int64] = np.maximum.accumulate(nearest - count) + count
    # Those that would fall behind the end move up before it.
    return np.minimum(rows, n - len(nearest) + count)


def _require_clock(attributes: dict[str, object], epoch: str, path: Path) -> None:
    if attributes["clock_epoch"] != epoch:
        raise RecordingError(
            "the recording has another clock than the format",
            file=path.name,
            expected=f"ns since {epoch}",
            found=f"ns since {attributes['clock_epoch']}",
        )


def _write(path: Path, delimiter: str, names: ArrayLike, columns: list[ArrayLike]) -> None:
    row = delimiter.join(["%s"] * len(columns)) + "\n"
    fields = np.empty((np.size(columns[0]), len(columns)), dtype=object)
    for position, column in enumerate(columns):
        fields[:, position] = column
    body = (row * len(fields)) % tuple(fields.ravel().tolist())
    path.write_bytes((delimiter.join(np.asarray(names).tolist()) + "\n" + body).encode())
