"""The simulated runner laid over real ones: joint curves, timing, bobbing and foot pitch."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from swaystride.simulate.foot_anchors import gait_anchors
from swaystride.simulate.running_body import SEGMENTS, runner_body, usual_shares, usual_shoe
from swaystride.simulate.running_manner import (
    NO_VARIABILITY,
    RunnerManner,
    manner_anchors,
    steady_run,
)
from swaystride.simulate.running_run import REFERENCE_HEIGHT_M, run_motion
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

#: Mean stature of the runners of ``running_markers_grf``, to whom the simulated one is compared, m.
HEIGHT_M: Final = 1.74
#: Speed of ``running_full_body_ik``.
FULL_BODY_SPEED_M_S: Final = 3.96


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
class JointComparison:
    """Joint curves at one speed.

    Parameters
    ----------
    real : RealCurves
        Strides of real runners.
    usual : SimulatedStride
        The usual simulated runner of that speed, who knows nothing of them.
    matched : SimulatedStride or None
        The same with the duty factor or the stride time of the real ones, if the files have it.
    fitted : SimulatedStride or None
        A runner whose manner was fitted to these curves, if there is one.
    population_sd_deg : dict of str to ndarray, shape (N_PHASES,)
        Standard deviation over strides and runners of a population; empty if there is none at hand.
    """

    real: RealCurves
    usual: SimulatedStride
    matched: SimulatedStride | None
    fitted: SimulatedStride | None
    population_sd_deg: dict[str, FloatArray]


@dataclass(frozen=True)
class RunnerComparison:
    """Real and simulated strides of one data set.

    Parameters
    ----------
    curves : list of JointComparison
        Joint curves at matched speed.
    trials : list of tuple of RealTrial, SimulatedStride
        Timing, bobbing and foot pitch at matched speed.
    """

    curves: list[JointComparison]
    trials: list[tuple[RealTrial, SimulatedStride]]


def simulated_stride(speed_m_s: float, manner: RunnerManner | None = None) -> SimulatedStride:
    """Stride of a runner at a speed, without scatter.

    Parameters
    ----------
    speed_m_s : float
        Speed.
    manner : RunnerManner, optional
        How the runner differs from the usual one, who is the default.
    """
    motion = run_motion(
        runner_body(HEIGHT_M, 70.0, shares=usual_shares(), shoe=usual_shoe()),
        RunnerManner() if manner is None else manner,
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


def matched_stride(real: RealCurves) -> SimulatedStride | None:
    """Stride with the duty factor and the stride time of real runners, as far as they are known.

    Parameters
    ----------
    real : RealCurves
        Of whom.
    """
    scale = float(np.sqrt(HEIGHT_M / REFERENCE_HEIGHT_M))
    usual = gait_anchors().at([real.speed_m_s]) | manner_anchors().at([real.speed_m_s])
    manner = {}
    if len(real.duty_factor):
        manner["duty_factor"] = float(np.median(real.duty_factor) - usual["duty_factor"][0])
    if len(real.stride_time_s):
        time = float(np.median(real.stride_time_s))
        manner["stride_time"] = time / (scale * float(usual["stride_time_s"][0]))
    return simulated_stride(real.speed_m_s, RunnerManner(**manner)) if manner else None


def fitted_stride(real: RealCurves) -> SimulatedStride | None:
    """Stride of a runner whose manner was fitted to these curves (``running_fitted.csv``).

    It shows how near the inputs that shape a person bring the body to single people; being fitted
    to what it is compared with, it proves nothing else.

    Parameters
    ----------
    real : RealCurves
        Of whom.

    Returns
    -------
    SimulatedStride or None
        None at a speed without a fit.
    """
    table = pd.read_csv(Path(__file__).with_name("running_fitted.csv"), index_col="speed_m_s")
    if real.speed_m_s not in table.index:
        return None
    values = table.drop(columns="source")
    row = values.to_numpy(dtype=np.float64)[list(table.index).index(real.speed_m_s)]
    manner = RunnerManner(**dict(zip(values.columns, row.tolist(), strict=True)))
    return simulated_stride(real.speed_m_s, manner)


def spread_deg(real: RealCurves) -> dict[str, FloatArray]:
    """Standard deviation of every joint over strides (of all runners) at each phase.

    Parameters
    ----------
    real : RealCurves
        Strides.
    """
    return {joint: real.angle_deg[joint].std(axis=0, ddof=1) for joint in JOINTS}


def compare_runners(folder: Path, dataset: str) -> RunnerComparison:
    """Read the real runners of a data set and simulate one at each of their speeds.

    The population is that of the eight runners at 2.5 m/s, at every speed: there are no more than
    two faster people.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.
    dataset : str
        ``running_markers_grf`` or ``running_full_body_ik``.
    """
    population = stride_curves(folder) if (folder / MARKERS).is_dir() else None
    spread = {} if population is None else spread_deg(population)
    if dataset == FULL_BODY:
        usual = simulated_stride(FULL_BODY_SPEED_M_S)
        peak = float(np.argmax(usual.angle_deg["knee"])) / (N_PHASES - 1)
        real, trial = full_body(folder, peak)
        curves = [JointComparison(real, usual, matched_stride(real), fitted_stride(real), spread)]
        return RunnerComparison(curves, [(trial, usual)])
    reals = [stride_curves(folder) if population is None else population, *mean_curves(folder)[1:]]
    curves = [
        JointComparison(
            real,
            simulated_stride(real.speed_m_s),
            matched_stride(real),
            fitted_stride(real),
            spread,
        )
        for real in reals
    ]
    return RunnerComparison(curves, [(real, curves[0].usual) for real in marker_trials(folder)])


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
