"""How a population stands: what is the same in all trials, and the path of activity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.signals.filters import butterworth_lowpass
from swaystride.simulate.standing_body import StandingParameters
from swaystride.sway.metrics import sway_metrics
from swaystride.units import GRAVITY_M_S2

Array = NDArray[np.float64]


@dataclass(frozen=True)
class StandingModel:
    """Settings of the standing body that do not vary between people and trials (spec §9.3).

    Activity 0 is the base set (older adults on foam), activity 1 the active one (concurrent
    feedback). Between and beyond them ``k − 1``, K_D and T_n change by constant ratios, so that
    the body stays upright (k > 1) and the noise keeps a time constant at any activity. Damping is
    scaled to the person as ``m h^(3/2)``, which keeps the damping ratio.

    Parameters
    ----------
    inertia_factor, delay_s : float
        See :class:`~swaystride.simulate.standing_body.StandingParameters`.
    base_stiffness_ratio, active_stiffness_ratio : float
        k at activity 0 and 1.
    base_damping_nm_s_rad, active_damping_nm_s_rad : float
        K_D of the reference person.
    base_noise_time_s, active_noise_time_s : float
        T_n.
    reference_mass_kg, reference_height_m : float
        Mass and pendulum height of the reference person.
    coupling_sd : float
        Standard deviation between trials of Fisher's z of the correlation of the noise torques.
    lean_drift_deg, lean_drift_period_s, breathing_deg, breathing_hz : float
        See :class:`~swaystride.simulate.standing_body.StandingParameters`.
    """

    inertia_factor: float
    delay_s: float
    base_stiffness_ratio: float
    active_stiffness_ratio: float
    base_damping_nm_s_rad: float
    active_damping_nm_s_rad: float
    base_noise_time_s: float
    active_noise_time_s: float
    reference_mass_kg: float
    reference_height_m: float
    coupling_sd: float
    lean_drift_deg: float
    lean_drift_period_s: float
    breathing_deg: float
    breathing_hz: float

    def draw_coupling(self, rng: np.random.Generator) -> float:
        """Draw the correlation of the noise torques of one trial."""
        return float(np.tanh(self.coupling_sd * rng.standard_normal()))

    def parameters(
        self,
        *,
        ln_noise_ap: float,
        ln_noise_ml: float,
        activity: float,
        coupling: float,
        mass_kg: float,
        pendulum_height_m: float,
        weight_shift_deg: tuple[float, float] = (0.0, 0.0),
    ) -> StandingParameters:
        """Physical parameters of one trial.

        Parameters
        ----------
        ln_noise_ap, ln_noise_ml : float
            Logarithms of the standard deviations of the noise torques over m g h.
        activity : float
            Position on the path of activity.
        coupling : float
            Correlation of the noise torques.
        mass_kg, pendulum_height_m : float
            The person.
        weight_shift_deg : tuple of float
            Slow further lean, AP and ML, see
            :class:`~swaystride.simulate.standing_body.StandingParameters`; by default none.

        Returns
        -------
        StandingParameters
        """
        gravity_torque = mass_kg * GRAVITY_M_S2 * pendulum_height_m
        size = (mass_kg / self.reference_mass_kg) * (
            pendulum_height_m / self.reference_height_m
        ) ** 1.5
        return StandingParameters(
            mass_kg=mass_kg,
            pendulum_height_m=pendulum_height_m,
            inertia_factor=self.inertia_factor,
            stiffness_ratio=1.0
            + _between(
                self.base_stiffness_ratio - 1.0, self.active_stiffness_ratio - 1.0, activity
            ),
            damping_nm_s_rad=size
            * _between(self.base_damping_nm_s_rad, self.active_damping_nm_s_rad, activity),
            delay_s=self.delay_s,
            noise_ap_nm=gravity_torque * float(np.exp(ln_noise_ap)),
            noise_ml_nm=gravity_torque * float(np.exp(ln_noise_ml)),
            noise_time_s=_between(self.base_noise_time_s, self.active_noise_time_s, activity),
            noise_coupling=coupling,
            lean_drift_deg=self.lean_drift_deg,
            lean_drift_period_s=self.lean_drift_period_s,
            breathing_deg=self.breathing_deg,
            breathing_hz=self.breathing_hz,
            weight_shift_ap_deg=weight_shift_deg[0],
            weight_shift_ml_deg=weight_shift_deg[1],
        )


@dataclass(frozen=True)
class TrialSettings:
    """One recorded trial, and the analysis by which its true features are defined.

    Parameters
    ----------
    simulation_rate_hz, warm_up_s : float
        Rate of integration, and the time before the recording starts.
    duration_s, rate_hz : float
        Duration and sampling rate of the recording; ``duration_s · rate_hz`` samples.
    cutoff_hz, filter_order, filter_pad_s : float, int, float
        Zero-lag low-pass filter of the sway angles.
    """

    simulation_rate_hz: float
    warm_up_s: float
    duration_s: float
    rate_hz: float
    cutoff_hz: float
    filter_order: int
    filter_pad_s: float

    @property
    def n_samples(self) -> int:
        """Samples of the recording."""
        return round(self.duration_s * self.rate_hz)

    def true_measures(self, ap_deg: ArrayLike, ml_deg: ArrayLike) -> dict[str, float]:
        """Sway measures of the true angles, after the filter of the analysis."""
        ap, ml = self.filtered(np.stack([np.asarray(ap_deg), np.asarray(ml_deg)]))
        return sway_metrics(ap, ml, self.rate_hz)

    def filtered(self, angles_deg: ArrayLike) -> Array:
        """Angles after the filter of the analysis, along the last axis."""
        return butterworth_lowpass(
            angles_deg,
            cutoff_hz=self.cutoff_hz,
            rate_hz=self.rate_hz,
            order=self.filter_order,
            direction="zero_lag",
            pad_s=self.filter_pad_s,
        )


def _between(base: float, active: float, activity: float) -> float:
    """Value on the path of constant ratios through both points."""
    return base * float((active / base) ** activity)
