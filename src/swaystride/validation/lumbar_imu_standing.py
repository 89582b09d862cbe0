"""Quiet standing with a lumbar IMU: real recordings with lost packets, through the whole chain.

Voisard et al. (2023), IPOL 2023/497: 110 recordings at L5, 100 Hz, each beginning with a few
seconds of quiet standing. Nobody published sway measures of them: what can be checked is the
reading, the arithmetic of the packet counter and what rebuilding the gaps is worth. Packets were
lost while people walked, hardly ever while they stood; therefore each recording's own densest
pattern of losses is laid over its own quiet window, whose complete measures are known.
"""

from __future__ import annotations

import lzma
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from swaystride.io.reading import read_recording
from swaystride.recording import Recording
from swaystride.signals.gaps import missing_runs
from swaystride.sway.trial_measures import MeasurementMethod, measure_trial
from swaystride.validation.manifest import verified_files
from swaystride.validation.summary import Check, reported

DATASET: Final = "lumbar_imu_standing"

#: Shortest quiet window that is measured, in samples: the shortest one in the data set.
SHORTEST_WINDOW: Final = 229

#: Longest gap that is filled, as in the feedback study.
LONGEST_GAP_S: Final = 0.25

#: Measures that are compared with and without rebuilt gaps.
MEASURES: Final = ("ap_rms", "ml_rms", "phi_mv", "path_length", "ellipse_area_prediction")

#: Units as the authors state them beside the files.
UNITS: Final = {"acc": "m/s^2", "gyr": "rad/s", "mag": "a.u."}

#: As gravity lies in the recordings: x up, z forward (sign arbitrary for sway), y lateral.
METHOD: Final = MeasurementMethod(
    sensor_forward="z",
    sensor_left="-y",
    sensor_up="x",
    fusion="offline_vqf",
    tau_acc_s=3.0,
    level_sensor=True,
    remove_mean_rate=True,
    filter_order=2,
    cutoff_hz=2.0,
    filter_direction="zero_lag",
    pad_s=3.0,
)


def lumbar_trials(folder: Path) -> pd.DataFrame:
    """Read every recording and measure its quiet window, with and without rebuilt gaps.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.

    Returns
    -------
    DataFrame
        ``trial``, ``lost_read`` and ``lost_counter`` (lost packets: found by the reader, and by
        the arithmetic of the counter), ``window_samples``, ``window_lost``, ``pattern_lost`` and
        ``pattern_longest_gap_s`` of the losses laid over the window, and for each measure its
        value in the quiet window, ``…_rebuilt`` and ``…_glued`` (rows taken as if nothing were
        missing); the last two are missing where a gap is too long to be filled.
    """
    paths = {path.name: path for path in verified_files(folder, DATASET)}
    index = pd.read_csv(paths["quiet_segments_index.csv"]).set_index("trial")
    rows = []
    for name, path in sorted(paths.items()):
        if not name.endswith("_lb.txt.xz"):
            continue
        trial = name.removesuffix("_lb.txt.xz")
        # one recording holds a packet twice (11-1): the first is kept, a finding says so
        recording = read_recording(path, units=UNITS, duplicate_packets="keep_first")
        counter = _packet_counter(path)
        n_quiet = int(index["n_quiet"].loc[trial])
        rows.append(
            {
                "trial": trial,
                "lost_read": int(_lost(recording).sum()),
                "lost_counter": int(counter[-1] - counter[0] + 1 - np.unique(counter).size),
                "window_samples": n_quiet,
                **_quiet_measures(recording, int(counter[n_quiet - 1] - counter[0]) + 1),
            }
        )
    return pd.DataFrame(rows)


def lumbar_checks(trials: pd.DataFrame) -> list[Check]:
    """Checks of this data set, from the table `trials` of :func:`lumbar_trials`."""
    agree = float((trials["lost_read"] == trials["lost_counter"]).sum())
    compared = trials.dropna(subset=[f"{MEASURES[0]}_rebuilt"])
    counter_source = "last − first + 1 − distinct counters"
    checks = [
        Check(DATASET, "recordings read", float(len(trials)), 110.0, "files at hand", 0),
        Check(DATASET, "recordings whose lost packets agree", agree, 110.0, counter_source, 0),
        reported(DATASET, "lost packets, all recordings", trials["lost_read"].sum(), "a count"),
        reported(
            DATASET,
            "quiet windows measured",
            (trials["window_samples"] >= SHORTEST_WINDOW).sum(),
            "229 samples or more",
        ),
        reported(
            DATASET,
            "quiet windows that lost packets themselves",
            (trials["window_lost"] > 0).sum(),
            "a count",
        ),
        reported(DATASET, "windows with laid-over losses", len(compared), "gaps of 0.25 s at most"),
    ]
    for measure in MEASURES:
        for how in ("rebuilt", "glued"):
            change = (compared[f"{measure}_{how}"] / compared[measure] - 1).abs()
            for label, value in (("median", change.median()), ("largest", change.max())):
                quantity = f"{measure}, gaps {how}: {label} relative error"
                checks.append(reported(DATASET, quantity, value, "complete window, same recording"))
    return checks


def _quiet_measures(recording: Recording, n_samples: int) -> dict[str, float]:
    """Measures of the quiet window: as recorded, and under the recording's densest losses."""
    quiet = recording.isel(time=slice(0, n_samples))
    lost = _lost(recording)
    density = np.convolve(lost, np.ones(n_samples), mode="valid")
    start = int(density.argmax())
    pattern = lost[start : start + n_samples]
    # first and last sample stay: a window is not shortened by its losses
    pattern[[0, -1]] = False
    runs = missing_runs(np.where(pattern, np.nan, 0.0))["length"]
    longest_gap_s = float(runs.max()) / recording.attrs["rate_hz"] if len(runs) else 0.0
    complete = measure_trial(quiet, METHOD)
    result = {
        "window_lost": int(_lost(quiet).sum()),
        "pattern_lost": int(pattern.sum()),
        "pattern_longest_gap_s": longest_gap_s,
        **{name: complete[name] for name in MEASURES},
    }
    if pattern.any() and longest_gap_s <= LONGEST_GAP_S:
        gappy = quiet.where(~xr.DataArray(pattern, dims="time"))
        rebuilt = measure_trial(gappy, METHOD)
        glued = measure_trial(quiet.isel(time=np.flatnonzero(~pattern)), METHOD)
        result |= {f"{name}_rebuilt": rebuilt[name] for name in MEASURES}
        result |= {f"{name}_glued": glued[name] for name in MEASURES}
    return result


def _lost(recording: Recording) -> NDArray[np.bool_]:
    """Flag the samples that are missing."""
    return np.asarray(np.isnan(recording["acc"].to_numpy()[0]).any(axis=0))


def _packet_counter(path: Path) -> NDArray[np.float64]:
    """First column of the file, read without our readers."""
    with lzma.open(path, "rt", encoding="utf-8") as file:
        return np.loadtxt(file, skiprows=2, usecols=0)
