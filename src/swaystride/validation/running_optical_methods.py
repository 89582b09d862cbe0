"""Published ways to see contacts in foot markers, side by side against the force plates.

Each rule names an instant by the peak of a signal. It is searched within a window around the event of
the force plate, which helps these rules: only the rule that is recommended finds its contacts alone.
Markers of the big toe and of the heel's back are not there; the first metatarsal and the lower heel
marker stand in.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.mocap.marker_gaps import PRINTED_LIMITS, fill_gaps
from swaystride.mocap.marker_set import SIDES, points
from swaystride.signals.filters import lowpass_without_lag
from swaystride.validation.running_optical import OpticalRun, optical_runs
from swaystride.validation.running_optical_recording import CLUSTERS, FOOT_MARKERS

Array = NDArray[np.float64]

#: Low-pass of the markers, as for the recommended rule.
_CUTOFF_HZ: Final = 30.0
#: Half of the window around an event of the force plate.
_WINDOW_S: Final = 0.1


def method_table(folder: Path) -> pd.DataFrame:
    """Errors of the rules, foot by foot.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.

    Returns
    -------
    DataFrame
        ``trial``, ``side``, ``event`` (``touch`` or ``toe_off``), ``rule``, ``bias_ms``, ``sd_ms``.
    """
    rows = []
    for found in optical_runs(folder):
        for side in SIDES if found.plates else ():
            truth = found.plates[side]
            for event, rules in foot_signals(*_foot_markers(found, side), found.rate_hz).items():
                column = {"touch": "initial_contact_s", "toe_off": "toe_off_s"}[event]
                for rule, signals in rules.items():
                    error = earliest_peaks(signals, truth[column].to_numpy(), found.rate_hz)
                    rows.append(
                        {
                            "trial": found.run.label,
                            "side": side,
                            "event": event,
                            "rule": rule,
                            "bias_ms": 1e3 * float(np.nanmean(error)),
                            "sd_ms": 1e3 * float(np.nanstd(error)),
                        }
                    )
    return pd.DataFrame(rows)


def _foot_markers(found: OpticalRun, side: str) -> tuple[Array, Array, Array]:
    """Lower heel, first metatarsal and middle of the posterior spines, (n, 3) each."""
    own = FOOT_MARKERS[side]
    names = (own["heel"][0], own["toe"][0], *CLUSTERS.back)
    filled, _ = fill_gaps(
        points(found.recording, names),
        names,
        limits=PRINTED_LIMITS,
        rigid=(),
        patterns=(names[2:],),
    )
    return filled[0], filled[1], filled[2:].mean(axis=0)


def foot_signals(
    heel_m: Array, toe_m: Array, sacrum_m: Array, rate_hz: float
) -> dict[str, dict[str, list[Array]]]:
    """Signals whose peaks are the events; of several signals the earliest peak counts.

    Parameters
    ----------
    heel_m, toe_m, sacrum_m : ndarray, shape (n, 3)
        Without gaps; world axes, x forward, z up.
    rate_hz : float
        Frames per second.

    Returns
    -------
    dict of str to dict of str to list of ndarray, shape (n,)
        By event, then by rule.
    """
    smooth = lowpass_without_lag(np.stack([heel_m.T, toe_m.T, sacrum_m.T]), _CUTOFF_HZ, rate_hz)
    heel, toe, sacrum = smooth
    speed = np.gradient(smooth[:2, 2], axis=-1)
    rise = np.gradient(speed, axis=-1)
    jerk = np.gradient(rise[1])
    return {
        "touch": {
            "heel furthest forward (Zeni et al. 2008)": [heel[0] - sacrum[0]],
            "heel lowest (Fellin et al. 2010)": [-heel[2]],
            "upward acceleration of heel or toe (Handsaker et al. 2016)": [rise[0], rise[1]],
        },
        "toe_off": {
            "toe furthest backward (Zeni et al. 2008)": [sacrum[0] - toe[0]],
            "upward acceleration of the toe": [rise[1]],
            "upward jerk of the toe (Handsaker et al. 2016)": [jerk],
        },
    }


def earliest_peaks(signals: list[Array], truth_s: Array, rate_hz: float) -> Array:
    """Time of the earliest of the signals' peaks near each true event, minus the event.

    Parameters
    ----------
    signals : list of ndarray, shape (n,)
    truth_s : ndarray, shape (n_events,)
    rate_hz : float
        Samples per second.

    Returns
    -------
    ndarray, shape (n_events,)
        Seconds, to a fraction of a sample; NaN beside the ends of the recording.
    """
    half = round(_WINDOW_S * rate_hz)
    middle = np.round(truth_s * rate_hz).astype(np.intp)
    inside = (middle > half) & (middle < len(signals[0]) - half - 2)
    out = np.full(len(truth_s), np.nan)
    frames = middle[inside, None] + np.arange(-half, half + 1)
    found = []
    for signal in signals:
        top = frames[np.arange(len(frames)), np.argmax(signal[frames], axis=1)]
        before, at, after = signal[top - 1], signal[top], signal[top + 1]
        bend = before - 2.0 * at + after
        off = np.where(bend < 0.0, 0.5 * (before - after) / np.where(bend < 0.0, bend, 1.0), 0.0)
        found.append((top + np.clip(off, -0.5, 0.5)) / rate_hz)
    out[inside] = np.min(found, axis=0) - truth_s[inside]
    return out
