"""The simulated cohort of the feedback study: participants, trials and model variables."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.simulate.feedback_parameters import FeedbackCohort, FeedbackProtocol, GroupTable
from swaystride.simulate.seeds import generator

Array = NDArray[np.float64]

ORDERS: Final = ("concurrent_first", "terminal_first")
_STUDY: Final = "feedback"


def design_tables(cohort: FeedbackCohort, seed: int) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Participants and trials, as a lab would keep them.

    Parameters
    ----------
    cohort : FeedbackCohort
        Parameters.
    seed : int
        Seed of the cohort.

    Returns
    -------
    participants : DataFrame
        ``participant``, ``order``, ``age_years``, ``sex``, ``height_m``, ``mass_kg``; means and
        SDs of the groups are the printed ones to the printed digits.
    trials : DataFrame
        ``participant``, ``session_trial``, ``block``, ``feedback``, ``phase``, ``set``,
        ``trial_in_set``, ``feedback_shown``, ``file``, ``note``.
    """
    protocol = cohort.protocol
    orders = [ORDERS[i % 2] for i in range(protocol.n_participants)]
    participants = pd.DataFrame(
        {
            "participant": [f"P{i + 1:02d}" for i in range(protocol.n_participants)],
            "order": orders,
        }
    )
    bodies = [
        _group_bodies(
            getattr(cohort, order),
            np.flatnonzero([other == order for other in orders]),
            protocol,
            seed,
            order,
        )
        for order in ORDERS
    ]
    participants = participants.join(pd.concat(bodies))
    trials = [
        row
        for i, (name, order) in enumerate(zip(participants["participant"], orders, strict=True))
        for row in _session(name, order, short=i < protocol.n_short, protocol=protocol)
    ]
    return participants, pd.DataFrame(trials).astype({"set": "Int64"})


def design_rows(
    participants: pd.DataFrame, trials: pd.DataFrame, cohort: FeedbackCohort
) -> pd.DataFrame:
    """Model variables of every trial (coding of spec §8.3), as the population model takes them.

    Parameters
    ----------
    participants, trials : DataFrame
        As from :func:`design_tables`.
    cohort : FeedbackCohort
        Parameters.

    Returns
    -------
    DataFrame
        Rows and index as in `trials`; columns
        :data:`~swaystride.simulate.feedback_population.DESIGN_COLUMNS` and ``session_trial``.
    """
    person = participants.set_index("participant").loc[trials["participant"]]
    training = trials["phase"].eq("training")
    removed = training & trials["feedback_shown"].eq("none")
    concurrent = trials["feedback"].eq("concurrent")
    return pd.DataFrame(
        {
            "participant": trials["participant"],
            "session_trial": trials["session_trial"],
            "order": person["order"].eq("terminal_first").to_numpy(dtype=np.float64),
            "block": concurrent.astype(np.float64),
            "trial_number": training.groupby(trials["participant"]).cumsum().astype(np.float64),
            "concurrent_feedback_removed": (removed & concurrent).astype(np.float64),
            "terminal_feedback_removed": (removed & ~concurrent).astype(np.float64),
            "age": person["age_years"].to_numpy(),
            "sex": person["sex"].eq("M").to_numpy(dtype=np.float64),
            "pendulum_height_m": cohort.placement.pendulum_height_ratio
            * person["height_m"].to_numpy(),
        },
        index=trials.index,
    )


def _group_bodies(
    group: GroupTable, rows: NDArray[np.intp], protocol: FeedbackProtocol, seed: int, order: str
) -> pd.DataFrame:
    """Age, sex, height and mass of one group.

    The printed number of people is drawn as a whole and has exactly the printed means and SDs up
    to rounding; a smaller cohort is its first part. Whoever comes on top is drawn alone. So no
    participant depends on how many there are.
    """
    rng = generator(seed, _STUDY, "participants", order)
    female = np.zeros(group.n, dtype=bool)
    female[rng.permutation(group.n)[: group.n_female]] = True
    z = _standard_body(rng.standard_normal((3, group.n)), female, protocol)
    z = np.stack([(values - values.mean()) / values.std(ddof=1) for values in z])
    for number in range(group.n, len(rows)):
        alone = generator(seed, _STUDY, "participants", order, f"extra {number}")
        woman = alone.random(1) < group.n_female / group.n
        extra = _standard_body(alone.standard_normal((3, 1)), woman, protocol)
        female, z = np.append(female, woman), np.append(z, extra, axis=1)
    age, height, mass = z[:, : len(rows)]
    return pd.DataFrame(
        {
            # Rounded as a lab notes them; the printed digits survive.
            "age_years": (group.age_mean_years + group.age_sd_years * age).round(1),
            "sex": np.where(female[: len(rows)], "F", "M"),
            "height_m": (group.height_mean_m + group.height_sd_m * height).round(2),
            "mass_kg": (group.mass_mean_kg + group.mass_sd_kg * mass).round(1),
        },
        index=pd.Index(rows),
    )


def _standard_body(z: Array, female: NDArray[np.bool_], protocol: FeedbackProtocol) -> Array:
    """Correlated standard scores of age, height and mass, men taller; shape (3, n)."""
    age, height, mass = z
    r = protocol.height_mass_correlation
    mass = r * height + np.sqrt(1.0 - r**2) * mass
    return np.stack([age, height + protocol.male_height_shift_sd * ~female, mass])


def _session(
    participant: str, order: str, *, short: bool, protocol: FeedbackProtocol
) -> list[dict[str, object]]:
    """Trials of one participant in the order of the session."""
    first = "concurrent" if order == "concurrent_first" else "terminal"
    second = "terminal" if first == "concurrent" else "concurrent"
    steps: list[tuple[int, str, int | None, int]] = []
    for block, feedback in ((1, first), (2, second)):
        n_baseline = protocol.baseline_trials - (short and feedback == "concurrent")
        steps += [(block, feedback, None, k + 1) for k in range(n_baseline)]
        training = [
            (block, feedback, s + 1, k + 1)
            for s in range(protocol.training_sets)
            for k in range(protocol.trials_per_set)
        ]
        steps += training[:-1] if short and feedback == "terminal" else training
    rows: list[dict[str, object]] = []
    for number, (block, feedback, training_set, trial_in_set) in enumerate(steps, start=1):
        shown = training_set is not None and trial_in_set < protocol.trials_per_set
        rows.append(
            {
                "participant": participant,
                "session_trial": number,
                "block": block,
                "feedback": feedback,
                "phase": "baseline" if training_set is None else "training",
                "set": training_set,
                "trial_in_set": trial_in_set,
                "feedback_shown": feedback if shown else "none",
                "file": f"{participant}/{participant}_{number:02d}.txt",
                "note": "",
            }
        )
    return rows
