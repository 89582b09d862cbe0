"""What is true of the population of the intensity study; the values stand in ``config/``.

Everything is measured on the rating scale: a latent intensity of 3 is the middle of it, one unit
is one step of the rating.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class LatentIntensity:
    """How intense an exercise truly is for a patient.

    ``λ = mean + weights · steps − ability + exercise + patient's exercise + trial``.

    Parameters
    ----------
    mean : float
        Of the easiest exercise (all steps 0) for a patient of ability 0.
    surface, stance, vision, head : float
        Weight per step of difficulty.
    ability_sd : float
        Between patients.
    exercise_sd : float
        Of an exercise, the same for all patients, beyond its four aspects.
    patient_exercise_sd : float
        Of an exercise for one patient.
    trial_sd : float
        Between the trials of one exercise.
    planning_sd : float
        Error of the intensity that is expected when the exercises are chosen.
    head_avoidance, extreme_stance_avoidance : float
        See :func:`swaystride.simulate.intensity_exercises.choose_exercises`.
    """

    mean: float
    surface: float
    stance: float
    vision: float
    head: float
    ability_sd: float
    exercise_sd: float
    patient_exercise_sd: float
    trial_sd: float
    planning_sd: float
    head_avoidance: float
    extreme_stance_avoidance: float

    @property
    def weights(self) -> Array:
        """Weights of surface, stance, vision and head, shape (4,)."""
        return np.array([self.surface, self.stance, self.vision, self.head])


@dataclass(frozen=True)
class TherapistRating:
    """How therapists turn what they see into a rating.

    Parameters
    ----------
    thresholds : tuple of float
        Four boundaries between the ratings 1 to 5 on the latent scale.
    rater_sd, rater_patient_sd, rater_exercise_sd : float
        Bias of a therapist; for a patient; for an exercise of a patient.
    trial_noise_sd, exercise_noise_sd : float
        Noise of a rating of a trial, and of an exercise as a whole.
    confused_share : float
        Probability that the direction of the scale is confused (r becomes 6 − r).
    """

    thresholds: tuple[float, float, float, float]
    rater_sd: float
    rater_patient_sd: float
    rater_exercise_sd: float
    trial_noise_sd: float
    exercise_noise_sd: float
    confused_share: float


@dataclass(frozen=True)
class SelfRating:
    """How patients rate themselves.

    Parameters
    ----------
    thresholds : tuple of float
        Four boundaries between the ratings 1 to 5 on the latent scale.
    trial_weight : float
        Share of the difference between trials that a patient notices.
    patient_sd, patient_exercise_sd : float
        Bias of a patient, and for an exercise.
    trial_noise_sd, exercise_noise_sd : float
        Noise of a rating of a trial, and of an exercise as a whole.
    confused_share : float
        Probability that the direction of the scale is confused.
    """

    thresholds: tuple[float, float, float, float]
    trial_weight: float
    patient_sd: float
    patient_exercise_sd: float
    trial_noise_sd: float
    exercise_noise_sd: float
    confused_share: float


@dataclass(frozen=True)
class SwayLink:
    """How the latent intensity of a trial shows in the sway.

    The logarithm of the noise torque over m g h is linear in the intensity, with scatter between
    patients and trials; those of the two directions have a common part.

    Parameters
    ----------
    ln_noise_ap, ln_noise_ml : float
        At intensity 3.
    slope_ap, slope_ml : float
        Per unit of intensity.
    activity, activity_slope : float
        Position on the path of activity at intensity 3, and per unit of intensity.
    patient_sd, exercise_sd, trial_sd : float
        Common scatter of both directions, of ln(noise).
    direction_sd_ap, direction_sd_ml : float
        Scatter of each direction alone, between the exercises of a patient.
    activity_sd : float
        Between the exercises of a patient.
    ln_weight_shift, weight_shift_slope, weight_shift_sd : float
        Logarithm of the slow anterior-posterior shift of weight in a trial (deg): at intensity 3, per unit
        of intensity, and its scatter between trials.
    weight_shift_ml_share : float
        Medio-lateral over anterior-posterior lean.
    largest_weight_shift_deg : float
        Nobody leans further than this.
    stop_share : float
        Probability that a patient ends the trial after a loss of balance.
    accidental_stop_share : float
        Probability that a trial ends early for no reason.
    """

    ln_noise_ap: float
    ln_noise_ml: float
    slope_ap: float
    slope_ml: float
    activity: float
    activity_slope: float
    patient_sd: float
    exercise_sd: float
    trial_sd: float
    direction_sd_ap: float
    direction_sd_ml: float
    activity_sd: float
    ln_weight_shift: float
    weight_shift_slope: float
    weight_shift_sd: float
    weight_shift_ml_share: float
    largest_weight_shift_deg: float
    stop_share: float
    accidental_stop_share: float


@dataclass(frozen=True)
class IntensityPopulation:
    """Everything that is true of the population.

    Parameters
    ----------
    latent, therapist, self_rating, sway : LatentIntensity, TherapistRating, SelfRating, SwayLink
        See there.
    """

    latent: LatentIntensity
    therapist: TherapistRating
    self_rating: SelfRating
    sway: SwayLink
