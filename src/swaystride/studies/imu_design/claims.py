"""What the paper concludes, and what this cohort shows (Potter et al. 2019, §3-5)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd

from swaystride.stats.correlation import spearman
from swaystride.studies.imu_design.experiments import EXPERIMENTS, ExperimentName
from swaystride.studies.imu_design.plan import SLOPE, ImuDesignPlan
from swaystride.studies.imu_design.requirements import slope_of, with_added_error

#: Mean speed below which the paper calls the errors nearly independent of the range (§3.1).
SLOW_M_S: Final = 2.2
#: What "nearly independent" is taken to mean: percent of the distance.
NEARLY_PCT: Final = 1.0
#: Data loss below which the paper finds all errors within the limit (§3.1, §3.2).
PRINTED_LOSS_LIMITS: Final[dict[ExperimentName, float]] = {
    "accelerometer_range": 1.5,
    "gyro_range": 2.6,
}
#: What the paper calls an error at 6 g (§3.1).
PRINTED_6G_PCT: Final = 30.0


@dataclass(frozen=True, eq=False)
class Evidence:
    """Results of one cohort, as the claims ask for them.

    Parameters
    ----------
    observations : DataFrame
        With ``added_error``.
    effects : DataFrame
        Of all experiments.
    plan : ImuDesignPlan
    """

    observations: pd.DataFrame
    effects: pd.DataFrame
    plan: ImuDesignPlan

    def effect(self, experiment: ExperimentName, *names: str) -> pd.DataFrame:
        """Rows of the named effects that there are, by name."""
        table = slope_of(self.effects, experiment, self.plan.model)
        return table.loc[[name for name in names if name in table.index]]

    def baseline(self, experiment: ExperimentName) -> pd.DataFrame:
        """Row of the baseline."""
        return slope_of(self.effects, experiment, self.plan.model).iloc[:1]

    def degrades(self, rows: pd.DataFrame) -> list[bool]:
        """Whether each slope is negative and significant."""
        alpha = self.plan.significance_level
        return [bool(row[SLOPE] < 0 and row["p"] < alpha) for row in rows.to_dict("records")]

    def changes_nothing(self, rows: pd.DataFrame) -> list[bool]:
        """Whether each slope is not significant."""
        return [bool(p >= self.plan.significance_level) for p in rows["p"]]

    def rows(self, experiment: ExperimentName) -> pd.DataFrame:
        """Observations of one experiment."""
        return self.observations[self.observations["experiment"] == experiment]


@dataclass(frozen=True)
class Claim:
    """One statement of the paper.

    Parameters
    ----------
    text : str
        The statement, in our words.
    section : str
        Where the paper makes it.
    parts : callable
        From the evidence to whether each part holds.
    """

    text: str
    section: str
    parts: Callable[[Evidence], list[bool]]


def _degrade(experiment: ExperimentName, *names: str) -> Callable[[Evidence], list[bool]]:
    return lambda e: e.degrades(e.effect(experiment, *names))


def _unchanged(experiment: ExperimentName, *names: str) -> Callable[[Evidence], list[bool]]:
    return lambda e: e.changes_nothing(e.effect(experiment, *names))


def _baseline_falls(e: Evidence) -> list[bool]:
    return [e.degrades(e.baseline(name))[0] for name in EXPERIMENTS]


def _monotone(e: Evidence) -> list[bool]:
    """The slope never rises as the range shrinks, beyond the standard error of a slope."""
    parts = []
    for experiment in PRINTED_LOSS_LIMITS:
        table = slope_of(e.effects, experiment, e.plan.model).iloc[1:]
        steps = np.diff(table[SLOPE].to_numpy(dtype=float))
        parts += [bool(step <= se) for step, se in zip(steps, table["se"].iloc[1:], strict=True)]
    return parts


def _only_62_hz_changes(e: Evidence) -> list[bool]:
    alpha = e.plan.significance_level
    others = e.changes_nothing(e.effect("downsampling", "500hz", "250hz", "125hz"))
    return others + [bool(p < alpha) for p in e.effect("downsampling", "62.5hz")["p"]]


def _within(experiment: ExperimentName, smallest: float) -> Callable[[Evidence], list[bool]]:
    def parts(e: Evidence) -> list[bool]:
        rows = e.rows(experiment)
        chosen = rows[rows["level"] >= smallest]
        largest = chosen.groupby("level")["error_pct"].agg(lambda x: x.abs().max())
        return [bool(x <= e.plan.distance_error_limit_pct) for x in largest]

    return parts


def _small_loss(e: Evidence) -> list[bool]:
    parts = []
    for experiment, loss in PRINTED_LOSS_LIMITS.items():
        rows = e.rows(experiment)
        errors = rows.loc[rows["loss_percent"] < loss, "error_pct"].abs()
        parts.append(bool((errors <= e.plan.distance_error_limit_pct).all()))
    return parts


def _six_g(e: Evidence) -> list[bool]:
    rows = e.rows("accelerometer_range")
    six = rows.loc[rows["condition"] == "6g", "error_pct"]
    return [bool(six.abs().max() > PRINTED_6G_PCT)] if len(six) else []


def _slow_is_unharmed(e: Evidence) -> list[bool]:
    rows = e.rows("accelerometer_range")
    slow = rows[rows["speed_m_s"] < SLOW_M_S]
    largest = slow.groupby("level")["added_error"].agg(lambda x: x.abs().max())
    return [bool(x <= NEARLY_PCT) for x in largest]


def _gyro_turns_sign(e: Evidence) -> list[bool]:
    rows = e.rows("gyro_range")
    low = rows[rows["level"] == rows["level"].min()]
    slow, fast = low[low["speed_m_s"] < SLOW_M_S], low[low["speed_m_s"] >= SLOW_M_S]
    if slow.empty or fast.empty:
        return []
    return [bool(slow["added_error"].mean() > 0), bool(fast["added_error"].mean() < 0)]


def _baseline_is_not_clipped(e: Evidence) -> list[bool]:
    parts = []
    for experiment in PRINTED_LOSS_LIMITS:
        rows = e.rows(experiment)
        base = rows[rows["condition"].str.startswith("baseline_")]
        parts.append(bool((base["loss_percent"] == 0.0).all()))
    return parts


def _spread_grows(e: Evidence) -> list[bool]:
    """With speed at the lowest level, and from the highest to the lowest level."""
    parts = []
    for experiment in EXPERIMENTS:
        rows = e.rows(experiment)
        rows = rows[~rows["condition"].str.startswith("baseline_")]
        low, high = (rows[rows["level"] == x] for x in (rows["level"].min(), rows["level"].max()))
        for column in ("length_difference_sd_m", "angle_difference_sd_deg"):
            known = low.dropna(subset=column)
            if len(known) > 2 and np.ptp(known[column].to_numpy()) > 0:
                parts.append(spearman(known["speed_m_s"], known[column]).r > 0)
            parts.append(bool(low[column].mean() > high[column].mean()))
    return parts


def _decimation_spreads_less(e: Evidence) -> list[bool]:
    spreads = [
        e.rows(name).groupby("level")["length_difference_sd_m"].median().iloc[0]
        for name in ("downsampling", "decimation")
    ]
    return [bool(spreads[1] < 0.5 * spreads[0])]


CLAIMS: Final[Sequence[Claim]] = (
    Claim("The error falls with speed for all full-range, full-rate recordings.", "§3.1-3.3, §4", _baseline_falls),
    Claim("Nothing is clipped at 100 g and at 2000 °/s.", "§2.3", _baseline_is_not_clipped),
    Claim("16, 10 and 6 g make the fall steeper.", "§3.1", _degrade("accelerometer_range", "16g", "10g", "6g")),
    Claim("24 g makes the fall steeper.", "§3.1", _degrade("accelerometer_range", "24g")),
    Claim("75 and 50 g change nothing.", "§3.1", _unchanged("accelerometer_range", "75g", "50g")),
    Claim("500 °/s makes the fall steeper.", "§3.2", _degrade("gyro_range", "500dps")),
    Claim("750 °/s makes the fall steeper.", "§3.2", _degrade("gyro_range", "750dps")),
    Claim("1500 and 1000 °/s change nothing.", "§3.2", _unchanged("gyro_range", "1500dps", "1000dps")),
    Claim("The smaller the range, the steeper the fall.", "abstract", _monotone),
    Claim("Leaving samples out changes the slope at 62.5 Hz only.", "§3.3", _only_62_hz_changes),
    Claim("Decimation changes no slope.", "§3.3", _unchanged("decimation", "500hz", "250hz", "125hz", "62.5hz")),
    Claim("Errors stay within 5 % with 50 g or more.", "§3.1, §5", _within("accelerometer_range", 50.0)),
    Claim("Errors stay within 5 % with 1000 °/s or more.", "§3.2, §5", _within("gyro_range", 1000.0)),
    Claim("Errors stay within 5 % if less than 1.5 % (acceleration) or 2.6 % (angular rate) is lost.", "§3.1-3.2, §5", _small_loss),
    Claim("Errors at 6 g exceed 30 %.", "§3.1", _six_g),
    Claim("Below 2.2 m/s the distance hardly depends on the accelerometer's range (within 1 %).", "§3.1", _slow_is_unharmed),
    Claim("500 °/s lengthens the distance of slow trials and shortens that of fast ones.", "§3.2", _gyro_turns_sign),
    Claim("Single strides scatter more at higher speed and at lower range or rate.", "§3.1-3.3", _spread_grows),
    Claim("With decimation they scatter far less than with samples left out (at the lowest rate less than half, median of the trials).", "§3.3", _decimation_spreads_less),
)  # fmt: skip


def claims_table(
    observations: pd.DataFrame, effects: pd.DataFrame, plan: ImuDesignPlan
) -> pd.DataFrame:
    """Judge every claim; one that no condition of the configuration concerns is left out.

    Parameters
    ----------
    observations : DataFrame
        From :func:`swaystride.studies.imu_design.observations.observations`.
    effects : DataFrame
        Of all experiments.
    plan : ImuDesignPlan

    Returns
    -------
    DataFrame
        ``claim``, ``section``, ``holds`` (parts of the claim that hold), ``reproduced`` (``yes``,
        ``partly``, ``no``).
    """
    evidence = Evidence(with_added_error(observations), effects, plan)
    rows = []
    for claim in CLAIMS:
        parts = claim.parts(evidence)
        if not parts:
            continue
        held = sum(parts)
        verdict = "yes" if held == len(parts) else "partly" if held else "no"
        rows.append((claim.text, claim.section, f"{held} of {len(parts)}", verdict))
    return pd.DataFrame(rows, columns=["claim", "section", "holds", "reproduced"])
