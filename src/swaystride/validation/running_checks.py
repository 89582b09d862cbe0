"""Tables and verdicts on the simulated runner beside real ones."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd

from swaystride.validation.running_body import (
    JointComparison,
    RunnerComparison,
    SimulatedStride,
    offset_curve,
)
from swaystride.validation.running_real import FULL_BODY, FULL_BODY_RUNNER, JOINTS, MARKERS
from swaystride.validation.summary import Check, reported

#: Least share of the stride that must lie within two standard deviations of the real strides.
LEAST_SHARE: Final = 0.9


def joint_table(comparison: RunnerComparison) -> pd.DataFrame:
    """Agreement of every joint at every speed.

    Parameters
    ----------
    comparison : RunnerComparison
        Real and simulated strides.

    Returns
    -------
    DataFrame
        ``real``, ``simulated`` (``usual``, ``matched``, ``fitted``), ``joint``, ``constant_deg`` (added to the
        simulated curve), ``rms_deg``, ``largest_deg`` and ``largest_at_percent`` of what is left,
        ``share_population`` of the stride within two standard deviations of the population around
        the mean of these strides, ``beyond_population_deg`` (most beyond that band),
        ``share_strides`` within two standard deviations of these strides, ``range_real_deg`` (mean
        over strides) and ``range_simulated_deg``.
    """
    rows = []
    for pair in comparison.curves:
        for name, simulated in (
            ("usual", pair.usual),
            ("matched", pair.matched),
            ("fitted", pair.fitted),
        ):
            if simulated is not None:
                rows += [_joint_row(pair, name, simulated, joint) for joint in JOINTS]
    return pd.DataFrame(rows)


def _joint_row(
    pair: JointComparison, name: str, simulated: SimulatedStride, joint: str
) -> dict[str, object]:
    strides = pair.real.angle_deg[joint]
    mean, sd = strides.mean(axis=0), strides.std(axis=0, ddof=1)
    curve = offset_curve(pair.real, simulated, joint)
    apart = np.abs(curve - mean)
    row = {
        "real": pair.real.label,
        "simulated": name,
        "joint": joint,
        "constant_deg": float(np.mean(curve - simulated.angle_deg[joint])),
        "rms_deg": float(np.sqrt(np.mean(apart**2))),
        "largest_deg": float(apart.max()),
        "largest_at_percent": 100.0 * float(np.argmax(apart)) / (len(apart) - 1),
        "share_population": float("nan"),
        "beyond_population_deg": float("nan"),
        "share_strides": float(np.mean(apart <= 2.0 * sd)),
        "range_real_deg": float(np.mean(np.ptp(strides, axis=1))),
        "range_simulated_deg": float(np.ptp(curve)),
    }
    if pair.population_sd_deg:
        band = 2.0 * pair.population_sd_deg[joint]
        row["share_population"] = float(np.mean(apart <= band))
        row["beyond_population_deg"] = float(np.maximum(apart - band, 0.0).max())
    return row


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
    """Verdicts: joint curves within the population, timing within the range of the real runners.

    Curves are judged for the runner with matched timing, or for the usual one where there is none.

    Parameters
    ----------
    comparison : RunnerComparison
        Real and simulated strides.
    """
    checks = []
    alone = [pair.real.label for pair in comparison.curves if pair.matched is None]
    for row in joint_table(comparison).to_dict("records"):
        dataset = FULL_BODY if "one runner" in row["real"] else MARKERS
        name = f"{row['joint']}, {row['real']}, {row['simulated']} simulated runner"
        share = f"{name}: share of the stride within 2 SD of the population"
        judged = row["simulated"] == "matched" or row["real"] in alone
        if judged and not np.isnan(row["share_population"]):
            # 1 is reached when all of the stride is within; 0.9 is enough.
            checks.append(
                Check(dataset, share, row["share_population"], 1.0, _POPULATION, 1.0 - LEAST_SHARE)
            )
        else:
            checks.append(reported(dataset, share, row["share_population"], _POPULATION))
        own = f"{name}: share of the stride within 2 SD of these strides"
        checks.append(reported(dataset, own, row["share_strides"], _FEW))
        note = f"after one constant; {row['largest_deg']:.1f} at {row['largest_at_percent']:.0f} %"
        checks.append(reported(dataset, f"{name}: RMS difference, deg", row["rms_deg"], note))
    return checks + _timing_checks(comparison)


_POPULATION: Final = "eight runners at 2.5 m/s, around the mean of these"
_FEW: Final = "one or two people at this speed, except at 2.5 m/s"


def _timing_checks(comparison: RunnerComparison) -> list[Check]:
    checks = []
    timing = timing_table(comparison)
    for quantity in ("stride time, s", "duty factor"):
        rows = timing[timing["quantity"] == quantity]
        if len(rows):
            dataset = FULL_BODY if FULL_BODY_RUNNER in rows["real"].iloc[0] else MARKERS
            who = rows["real"].iloc[0].split(" at ")[1]
            low, high = float(rows["least"].min()), float(rows["largest"].max())
            ours = float(rows["simulated"].iloc[0])
            checks.append(_in_range(dataset, f"{quantity}, at {who}", ours, low, high))
    for pair in comparison.curves:
        duty = pair.real.duty_factor
        if len(duty):
            quantity = f"duty factor, at {pair.real.speed_m_s:g} m/s"
            checks.append(
                _in_range(
                    pair.real.dataset, quantity, pair.usual.duty_factor, duty.min(), duty.max()
                )
            )
    for row in timing.to_dict("records"):
        note = f"median of the real strides {row['median']:.3f}"
        dataset = FULL_BODY if FULL_BODY_RUNNER in row["real"] else MARKERS
        name = f"{row['quantity']}, {row['real']}"
        checks.append(reported(dataset, name, row["simulated"], note))
    return checks


def _in_range(dataset: str, quantity: str, ours: float, low: float, high: float) -> Check:
    source = f"real strides, {low:.3f} to {high:.3f}"
    return Check(dataset, quantity, ours, (low + high) / 2, source, (high - low) / 2)
