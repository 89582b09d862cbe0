"""What the ratings of a simulated cohort were drawn from: read from the print, and kept as its truth."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.errors import ConfigurationError, DesignError
from swaystride.simulate.experience_population import (
    ExperiencePopulation,
    PrintedAssociations,
    distance,
)
from swaystride.simulate.experience_rating_parameters import SCALES
from swaystride.simulate.experience_ratings import CohortRatings, RatedRuns

Array = NDArray[np.float64]

#: Two values of Table 5.3 that stand in each other's row: β and p of both rows say so (register I-26).
AS_MEANT: Final = {
    ("Hip ROM", "activity_enjoyment"): 0.22,
    ("Foot Peak Roll Rate", "activity_enjoyment"): 0.09,
}
#: Rows whose p-values belong to two runs fewer (D§5.3.4.1: heart rate of two runs, head sensor of two).
LOST_RUNS: Final = 2
_LOSING_WORDS: Final = ("Head", "Heart Rate")
#: Names of the correlations between the scales in the running text.
_BETWEEN: Final = {
    "r_fs_paces": ("affective_valence", "activity_enjoyment"),
    "r_fs_fss": ("affective_valence", "flow"),
    "r_fss_paces": ("activity_enjoyment", "flow"),
}


@dataclass(frozen=True)
class RatingTruth:
    """Truth of the ratings of a cohort, as kept beside its raw files.

    Parameters
    ----------
    runs : RatedRuns
        Who ran, and for how long.
    measures : tuple of str
        Rows of `population.correlation`.
    population : ExperiencePopulation
        What was attained.
    between_scales : ndarray, shape (3, 3)
        Correlations between the scales.
    """

    runs: RatedRuns
    measures: tuple[str, ...]
    population: ExperiencePopulation
    between_scales: Array

    def attainable(self, measure: str, scale: str) -> float:
        """Correlation of a `measure` with a `scale` in the population."""
        at = (self.measures.index(measure), SCALES.index(scale))
        return float(self.population.correlation[at])


def printed_associations(
    table_5_3: pd.DataFrame,
    study5_text: pd.DataFrame,
    names: Mapping[str, str],
    reversed_measures: Sequence[str],
) -> PrintedAssociations:
    """Printed correlations as they are meant.

    Parameters
    ----------
    table_5_3, study5_text : DataFrame
        As in data/published.
    names : mapping of str to str
        Key of each measure by its printed name, in the order wanted.
    reversed_measures : sequence of str
        Keys of measures whose correlations are taken with the opposite sign.

    Returns
    -------
    PrintedAssociations
        The two exchanged values (:data:`AS_MEANT`) put right.

    Raises
    ------
    ConfigurationError
        If a row or a correlation of the scales is missing, or a reversed measure is none.
    """
    wanted = pd.MultiIndex.from_product([list(names), SCALES])
    rows = table_5_3.set_index(["measure", "scale"])
    text = study5_text.set_index("quantity")["value"].astype(float)
    missing = [" ".join(key) for key in wanted if key not in rows.index]
    missing += [quantity for quantity in _BETWEEN if quantity not in text.index]
    if missing:
        raise ConfigurationError("a printed correlation is missing", expected=missing[0])
    unknown = sorted(set(reversed_measures) - set(names.values()))
    if unknown:
        raise ConfigurationError(
            "not a measure",
            place="simulation.ratings.association.reversed_measures",
            expected=", ".join(names.values()),
            found=unknown[0],
        )
    values = rows.loc[wanted, "r"].astype(float)
    for key, value in AS_MEANT.items():
        if key in values.index:
            values.loc[key] = value
    between = np.eye(len(SCALES))
    for quantity, (one, other) in _BETWEEN.items():
        at, to = SCALES.index(one), SCALES.index(other)
        between[at, to] = between[to, at] = text[quantity]
    lost = [LOST_RUNS * any(word in name for word in _LOSING_WORDS) for name in names]
    shape = (len(names), len(SCALES))
    signs = np.array([-1.0 if key in reversed_measures else 1.0 for key in names.values()])
    return PrintedAssociations(
        correlation=signs[:, None] * values.to_numpy(dtype=np.float64).reshape(shape),
        n_runs=float(text["n_runs"]) - np.array(lost, dtype=np.float64),
        between_scales=between,
        significant=rows.loc[wanted, "significant"].to_numpy().reshape(shape).astype(int) == 1,
    )


def write_answers(
    folder: Path, runs: RatedRuns, ratings: CohortRatings, questionnaires: tuple[str, str]
) -> None:
    """Write what the runners answered, as a lab keeps it.

    Parameters
    ----------
    folder : Path
        Raw files of the cohort: ``<participant>/<run>_affect.tsv`` and ``questionnaires.tsv``.
    runs : RatedRuns
        Who ran.
    ratings : CohortRatings
        What was answered.
    questionnaires : tuple of str
        Names of those of enjoyment and flow.
    """
    for run, runner, series in zip(runs.names, runs.runners, ratings.affect, strict=True):
        table = pd.DataFrame({"time_s": series.time_s, "feeling_scale": series.rating})
        (folder / runner).mkdir(parents=True, exist_ok=True)
        _write_tsv(table, folder / runner / f"{run}_affect.tsv")
    rows = [
        (*run.split("_"), questionnaire, int(score))
        for run, scores in zip(runs.names, ratings.scores, strict=True)
        for questionnaire, score in zip(questionnaires, scores, strict=True)
    ]
    columns = ["participant", "run", "questionnaire", "score"]
    _write_tsv(pd.DataFrame(rows, columns=columns), folder / "questionnaires.tsv")


def write_truth(
    path: Path, truth: RatingTruth, printed: PrintedAssociations, ratings: CohortRatings
) -> None:
    """Write the truth of the ratings.

    Parameters
    ----------
    path : Path
        ``truth/population.json``.
    truth : RatingTruth
        What they were drawn from.
    printed : PrintedAssociations
        What was aimed at.
    ratings : CohortRatings
        What was drawn.
    """
    population, runs = truth.population, truth.runs
    away = distance(population.correlation, printed)
    tree = {
        "description": "simulated by swaystride, not a measurement",
        "scales": list(SCALES),
        "measures": list(truth.measures),
        "attainable": _rows(truth.measures, population.correlation),
        "printed": _rows(truth.measures, printed.correlation),
        "measure_weights": _rows(truth.measures, population.measure_weights),
        "distance": {
            "rms": away.rms,
            "rms_in_printed_standard_errors": away.rms_standard_errors,
            "largest_of_significant": away.largest_significant,
            "gap": population.gap,
        },
        "settled_s": runs.settled_s,
        "between_scales": truth.between_scales.tolist(),
        "residual": population.residual.tolist(),
        "runs": [
            {
                "run": run,
                "participant": runs.runners[at],
                "duration_s": float(runs.duration_s[at]),
                "ratings_known_until_s": float(runs.known_until_s[at]),
                "signal": population.signal[at].tolist(),
                "latent": dict(zip(SCALES, ratings.latent[at].tolist(), strict=True)),
            }
            for at, run in enumerate(runs.names)
        ],
        "answers_moved_to_the_end_of_the_scale": dict(zip(SCALES, ratings.n_clipped, strict=True)),
    }
    path.write_text(json.dumps(tree, indent=1, allow_nan=False) + "\n", encoding="utf-8")


def read_truth(path: Path) -> RatingTruth:
    """Read what :func:`write_truth` wrote.

    Parameters
    ----------
    path : Path
        ``truth/population.json``.

    Raises
    ------
    DesignError
        If the file is missing or incomplete.
    """
    try:
        tree: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        rows = tree["runs"]
        return RatingTruth(
            runs=RatedRuns(
                names=[row["run"] for row in rows],
                runners=[row["participant"] for row in rows],
                duration_s=[row["duration_s"] for row in rows],
                known_until_s=[row["ratings_known_until_s"] for row in rows],
                settled_s=float(tree["settled_s"]),
            ),
            measures=tuple(tree["measures"]),
            population=ExperiencePopulation(
                signal=np.array([row["signal"] for row in rows], dtype=np.float64),
                residual=np.array(tree["residual"], dtype=np.float64),
                correlation=_values(tree["attainable"]),
                measure_weights=_values(tree["measure_weights"]),
                gap=float(tree["distance"]["gap"]),
            ),
            between_scales=np.array(tree["between_scales"], dtype=np.float64),
        )
    except (OSError, ValueError, KeyError) as error:
        raise DesignError(
            "truth of the ratings cannot be read", file=path, found=str(error)
        ) from None


def _write_tsv(table: pd.DataFrame, path: Path) -> None:
    table.to_csv(path, sep="\t", index=False, lineterminator="\n")


def _rows(measures: tuple[str, ...], values: Array) -> dict[str, dict[str, float | None]]:
    """A row per measure, a value per scale, none where there is none."""
    return {
        key: {
            scale: None if np.isnan(value) else float(value)
            for scale, value in zip(SCALES, row, strict=True)
        }
        for key, row in zip(measures, values, strict=True)
    }


def _values(rows: dict[str, dict[str, float | None]]) -> Array:
    """What :func:`_rows` wrote; NaN where there is none."""
    return np.array([list(row.values()) for row in rows.values()], dtype=np.float64)
