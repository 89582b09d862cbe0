"""Missing samples: where they are, and filling the short ones."""

from __future__ import annotations

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray


def missing_runs(signal: ArrayLike) -> pd.DataFrame:
    """List the runs of missing samples of a multi-channel signal.

    Parameters
    ----------
    signal : array_like, shape (..., n_samples)
        A sample is missing if any of its channels is NaN.

    Returns
    -------
    DataFrame
        ``start`` (index of the first missing sample) and ``length`` (number of samples).

    Examples
    --------
    >>> missing_runs([0.0, np.nan, np.nan, 1.0, np.nan]).to_dict("list")
    {'start': [1, 4], 'length': [2, 1]}
    """
    missing = _missing(np.asarray(signal, dtype=np.float64))
    edges = np.flatnonzero(np.diff(np.r_[False, missing, False].astype(np.int8)))
    return pd.DataFrame({"start": edges[::2], "length": edges[1::2] - edges[::2]})


def fill_short_gaps(signal: ArrayLike, *, longest_gap: int) -> NDArray[np.float64]:
    """Fill runs of missing samples by linear interpolation, per channel.

    Runs longer than `longest_gap` samples, and runs at either end, stay missing: they are the
    caller's to exclude.

    Parameters
    ----------
    signal : array_like, shape (..., n_samples)
        Missing samples are NaN.
    longest_gap : int
        Longest run that is filled.

    Returns
    -------
    ndarray, shape (..., n_samples)
        A copy.

    Examples
    --------
    >>> fill_short_gaps([0.0, np.nan, 2.0], longest_gap=1)
    array([0., 1., 2.])
    """
    filled = np.array(signal, dtype=np.float64)
    n_samples = filled.shape[-1]
    runs = missing_runs(filled)
    inside = (runs["start"] > 0) & (runs["start"] + runs["length"] < n_samples)
    for run in runs[inside & (runs["length"] <= longest_gap)].itertuples(index=False):
        weight = np.arange(1, run.length + 1) / (run.length + 1)
        before = filled[..., run.start - 1, None]
        after = filled[..., run.start + run.length, None]
        filled[..., run.start : run.start + run.length] = before + (after - before) * weight
    return filled


def present_span(signal: ArrayLike) -> slice:
    """Span from the first to the last sample that is not missing; empty if there is none.

    Parameters
    ----------
    signal : array_like, shape (..., n_samples)

    Examples
    --------
    >>> present_span([np.nan, 1.0, np.nan, 2.0, np.nan])
    slice(1, 4, None)
    """
    present = np.flatnonzero(~_missing(np.asarray(signal, dtype=np.float64)))
    if present.size == 0:
        return slice(0, 0)
    return slice(int(present[0]), int(present[-1]) + 1)


def _missing(values: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Flag the samples of which at least one channel is missing."""
    flags = np.isnan(values)
    return np.asarray(flags.any(axis=tuple(range(values.ndim - 1))))
