"""Agreement of the waveforms of one joint angle over a trial, by every reading of the printed table.

The printed numbers of Table 4.3 contradict each other under the definitions of the text (register
I-15, I-33), so each measure is computed in all readings (methods §1.9).
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError
from swaystride.gait.stride_curves import ensemble, stride_curves

Array = NDArray[np.float64]
Index = NDArray[np.int64]

#: What :func:`waveform_agreement` returns.
AGREEMENT_COLUMNS: Final = (
    "n_strides",
    "rom_deg",
    "bias_deg",
    "r2",
    "r2_squared_correlation",
    "r2_raw",
    "mad_deg",
    "mad_alt_deg",
    "rmsd_deg",
    "nrmsd_pct",
    "rmsd_ensemble_deg",
    "nrmsd_ensemble_pct",
    "rmsd_trial_deg",
    "nrmsd_trial_pct",
    "rmsd_stride_deg",
    "nrmsd_stride_pct",
)


def waveform_agreement(
    optic_deg: ArrayLike, erkf_deg: ArrayLike, start: ArrayLike, stop: ArrayLike
) -> dict[str, float]:
    """Compare two waveforms over the strides that count.

    Parameters
    ----------
    optic_deg, erkf_deg : array_like, shape (n_samples,)
        The reference and the estimate; NaN where missing.
    start, stop : array_like of int, shape (n_strides,)
        First sample of each stride, and the one after its last.

    Returns
    -------
    dict
        :data:`AGREEMENT_COLUMNS`. ``n_strides``: strides without a missing sample, on which all
        else rests; NaN if there are none. ``rom_deg``: mean range of the reference within a stride,
        by which the ``nrmsd`` are divided. ``bias_deg``: mean of estimate − reference.
        ``r2``: 1 − SSE/SST after the bias is removed; ``r2_raw``: with the bias;
        ``r2_squared_correlation``. ``mad_deg``: absolute value of the bias; ``mad_alt_deg``: mean
        absolute difference. ``rmsd_deg`` and the same after removal of one constant
        (``rmsd_trial``), one constant per stride (``rmsd_stride``), or the mean curve of the
        difference over the stride (``rmsd_ensemble``).

    Raises
    ------
    RecordingError
        If the waveforms differ in length or a stride lies outside of them.

    Examples
    --------
    >>> phase = 2 * np.pi * np.arange(400) / 100.0
    >>> found = waveform_agreement(
    ...     20 * np.sin(phase), 20 * np.sin(phase) + 3, [0, 100, 200], [100, 200, 300])
    >>> [round(found[name], 6) for name in ("bias_deg", "rmsd_deg", "rmsd_trial_deg", "r2")]
    [3.0, 3.0, 0.0, 1.0]
    """
    optic, erkf = (np.asarray(values, dtype=np.float64) for values in (optic_deg, erkf_deg))
    begin, end = (np.asarray(edge, dtype=np.int64) for edge in (start, stop))
    _check(optic, erkf, begin, end)
    missing = np.cumsum(np.r_[0, ~(np.isfinite(optic) & np.isfinite(erkf))])
    complete = missing[end] == missing[begin]
    begin, end = begin[complete], end[complete]
    if begin.size == 0:
        return {"n_strides": 0} | dict.fromkeys(AGREEMENT_COLUMNS[1:], float("nan"))
    index, stride, phase = _samples_of(begin, end)
    reference, difference = optic[index], erkf[index] - optic[index]
    first = np.cumsum(end - begin) - (end - begin)
    rom = float(
        np.mean(np.maximum.reduceat(reference, first) - np.minimum.reduceat(reference, first))
    )
    rmsds = _rmsds(difference, stride, phase, _mean_curve(erkf - optic, begin, end))
    bias = float(difference.mean())
    found: dict[str, float] = {
        "n_strides": int(begin.size),
        "rom_deg": rom,
        "bias_deg": bias,
        **_explained(reference, difference),
        "mad_deg": abs(bias),
        "mad_alt_deg": float(np.abs(difference).mean()),
    }
    for name, value in rmsds.items():
        found[f"{name}_deg"] = value
        found[f"n{name}_pct"] = 100.0 * value / rom if rom > 0.0 else float("nan")
    return {name: found[name] for name in AGREEMENT_COLUMNS}


def _samples_of(begin: Index, end: Index) -> tuple[Index, Index, Array]:
    """Samples of the strides, the stride of each, and its phase in percent."""
    length = end - begin
    stride = np.repeat(np.arange(begin.size), length)
    since = np.arange(int(length.sum())) - np.repeat(np.cumsum(length) - length, length)
    return begin[stride] + since, stride, 100.0 * since / length[stride]


def _mean_curve(difference: Array, begin: Index, end: Index) -> Array:
    """Mean difference at 0 to 100 % of the stride."""
    last = np.minimum(end, difference.size - 1)
    mean, _ = ensemble(stride_curves(difference, begin, last))
    # the sample after the last stride may be missing in all of them
    return np.where(np.isfinite(mean), mean, mean[0])


def _rmsds(difference: Array, stride: Index, phase: Array, curve: Array) -> dict[str, float]:
    """Root mean square difference, with and without the three removals of an offset."""
    own_mean = np.bincount(stride, weights=difference) / np.bincount(stride)
    over_phase = np.interp(phase, np.linspace(0.0, 100.0, curve.size), curve)
    removed = {
        "rmsd": 0.0,
        "rmsd_ensemble": over_phase,
        "rmsd_trial": difference.mean(),
        "rmsd_stride": own_mean[stride],
    }
    return {
        name: float(np.sqrt(np.mean((difference - offset) ** 2)))
        for name, offset in removed.items()
    }


def _explained(reference: Array, difference: Array) -> dict[str, float]:
    """R² in three readings; NaN for a waveform that does not vary."""
    estimate = reference + difference
    total, own, both = (
        float(np.mean((a - a.mean()) * (b - b.mean())))
        for a, b in ((reference, reference), (estimate, estimate), (reference, estimate))
    )
    nan = float("nan")
    return {
        "r2": 1.0 - float(difference.var()) / total if total > 0.0 else nan,
        "r2_squared_correlation": both**2 / (total * own) if total * own > 0.0 else nan,
        "r2_raw": 1.0 - float(np.mean(difference**2)) / total if total > 0.0 else nan,
    }


def _check(optic: Array, erkf: Array, begin: Index, end: Index) -> None:
    """Waveforms of one length, strides inside."""
    if optic.shape != erkf.shape or optic.ndim != 1:
        raise RecordingError(
            "two waveforms must be of the same samples",
            expected="two arrays of one length",
            found=f"shapes {optic.shape} and {erkf.shape}",
        )
    if begin.size and not (begin.min() >= 0 and end.max() <= optic.size and np.all(end > begin)):
        raise RecordingError(
            "a stride lies outside the recording",
            expected=f"samples from 0 to {optic.size}",
            found=f"{begin.min()} to {end.max()}",
        )
