"""How the sway of a trial follows from its latent intensity, without any file."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.simulate.intensity_parameters import STUDY, IntensityCohort
from swaystride.simulate.intensity_ratings import PatientTruth
from swaystride.simulate.intensity_truth import SwayLink
from swaystride.simulate.sampling import decimation_factor, filter_reach
from swaystride.simulate.seeds import generator
from swaystride.simulate.standing_body import StandingMotion, StandingParameters
from swaystride.simulate.standing_model import TrialSettings
from swaystride.simulate.standing_recordings import (
    recorded_duration_s,
    standing_motion,
    true_loss_times,
    true_measures,
)

Array = NDArray[np.float64]

#: The intensity at which the parameters of the link are stated.
_MIDDLE: Final = 3.0


@dataclass(frozen=True)
class SwayInputs:
    """Physical inputs of a patient's trials; arrays of shape (n_exercises, n_trials).

    Parameters
    ----------
    ln_noise_ap, ln_noise_ml : ndarray
        Logarithms of the noise torques' standard deviations over m g h.
    activity : ndarray
        Position on the path of activity.
    weight_shift_deg : ndarray
        Standard deviation of the slow anterior-posterior lean.
    """

    ln_noise_ap: Array
    ln_noise_ml: Array
    activity: Array
    weight_shift_deg: Array


@dataclass(frozen=True)
class SwayTrial:
    """One simulated trial.

    Parameters
    ----------
    body : StandingParameters
        Physical parameters.
    motion : StandingMotion
        What the body does, as long as the trial lasts.
    loss_times_s : tuple of float
        Losses of balance, from the first sample of the recording.
    stop : str
        ``complete``, ``after a loss of balance`` or ``by accident``.
    """

    body: StandingParameters
    motion: StandingMotion
    loss_times_s: tuple[float, ...]
    stop: str


def draw_sway_inputs(link: SwayLink, intensity: Array, rng: np.random.Generator) -> SwayInputs:
    """Draw the physical inputs of a patient's trials from their intensities.

    Parameters
    ----------
    link : SwayLink
        What is true.
    intensity : ndarray, shape (n_exercises, n_trials)
        Latent intensity.
    rng : numpy.random.Generator
        The patient's own.

    Returns
    -------
    SwayInputs
    """
    n_exercises, n_trials = intensity.shape
    common = (
        link.patient_sd * rng.standard_normal()
        + link.exercise_sd * rng.standard_normal((n_exercises, 1))
        + link.trial_sd * rng.standard_normal((n_exercises, n_trials))
    )
    alone = rng.standard_normal((3, n_exercises, 1))
    above = intensity - _MIDDLE
    ln_shift = link.ln_weight_shift + link.weight_shift_slope * above
    ln_shift = ln_shift + link.weight_shift_sd * rng.standard_normal((n_exercises, n_trials))
    return SwayInputs(
        link.ln_noise_ap + link.slope_ap * above + common + link.direction_sd_ap * alone[0],
        link.ln_noise_ml + link.slope_ml * above + common + link.direction_sd_ml * alone[1],
        link.activity + link.activity_slope * above + link.activity_sd * alone[2],
        np.minimum(np.exp(ln_shift), link.largest_weight_shift_deg),
    )


def simulate_trial(
    inputs: SwayInputs,
    exercise: int,
    trial: int,
    *,
    cohort: IntensityCohort,
    mass_kg: float,
    height_m: float,
    rng: np.random.Generator,
) -> SwayTrial:
    """Simulate one trial: the body, its losses of balance, and its end.

    Parameters
    ----------
    inputs : SwayInputs
        Of this patient.
    exercise, trial : int
        Which one, from 0.
    cohort : IntensityCohort
        Parameters.
    mass_kg, height_m : float
        The patient.
    rng : numpy.random.Generator
        The trial's own.

    Returns
    -------
    SwayTrial
    """
    standing = cohort.standing
    shift_deg = float(inputs.weight_shift_deg[exercise, trial])
    body = standing.parameters(
        ln_noise_ap=float(inputs.ln_noise_ap[exercise, trial]),
        ln_noise_ml=float(inputs.ln_noise_ml[exercise, trial]),
        activity=float(inputs.activity[exercise, trial]),
        coupling=standing.draw_coupling(rng),
        mass_kg=mass_kg,
        pendulum_height_m=cohort.placement.pendulum_height_m(height_m),
        weight_shift_deg=(shift_deg, cohort.population.sway.weight_shift_ml_share * shift_deg),
    )
    motion = standing_motion(body, cohort.trial, rng, loss_of_balance=cohort.loss_of_balance)
    losses = true_loss_times(motion, cohort.trial)
    duration_s, stop = _end_of_trial(losses, cohort, rng)
    if stop != "complete":
        motion = _shortened(motion, cohort.trial, duration_s)
        losses = tuple(time for time in losses if time <= duration_s)
    return SwayTrial(body, motion, losses, stop)


def simulate_features(
    participant: str,
    truth: PatientTruth,
    *,
    cohort: IntensityCohort,
    mass_kg: float,
    height_m: float,
    seed: int,
) -> pd.DataFrame:
    """True sway measures of all trials of one patient; the same motions as in the raw files.

    Parameters
    ----------
    participant : str
        Name of the patient.
    truth : PatientTruth
        Of this patient.
    cohort : IntensityCohort
        Parameters.
    mass_kg, height_m : float
        The patient.
    seed : int
        Seed of the cohort.

    Returns
    -------
    DataFrame
        ``exercise_order`` and ``trial`` from 1, ``duration_s``, and the measures.
    """
    inputs = sway_inputs_of(participant, truth, cohort, seed)
    rows = []
    for e, t in np.ndindex(*truth.intensity.shape):
        simulated = simulate_trial(
            inputs,
            e,
            t,
            cohort=cohort,
            mass_kg=mass_kg,
            height_m=height_m,
            rng=trial_generator(seed, participant, e, t),
        )
        measures = true_measures(simulated.motion, cohort.trial)
        duration_s = recorded_duration_s(simulated.motion, cohort.trial)
        rows.append({"exercise_order": e + 1, "trial": t + 1, "duration_s": duration_s, **measures})
    return pd.DataFrame(rows)


def sway_inputs_of(
    participant: str, truth: PatientTruth, cohort: IntensityCohort, seed: int
) -> SwayInputs:
    """Physical inputs of one patient, the same for the features and for the raw files.

    Parameters
    ----------
    participant : str
        Name of the patient.
    truth : PatientTruth
        Of this patient.
    cohort : IntensityCohort
        Parameters.
    seed : int
        Seed of the cohort.
    """
    rng = generator(seed, STUDY, participant, "sway")
    return draw_sway_inputs(cohort.population.sway, truth.intensity, rng)


def trial_generator(seed: int, participant: str, exercise: int, trial: int) -> np.random.Generator:
    """Random numbers of one trial.

    Parameters
    ----------
    seed : int
        Seed of the cohort.
    participant : str
        Name of the patient.
    exercise, trial : int
        Which one, from 0.
    """
    return generator(seed, STUDY, participant, f"exercise {exercise + 1:02d} trial {trial + 1}")


def _end_of_trial(
    losses: tuple[float, ...], cohort: IntensityCohort, rng: np.random.Generator
) -> tuple[float, str]:
    """When a trial ends, and why; always three random numbers."""
    link, full_s = cohort.population.sway, cohort.trial.duration_s
    by_accident, gives_up, where = rng.random(3).tolist()
    shortest_s = cohort.protocol.shortest_trial_s
    if by_accident < link.accidental_stop_share:
        return shortest_s + where * (full_s - shortest_s), "by accident"
    ends = [time + cohort.protocol.stop_delay_s for time in losses]
    ends = [end for end in ends if shortest_s <= end < full_s]
    if ends and gives_up < link.stop_share:
        return ends[int(where * len(ends))], "after a loss of balance"
    return full_s, "complete"


def _shortened(motion: StandingMotion, trial: TrialSettings, duration_s: float) -> StandingMotion:
    """The first part of a motion, with what the anti-alias filter needs on both sides."""
    reach = filter_reach(trial.simulation_rate_hz, trial.rate_hz)
    n_samples = replace(trial, duration_s=duration_s).n_samples
    factor = decimation_factor(trial.simulation_rate_hz, trial.rate_hz)
    n = (n_samples - 1) * factor + 1 + 2 * reach
    return replace(
        motion,
        angle_rad=motion.angle_rad[:, :n],
        velocity_rad_s=motion.velocity_rad_s[:, :n],
        acceleration_rad_s2=motion.acceleration_rad_s2[:, :n],
    )
