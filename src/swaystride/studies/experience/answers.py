"""What the runners said: ratings of affect during the run, questionnaires after it, checked.

All errors of a cohort are collected and raised together, so that a lab mends them in one go.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from swaystride.errors import DesignError, SwaystrideError
from swaystride.findings import FINDING_COLUMNS, Finding
from swaystride.gait.rating_windows import RatingMean, check_ratings
from swaystride.io.study_tables import Column, read_study_table
from swaystride.studies.experience.design import LOST_RATINGS, ExperienceDesign, RunFiles
from swaystride.studies.experience.plan import QUESTIONNAIRES
from swaystride.studies.experience.questionnaires import QUESTIONNAIRE_FILE, read_scores

AFFECT_COLUMNS: Final = {"time_s": Column("number"), "feeling_scale": Column("integer")}
AFFECT_TABLE: Final = ("run", "time_s", "feeling_scale")
SCORE_TABLE: Final = (
    "run",
    "participant",
    "activity_enjoyment",
    "flow",
    "ratings_known_until_s",
    "n_ratings",
    "reason",
)


@dataclass(frozen=True)
class AnswerRules:
    """Ends of the scales, and what the mean rating of a run is.

    Parameters
    ----------
    affective_valence, activity_enjoyment, flow : tuple of float
        Lowest and highest value.
    mean : {"time_weighted", "simple"}
        See :func:`swaystride.gait.rating_windows.mean_rating`.
    """

    affective_valence: tuple[float, float]
    activity_enjoyment: tuple[float, float]
    flow: tuple[float, float]
    mean: RatingMean

    def ends(self, scale: str) -> tuple[float, float]:
        """Lowest and highest value of a scale.

        Parameters
        ----------
        scale : str
        """
        low, high = getattr(self, scale)
        return float(low), float(high)


@dataclass(frozen=True)
class RunChecks:
    """What the import says of a run.

    Parameters
    ----------
    excluded : bool
    duration_s : float
        Length of the run.
    events : DataFrame
        ``start_s``, ``stop_s`` (missing: until the end), ``event``, ``sensor``.
    """

    excluded: bool
    duration_s: float
    events: pd.DataFrame


class AnswersError(DesignError):
    """Several errors, one line each.

    Parameters
    ----------
    errors : sequence of SwaystrideError
    """

    def __init__(self, errors: Sequence[SwaystrideError]) -> None:
        self.errors = tuple(errors)
        super().__init__(f"{len(self.errors)} errors in the answers")

    def __str__(self) -> str:
        return "\n".join(str(error) for error in self.errors)


@dataclass(frozen=True, eq=False)
class Answers:
    """Answers of a cohort; made by :func:`read_answers`.

    Parameters
    ----------
    affect : DataFrame
        ``run, time_s, feeling_scale``: ratings that are known.
    scores : DataFrame
        A row per run that is not left out: ``run, participant, activity_enjoyment, flow,
        ratings_known_until_s`` (the end of the run if none were lost; missing without ratings),
        ``n_ratings, reason`` (why something is missing).
    findings : DataFrame
        ``run`` and the columns of a finding.
    """

    affect: pd.DataFrame
    scores: pd.DataFrame
    findings: pd.DataFrame


def read_checks(runs: Sequence[str], quality: Path, spans: Path) -> dict[str, RunChecks]:
    """What the import says of every run.

    Parameters
    ----------
    runs : sequence of str
        Names.
    quality, spans : Path
        Folders with ``<run>.json`` (``excluded``, ``duration_s``) and ``<run>.parquet`` (events).

    Returns
    -------
    dict of str to RunChecks
    """
    checks = {}
    for run in runs:
        said = json.loads((quality / f"{run}.json").read_text(encoding="utf-8"))
        excluded = bool(said["excluded"])
        # a run that is left out may have no length and no events
        duration_s = float("nan") if excluded else float(said["duration_s"])
        columns = ["start_s", "stop_s", "event", "sensor"]
        events = (
            pd.DataFrame(columns=columns) if excluded else pd.read_parquet(spans / f"{run}.parquet")
        )
        checks[run] = RunChecks(excluded, duration_s, events)
    return checks


def read_answers(
    folder: Path, design: ExperienceDesign, checks: Mapping[str, RunChecks], rules: AnswerRules
) -> Answers:
    """Read and check ratings and questionnaires of all runs.

    Parameters
    ----------
    folder : Path
        ``data/raw/<cohort>/experience``.
    design : ExperienceDesign
    checks : mapping of str to RunChecks
        Of every run of the design.
    rules : AnswerRules

    Returns
    -------
    Answers
        Nothing of runs that are left out.

    Raises
    ------
    DesignError
        If the table of questionnaires cannot be read.
    AnswersError
        All that is wrong: ratings outside the run or the scale, out of order or unreadable; scores
        outside their scale or unreadable, of unknown runs or questionnaires, or twice the same.
    """
    errors: list[SwaystrideError] = []
    runs = [design.run(name) for name in design.run_names if not checks[name].excluded]
    series: dict[str, pd.DataFrame] = {}
    for run in runs:
        if "affect" in run.files:
            try:
                series[run.name] = _read_affect(folder, run, checks[run.name], rules)
            except SwaystrideError as error:
                errors.append(error)
    ends = {scale: rules.ends(scale) for scale in QUESTIONNAIRES.values()}
    scores, faults = read_scores(folder / QUESTIONNAIRE_FILE, design.run_names, ends)
    errors += faults
    if errors:
        raise AnswersError(errors)
    rows, findings, known = [], [], []
    for run in runs:
        row, own, seen = _answers_of_run(run, series.get(run.name), scores, checks[run.name])
        rows.append(row)
        known.append(own)
        findings += seen
    return Answers(
        affect=pd.concat(known, ignore_index=True) if known else _no_affect(),
        scores=pd.DataFrame(rows, columns=list(SCORE_TABLE)).astype({"n_ratings": "int64"}),
        findings=pd.DataFrame(
            [{"run": run, **asdict(finding)} for run, finding in findings],
            columns=["run", *FINDING_COLUMNS],
        ),
    )


def known_until_s(events: pd.DataFrame, duration_s: float) -> float:
    """Until when the ratings of a run are known: the begin of the first loss, or the end.

    Parameters
    ----------
    events : DataFrame
        Of the run.
    duration_s : float
        Length of the run.

    Examples
    --------
    >>> lost = {"start_s": [1500.0], "event": ["data_loss"], "sensor": ["ratings"]}
    >>> known_until_s(pd.DataFrame(lost), 1800.0)
    1500.0
    """
    lost = events[(events["event"] == "data_loss") & (events["sensor"] == LOST_RATINGS)]
    return float(np.min([*lost["start_s"].to_numpy(dtype=float), duration_s]))


def _no_affect() -> pd.DataFrame:
    return pd.DataFrame({"run": pd.Series(dtype="str"), "time_s": [], "feeling_scale": []})


def _read_affect(
    folder: Path, run: RunFiles, checks: RunChecks, rules: AnswerRules
) -> pd.DataFrame:
    """Ratings of one run."""
    file = run.files["affect"]
    low, high = rules.ends("affective_valence")
    try:
        table = read_study_table(folder / file, AFFECT_COLUMNS, unique=["time_s"])
        check_ratings(
            table["time_s"], table["feeling_scale"],
            run_s=checks.duration_s, lowest=low, highest=high,
        )  # fmt: skip
    except SwaystrideError as error:
        # the name as the lab knows it, without the folders of this machine
        raise DesignError(
            error.problem, file=file, place=error.place, expected=error.expected, found=error.found
        ) from None
    return table[list(AFFECT_COLUMNS)].astype("float64").assign(run=run.name)


def _answers_of_run(
    run: RunFiles,
    ratings: pd.DataFrame | None,
    scores: Mapping[tuple[str, str], float],
    checks: RunChecks,
) -> tuple[dict[str, object], pd.DataFrame, list[tuple[str, Finding]]]:
    """Row of scores, known ratings and findings of one run."""
    reasons: list[str] = []
    findings: list[Finding] = []

    def missing(check: str, file: str, expected: str, found: str, reason: str) -> None:
        reasons.append(reason)
        findings.append(Finding(check, "warning", file, f"run {run.name}", expected, found))

    until = float("nan")
    known = _no_affect()
    if ratings is None:
        missing("no_affect", "runs.tsv", "a file of ratings", "none", "no ratings of affect")
    else:
        file = run.files["affect"]
        until = known_until_s(checks.events, checks.duration_s)
        known = ratings[ratings["time_s"] <= until]
        if until < checks.duration_s:
            later = len(ratings) - len(known)
            said = f"lost from {until:.0f} s on" + (f"; {later} later ones unused" if later else "")
            whole = f"ratings of the whole run, {checks.duration_s:.0f} s"
            missing("ratings_lost", file, whole, said, f"ratings lost from {until:.0f} s on")
    for questionnaire, scale in QUESTIONNAIRES.items():
        if (run.name, scale) not in scores:
            reason = f"no {questionnaire}"
            missing("no_score", QUESTIONNAIRE_FILE, f"a score of {questionnaire}", "none", reason)
    row = {
        "run": run.name,
        "participant": run.participant,
        **{scale: scores.get((run.name, scale), np.nan) for scale in QUESTIONNAIRES.values()},
        "ratings_known_until_s": until,
        "n_ratings": len(known),
        "reason": "; ".join(reasons),
    }
    return row, known[list(AFFECT_TABLE)], [(run.name, finding) for finding in findings]
