"""Raw files of the simulated feedback study, one per trial, with the truth kept beside."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from swaystride.simulate.feedback_cohort import design_rows
from swaystride.simulate.feedback_parameters import FeedbackCohort
from swaystride.simulate.feedback_population import SIX_FEATURES, TrialTruth, draw_trials
from swaystride.simulate.inertial_sensor import draw_unit
from swaystride.simulate.seeds import generator
from swaystride.simulate.standing_body import StandingParameters
from swaystride.simulate.standing_recordings import (
    standing_motion,
    true_measures,
    write_standing_recording,
)
from swaystride.simulate.standing_response import FEATURES

_STUDY: Final = "feedback"


def lost_trials(trials: pd.DataFrame, cohort: FeedbackCohort, seed: int) -> pd.DataFrame:
    """The trials whose radio link is lost: the one draw that concerns the cohort as a whole.

    They are drawn among the printed number of participants (or all, if there are fewer), so that
    a further participant changes nobody else's recordings.

    Parameters
    ----------
    trials : DataFrame
        All trials of the cohort.
    cohort : FeedbackCohort
        Parameters.
    seed : int
        Seed of the cohort.

    Returns
    -------
    DataFrame
        Rows of `trials`, in their order.
    """
    rng = generator(seed, _STUDY, "lost trials")
    n_printed = cohort.concurrent_first.n + cohort.terminal_first.n
    eligible = int(trials["participant"].isin(trials["participant"].unique()[:n_printed]).sum())
    rows = rng.choice(eligible, size=cohort.radio.n_lost_trials, replace=False)
    return trials.iloc[np.sort(rows)]


def write_participant(
    participant: str,
    *,
    participants: pd.DataFrame,
    trials: pd.DataFrame,
    cohort: FeedbackCohort,
    seed: int,
    folder: Path | str,
    truth_file: Path | str,
) -> pd.DataFrame:
    """Simulate one participant and write the raw files and the truth.

    Parameters
    ----------
    participant : str
        Name in the tables.
    participants, trials : DataFrame
        Tables of the whole cohort, from :func:`design_tables`.
    cohort : FeedbackCohort
        Parameters.
    seed : int
        Seed of the cohort.
    folder : path or str
        Receives the recordings at the relative paths of the column ``file``.
    truth_file : path or str
        Receives the truth, tab-separated, one row per trial.

    Returns
    -------
    DataFrame
        The truth as written: wanted expectations and drawn scatter of the log features
        (``expected_*``, ``scatter_*``, ``attained_*``), physical parameters, true features of the
        true angles (``true_*``, deg, deg/s, deg²), and what the radio lost.
    """
    folder, truth_file = Path(folder), Path(truth_file)
    trial = cohort.population.trial
    own = trials[trials["participant"] == participant]
    is_person = participants["participant"] == participant
    height_m, mass_kg = participants.loc[is_person, ["height_m", "mass_kg"]].to_numpy()[0].tolist()
    design = design_rows(participants, trials, cohort).loc[own.index]
    truth = draw_trials(design, cohort.population, generator(seed, _STUDY, participant, "truth"))
    unit = draw_unit(
        cohort.sensor,
        tilt_sd_deg=cohort.placement.tilt_sd_deg,
        heading_sd_deg=cohort.placement.heading_sd_deg,
        rng=generator(seed, _STUDY, participant, "sensor"),
    )
    lost = set(lost_trials(trials, cohort, seed).index)
    rows = []
    labels = zip(own.index, own["session_trial"].tolist(), own["file"].tolist(), strict=True)
    for i, (row, number, file) in enumerate(labels):
        rng = generator(seed, _STUDY, participant, f"trial {number:02d}")
        body = _body(truth, i, cohort, mass_kg=mass_kg, height_m=height_m, rng=rng)
        motion = standing_motion(body, trial, rng)
        measures = true_measures(motion, trial)
        link = write_standing_recording(
            folder / file,
            motion,
            height_m=height_m,
            placement=cohort.placement,
            sensor=cohort.sensor,
            unit=unit,
            trial=trial,
            radio=cohort.radio,
            link_lost=row in lost,
            rng=rng,
        )
        rows.append(
            {
                "participant": participant,
                "session_trial": number,
                **_wanted(truth, i),
                **_physical(body, truth, i),
                **{f"true_{name}": measures[name] for name in SIX_FEATURES},
                **link,
            }
        )
    table = pd.DataFrame(rows)
    truth_file.parent.mkdir(parents=True, exist_ok=True)
    table.to_csv(truth_file, sep="\t", index=False, float_format="%.9g", lineterminator="\n")
    return table


def _body(
    truth: TrialTruth,
    i: int,
    cohort: FeedbackCohort,
    *,
    mass_kg: float,
    height_m: float,
    rng: np.random.Generator,
) -> StandingParameters:
    """Physical parameters of trial i of a participant."""
    standing = cohort.population.standing
    return standing.parameters(
        ln_noise_ap=float(truth.inputs.ln_noise_ap[i]),
        ln_noise_ml=float(truth.inputs.ln_noise_ml[i]),
        activity=float(truth.inputs.activity[i]),
        coupling=standing.draw_coupling(rng),
        mass_kg=mass_kg,
        pendulum_height_m=cohort.placement.pendulum_height_m(height_m),
    )


def _wanted(truth: TrialTruth, i: int) -> dict[str, float]:
    """Expectation, scatter and attained expectation of trial i."""
    parts = {"expected": truth.expectation, "scatter": truth.scatter, "attained": truth.attained}
    return {
        f"{part}_ln_{name}": float(values[i, f])
        for part, values in parts.items()
        for f, name in enumerate(FEATURES)
    }


def _physical(body: StandingParameters, truth: TrialTruth, i: int) -> dict[str, object]:
    """Physical parameters of trial i that vary between trials."""
    return {
        "activity": float(truth.inputs.activity[i]),
        "in_range": int(truth.inputs.in_range[i]),
        "pendulum_height_m": body.pendulum_height_m,
        "stiffness_ratio": body.stiffness_ratio,
        "damping_nm_s_rad": body.damping_nm_s_rad,
        "noise_ap_nm": body.noise_ap_nm,
        "noise_ml_nm": body.noise_ml_nm,
        "noise_time_s": body.noise_time_s,
        "noise_coupling": body.noise_coupling,
    }
