"""Choices of the filter: one dataclass, and two sets of values with their evidence."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

Integrator = Literal["midpoint", "euler"]


@dataclass(frozen=True)
class FilterOptions:
    """Which model the filter runs.

    Parameters
    ----------
    integrator : {"midpoint", "euler"}
        Mean rate of two samples and mean force of both ends of a step, each in the orientation of
        its end; or the first sample held over the step.
    gyro_bias : bool
        Twelve error states per segment instead of nine.
    contact_point : bool
        The contact point under the foot stands still, not the sensor; needs levers in the body.
    joint_rate_hz : float or None
        Joint centres and axes are applied at this rate; None means every sample.
    joint_correlation_s : float
        Their errors are alike over this time; their standard deviations are multiplied by
        ``sqrt(rate · time)`` where that exceeds one. 0 takes them as white.
    gate : float
        Largest squared, normalised innovation of a constraint (three degrees of freedom); infinity
        believes all.
    longest_refusal_s : float
        A constraint that was not believed for this time, refused or not due, is believed at its next
        sample: then the filter is wrong, not the constraint.
    checkpoint_spacing : int
        Samples between two checkpoints of the smoother. Changes memory and speed only.

    Examples
    --------
    >>> RECOMMENDED_OPTIONS.joint_inflation(200.0)  # joints at 50 Hz, correlated over 0.08 s
    2.0
    """

    integrator: Integrator
    gyro_bias: bool
    contact_point: bool
    joint_rate_hz: float | None
    joint_correlation_s: float
    gate: float
    longest_refusal_s: float
    checkpoint_spacing: int

    def joint_inflation(self, rate_hz: float) -> float:
        """Factor on the standard deviation of joint centres and axes.

        Parameters
        ----------
        rate_hz : float
            Sampling rate of the recording.
        """
        applied_hz = min(rate_hz, self.joint_rate_hz or rate_hz)
        return max(1.0, math.sqrt(applied_hz * self.joint_correlation_s))

    def patience(self, rate_hz: float) -> int:
        """Samples after which a refused constraint is believed.

        Parameters
        ----------
        rate_hz : float
            Sampling rate of the recording.
        """
        if math.isinf(self.longest_refusal_s):
            return np.iinfo(np.int64).max
        return round(self.longest_refusal_s * rate_hz)


#: As printed (dissertation §4.3.4.2, Fig. 4.3), and where it is silent as methods §1.2 and §1.5 say.
PRINTED_OPTIONS: Final = FilterOptions(
    integrator="midpoint",
    gyro_bias=False,
    contact_point=False,
    joint_rate_hz=None,
    joint_correlation_s=0.0,
    gate=math.inf,
    longest_refusal_s=math.inf,
    checkpoint_spacing=64,
)

#: Methods §1.6 (joints at 50 Hz, errors alike over 0.05-0.1 s), §1.12 (contact point, bias). Gate:
#: ten standard deviations. The 99.9 % of chi-squared of methods §1.5 (16.27) refuses joint centres
#: whenever soft tissue wobbles after an impact, until the pelvis has drifted off for good (hip
#: flexion of the simulated runner wrong by 10°). After two strides of refusals it is believed [N].
RECOMMENDED_OPTIONS: Final = FilterOptions(
    integrator="midpoint",
    gyro_bias=True,
    contact_point=True,
    joint_rate_hz=50.0,
    joint_correlation_s=0.08,
    gate=100.0,
    longest_refusal_s=1.5,
    checkpoint_spacing=64,
)
