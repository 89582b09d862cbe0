"""Choices of a foot trajectory: one dataclass, and two sets of values with their evidence."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final, Literal

ZeroVelocityRule = Literal["gyro_minimum", "gyro_energy", "stillness"]
Estimator = Literal["linear_drift", "smoother"]


@dataclass(frozen=True)
class FootMethod:
    """How zero-velocity epochs are found and how the trajectory is estimated between them.

    Parameters
    ----------
    zero_velocity : {"gyro_minimum", "gyro_energy", "stillness"}
        The epoch of a stance: the smallest angular rate (Potter et al. 2019), the centre of the
        samples under the threshold of gyroscopic energy (dissertation, §4.3.4.2), or the stillest
        instant of rate and acceleration together.
    estimator : {"linear_drift", "smoother"}
        Tilt-corrected orientation with a linear drift of velocity removed from every stride, or
        the error-state smoother.
    stillness_window_s : float
        Length of the moving mean in which a foot is judged.
    stillness_acc_m_s2_per_rad_s : float
        Deviation of the acceleration from gravity that counts like 1 rad/s.
    stance_ratio : float
        Factor by which stillness must rise between two stances.
    stance_depth : float
        A stance lies at least this share of the logarithmic distance below the least still instant
        around it towards the stillest one.
    stance_context_s : float
        Reach of "around it", to either side.
    rest_rate_rad_s, rest_acc_m_s2 : float
        Below both (root mean square in `rest_window_s`) a foot is at rest.
    rest_window_s, shortest_rest_s : float
        Window of the judgement, and the shortest rest (half of it at the ends of a recording).
    shortest_step_s : float
        No stance has its middle nearer to a rest.
    energy_window_s : float
        Window of the gyroscopic energy.
    energy_time_per_stride_s : float
        Time per stride, on average, below the threshold of energy.
    minimum_reach_s : float
        The smallest angular rate is sought this far to either side of the stillest instant.
    rest_rate_removed : bool
        Whether the mean rate of the first rest is subtracted from the gyroscope.
    tilt_rate_noise_rad_s_rthz : float
        Drift of orientation between updates of the tilt.
    tilt_average_s, tilt_stance_sd, tilt_rest_sd : float
        Acceleration is averaged over this time around an epoch; standard deviation of its
        direction (chord) in stance and at rest.
    acc_noise_m_s2_rthz, gyr_noise_rad_s_rthz : float
        Noise of the smoother, all errors of the sensors that look white included.
    acc_step_share, gyr_step_share : float
        Share of the change from one sample to the next that integration may miss.
    bias_walk_rad_s_rts : float
        Random walk of the gyroscope bias.
    start_bias_sd_rad_s : float
        Of the gyroscope bias at the first epoch.
    stance_velocity_sd_m_s, stance_vertical_sd_m_s : float
        Of the horizontal and vertical velocity of the contact point.
    lever_height_m, lever_height_sd_m : float
        Height of the sensor above the contact point; one value for everybody.
    rest_velocity_sd_m_s, rest_rate_sd_rad_s, rest_spacing_s : float
        Velocity and mean rate at rest, and the time between two epochs at rest.
    gate : float
        Largest squared, normalised innovation (three degrees of freedom) of a stance.
    longest_unaided_s : float
        After this time without an epoch the next stance is believed in any case.
    passes : int
        Passes of the smoother; each linearises about the result of the one before.
    """

    zero_velocity: ZeroVelocityRule
    estimator: Estimator
    stillness_window_s: float
    stillness_acc_m_s2_per_rad_s: float
    stance_ratio: float
    stance_depth: float
    stance_context_s: float
    rest_rate_rad_s: float
    rest_acc_m_s2: float
    rest_window_s: float
    shortest_rest_s: float
    shortest_step_s: float
    energy_window_s: float
    energy_time_per_stride_s: float
    minimum_reach_s: float
    rest_rate_removed: bool
    tilt_rate_noise_rad_s_rthz: float
    tilt_average_s: float
    tilt_stance_sd: float
    tilt_rest_sd: float
    acc_noise_m_s2_rthz: float
    gyr_noise_rad_s_rthz: float
    acc_step_share: float
    gyr_step_share: float
    bias_walk_rad_s_rts: float
    start_bias_sd_rad_s: float
    stance_velocity_sd_m_s: float
    stance_vertical_sd_m_s: float
    lever_height_m: float
    lever_height_sd_m: float
    rest_velocity_sd_m_s: float
    rest_rate_sd_rad_s: float
    rest_spacing_s: float
    gate: float
    longest_unaided_s: float
    passes: int


#: The error-state smoother on the stillest instants. Evidence: see docs/methods.md, foot
#: trajectories; four values were compared on the public recordings `foot_imu_vicon`
#: (docs/decisions.md says which, and what leaving one trial out changes).
RECOMMENDED: Final = FootMethod(
    zero_velocity="stillness",
    estimator="smoother",
    stillness_window_s=0.05,
    stillness_acc_m_s2_per_rad_s=8.0,
    stance_ratio=2.0,
    stance_depth=0.5,
    stance_context_s=1.0,
    rest_rate_rad_s=0.15,
    rest_acc_m_s2=1.0,
    rest_window_s=0.1,
    shortest_rest_s=1.0,
    shortest_step_s=0.4,
    energy_window_s=0.02,
    energy_time_per_stride_s=0.025,
    minimum_reach_s=0.05,
    rest_rate_removed=True,
    tilt_rate_noise_rad_s_rthz=0.003,
    tilt_average_s=0.02,
    tilt_stance_sd=0.05,
    tilt_rest_sd=0.01,
    acc_noise_m_s2_rthz=0.3,
    gyr_noise_rad_s_rthz=0.01,
    acc_step_share=0.3,
    gyr_step_share=0.1,
    bias_walk_rad_s_rts=1e-4,
    start_bias_sd_rad_s=0.01,
    stance_velocity_sd_m_s=0.02,
    stance_vertical_sd_m_s=0.05,
    lever_height_m=0.11,
    lever_height_sd_m=0.02,
    rest_velocity_sd_m_s=0.005,
    rest_rate_sd_rad_s=0.0035,
    rest_spacing_s=0.1,
    gate=50.0,
    longest_unaided_s=2.0,
    passes=2,
)

#: Potter et al. (2019), §2.2, with the defaults of methods §2.2 where the paper is silent.
PRINTED: Final = replace(RECOMMENDED, zero_velocity="gyro_minimum", estimator="linear_drift")
