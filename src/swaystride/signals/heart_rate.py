"""Heart rate from an electrocardiogram: R-peaks, RR intervals, mean rate.

R-peaks are those of ``sleepecg`` (Pan & Tompkins 1985 with adaptive thresholds and filters without
delay), moved to the largest deflection nearby. A drop-out ends one stretch and begins the next: no RR interval spans it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.signal import butter, sosfiltfilt

from swaystride.errors import RecordingError
from swaystride.findings import Finding
from swaystride.signals.gaps import fill_short_gaps, missing_runs

#: The detector learns its thresholds in the first 2 s, and needs beats after them.
SHORTEST_STRETCH_S: Final = 5.0
#: Time before the first steep slope that the detector is shown.
LEAD_S: Final = 0.3
#: Band of a QRS complex, that of the detector.
QRS_BAND_HZ: Final = (5.0, 30.0)
LOWEST_RATE_HZ: Final = 100.0


@dataclass(frozen=True)
class HeartRateMethod:
    """What counts as an RR interval.

    Ectopic beats are beats: an interval is not left out because it is unlike its neighbours, or
    the mean of a person with many of them would be wrong. What is left out cannot be one interval.

    Parameters
    ----------
    search_s : float
        An R-peak is the largest deflection, in the band of a QRS complex, so near to what the
        detector found: it sometimes marks both flanks of a complex.
    least_height : float
        A peak of less than this share of the median deflection is noise.
    shortest_rr_s : float
        A peak that follows the one before it sooner is no beat.
    longest_rr_s : float
        A longer interval has lost beats, and is left out.
    longest_bridge_s : float
        Drop-outs up to this length are bridged by a straight line; they cannot hide a QRS complex.
    least_coverage : float
        Share of the duration below which the accepted intervals lead to a warning.
    """

    search_s: float
    least_height: float
    shortest_rr_s: float
    longest_rr_s: float
    longest_bridge_s: float
    least_coverage: float


#: 240/min is beyond any runner, 30/min below the rest of almost everybody; a QRS complex lasts 0.08
#: to 0.12 s. Ectopic beats may be low in the band of a QRS complex: in ``chest_strap_ecg`` a least
#: height of 0.2 would leave out 15 of 799, 0.1 leaves out 6, at a mean rate within 0.7 % of the strap's.
RECOMMENDED: Final = HeartRateMethod(
    search_s=0.15,
    least_height=0.1,
    shortest_rr_s=0.25,
    longest_rr_s=2.0,
    longest_bridge_s=0.04,
    least_coverage=0.8,
)


@dataclass(frozen=True)
class HeartRate:
    """Beats of one recording.

    Parameters
    ----------
    peak_s : ndarray, shape (n_beats,)
        Times of the R-peaks, s from the first sample.
    rr_s, rr_end_s : ndarray, shape (n_intervals,)
        Accepted RR intervals, and the times at which they end.
    mean_bpm : float
        60 s over the mean accepted interval.
    coverage : float
        Sum of the accepted intervals over the duration.
    findings : tuple of Finding
        Short stretches that were not used, peaks and intervals left out, low coverage.
    """

    peak_s: NDArray[np.float64]
    rr_s: NDArray[np.float64]
    rr_end_s: NDArray[np.float64]
    mean_bpm: float
    coverage: float
    findings: tuple[Finding, ...]


def heart_rate(
    ecg: ArrayLike, rate_hz: float, *, method: HeartRateMethod = RECOMMENDED, file: str = ""
) -> HeartRate:
    """Beats and mean heart rate of an electrocardiogram.

    Parameters
    ----------
    ecg : array_like, shape (n_samples,)
        In any unit; lost samples are NaN.
    rate_hz : float
        At least 100 Hz.
    method : HeartRateMethod
    file : str
        Name of the recording, for errors and findings.

    Returns
    -------
    HeartRate

    Raises
    ------
    RecordingError
        If the rate is too low, the signal is flat, or there are no two beats in a row.

    Examples
    --------
    A beat every 0.8 s:

    >>> time = np.arange(130 * 30) / 130
    >>> ecg = np.exp(-(((time + 0.4) % 0.8 - 0.4) / 0.012) ** 2)
    >>> rate = heart_rate(ecg, 130.0)
    >>> round(rate.mean_bpm), len(rate.findings)
    (75, 0)
    """
    if not rate_hz >= LOWEST_RATE_HZ:
        raise RecordingError(
            "the sampling rate is too low for R-peaks",
            file=file or None,
            expected=f"at least {LOWEST_RATE_HZ:g} Hz",
            found=f"{rate_hz:g} Hz",
        )
    signal = fill_short_gaps(ecg, longest_gap=int(method.longest_bridge_s * rate_hz))
    stretches, findings = _stretches(signal, rate_hz, file)
    peaks, intervals, ends = [], [], []
    n_early = n_long = 0
    for start, stop in stretches:
        found = _highest_near(
            _detect(signal[start:stop], rate_hz), signal[start:stop], rate_hz, method
        )
        kept = _without_early_peaks(found, method.shortest_rr_s * rate_hz)
        n_early += len(found) - len(kept)
        peak_s = (start + kept) / rate_hz
        rr_s = np.diff(peak_s)
        whole = rr_s <= method.longest_rr_s
        n_long += int((~whole).sum())
        peaks.append(peak_s)
        intervals.append(rr_s[whole])
        ends.append(peak_s[1:][whole])
    rr = np.concatenate([np.empty(0), *intervals])
    if rr.size == 0:
        raise RecordingError(
            "no heart beats",
            file=file or None,
            expected=f"two R-peaks within {method.longest_rr_s:g} s",
            found=f"{sum(map(len, peaks))} R-peaks in {len(signal) / rate_hz:.1f} s",
        )
    coverage = float(rr.sum()) / (len(signal) / rate_hz)
    findings += _judgements(n_early, n_long, coverage, method, file)
    return HeartRate(
        peak_s=np.concatenate(peaks),
        rr_s=rr,
        rr_end_s=np.concatenate(ends),
        mean_bpm=60.0 / float(rr.mean()),
        coverage=coverage,
        findings=tuple(findings),
    )


def _stretches(
    signal: NDArray[np.float64], rate_hz: float, file: str
) -> tuple[list[tuple[int, int]], list[Finding]]:
    """Stretches without drop-outs that are long enough for the detector."""
    gaps = missing_runs(signal)
    starts = [0, *(gaps["start"] + gaps["length"]).tolist()]
    stops = [*gaps["start"].tolist(), len(signal)]
    pairs = [(start, stop) for start, stop in zip(starts, stops, strict=True) if stop > start]
    long = [pair for pair in pairs if pair[1] - pair[0] >= SHORTEST_STRETCH_S * rate_hz]
    if len(long) == len(pairs):
        return long, []
    short_s = (sum(b - a for a, b in pairs) - sum(b - a for a, b in long)) / rate_hz
    finding = Finding(
        "ecg_short_stretch",
        "warning",
        file,
        "ecg",
        f"at least {SHORTEST_STRETCH_S:g} s between drop-outs",
        f"{len(pairs) - len(long)} shorter stretches, {short_s:.1f} s in all, not used",
    )
    return long, [finding]


def _detect(ecg: NDArray[np.float64], rate_hz: float) -> NDArray[np.int64]:
    """Sample indices of the R-peaks; none in a flat stretch."""
    # Its other half, the staging of sleep, makes the import slow.
    from sleepecg.heartbeats import detect_heartbeats

    if np.ptp(ecg) == 0:
        return np.empty(0, dtype=np.int64)
    # Without a beat in its first second, the detector takes noise for one, and its thresholds do not
    # recover. So the stretch is preceded by its own mirror image, from just before a steep slope.
    steepest = int(np.abs(np.diff(ecg[: int(SHORTEST_STRETCH_S * rate_hz)])).argmax())
    n_before = min(steepest + int(LEAD_S * rate_hz), len(ecg) - 1)
    joined = np.concatenate([ecg[n_before:0:-1], ecg])
    found: NDArray[np.int64] = np.array(detect_heartbeats(joined, rate_hz), np.int64) - n_before
    return found[found >= 0]


def _highest_near(
    peaks: NDArray[np.int64], ecg: NDArray[np.float64], rate_hz: float, method: HeartRateMethod
) -> NDArray[np.int64]:
    """Largest deflection near each peak, once, without those that are too low."""
    if peaks.size == 0:
        return peaks
    sos = butter(2, QRS_BAND_HZ, "bandpass", fs=rate_hz, output="sos")
    deflection = np.abs(sosfiltfilt(sos, ecg))
    reach = int(method.search_s * rate_hz)
    around = np.clip(peaks[:, None] + np.arange(-reach, reach + 1), 0, len(ecg) - 1)
    highest = np.unique(around[np.arange(len(peaks)), deflection[around].argmax(axis=1)])
    heights = deflection[highest]
    kept: NDArray[np.int64] = highest[heights >= method.least_height * np.median(heights)]
    return kept


def _without_early_peaks(peaks: NDArray[np.int64], shortest: float) -> NDArray[np.int64]:
    """Peaks without those that follow a kept one too soon."""
    kept: list[int] = []
    for peak in peaks.tolist():
        if not kept or peak - kept[-1] >= shortest:
            kept.append(peak)
    return np.array(kept, dtype=np.int64)


def _judgements(
    n_early: int, n_long: int, coverage: float, method: HeartRateMethod, file: str
) -> list[Finding]:
    findings = []
    if n_early:
        expected = f"at least {method.shortest_rr_s:g} s between R-peaks"
        found = f"sooner; peaks left out: {n_early}"
        findings.append(Finding("early_r_peak", "warning", file, "ecg", expected, found))
    if n_long:
        expected = f"at most {method.longest_rr_s:g} s between R-peaks"
        found = f"more; intervals left out: {n_long}"
        findings.append(Finding("long_rr_interval", "warning", file, "ecg", expected, found))
    if coverage < method.least_coverage:
        expected = f"RR intervals over {method.least_coverage:.0%} of the duration"
        findings.append(
            Finding("ecg_coverage", "warning", file, "ecg", expected, f"over {coverage:.0%}")
        )
    return findings
