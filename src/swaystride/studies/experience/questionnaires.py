"""Questionnaires filled in after the runs: one score per run and questionnaire, checked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from swaystride.errors import DesignError
from swaystride.io.study_tables import Column, read_study_table
from swaystride.studies.experience.plan import QUESTIONNAIRES

#: Read as text, because every fault is listed, not only the first.
QUESTIONNAIRE_COLUMNS: Final = {
    name: Column("text", may_be_empty=True)
    for name in ("participant", "run", "questionnaire", "score")
}
QUESTIONNAIRE_FILE: Final = "questionnaires.tsv"


def read_scores(
    path: Path, runs: Sequence[str], ends: Mapping[str, tuple[float, float]]
) -> tuple[dict[tuple[str, str], float], list[DesignError]]:
    """Read the scores of all runs.

    Parameters
    ----------
    path : Path
        ``questionnaires.tsv``.
    runs : sequence of str
        Names of the runs that the lab lists.
    ends : mapping of str to tuple of float
        Lowest and highest score of each scale.

    Returns
    -------
    scores : dict
        By run and scale; without those whose cell is empty.
    errors : list of DesignError
        One per faulty line.

    Raises
    ------
    DesignError
        If the file is missing or lacks a column.
    """
    table = read_study_table(path, QUESTIONNAIRE_COLUMNS, unique=())
    scores: dict[tuple[str, str], float] = {}
    first: dict[tuple[str, str], int] = {}
    errors: list[DesignError] = []
    numbers = pd.to_numeric(table["score"].str.strip(), errors="coerce").to_numpy(dtype=float)
    texts = zip(*(table[name].str.strip() for name in QUESTIONNAIRE_COLUMNS), strict=True)
    for line, ((participant, run, questionnaire, text), number) in enumerate(
        zip(texts, numbers, strict=True), start=2
    ):
        name, scale = f"{participant}_{run}", QUESTIONNAIRES.get(questionnaire, "")
        low, high = ends.get(scale, (0.0, 0.0))
        if name not in runs:
            fault = ("run is not in runs.tsv", "a run of a participant that is listed there", name)
        elif not scale:
            fault = ("unknown questionnaire", " or ".join(QUESTIONNAIRES), repr(questionnaire))
        elif (name, scale) in first:
            fault = (
                f"{questionnaire} of run {name} stands twice",
                "one score",
                f"lines {first[name, scale]} and {line}",
            )
        elif text and not np.isfinite(number):
            fault = ("score is no number", f"{low:g} to {high:g}, or nothing", repr(text))
        elif text and not low <= number <= high:
            fault = ("score outside its scale", f"{low:g} to {high:g}", text)
        else:
            first[name, scale] = line
            if text:
                scores[name, scale] = float(number)
            continue
        problem, expected, found = fault
        place = f"line {line}"
        errors.append(
            DesignError(
                problem, file=QUESTIONNAIRE_FILE, place=place, expected=expected, found=found
            )
        )
    return scores, errors
