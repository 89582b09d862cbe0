"""From a standing body to the raw file of one trial, for any study with a lumbar sensor."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from swaystride.io.xsens_txt_writer import write_xsens_txt
from swaystride.simulate.inertial_sensor import SensorModel, SensorUnit, measure, trunk_signals
from swaystride.simulate.loss_of_balance import LossOfBalance
from swaystride.simulate.sampling import decimation_factor, filter_reach
from swaystride.simulate.standing_body import (
    StandingMotion,
    StandingParameters,
    lean_angles_deg,
    simulate_standing,
)
from swaystride.simulate.standing_model import TrialSettings
from swaystride.simulate.worn_sensor import RadioLoss, SensorPlacement

Array = NDArray[np.float64]


def standing_motion(
    body: StandingParameters,
    trial: TrialSettings,
    rng: np.random.Generator,
    *,
    duration_s: float | None = None,
    loss_of_balance: LossOfBalance | None = None,
) -> StandingMotion:
    """One trial at the rate of simulation, with what the anti-alias filter needs on both sides.

    The first sample of the recording is ``filter_reach(trial.simulation_rate_hz, trial.rate_hz)``
    samples after the beginning of the motion; the functions of this module know that.

    Parameters
    ----------
    body : StandingParameters
        The person and how they stand.
    trial : TrialSettings
        Rates, warm-up and duration.
    rng : numpy.random.Generator
        Source of all random numbers. The motion of a shorter trial is not the beginning of that
        of a longer one.
    duration_s : float, optional
        Duration of a trial that stops early; by default that of `trial`.
    loss_of_balance : LossOfBalance, optional
        What happens beyond the limit of balance; by default nothing does.

    Returns
    -------
    StandingMotion
    """
    if duration_s is not None:
        trial = replace(trial, duration_s=duration_s)
    factor = decimation_factor(trial.simulation_rate_hz, trial.rate_hz)
    reach = filter_reach(trial.simulation_rate_hz, trial.rate_hz)
    return simulate_standing(
        body,
        n_samples=(trial.n_samples - 1) * factor + 1 + 2 * reach,
        rate_hz=trial.simulation_rate_hz,
        warm_up_s=trial.warm_up_s,
        rng=rng,
        loss_of_balance=loss_of_balance,
    )


def true_sway(motion: StandingMotion, trial: TrialSettings) -> tuple[Array, Array]:
    """True sway angles at the sampling instants of the sensor.

    Parameters
    ----------
    motion : StandingMotion
        From :func:`standing_motion`.
    trial : TrialSettings
        Rates.

    Returns
    -------
    ap_deg, ml_deg : ndarray, shape (n_samples,)
        Forward and to the right positive, not filtered.
    """
    factor = decimation_factor(trial.simulation_rate_hz, trial.rate_hz)
    reach = filter_reach(trial.simulation_rate_hz, trial.rate_hz)
    ap, ml = lean_angles_deg(
        motion.angle_rad[:, reach : motion.angle_rad.shape[1] - reach : factor]
    )
    return ap, ml


def true_measures(motion: StandingMotion, trial: TrialSettings) -> dict[str, float]:
    """Sway measures of the true angles, after the filter of the analysis.

    Parameters
    ----------
    motion : StandingMotion
        From :func:`standing_motion`.
    trial : TrialSettings
        Rates and filter.

    Returns
    -------
    dict
        All measures of :func:`~swaystride.sway.metrics.sway_metrics`.
    """
    return trial.true_measures(*true_sway(motion, trial))


def recorded_duration_s(motion: StandingMotion, trial: TrialSettings) -> float:
    """Time from the first to the last sample of the recording of a motion.

    Parameters
    ----------
    motion : StandingMotion
        From :func:`standing_motion`.
    trial : TrialSettings
        Rates.
    """
    reach = filter_reach(trial.simulation_rate_hz, trial.rate_hz)
    return float((motion.angle_rad.shape[1] - 1 - 2 * reach) / motion.rate_hz)


def true_loss_times(motion: StandingMotion, trial: TrialSettings) -> tuple[float, ...]:
    """Times of the losses of balance, counted from the first sample of the recording.

    Parameters
    ----------
    motion : StandingMotion
        From :func:`standing_motion`.
    trial : TrialSettings
        Rates.

    Returns
    -------
    tuple of float
        In s, in order; only losses that begin between the first and the last sample.
    """
    reach = filter_reach(trial.simulation_rate_hz, trial.rate_hz)
    last_s = recorded_duration_s(motion, trial)
    times_s = (time_s - reach / motion.rate_hz for time_s in motion.loss_times_s)
    return tuple(time_s for time_s in times_s if 0.0 <= time_s <= last_s)


def write_standing_recording(
    path: Path | str,
    motion: StandingMotion,
    *,
    height_m: float,
    placement: SensorPlacement,
    sensor: SensorModel,
    unit: SensorUnit,
    trial: TrialSettings,
    radio: RadioLoss,
    link_lost: bool,
    rng: np.random.Generator,
) -> dict[str, object]:
    """Write what the sensor and its radio make of a trial.

    Parameters
    ----------
    path : path or str
        File to write, Xsens MT Manager text; its folder is made if there is none.
    motion : StandingMotion
        From :func:`standing_motion`; it sets the duration.
    height_m : float
        Stature of the person.
    placement : SensorPlacement
        Where the sensor sits.
    sensor : SensorModel
        Type of the sensor.
    unit : SensorUnit
        Its errors on this person in this session.
    trial : TrialSettings
        Rates.
    radio : RadioLoss
        What gets lost.
    link_lost : bool
        Whether this trial is one whose link is lost.
    rng : numpy.random.Generator
        Source of sensor noise, radio losses and the first packet number.

    Returns
    -------
    dict
        ``radio``: ``complete``, ``few packets``, ``hole`` or ``ends early``; ``n_lost_packets``.
    """
    acc_ideal, gyr_ideal = trunk_signals(motion, placement.position_m(height_m))
    acc, gyr = measure(
        sensor,
        unit,
        acc_m_s2=acc_ideal,
        gyr_rad_s=gyr_ideal,
        rate_hz=trial.simulation_rate_hz,
        output_rate_hz=trial.rate_hz,
        rng=rng,
    )
    kind, lost = lost_packets(acc.shape[1], trial.rate_hz, radio, link_lost=link_lost, rng=rng)
    n_written = int(np.flatnonzero(~lost)[-1]) + 1
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    write_xsens_txt(
        path,
        acc[:, :n_written],
        gyr[:, :n_written],
        rate_hz=trial.rate_hz,
        first_packet=int(rng.integers(2**16)),
        lost=lost[:n_written],
        comments=("simulated by swaystride, not a measurement",),
    )
    return {"radio": kind, "n_lost_packets": int(lost.sum())}


def lost_packets(
    n_samples: int,
    rate_hz: float,
    radio: RadioLoss,
    *,
    link_lost: bool,
    rng: np.random.Generator,
) -> tuple[str, NDArray[np.bool_]]:
    """What happened to the radio link of one trial, and which packets are lost.

    Parameters
    ----------
    n_samples : int
        Samples of the trial.
    rate_hz : float
        Sampling rate.
    radio : RadioLoss
        What gets lost.
    link_lost : bool
        Whether the link is lost: a hole, at most from the second to the last but one sample, or
        an early end. If not, a few single packets may be.
    rng : numpy.random.Generator
        Source of the losses.

    Returns
    -------
    kind : str
        ``complete``, ``few packets``, ``hole`` or ``ends early``.
    lost : ndarray of bool, shape (n_samples,)
    """
    lost = np.zeros(n_samples, dtype=bool)
    if link_lost and rng.random() < radio.hole_share:
        length = min(round(rng.uniform(*radio.hole_s) * rate_hz), n_samples - 2)
        start = int(rng.integers(1, n_samples - length))
        lost[start : start + length] = True
        return "hole", lost
    if link_lost:
        lost[round(rng.uniform(*radio.end_fraction) * n_samples) :] = True
        return "ends early", lost
    if rng.random() < radio.few_packets_share:
        n_lost = int(rng.integers(1, radio.few_packets + 1))
        # Single packets: neither the first nor the last, and no two in a row.
        slots = rng.choice(np.arange(1, n_samples - 1, 2), size=n_lost, replace=False)
        lost[slots] = True
        return "few packets", lost
    return "complete", lost
