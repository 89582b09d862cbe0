"""Verdicts on the measures of a run: events against force plates, variability of coordination.

What is judged follows from what others reached with sensors on feet, or holds for any data. Errors of
the events are judged as medians over the feet, because Falbriard et al. (2018, Front Physiol 9:610)
give medians over trials: bias of contact time 12 ± 10 ms, precision 4 ± 3 ms, precision of terminal
contact by the least pitch rate 4 ± 2 ms (median ± interquartile range; the limits are the sums). The
aims that the study has against simulated truth stand beside, and are not reached on these feet.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from swaystride.validation.running_coordination import (
    coordination_table,
    invariance_table,
    variability_curves,
)
from swaystride.validation.running_coordination_published import (
    SAME_PERSON,
    differences_from_same_person,
    published_table,
)
from swaystride.validation.running_measure_figures import figure_coordination, figure_events
from swaystride.validation.running_optical_checks import OpticalReport
from swaystride.validation.running_optical_recording import MARKERS
from swaystride.validation.running_sensor_events import sensor_event_table, single_errors
from swaystride.validation.running_sensors import MARKER_CUTOFF_HZ
from swaystride.validation.summary import Check, reported

#: Median ± interquartile range over trials, added up (Falbriard et al. 2018, abstract).
CONTACT_BIAS_MS: Final = 12.0 + 10.0
CONTACT_SD_MS: Final = 4.0 + 3.0
TOE_OFF_SD_MS: Final = 4.0 + 2.0
_FALBRIARD: Final = "Falbriard et al. (2018), force threshold, medians over trials"
#: A constant delay cancels in the mean stride time.
STRIDE_TIME_MS: Final = 1.0
#: Rounding, and the share by which a mean of 100 draws of 15 strides may miss.
ROUNDING_DEG: Final = 1e-9
FEW_STRIDES: Final = 0.02
#: Aims of the study against simulated truth, ms.
_AIMS: Final = {
    "initial_contact_bias_ms": 8.0,
    "initial_contact_sd_ms": 5.0,
    "contact_time_bias_ms": 12.0,
}
_WORDS: Final = {
    "initial_contact": "initial contact",
    "toe_off": "toe-off",
    "contact_time": "contact time",
    "step_time": "step time",
    "stride_time": "stride time",
}


def measure_report(folder: Path) -> OpticalReport:
    """Verdicts, tables and figures of the measures of a run.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.
    """
    errors = single_errors(folder)
    events = sensor_event_table(errors)
    values, invariances = coordination_table(folder), invariance_table(folder)
    published, curves = published_table(folder), variability_curves(folder)
    usual = errors[errors["cutoff_hz"] == MARKER_CUTOFF_HZ]
    return OpticalReport(
        [
            *sensor_event_checks(events),
            *invariance_checks(invariances),
            *coordination_checks(values),
            *published_checks(published),
        ],
        {
            "sensor_events": events,
            "coordination": wide_coordination(values),
            "coordination_published": published,
        },
        {
            "sensor_events_figure": lambda: figure_events(usual),
            "coordination_figure": lambda: figure_coordination(curves),
        },
    )


def sensor_event_checks(table: pd.DataFrame) -> list[Check]:
    """Stride times of each foot, contact times and toe-offs as medians over the feet.

    Parameters
    ----------
    table : DataFrame
        From :func:`swaystride.validation.running_sensor_events.sensor_event_table`.
    """
    usual = table[table["cutoff_hz"] == MARKER_CUTOFF_HZ]
    recommended = usual[usual["method"] == "recommended"]
    checks = [
        Check(MARKERS, f"{row['trial']}, {row['side']} foot, sensor events (recommended): mean "
              "stride time, ms", row["stride_time_bias_ms"], 0.0,
              f"force plates, {row['paired']} of {row['found']} strides paired", STRIDE_TIME_MS)
        for row in recommended.to_dict("records")
    ]  # fmt: skip
    judged = {
        # toe-off by the unloading of the pelvis halves the bias and misses the limit of the SD
        "recommended": ("contact_time_bias_ms", "toe_off_sd_ms"),
        "push_off_end": ("contact_time_bias_ms", "contact_time_sd_ms", "toe_off_sd_ms"),
        "printed": ("toe_off_sd_ms",),
    }
    limits = {
        "contact_time_bias_ms": CONTACT_BIAS_MS,
        "contact_time_sd_ms": CONTACT_SD_MS,
        "toe_off_sd_ms": TOE_OFF_SD_MS,
    }
    for method, feet in usual.groupby("method", sort=False):
        own = judged.get(str(method), ())
        for column in limits:
            sizes = feet[column].abs()
            quantity = f"sensor events ({method}), {_named(column)}: median of {len(feet)} feet, ms"
            span = f"single feet {sizes.min():.1f} to {sizes.max():.1f} ms"
            if column in own:
                checks.append(Check(MARKERS, quantity, float(sizes.median()), 0.0,
                                    f"{_FALBRIARD}; {span}", limits[column]))  # fmt: skip
            else:
                note = f"{span}; {limits[column]:g} ms by {_FALBRIARD}"
                checks.append(reported(MARKERS, quantity, float(sizes.median()), note))
        if method in ("literal_toe_off", "push_off_end"):
            continue  # contacts are those of `printed` and `recommended`
        for column, aim in _AIMS.items():
            quantity = (
                f"sensor events ({method}), {_named(column)}: largest of {len(feet)} feet, ms"
            )
            note = f"aim against simulated truth {aim:g} ms"
            checks.append(reported(MARKERS, quantity, float(feet[column].abs().max()), note))
        step = feet["step_time_bias_ms"].abs()
        checks.append(reported(MARKERS, f"sensor events ({method}), step time, size of the bias: "
                               f"largest of {len(feet)} feet, ms", float(step.max()),
                               f"median {step.median():.1f} ms"))  # fmt: skip
    return checks


def _named(column: str) -> str:
    name, _, kind = column.removesuffix("_ms").rpartition("_")
    return f"{_WORDS[name]}, {'size of the bias' if kind == 'bias' else 'SD'}"


def invariance_checks(table: pd.DataFrame) -> list[Check]:
    """What cannot change the variability, and what the number of strides must do to it.

    Parameters
    ----------
    table : DataFrame
        From :func:`swaystride.validation.running_coordination.invariance_table`.
    """
    quantities = {
        "textbook_deg": ("from the printed formula with circular statistics of SciPy", "SciPy"),
        "shuffled_deg": ("strides in another order", "same strides"),
        "exchanged_deg": ("proximal and distal segment exchanged", "a reflection"),
    }
    checks = []
    for trial, rows in table.groupby("trial", sort=False):
        for column, (what, source) in quantities.items():
            quantity = f"{trial}, twelve values of coordination: {what}, largest difference, deg"
            checks.append(
                Check(MARKERS, quantity, float(rows[column].max()), 0.0, source, ROUNDING_DEG)
            )
        checks.append(
            Check(MARKERS, f"{trial}, twelve values of coordination: 15 random strides over all, mean",
                  float(rows["few_strides_ratio"].mean()),
                  float(rows["few_strides_expected"].mean()),
                  "closed form for normal scatter of small angles", FEW_STRIDES)
        )  # fmt: skip
    return checks


def coordination_checks(table: pd.DataFrame) -> list[Check]:
    """How large the variability is, and how much it changes when angles replace rates.

    Parameters
    ----------
    table : DataFrame
        From :func:`swaystride.validation.running_coordination.coordination_table`.
    """
    checks = []
    is_leg = table["couple"] != "thigh-pelvis"
    for trial, rows in table.groupby("trial", sort=False):
        for couples, chosen in (("couples of the leg", is_leg), ("thigh-pelvis", ~is_leg)):
            own = rows[chosen.loc[rows.index]]
            values = own["variability_deg"]
            note = f"{values.min():.1f} to {values.max():.1f}°; no published numbers of this definition at hand"
            checks.append(reported(MARKERS, f"{trial}, variability of coordination, {couples}: median, "
                                   "deg", float(values.median()), note))  # fmt: skip
            apart = (values - own["from_angles_deg"]).abs()
            note = "rates turn about axes of the segment, angles are seen from the side"
            checks.append(reported(MARKERS, f"{trial}, variability of coordination, {couples}: from "
                                   "rates and from angles, largest difference, deg",
                                   float(apart.max()), note))  # fmt: skip
    return checks


def published_checks(table: pd.DataFrame) -> list[Check]:
    """Our curves of a runner beside the authors' of the same person.

    Parameters
    ----------
    table : DataFrame
        From :func:`swaystride.validation.running_coordination_published.published_table`.
    """
    note = "the trial may be another one; SDs of two such sets differ by up to 1.41-fold in 95 %"
    return [
        reported(MARKERS, f"RBDS001 at 2.5 m/s, {side}, variability from joint angles, eight values: "
                 f"largest difference from the authors' curves of {SAME_PERSON}, deg", apart, note)
        for side, apart in differences_from_same_person(table).items()
    ]  # fmt: skip


def wide_coordination(table: pd.DataFrame) -> pd.DataFrame:
    """A row per trial, couple and period, mean of both sides.

    Parameters
    ----------
    table : DataFrame
        From :func:`swaystride.validation.running_coordination.coordination_table`.

    Returns
    -------
    DataFrame
        ``trial``, ``couple``, ``period``, ``strides`` (of both sides), ``variability_deg``,
        ``right_deg``, ``left_deg``, ``from_angles_deg``, ``ellipse_deg2``.
    """
    rows = []
    for (trial, couple, period), own in table.groupby(["trial", "couple", "period"], sort=False):
        sides = own.set_index("side")["variability_deg"]
        rows.append(
            {
                "trial": trial,
                "couple": couple,
                "period": str(period).replace("_", " "),
                "strides": int(own["strides"].sum()),
                "variability_deg": float(np.mean(sides)),
                "right_deg": float(sides["right"]),
                "left_deg": float(sides["left"]),
                "from_angles_deg": float(own["from_angles_deg"].mean()),
                "ellipse_deg2": float(own["ellipse_deg2"].mean()),
            }
        )
    return pd.DataFrame(rows)
