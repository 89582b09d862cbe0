"""What the ratings of a simulated cohort were drawn from, and ratings without any association."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pandas as pd

from swaystride.errors import DesignError
from swaystride.studies.experience.between_runs import BetweenRules, ClusterRule, associations
from swaystride.studies.experience.plan import SCALES


def read_population(path: Path) -> pd.DataFrame:
    """Printed and attainable correlations of all runs.

    Parameters
    ----------
    path : Path
        ``truth/population.json``.

    Returns
    -------
    DataFrame
        ``group``, ``measure``, ``scale``, ``printed`` (as meant, register I-26), ``attainable``.

    Raises
    ------
    DesignError
        If the file is missing or lacks them.
    """
    try:
        tree: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        rows = [
            ("all", measure, scale, tree["printed"][measure][scale], value)
            for measure, values in tree["attainable"].items()
            for scale, value in values.items()
        ]
    except (OSError, ValueError, KeyError) as error:
        raise DesignError(
            "truth of the ratings cannot be read", file=path, found=str(error)
        ) from None
    table = pd.DataFrame(rows, columns=["group", "measure", "scale", "printed", "attainable"])
    return table.astype({"printed": float, "attainable": float})


def null_associations(
    observations: pd.DataFrame, null_scores: pd.DataFrame, level: float
) -> pd.DataFrame:
    """Associations of the measured runs with ratings that have nothing to do with them.

    Parameters
    ----------
    observations : DataFrame
        A row per run: ``run``, ``participant``, ``pattern``, the measures.
    null_scores : DataFrame
        ``run`` and the scales, drawn without association.
    level : float
        Confidence level.

    Returns
    -------
    DataFrame
        See :func:`swaystride.studies.experience.between_runs.associations`; no resampling. A score
        that the cohort lacks is missing here too.
    """
    drawn = null_scores.set_index("run").reindex(observations["run"])
    scales = {
        scale: drawn[scale].where(observations[scale].notna().to_numpy()).to_numpy(dtype=float)
        for scale in SCALES
    }
    rules = BetweenRules(level, ClusterRule(enabled=False, n_draws=0, seed=0))
    return associations(observations.assign(**scales), rules)
