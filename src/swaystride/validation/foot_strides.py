"""Our stride lengths on the public foot recordings, beside the optical and everybody else's."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
import xarray as xr

from swaystride.gait.foot_methods import PRINTED, RECOMMENDED, FootMethod
from swaystride.gait.strides import stride_lengths_at, stride_table
from swaystride.gait.trajectory import foot_trajectory
from swaystride.validation.foot_baseline import vqf_path
from swaystride.validation.foot_recording import FloatArray, FootRecording, displacements

#: Column of lengths -> name on the page. The first is ours.
METHODS: Final = {
    "length_m": "recommended",
    "printed_m": "printed",
    "stored_m": "in the files",
    "gaitmap_m": "gaitmap RTS",
    "vqf_m": "VQF, linear de-drift",
}


@dataclass(frozen=True)
class FootTrial:
    """One recording with everything that was computed on it.

    Parameters
    ----------
    recording : FootRecording
    path_m : array, shape (2, n_samples)
        Our horizontal path, heading arbitrary.
    own_spans_s : array, shape (n_own_strides, 2)
        Start and stop of the strides that the library found by itself.
    strides : DataFrame
        One row per given stride: ``dataset``, ``trial``, ``gait``, ``stride`` (from 1),
        ``start_s``, ``stop_s``, ``length_m`` (recommended), ``reference_m``, ``error_m``, the
        other columns of :data:`METHODS` (missing where there is no such value), and
        ``reference_<marker>_m`` for other markers.
    """

    recording: FootRecording
    path_m: FloatArray
    own_spans_s: FloatArray
    strides: pd.DataFrame

    @property
    def path_at_frames(self) -> FloatArray:
        """Our path at the times of the optical frames, shape (2, n_frames)."""
        time_s = np.arange(self.path_m.shape[1]) / self.recording.rate_hz
        return np.stack([np.interp(self.recording.path_s, time_s, axis) for axis in self.path_m])

    @property
    def own_strides(self) -> pd.DataFrame:
        """``length_m`` and ``reference_m`` of our own strides, where the optical system saw them."""
        recording = self.recording
        start_s, stop_s = self.own_spans_s.T
        seen = (start_s >= recording.path_s[0]) & (stop_s <= recording.path_s[-1])
        time_s = np.arange(self.path_m.shape[1]) / recording.rate_hz
        lengths = {
            name: [displacements(path, times, span)[0] for span in self.own_spans_s[seen]]
            for name, path, times in (
                ("length_m", self.path_m, time_s),
                ("reference_m", recording.path_m, recording.path_s),
            )
        }
        return pd.DataFrame(lengths, dtype=np.float64)


def foot_trial(recording: FootRecording, peers: Mapping[str, FloatArray]) -> FootTrial:
    """Compute one recording with default settings, nothing chosen for the trial.

    Parameters
    ----------
    recording : FootRecording
    peers : mapping
        Lengths of gaitmap by trial, as from
        :func:`swaystride.validation.foot_peers.peer_lengths`; may be empty.
    """
    recommended, printed = (_trajectory(recording, method) for method in (RECOMMENDED, PRINTED))
    instants_s = recording.instants_s
    epochs = np.asarray(recommended["epoch_index"].values, dtype=np.int64)
    time_s = np.arange(recording.acc_m_s2.shape[1]) / recording.rate_hz
    baseline_m = vqf_path(recording.acc_m_s2, recording.gyr_rad_s, recording.rate_hz, epochs)
    nothing = np.full(len(instants_s) - 1, np.nan)
    stored = recording.stored_path_m
    lengths = {
        "length_m": stride_lengths_at(recommended, instants_s),
        "printed_m": stride_lengths_at(printed, instants_s),
        "stored_m": nothing if stored is None else displacements(stored, time_s, instants_s),
        "gaitmap_m": peers.get(recording.trial, nothing),
        "vqf_m": displacements(baseline_m[:2], time_s, instants_s),
    }
    return FootTrial(
        recording=recording,
        path_m=np.asarray(recommended["position"].sel(axis=["x", "y"]).values, dtype=np.float64),
        own_spans_s=stride_table(recommended)[["start_s", "stop_s"]].to_numpy(dtype=np.float64),
        strides=_stride_rows(recording, lengths),
    )


def all_strides(trials: list[FootTrial]) -> pd.DataFrame:
    """Strides of all trials in one table.

    Parameters
    ----------
    trials : list of FootTrial
    """
    return pd.concat([trial.strides for trial in trials], ignore_index=True)


def _trajectory(recording: FootRecording, method: FootMethod) -> xr.Dataset:
    """The library's trajectory."""
    return foot_trajectory(recording.acc_m_s2, recording.gyr_rad_s, recording.rate_hz, method)


def _stride_rows(recording: FootRecording, lengths: Mapping[str, FloatArray]) -> pd.DataFrame:
    """Table of the given strides."""
    n_strides = len(recording.reference_m)
    ours = lengths["length_m"]
    rows = {
        "dataset": [recording.dataset] * n_strides,
        "trial": [recording.trial] * n_strides,
        "gait": [recording.gait] * n_strides,
        "stride": np.arange(1, n_strides + 1),
        "start_s": recording.instants_s[:-1],
        "stop_s": recording.instants_s[1:],
        "length_m": ours,
        "reference_m": recording.reference_m,
        "error_m": ours - recording.reference_m,
    }
    others = {name: lengths[name] for name in ("stored_m", "printed_m", "gaitmap_m", "vqf_m")}
    markers = {
        f"reference_{name.lower()}_m": moved for name, moved in recording.other_references_m.items()
    }
    return pd.DataFrame({**rows, **others, **markers})
