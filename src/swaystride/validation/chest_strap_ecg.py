"""Heart rate of a chest strap: R-peaks of a real recording beside the strap's own intervals.

Ten minutes of one person at rest (Broman, detectPVC, MIT), 130 Hz nominal, with premature beats. The
strap's RR intervals are an independent reference; it leaves out some of the premature ones.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from swaystride.findings import findings_from_json
from swaystride.io.polar_ecg import read_ecg
from swaystride.signals.heart_rate import heart_rate
from swaystride.validation.manifest import verified_files
from swaystride.validation.summary import Check, reported

DATASET: Final = "chest_strap_ecg"
#: 60000 over the mean of the 798 intervals (ms) that the strap reported.
STRAP_BPM: Final = 79.87
TOLERANCE: Final = 0.015
MINUTE_S: Final = 60.0


def heart_rate_table(folder: Path) -> pd.DataFrame:
    """Heart rate minute by minute, from R-peaks and from the strap's own intervals.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.

    Returns
    -------
    DataFrame
        ``minute`` (from 1), ``beats``, ``mean_rr_s``, ``heart_rate_bpm``, and of the strap
        ``strap_beats``, ``strap_mean_rr_s``, ``strap_heart_rate_bpm``.
    """
    (path,) = verified_files(folder, DATASET)
    ecg = read_ecg(path)
    found = heart_rate(ecg["ecg"].to_numpy(), ecg.attrs["rate_hz"], file=path.name)
    said = np.isfinite(ecg["strap_rr_s"].to_numpy())
    intervals = {
        "": (found.rr_end_s, found.rr_s),
        "strap_": (ecg["report_time"].to_numpy()[said], ecg["strap_rr_s"].to_numpy()[said]),
    }
    columns = []
    for prefix, (end_s, rr_s) in intervals.items():
        frame = pd.DataFrame({"minute": (end_s // MINUTE_S).astype(int) + 1, "rr_s": rr_s})
        grouped = frame.groupby("minute")["rr_s"].agg(["size", "mean"])
        grouped.columns = pd.Index([f"{prefix}beats", f"{prefix}mean_rr_s"])
        grouped[f"{prefix}heart_rate_bpm"] = 60.0 / grouped[f"{prefix}mean_rr_s"]
        columns.append(grouped)
    return pd.concat(columns, axis=1).reset_index()


def heart_rate_checks(minutes: pd.DataFrame, folder: Path) -> list[Check]:
    """Mean heart rate against the strap's, and what the reader saw.

    Parameters
    ----------
    minutes : DataFrame
        From :func:`heart_rate_table`.
    folder : Path
        Folder with public recordings.
    """
    (path,) = verified_files(folder, DATASET)
    ecg = read_ecg(path)
    mean_rr_s = np.average(minutes["mean_rr_s"], weights=minutes["beats"])
    strap_s = np.average(minutes["strap_mean_rr_s"], weights=minutes["strap_beats"])
    apart = minutes["heart_rate_bpm"] / minutes["strap_heart_rate_bpm"] - 1
    source = "60000 over the mean RR interval that the strap reported"
    lost = {finding.check for finding in findings_from_json(ecg.attrs["findings"])}
    return [
        Check(DATASET, "mean heart rate, 1/min", 60 / mean_rr_s, STRAP_BPM, source,
              TOLERANCE * STRAP_BPM),
        Check(DATASET, "mean of the strap's RR, as read, ms", 1000 * strap_s, 751.19,
              "description of the data set", 0.01),
        Check(DATASET, "sampling rate, Hz", ecg.attrs["rate_hz"], 130.16,
              "description of the data set", 0.01),
        Check(DATASET, "lost packets", float("packet_loss" in lost), 0.0,
              "78096 rows without a gap", 0.0),
        reported(DATASET, "RR intervals", minutes["beats"].sum(),
                 "the strap reported 798; it leaves out some premature beats"),
        reported(DATASET, "largest difference of a minute, %", 100 * apart.abs().max(),
                 "the strap reports late and skips beats"),
    ]  # fmt: skip
