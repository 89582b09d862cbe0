"""From a fine simulation to samples: anti-alias filter, decimation, converter."""

from __future__ import annotations

from functools import cache
from typing import Final

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import ArrayLike, NDArray
from scipy.signal import firwin

from swaystride.errors import ConfigurationError

Array = NDArray[np.float64]

#: Half the length of the anti-alias filter, in output samples; the ideal signals must reach this
#: much beyond both ends of the wanted ones.
FILTER_REACH_SAMPLES: Final = 10
#: Outputs that are filtered together; a matter of speed only.
_GROUP: Final = 16


def quantise(values: ArrayLike, *, full_scale: float, bits: int) -> Array:
    """Round to the steps of a converter over ±full scale and clip to its range.

    Parameters
    ----------
    values : array_like
        In the unit of `full_scale`.
    full_scale : float
        End of the range; the lowest code is −full_scale, the highest one step below full_scale.
    bits : int
        The range has ``2 ** bits`` codes.

    Returns
    -------
    ndarray

    Examples
    --------
    >>> quantise([0.3, -0.3, 5.0], full_scale=1.0, bits=2).tolist()
    [0.5, -0.5, 0.5]
    """
    step = 2.0 * full_scale / 2**bits
    counts = np.rint(np.asarray(values, dtype=np.float64) / step)
    return np.asarray(np.clip(counts, -(2 ** (bits - 1)), 2 ** (bits - 1) - 1) * step)


def filter_reach(rate_hz: float, output_rate_hz: float) -> int:
    """Input samples that :func:`anti_alias` needs beyond the first and the last output.

    Parameters
    ----------
    rate_hz, output_rate_hz : float
        Rates; an integer ratio.

    Examples
    --------
    >>> filter_reach(1000.0, 100.0)
    100
    """
    return FILTER_REACH_SAMPLES * decimation_factor(rate_hz, output_rate_hz)


def decimation_factor(rate_hz: float, output_rate_hz: float) -> int:
    """Integer ratio of two rates.

    Parameters
    ----------
    rate_hz, output_rate_hz : float
        Rate of the simulation and of the recording.

    Returns
    -------
    int

    Raises
    ------
    ConfigurationError
        If the ratio is not an integer.
    """
    factor = round(rate_hz / output_rate_hz)
    if factor < 1 or not np.isclose(factor * output_rate_hz, rate_hz, rtol=1e-12):
        raise ConfigurationError(
            "the simulation cannot be decimated to the output rate",
            expected="an integer ratio of the rates",
            found=f"{rate_hz:g} Hz to {output_rate_hz:g} Hz",
        )
    return factor


def anti_alias(
    signal: ArrayLike,
    *,
    rate_hz: float,
    output_rate_hz: float,
    bandwidth_hz: float | None = None,
) -> Array:
    """Low-pass and decimate along the last axis, without delay and without end effects.

    A linear-phase FIR filter (Kaiser, 60 dB, −6 dB at the bandwidth), of which only
    outputs are returned that rest on given samples: output j is centred on input
    ``reach + j · factor``.

    Parameters
    ----------
    signal : array_like, shape (..., n_samples)
        At least ``2 · reach + 1`` samples, see :func:`filter_reach`.
    rate_hz, output_rate_hz : float
        Rates; an integer ratio.
    bandwidth_hz : float, optional
        Where the filter is down by 6 dB; by default half the output rate. It has no effect on a
        signal that is not decimated.

    Returns
    -------
    ndarray, shape (..., n_output)

    Examples
    --------
    >>> anti_alias(np.ones(300), rate_hz=1000.0, output_rate_hz=100.0).round(12).tolist()
    [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]
    """
    values = np.asarray(signal, dtype=np.float64)
    factor = decimation_factor(rate_hz, output_rate_hz)
    if factor == 1:
        reach = FILTER_REACH_SAMPLES
        return values[..., reach:-reach].copy()
    reach = factor * FILTER_REACH_SAMPLES
    edge_hz = output_rate_hz / 2.0 if bandwidth_hz is None else bandwidth_hz
    taps = _taps_of_groups(rate_hz, factor, edge_hz)
    n_output = (values.shape[-1] - 2 * reach - 1) // factor + 1
    n_groups = -(-n_output // _GROUP)
    step = _GROUP * factor
    # The last group may lack some outputs, and the inputs that only they would need.
    lacking = max((n_groups - 1) * step + len(taps) - values.shape[-1], 0)
    if lacking:
        values = np.concatenate([values, np.zeros((*values.shape[:-1], lacking))], axis=-1)
    windows = sliding_window_view(values, len(taps), axis=-1)[..., ::step, :][..., :n_groups, :]
    filtered = np.ascontiguousarray(windows) @ taps
    return np.asarray(filtered.reshape(*filtered.shape[:-2], -1)[..., :n_output])


@cache
def _taps_of_groups(rate_hz: float, factor: int, edge_hz: float) -> Array:
    """Taps for some outputs in a row, a column each: one product of matrices filters them all."""
    n_taps = 2 * factor * FILTER_REACH_SAMPLES + 1
    taps = firwin(n_taps, edge_hz, window=("kaiser", 5.65), fs=rate_hz)
    columns = np.zeros((n_taps + (_GROUP - 1) * factor, _GROUP))
    for k in range(_GROUP):
        columns[k * factor : k * factor + n_taps, k] = taps
    return columns
