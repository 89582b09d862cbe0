"""The simulated runner laid over real ones: joint curves, timing, bobbing and foot pitch."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from swaystride.simulate.running_body import SEGMENTS, runner_body, usual_shares, usual_shoe
from swaystride.simulate.running_manner import NO_VARIABILITY, RunnerManner, steady_run
from swaystride.simulate.running_run import run_motion
from swaystride.validation.running_real import (
    FULL_BODY,
    JOINTS,
    MARKERS,
    N_PHASES,
    FloatArray,
    RealCurves,
    RealTrial,
    full_body,
    level_in_stance,
    marker_trials,
    mean_curves,
    stride_curves,
)
from swaystride.validation.summary import Check, reported

#: Mean stature of the runners of ``running_markers_grf``, to whom the simulated one is compared, m.
HEIGHT_M: Final = 1.74
#: Least share of the stride that must lie within two standard deviations of the real strides.
LEAST_SHARE: Final = 0.9


@dataclass(frozen=True)
class SimulatedStride:
    """One right stride of the usual simulated runner.

    Parameters
    ----------
    speed_m_s, stride_time_s, duty_factor, oscillation_m : float
        Speed, timing, and vertical range of the pelvis.
    angle_deg : dict of str to ndarray, shape (N_PHASES,)
        Flexion (dorsiflexion) of hip, knee and ankle from first touch.
    foot_pitch_deg : ndarray, shape (N_PHASES,)
        Toes up positive, 0 in the middle of the stance.
    """

    speed_m_s: float
    stride_time_s: float
    duty_factor: float
    oscillation_m: float
    angle_deg: dict[str, FloatArray]
    foot_pitch_deg: FloatArray


@dataclass(frozen=True)
class RunnerComparison:
    """Real and simulated strides.

    Parameters
    ----------
    curves : list of tuple of RealCurves, SimulatedStride
        Joint curves at matched speed; the first pair is the one that is judged.
    trials : list of tuple of RealTrial, SimulatedStride
        Timing, bobbing and foot pitch at matched speed.
    """

    curves: list[tuple[RealCurves, SimulatedStride]]
    trials: list[tuple[RealTrial, SimulatedStride]]


def simulated_stride(speed_m_s: float) -> SimulatedStride:
    """Stride of the usual runner at a speed, without scatter.

    Parameters
    ----------
    speed_m_s : float
        Speed.
    """
    motion = run_motion(
        runner_body(HEIGHT_M, 70.0, shares=usual_shares(), shoe=usual_shoe()),
        RunnerManner(),
        steady_run(6.0, speed_m_s),
        duration_s=6.0,
        variability=NO_VARIABILITY,
        rng=np.random.default_rng(1),
    )
    contact, toe_off = motion.contacts_s(0)
    begin, end = contact[1], contact[2]
    time = np.linspace(begin, end, N_PHASES)
    states = motion.states(time)
    angles = states.joint_angles_rad()
    duty = float((toe_off[toe_off > begin][0] - begin) / (end - begin))
    toes = states.r_world_from_segment[:, SEGMENTS.index("foot_right"), :, 0]
    pitch = np.unwrap(np.arctan2(toes[:, 2], toes[:, 0]))[None]
    return SimulatedStride(
        speed_m_s,
        float(end - begin),
        duty,
        float(np.ptp(states.position_m[:, 0, 2])),
        {joint: np.degrees(angles[f"{joint}_right"][:, 0]) for joint in JOINTS},
        level_in_stance(np.degrees(pitch), duty)[0],
    )


def compare_runners(folder: Path) -> RunnerComparison:
    """Read the real runners and simulate one at each of their speeds.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.
    """
    fast = simulated_stride(3.96)
    peak = float(np.argmax(fast.angle_deg["knee"])) / (N_PHASES - 1)
    strides, trial = full_body(folder, peak)
    slow = simulated_stride(2.5)
    curves = [(stride_curves(folder), slow)]
    curves += [(mean, simulated_stride(mean.speed_m_s)) for mean in mean_curves(folder)[1:]]
    trials = [(real, slow) for real in marker_trials(folder)]
    return RunnerComparison([*curves, (strides, fast)], [*trials, (trial, fast)])


def offset_curve(real: RealCurves, simulated: SimulatedStride, joint: str) -> FloatArray:
    """Simulated curve after one constant, which takes away the mean difference.

    Parameters
    ----------
    real : RealCurves
        Real strides.
    simulated : SimulatedStride
        Simulated one.
    joint : str
        ``hip``, ``knee`` or ``ankle``.
    """
    mean = real.angle_deg[joint].mean(axis=0)
    curve = simulated.angle_deg[joint]
    return np.asarray(curve + np.mean(mean - curve))


def joint_table(comparison: RunnerComparison) -> pd.DataFrame:
    """Agreement of every joint at every speed.

    Parameters
    ----------
    comparison : RunnerComparison
        Real and simulated strides.

    Returns
    -------
    DataFrame
        ``real``, ``joint``, ``constant_deg`` (added to the simulated curve), ``rms_deg`` of what is
        left, ``share_within_2sd`` of the stride, ``range_real_deg`` (mean over strides) and
        ``range_simulated_deg``.
    """
    rows = []
    for real, simulated in comparison.curves:
        for joint in JOINTS:
            strides = real.angle_deg[joint]
            mean, sd = strides.mean(axis=0), strides.std(axis=0, ddof=1)
            curve = offset_curve(real, simulated, joint)
            rows.append(
                {
                    "real": real.label,
                    "joint": joint,
                    "constant_deg": float(np.mean(curve - simulated.angle_deg[joint])),
                    "rms_deg": float(np.sqrt(np.mean((curve - mean) ** 2))),
                    "share_within_2sd": float(np.mean(np.abs(curve - mean) <= 2.0 * sd)),
                    "range_real_deg": float(np.mean(np.ptp(strides, axis=1))),
                    "range_simulated_deg": float(np.ptp(curve)),
                }
            )
    return pd.DataFrame(rows)


def timing_table(comparison: RunnerComparison) -> pd.DataFrame:
    """Timing, bobbing and foot pitch of every trial beside the simulated runner.

    Parameters
    ----------
    comparison : RunnerComparison
        Real and simulated strides.

    Returns
    -------
    DataFrame
        ``real``, ``quantity``, least and largest stride, median, and ``simulated``.
    """
    rows = []
    for real, simulated in comparison.trials:
        mean_pitch = real.foot_pitch_deg.mean(axis=0)
        for quantity, values, ours in (
            ("stride time, s", real.stride_time_s, simulated.stride_time_s),
            ("duty factor", real.duty_factor, simulated.duty_factor),
            ("vertical range of the pelvis, m", real.oscillation_m, simulated.oscillation_m),
            (
                "lowest foot pitch, deg",
                real.foot_pitch_deg.min(axis=1),
                float(simulated.foot_pitch_deg.min()),
            ),
            (
                "foot pitch, RMS from the mean real stride, deg",
                np.sqrt(np.mean((real.foot_pitch_deg - mean_pitch) ** 2, axis=1)),
                float(np.sqrt(np.mean((simulated.foot_pitch_deg - mean_pitch) ** 2))),
            ),
        ):
            if np.isnan(values).all():
                continue
            rows.append(
                {
                    "real": f"{real.label} at {real.speed_m_s:g} m/s",
                    "quantity": quantity,
                    "least": float(values.min()),
                    "median": float(np.median(values)),
                    "largest": float(values.max()),
                    "simulated": ours,
                }
            )
    return pd.DataFrame(rows)


def runner_checks(comparison: RunnerComparison) -> list[Check]:
    """Verdicts: joint curves of the first pair, timing within the range of the real strides.

    Parameters
    ----------
    comparison : RunnerComparison
        Real and simulated strides.
    """
    checks = []
    joints = joint_table(comparison)
    judged = comparison.curves[0][0].label
    for row in joints.itertuples(index=False):
        quantity = f"{row.joint}, {row.real}: share of the stride within 2 SD"
        dataset = FULL_BODY if "one runner" in str(row.real) else MARKERS
        share = float(str(row.share_within_2sd))
        if row.real == judged:
            # 1 is reached when all of the stride is within; 0.9 is enough.
            checks.append(Check(dataset, quantity, share, 1.0, "real strides", 1.0 - LEAST_SHARE))
        else:
            checks.append(reported(dataset, quantity, share, "few strides, one or two people"))
        note = "after one constant per joint"
        rms = f"{row.joint}, {row.real}: RMS difference, deg"
        checks.append(reported(dataset, rms, float(str(row.rms_deg)), note))
    timing = timing_table(comparison)
    for quantity in ("stride time, s", "duty factor"):
        rows = timing[(timing["quantity"] == quantity) & timing["real"].str.endswith("2.5 m/s")]
        low, high = float(rows["least"].min()), float(rows["largest"].max())
        source = f"strides of two runners, {low:.3f} to {high:.3f}"
        ours = float(rows["simulated"].iloc[0])
        checks.append(
            Check(
                MARKERS, f"{quantity}, at 2.5 m/s", ours, (low + high) / 2, source, (high - low) / 2
            )
        )
    for row in timing.itertuples(index=False):
        note = f"median of the real strides {float(str(row.median)):.3f}"
        dataset = FULL_BODY if "subject02" in str(row.real) else MARKERS
        name = f"{row.quantity}, {row.real}"
        checks.append(reported(dataset, name, float(str(row.simulated)), note))
    return checks
