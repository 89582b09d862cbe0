"""Global running pattern of a run by its mean duty factor, as run and at one speed (D§5.3.4.2).

The cut-offs come from a treadmill at 12 km/h, while people run outdoors at speeds of their own, and
the duty factor falls with speed. So it is also given at 12 km/h, along a straight line.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt
from numpy.typing import NDArray

from swaystride.errors import ConfigurationError

Array = NDArray[np.float64]
#: Which duty factor tells the pattern of a run.
PatternBy = Literal["run_mean", "at_12_km_h"]

#: Speed of the treadmill that the cut-offs come from.
REFERENCE_SPEED_M_S = 12.0 / 3.6


@dataclass(frozen=True)
class PatternRules:
    """Cut-offs and what is held against them.

    Parameters
    ----------
    aerial_below, terrestrial_above : float
        Duty factors below the first are aerial, above the second terrestrial, others intermediate.
    duty_factor_slope_s_m : float
        Change of the duty factor per m/s.
    pattern_by : {"run_mean", "at_12_km_h"}
        Duty factor that tells the pattern.

    Raises
    ------
    ConfigurationError
        If the cut-offs overlap.
    """

    aerial_below: float
    terrestrial_above: float
    duty_factor_slope_s_m: float
    pattern_by: PatternBy

    def __post_init__(self) -> None:
        if self.aerial_below > self.terrestrial_above:
            raise ConfigurationError(
                "a duty factor would be aerial and terrestrial",
                place="analysis.model.cutoffs",
                expected="aerial_below up to terrestrial_above",
                found=f"{self.aerial_below:g} and {self.terrestrial_above:g}",
            )


def running_patterns(duty_factor: npt.ArrayLike, rules: PatternRules) -> list[str]:
    """Pattern of each run.

    Parameters
    ----------
    duty_factor : array_like, shape (n,)
        NaN where unknown.
    rules : PatternRules

    Returns
    -------
    list of str
        ``aerial``, ``terrestrial``, ``intermediate`` (at a cut-off too), or nothing where unknown.

    Examples
    --------
    >>> rules = PatternRules(0.276, 0.288, -0.033, "run_mean")
    >>> running_patterns([0.25, 0.276, 0.288, 0.3, np.nan], rules)
    ['aerial', 'intermediate', 'intermediate', 'terrestrial', '']
    """
    values = np.asarray(duty_factor, dtype=np.float64)
    conditions = [
        np.isnan(values),
        values < rules.aerial_below,
        values > rules.terrestrial_above,
    ]
    names = np.select(conditions, ["", "aerial", "terrestrial"], default="intermediate")
    return [str(name) for name in names]


def duty_factor_at_12_km_h(
    duty_factor: npt.ArrayLike, speed_m_s: npt.ArrayLike, rules: PatternRules
) -> Array:
    """Duty factor that a runner would have at 12 km/h.

    Parameters
    ----------
    duty_factor, speed_m_s : array_like, shape (n,)
        Means of a run.
    rules : PatternRules

    Returns
    -------
    ndarray, shape (n,)

    Examples
    --------
    >>> rules = PatternRules(0.276, 0.288, -0.03, "run_mean")
    >>> duty_factor_at_12_km_h([0.27], [13.0 / 3.6], rules).round(4).tolist()
    [0.2783]
    """
    faster = np.asarray(speed_m_s, dtype=np.float64) - REFERENCE_SPEED_M_S
    return np.asarray(duty_factor, dtype=np.float64) - rules.duty_factor_slope_s_m * faster
