"""Heart of a runner: when it beats during a run, and what a chest strap shows of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

Array = NDArray[np.float64]

#: Waves of a beat as (name, amplitude over that of R, middle and width in s), usual of a chest lead
#: [M]; P and T move with the square root of the RR interval, which is 1 s here.
_WAVES: Final = (
    ("P", 0.10, -0.16, 0.022, True),
    ("Q", -0.12, -0.026, 0.009, False),
    ("R", 1.00, 0.0, 0.010, False),
    ("S", -0.20, 0.028, 0.010, False),
    ("T", 0.22, 0.27, 0.045, True),
)


@dataclass(frozen=True)
class HeartBeats:
    """Heart rate over a run.

    Parameters
    ----------
    quantiles_bpm : tuple of float
        Least, first quartile, median, third quartile and largest mean of a run over its steady
        part; linear between them.
    person_share : float
        Share of the variance between runs that is between people.
    rise_bpm, rise_time_s : float
        By how much the rate is lower when the run begins, and how fast it rises.
    drift_bpm : float
        Rise from the warm-up to the end.
    slow_sd_bpm, slow_time_s : float
        Slow changes.
    breath_rr_s, breath_hz : float
        Size and frequency of the change of the RR interval with breath.
    beat_rr_sd_s : float
        Scatter from beat to beat.
    """

    quantiles_bpm: tuple[float, float, float, float, float]
    person_share: float
    rise_bpm: float
    rise_time_s: float
    drift_bpm: float
    slow_sd_bpm: float
    slow_time_s: float
    breath_rr_s: float
    breath_hz: float
    beat_rr_sd_s: float


@dataclass(frozen=True)
class StrapSignal:
    """Electrocardiogram of a chest strap.

    Parameters
    ----------
    rate_hz : float
        Sampling rate.
    r_wave_v, r_wave_log_sd : float
        Size of the R wave, and its scatter between runs.
    noise_v : float
        Standard deviation of the noise of muscles and electrodes.
    wander_v, step_v : float
        Amplitudes of what breath and steps do to the signal.
    wander_hz, step_hz : float
        Frequencies of breath and steps in it.
    """

    rate_hz: float
    r_wave_v: float
    r_wave_log_sd: float
    noise_v: float
    wander_v: float
    step_v: float
    wander_hz: float
    step_hz: float


def mean_rate_bpm(heart: HeartBeats, z_person: float, z_run: float) -> float:
    """Mean heart rate of a run.

    Parameters
    ----------
    heart : HeartBeats
        Distribution.
    z_person, z_run : float
        Unit normal numbers.

    Returns
    -------
    float

    Examples
    --------
    >>> heart = HeartBeats((129, 152, 160, 165, 179), 0.5, 30, 60, 4, 1, 120, 0.004, 0.5, 0.003)
    >>> mean_rate_bpm(heart, 0.0, 0.0)
    160.0
    """
    share = heart.person_share
    level = float(ndtr(np.sqrt(share) * z_person + np.sqrt(1.0 - share) * z_run))
    return float(np.interp(level, [0.0, 0.25, 0.5, 0.75, 1.0], heart.quantiles_bpm))


def beat_times_s(
    heart: HeartBeats,
    mean_bpm: float,
    *,
    duration_s: float,
    warm_up_s: float,
    steady: NDArray[np.float64],
    rng: np.random.Generator,
) -> Array:
    """Instants of the R-peaks of a run.

    Parameters
    ----------
    heart : HeartBeats
        How the rate changes.
    mean_bpm : float
        Mean over the steady parts: 60 s over the mean RR interval in them, to a few beats in a
        thousand.
    duration_s, warm_up_s : float
        Of the run.
    steady : ndarray, shape (n_parts, 2)
        Begin and end of the steady parts.
    rng : numpy.random.Generator
        Of the run.

    Returns
    -------
    ndarray, shape (n_beats,)
        Rising, in s.
    """
    time = np.arange(0.0, duration_s + 0.5, 0.5)
    change = -heart.rise_bpm * np.exp(-time / heart.rise_time_s)
    change += heart.drift_bpm * np.clip((time - warm_up_s) / (duration_s - warm_up_s), 0.0, 1.0)
    knots = np.arange(-heart.slow_time_s, duration_s + 2.0 * heart.slow_time_s, heart.slow_time_s)
    change += heart.slow_sd_bpm * np.interp(time, knots, rng.standard_normal(len(knots)))
    inside = ((time[:, None] >= steady[:, 0]) & (time[:, None] < steady[:, 1])).any(axis=1)
    rate_hz = (mean_bpm + change - change[inside].mean()) / 60.0
    beats = np.concatenate([[0.0], np.cumsum(0.25 * (rate_hz[1:] + rate_hz[:-1]))])
    whole = np.arange(rng.random(), beats[-1])
    usual = np.interp(whole, beats, time)
    breath = np.sin(2.0 * np.pi * (heart.breath_hz * usual + rng.random()))
    # Differences of what is added here are those of the intervals.
    swing = heart.breath_rr_s / (2.0 * np.sin(np.pi * heart.breath_hz / rate_hz.mean()))
    jitter = heart.beat_rr_sd_s / np.sqrt(2.0) * rng.standard_normal(len(usual))
    return np.asarray(usual + swing * breath + np.clip(jitter, -0.02, 0.02))


def mean_rate_of_beats_bpm(beats_s: Array, steady: NDArray[np.float64]) -> float:
    """60 s over the mean of the RR intervals that lie within the steady parts.

    Parameters
    ----------
    beats_s : ndarray, shape (n_beats,)
        Instants of the R-peaks.
    steady : ndarray, shape (n_parts, 2)
        Begin and end of the parts.

    Returns
    -------
    float

    Examples
    --------
    >>> mean_rate_of_beats_bpm(np.arange(0.0, 9.0, 0.5), np.array([[1.0, 3.0], [5.0, 8.0]]))
    120.0
    """
    begin, end = beats_s[:-1, None], beats_s[1:, None]
    inside = ((begin >= steady[:, 0]) & (end <= steady[:, 1])).any(axis=1)
    return 60.0 / float(np.diff(beats_s)[inside].mean())


def electrocardiogram_v(
    strap: StrapSignal, beats_s: Array, *, duration_s: float, rng: np.random.Generator
) -> Array:
    """Electrocardiogram with the waves of every beat, wander and noise.

    Parameters
    ----------
    strap : StrapSignal
        Sizes.
    beats_s : ndarray, shape (n_beats,)
        Instants of the R-peaks.
    duration_s : float
        Length; sample 0 is at time 0.
    rng : numpy.random.Generator
        Of the run.

    Returns
    -------
    ndarray, shape (n_samples,)
        In V.
    """
    n = int(np.floor(duration_s * strap.rate_hz + 1e-9))
    size = strap.r_wave_v * float(np.exp(strap.r_wave_log_sd * rng.standard_normal()))
    rr = np.diff(beats_s, append=2.0 * beats_s[-1] - beats_s[-2])
    reach = int(0.4 * strap.rate_hz)
    index = np.rint(beats_s * strap.rate_hz).astype(np.int64)[:, None] + np.arange(-reach, reach)
    since = index / strap.rate_hz - beats_s[:, None]
    wave = np.zeros(since.shape)
    for _, share, middle, width, moves in _WAVES:
        slower = np.sqrt(rr)[:, None] if moves else 1.0
        wave += size * share * np.exp(-0.5 * ((since - middle * slower) / (width * slower)) ** 2)
    inside = (index >= 0) & (index < n)
    ecg = np.bincount(index[inside], wave[inside], minlength=n)
    time = np.arange(n) / strap.rate_hz
    phase = rng.random(2)
    ecg += strap.wander_v * np.sin(2.0 * np.pi * (strap.wander_hz * time + phase[0]))
    ecg += strap.step_v * np.sin(2.0 * np.pi * (strap.step_hz * time + phase[1]))
    return np.asarray(ecg + strap.noise_v * rng.standard_normal(n))
