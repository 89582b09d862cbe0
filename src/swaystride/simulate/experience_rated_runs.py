"""The runs of the simulated experience study as those who rate them see them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from swaystride.errors import DesignError
from swaystride.simulate.experience_cohort import run_names
from swaystride.simulate.experience_parameters import ExperienceCohort
from swaystride.simulate.experience_ratings import RatedRuns

#: What the names of those measures contain that need the sensor of the head, or the heart.
_HEAD: Final = "head"
_HEART: Final = "heart"


def rated_runs(cohort: ExperienceCohort) -> RatedRuns:
    """Runs of a cohort, how long they are and until when their ratings are known.

    Parameters
    ----------
    cohort : ExperienceCohort
        Parameters.

    Returns
    -------
    RatedRuns
    """
    names = run_names(cohort)
    duration, lost = cohort.protocol.duration_s, cohort.losses
    return RatedRuns(
        names=names,
        runners=[name.split("_")[0] for name in names],
        duration_s=[duration] * len(names),
        known_until_s=[
            duration - lost.ratings_lost_s * (name in lost.ratings_runs) for name in names
        ],
        settled_s=cohort.protocol.warm_up_s,
    )


def true_run_measures(folder: Path, names: Sequence[str], measures: Sequence[str]) -> pd.DataFrame:
    """True measures of all runs.

    Parameters
    ----------
    folder : Path
        ``truth`` of a cohort, with a ``<run>.json`` for each run.
    names : sequence of str
        Runs.
    measures : sequence of str
        Keys of the measures.

    Returns
    -------
    DataFrame
        One row per run, one column per measure.

    Raises
    ------
    DesignError
        If a file or a measure is missing.
    """
    rows = {}
    for name in names:
        file = folder / f"{name}.json"
        try:
            values = json.loads(file.read_text(encoding="utf-8"))["measures"]
            rows[name] = [float(values[key]) for key in measures]
        except (OSError, ValueError, TypeError, KeyError) as error:
            raise DesignError("truth of a run is incomplete", file=file, found=str(error)) from None
    return pd.DataFrame.from_dict(rows, orient="index", columns=list(measures))


def as_tabled(measures: pd.DataFrame, cohort: ExperienceCohort) -> pd.DataFrame:
    """Measures without those that the study loses: its tables rest on the other runs.

    Parameters
    ----------
    measures : DataFrame
        One row per run, as from :func:`true_run_measures`.
    cohort : ExperienceCohort
        Says which runs lose what.

    Returns
    -------
    DataFrame
        NaN for the heart rate and for the measures of the head in the runs that lose them.
    """
    lost = cohort.losses
    kept = measures.copy()
    for word, runs in (
        (_HEART, lost.heart_rate_runs),
        (_HEAD, (*lost.head_lost_runs, *lost.head_loose_runs)),
    ):
        columns = [key for key in measures.columns if word in key]
        kept.loc[kept.index.isin(runs), columns] = np.nan
    return kept
