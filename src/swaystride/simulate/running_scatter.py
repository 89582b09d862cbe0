"""How runners differ from the usual one, and from one run to the next."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Final

import numpy as np

from swaystride.simulate.running_manner import RunnerManner
from swaystride.units import RAD_PER_DEG

#: Nobody differs from the usual runner by more standard deviations than this [N].
MOST_SD: Final = 2.0


@dataclass(frozen=True)
class RunnerScatter:
    """How runners differ from the usual one of their speed.

    Names are those of :class:`~swaystride.simulate.running_manner.RunnerManner`: ``_log_sd`` is the
    scatter of the logarithm of a factor, ``_sd_deg``, ``_sd_m`` and ``_sd`` that of what is added.

    Parameters
    ----------
    stride_time_log_sd, impact_log_sd, arrest_log_sd, quiet_rate_log_sd : float
        Timing and impacts.
    duty_factor_sd, contact_pitch_sd_deg, toe_off_pitch_sd_deg, swing_pitch_sd_deg : float
        Stance, and pitch of the foot.
    toe_out_sd_deg, foot_roll_log_sd, step_width_sd_m : float
        Feet in the other planes.
    hip_range_log_sd, knee_range_log_sd : float
        Flexion that the swing aims at.
    hip_rotation_range_log_sd, knee_adduction_range_log_sd, knee_rotation_range_log_sd : float
        Legs in the other planes.
    pelvis_range_log_sd, pelvis_tilt_sd_deg, trunk_range_log_sd, trunk_lean_sd_deg : float
        Pelvis and trunk.
    arm_swing_log_sd, elbow_sd_deg, soft_tissue_log_sd : float
        Arms, and wobble of soft tissue.
    trial_share : float
        Scatter between the trials of a person over that between people.
    """

    stride_time_log_sd: float
    impact_log_sd: float
    arrest_log_sd: float
    quiet_rate_log_sd: float
    duty_factor_sd: float
    contact_pitch_sd_deg: float
    toe_off_pitch_sd_deg: float
    swing_pitch_sd_deg: float
    toe_out_sd_deg: float
    foot_roll_log_sd: float
    step_width_sd_m: float
    hip_range_log_sd: float
    knee_range_log_sd: float
    hip_rotation_range_log_sd: float
    knee_adduction_range_log_sd: float
    knee_rotation_range_log_sd: float
    pelvis_range_log_sd: float
    pelvis_tilt_sd_deg: float
    trunk_range_log_sd: float
    trunk_lean_sd_deg: float
    arm_swing_log_sd: float
    elbow_sd_deg: float
    soft_tissue_log_sd: float
    trial_share: float


#: Ends of the names of a scatter: what stands for them in a manner, and the factor to its unit.
_ENDS: Final = {
    "_log_sd": ("", 1.0),
    "_sd_deg": ("_rad", RAD_PER_DEG),
    "_sd_m": ("_m", 1.0),
    "_sd": ("", 1.0),
}


def manner_scales(scatter: RunnerScatter) -> dict[str, float]:
    """Standard deviation of every part of a manner that scatters.

    Parameters
    ----------
    scatter : RunnerScatter
        Between people.

    Returns
    -------
    dict of str to float
        By field of :class:`~swaystride.simulate.running_manner.RunnerManner`, in its unit; that of
        a factor is the one of its logarithm.
    """
    scales = {}
    for part in fields(RunnerScatter):
        end = next((end for end in _ENDS if part.name.endswith(end)), None)
        if end is not None:
            ending, factor = _ENDS[end]
            name = part.name.removesuffix(end) + ending
            scales[name] = getattr(scatter, part.name) * factor
    return scales


def drawn_manner(
    scatter: RunnerScatter, person_rng: np.random.Generator, trial_rng: np.random.Generator
) -> RunnerManner:
    """How a person runs in a trial: the person's manner, and a little of the trial's own.

    Parameters
    ----------
    scatter : RunnerScatter
        Between people, and its share between trials.
    person_rng, trial_rng : numpy.random.Generator
        Those of the person and of the trial.

    Returns
    -------
    RunnerManner
    """
    scales = manner_scales(scatter)
    own, then = (
        np.clip(rng.standard_normal(len(scales)), -MOST_SD, MOST_SD)
        for rng in (person_rng, trial_rng)
    )
    changed = np.array(list(scales.values())) * (own + scatter.trial_share * then)
    return manner_from(dict(zip(scales, changed.tolist(), strict=True)))


def manner_from(changed: dict[str, float]) -> RunnerManner:
    """Manner that differs from the usual one by some amounts.

    Parameters
    ----------
    changed : dict of str to float
        By field; of a factor, its logarithm.

    Examples
    --------
    >>> manner = manner_from({"impact": 0.0, "crouch_m": 0.01})
    >>> manner.impact, manner.crouch_m
    (1.0, 0.01)
    """
    usual = RunnerManner()
    values = {
        name: float(np.exp(value)) if getattr(usual, name) == 1.0 else value
        for name, value in changed.items()
    }
    return RunnerManner(**values)
