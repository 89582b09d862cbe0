"""Raw files of the simulated intensity study, one per trial, with the truth kept beside."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from swaystride.simulate.inertial_sensor import SensorUnit, draw_unit
from swaystride.simulate.intensity_cohort import IntensityTables, truth_of
from swaystride.simulate.intensity_parameters import STUDY, IntensityCohort
from swaystride.simulate.intensity_sway import (
    SwayTrial,
    simulate_trial,
    sway_inputs_of,
    trial_generator,
)
from swaystride.simulate.seeds import generator
from swaystride.simulate.standing_recordings import (
    recorded_duration_s,
    true_measures,
    write_standing_recording,
)

#: Measures whose true values are kept, in the order of Table 3.3.
MEASURES: Final = (
    "phi_rms",
    "ap_rms",
    "ml_rms",
    "phi_mv",
    "ap_mv",
    "ml_mv",
    "path_length",
    "ellipse_area",
)


def write_patient(
    participant: str,
    *,
    tables: IntensityTables,
    cohort: IntensityCohort,
    seed: int,
    folder: Path | str,
    truth_file: Path | str,
) -> pd.DataFrame:
    """Simulate one patient and write the raw files and the truth.

    Parameters
    ----------
    participant : str
        Name in the tables.
    tables : IntensityTables
        Tables of the whole cohort.
    cohort : IntensityCohort
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
        The truth as written: the latent intensity, physical parameters, losses of balance, why
        the trial ended, true measures of the true angles (``true_*``, deg, deg/s, deg²), and what
        the radio lost.
    """
    folder, truth_file = Path(folder), Path(truth_file)
    people = tables.participants.set_index("participant")
    height_m, mass_kg = people.loc[[participant], ["height_m", "mass_kg"]].to_numpy()[0].tolist()
    truth = truth_of(participant, cohort, seed)
    inputs = sway_inputs_of(participant, truth, cohort, seed)
    unit = draw_unit(
        cohort.sensor,
        tilt_sd_deg=cohort.placement.tilt_sd_deg,
        heading_sd_deg=cohort.placement.heading_sd_deg,
        rng=generator(seed, STUDY, participant, "sensor"),
    )
    own = tables.trials[tables.trials["participant"] == participant]
    rows = []
    columns = ["exercise", "exercise_order", "trial", "file"]
    for exercise, order, trial, file in own[columns].itertuples(index=False, name=None):
        rng = trial_generator(seed, participant, order - 1, trial - 1)
        simulated = simulate_trial(
            inputs,
            order - 1,
            trial - 1,
            cohort=cohort,
            mass_kg=mass_kg,
            height_m=height_m,
            rng=rng,
        )
        link = _write(folder / file, simulated, cohort, unit=unit, height_m=height_m, rng=rng)
        rows.append(
            {
                "participant": participant,
                "exercise": exercise,
                "exercise_order": order,
                "trial": trial,
                "intensity": float(truth.intensity[order - 1, trial - 1]),
                **_physical(simulated, cohort),
                **link,
            }
        )
    table = pd.DataFrame(rows)
    truth_file.parent.mkdir(parents=True, exist_ok=True)
    table.to_csv(truth_file, sep="\t", index=False, float_format="%.9g", lineterminator="\n")
    return table


def _write(
    path: Path,
    simulated: SwayTrial,
    cohort: IntensityCohort,
    *,
    unit: SensorUnit,
    height_m: float,
    rng: np.random.Generator,
) -> dict[str, object]:
    """Write the raw file of one trial; what the radio lost."""
    return write_standing_recording(
        path,
        simulated.motion,
        height_m=height_m,
        placement=cohort.placement,
        sensor=cohort.sensor,
        unit=unit,
        trial=cohort.trial,
        radio=cohort.radio,
        link_lost=False,
        rng=rng,
    )


def _physical(simulated: SwayTrial, cohort: IntensityCohort) -> dict[str, object]:
    """Physical parameters, losses of balance and true measures of one trial."""
    body = simulated.body
    measures = true_measures(simulated.motion, cohort.trial)
    return {
        "noise_ap_nm": body.noise_ap_nm,
        "noise_ml_nm": body.noise_ml_nm,
        "noise_time_s": body.noise_time_s,
        "noise_coupling": body.noise_coupling,
        "stiffness_ratio": body.stiffness_ratio,
        "damping_nm_s_rad": body.damping_nm_s_rad,
        "n_losses_of_balance": len(simulated.loss_times_s),
        "first_loss_s": simulated.loss_times_s[0] if simulated.loss_times_s else np.nan,
        "end": simulated.stop,
        "duration_s": recorded_duration_s(simulated.motion, cohort.trial),
        **{f"true_{name}": measures[name] for name in MEASURES},
    }
