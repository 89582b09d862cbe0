"""Loss of balance of a standing person: fall, reaction, and the catch by the handrail."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from swaystride.errors import ConfigurationError
from swaystride.units import RAD_PER_DEG


@dataclass(frozen=True)
class LossOfBalance:
    """When balance is lost and how it is regained (spec §8.4, §9.3).

    The inclination is that of the pendulums, the resultant of pitch and roll without slow drift
    and breathing. Beyond the threshold the centre of pressure is at the edge of the foot: control
    and its noise do nothing, and the body falls as an inverted pendulum. After the reaction time,
    or at the largest inclination, the handrail or the harness catches it: each angle follows the
    polynomial of degree five that takes over angle, velocity and acceleration and ends upright,
    without velocity and acceleration. Then control and noise go on; the control still sees the
    path of the catch for the time of its delay, and the noise torque has run on unfelt.

    Stopping takes time, so that the body leans beyond `largest_deg` before it returns: with a
    catch of 1 s and the usual body by up to some 60 %.

    Parameters
    ----------
    threshold_deg : float
        Inclination beyond which balance is lost.
    reaction_median_s, reaction_log_sd : float
        The time to the catch is log-normal: its median, and the standard deviation of its
        logarithm. One draw per loss.
    largest_deg : float
        Inclination at which the body is caught whatever the reaction time.
    catch_s : float
        Time from the catch to upright.

    Raises
    ------
    ConfigurationError
        If an angle or a time is not positive, the spread is negative, or the body would be caught
        before it falls.
    """

    threshold_deg: float
    reaction_median_s: float
    reaction_log_sd: float
    largest_deg: float
    catch_s: float

    def __post_init__(self) -> None:
        for name in ("threshold_deg", "reaction_median_s", "catch_s"):
            if not 0.0 < getattr(self, name) < np.inf:
                raise _impossible(name, "a positive number", getattr(self, name))
        if not 0.0 <= self.reaction_log_sd < np.inf:
            raise _impossible("reaction_log_sd", "zero or more", self.reaction_log_sd)
        if not self.threshold_deg <= self.largest_deg < 90.0:
            raise _impossible("largest_deg", "from threshold_deg to below 90", self.largest_deg)

    @property
    def threshold_rad(self) -> float:
        """Inclination beyond which balance is lost, in rad."""
        return self.threshold_deg * RAD_PER_DEG

    @property
    def largest_rad(self) -> float:
        """Inclination at which the body is caught, in rad."""
        return self.largest_deg * RAD_PER_DEG

    def catch_steps(self, rate_hz: float) -> int:
        """Steps of the catch, at least one.

        Parameters
        ----------
        rate_hz : float
            Steps per second.
        """
        return max(round(self.catch_s * rate_hz), 1)

    def draw_reaction_steps(
        self, n_steps: int, rate_hz: float, rng: np.random.Generator
    ) -> NDArray[np.int64]:
        """Reaction times of as many losses as a run can have, in steps.

        A loss lasts at least as long as its catch, so that there cannot be more.

        Parameters
        ----------
        n_steps : int
            Steps of the run.
        rate_hz : float
            Steps per second.
        rng : numpy.random.Generator
            Source of the times.

        Returns
        -------
        ndarray of int, shape (n_losses,)

        Examples
        --------
        >>> rail = LossOfBalance(6.0, 0.3, 0.5, largest_deg=20.0, catch_s=1.0)
        >>> steps = rail.draw_reaction_steps(10**7, 1000.0, np.random.default_rng(1))
        >>> len(steps), bool(abs(np.median(steps) - 300) < 10)
        (10001, True)
        """
        n_losses = n_steps // self.catch_steps(rate_hz) + 1
        reaction_s = self.reaction_median_s * np.exp(
            self.reaction_log_sd * rng.standard_normal(n_losses)
        )
        # A reaction later than the end of the run is none; the bound keeps the integers small.
        return np.rint(np.minimum(reaction_s * rate_hz, n_steps)).astype(np.int64)


def _impossible(name: str, expected: str, found: float) -> ConfigurationError:
    """The error about one parameter."""
    return ConfigurationError(
        "such a loss of balance is impossible",
        place=name,
        expected=expected,
        found=f"{found:g}",
    )
