"""Variability of coordination of real runners: twelve values per trial, and what must leave them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.special import gammaln
from scipy.stats import circvar

from swaystride.gait.vector_coding import (
    ANGULAR_DEVIATION,
    COUPLES,
    N_INTERVALS,
    PERIODS,
    PREDICTION_ELLIPSE,
    coordination_variability,
    coupling_angles_deg,
    interval_variability,
)
from swaystride.units import DEG_PER_RAD
from swaystride.validation.running_increments import coordination_trials

Array = NDArray[np.float64]

#: Smallest number of strides that counts, and how often so many are drawn.
FEW: Final = ANGULAR_DEVIATION.least_strides
_DRAWS: Final = 100
_SEED: Final = 5


def textbook_variability(increments: Mapping[str, Array]) -> dict[str, float]:
    """The twelve values by the formula as it is printed, with the circular statistics of SciPy.

    Parameters
    ----------
    increments : mapping of str to ndarray, shape (n_strides, 200)

    Returns
    -------
    dict of str to float
    """
    values = {}
    for distal, proximal in COUPLES:
        angle = np.radians(coupling_angles_deg(increments[proximal], increments[distal]))
        spread = DEG_PER_RAD * np.sqrt(2.0 * circvar(angle, axis=0))
        for period, part in PERIODS.items():
            values[f"{distal}_{proximal}_{period}"] = float(spread[part].mean())
    return values


def few_strides_ratio(increments: Mapping[str, Array]) -> float:
    """Values from few strides, drawn at random, over those from all: mean of the twelve.

    Parameters
    ----------
    increments : mapping of str to ndarray, shape (n_strides, 200)
    """
    rng = np.random.default_rng(_SEED)
    n = len(next(iter(increments.values())))
    drawn = []
    for _ in range(_DRAWS):
        rows = rng.permutation(n)[:FEW]
        some = {segment: steps[rows] for segment, steps in increments.items()}
        drawn.append(list(coordination_variability(some, ANGULAR_DEVIATION).values()))
    every = list(coordination_variability(increments, ANGULAR_DEVIATION).values())
    return float((np.mean(drawn, axis=0) / every).mean())


def expected_few_strides_ratio(n: int) -> float:
    """What :func:`few_strides_ratio` is where directions scatter little, and normally.

    The variability then is a standard deviation about the mean of the strides at hand: that of n
    strides is sqrt((n − 1)/n) c4(n) of the true one on average, with the usual factor c4.

    Parameters
    ----------
    n : int
        Strides that there are.

    Examples
    --------
    >>> round(expected_few_strides_ratio(38), 3), expected_few_strides_ratio(FEW)
    (0.968, 1.0)
    """
    return _mean_of_sd(FEW) / _mean_of_sd(n)


def _mean_of_sd(n: int) -> float:
    """Mean of sqrt(mean squared deviation) of n normal values, over their standard deviation."""
    return float(np.sqrt(2.0 / n) * np.exp(gammaln(n / 2.0) - gammaln((n - 1.0) / 2.0)))


def coordination_table(folder: Path) -> pd.DataFrame:
    """The twelve values of every trial and side.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.

    Returns
    -------
    DataFrame
        ``trial``, ``side``, ``strides``, ``couple``, ``period``, ``variability_deg``,
        ``from_angles_deg``, ``ellipse_deg2``.
    """
    tables = []
    for found, side, steps, angles in coordination_trials(folder):
        ours = coordination_variability(steps, ANGULAR_DEVIATION)
        table = _labelled(found.run.label, side, len(steps["foot"]), ours)
        table["from_angles_deg"] = list(
            coordination_variability(angles, ANGULAR_DEVIATION).values()
        )
        table["ellipse_deg2"] = list(coordination_variability(steps, PREDICTION_ELLIPSE).values())
        tables.append(table)
    return pd.concat(tables, ignore_index=True)


def invariance_table(folder: Path) -> pd.DataFrame:
    """What must not change the twelve values, and what few strides do to them.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.

    Returns
    -------
    DataFrame
        ``trial``, ``side``, ``strides``; largest differences in degrees: ``textbook_deg``,
        ``shuffled_deg``, ``exchanged_deg`` (proximal for distal segment); ``few_strides_ratio``
        and ``few_strides_expected``.
    """
    rows = []
    for found, side, steps, _ in coordination_trials(folder):
        ours = coordination_variability(steps, ANGULAR_DEVIATION)
        n = len(steps["foot"])
        order = np.random.default_rng(_SEED).permutation(n)
        mixed = {segment: moves[order] for segment, moves in steps.items()}
        rows.append(
            {
                "trial": found.run.label,
                "side": side,
                "strides": n,
                "textbook_deg": _largest(ours, textbook_variability(steps)),
                "shuffled_deg": _largest(ours, coordination_variability(mixed, ANGULAR_DEVIATION)),
                "exchanged_deg": _largest(ours, _exchanged(steps)),
                "few_strides_ratio": few_strides_ratio(steps),
                "few_strides_expected": expected_few_strides_ratio(n),
            }
        )
    return pd.DataFrame(rows)


def _exchanged(steps: Mapping[str, Array]) -> dict[str, float]:
    """The twelve values with proximal and distal segment exchanged: a reflection of the plane."""
    values = {}
    for distal, proximal in COUPLES:
        spread = interval_variability(steps[distal], steps[proximal], ANGULAR_DEVIATION)
        for period, part in PERIODS.items():
            values[f"{distal}_{proximal}_{period}"] = float(spread[part].mean())
    return values


def _largest(one: Mapping[str, float], other: Mapping[str, float]) -> float:
    return max(abs(one[name] - other[name]) for name in one)


def _labelled(trial: str, side: str, n: int, values: Mapping[str, float]) -> pd.DataFrame:
    """A row per value, with couple and period apart."""
    names = [(f"{distal}-{proximal}", period) for distal, proximal in COUPLES for period in PERIODS]
    table = pd.DataFrame(names, columns=["couple", "period"])
    table.insert(0, "strides", n)
    table.insert(0, "side", side)
    table.insert(0, "trial", trial)
    return table.assign(variability_deg=list(values.values()))


def variability_curves(folder: Path) -> pd.DataFrame:
    """Variability at every interval, mean of both sides, for the figure.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.

    Returns
    -------
    DataFrame
        ``trial``, ``couple``, ``phase_percent`` (of the stance, from 100 to 200 of the swing),
        ``variability_deg``.
    """
    parts = []
    for found, _, steps, _ in coordination_trials(folder):
        for distal, proximal in COUPLES:
            spread = interval_variability(steps[proximal], steps[distal], ANGULAR_DEVIATION)
            columns = {
                "trial": found.run.label,
                "couple": f"{distal}-{proximal}",
                "phase_percent": np.arange(2 * N_INTERVALS) + 0.5,
                "variability_deg": spread,
            }
            parts.append(pd.DataFrame(columns))
    keys = ["trial", "couple", "phase_percent"]
    return pd.concat(parts).groupby(keys, sort=False, as_index=False).mean()
