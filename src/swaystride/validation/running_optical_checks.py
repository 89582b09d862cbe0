"""Verdicts on the optical side: angles against the authors' own, events against force plates.

The angles are compared after one constant per curve with the mean curves that the authors publish
with the data. For RBDS001 these are of the runner in the trials: the vertical force per mass agrees.
For RBDS0041 they are not: the force of the published mean has another shape than that of the force
plates in the trial of that name, so that its angles are reported and not judged.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from swaystride.findings import findings_from_json
from swaystride.mocap.joint_axes import RECIPES, public_joint_axes
from swaystride.mocap.marker_set import SIDES
from swaystride.units import DEG_PER_RAD
from swaystride.validation.running_optical import optical_runs
from swaystride.validation.running_optical_figures import figure_angles
from swaystride.validation.running_optical_methods import method_table
from swaystride.validation.running_optical_recording import MARKERS
from swaystride.validation.running_optical_tables import (
    curve_samples,
    curve_table,
    event_table,
    force_difference,
    recomputed_axes,
)
from swaystride.validation.summary import Check, reported

#: Largest accepted differences: sagittal curves, stride and contact time.
CURVE_DEG: Final = 3.0
STRIDE_S: Final = 0.005
CONTACT_S: Final = 0.020
#: Forces of one runner differ less than this, those of two more; between 0.8 (RBDS001) and 1.8.
FORCE_N_KG: Final = 1.0
#: Whose published mean curves are of the runner in the trial.
SAME_RUNNER: Final = "RBDS001"


@dataclass(frozen=True, eq=False)
class OpticalReport:
    """Everything that the validation of the optical side writes.

    Parameters
    ----------
    checks : list of Check
        Rows of the summary.
    tables : dict of str to DataFrame
        By the name of the file.
    figures : dict of str to callable
        By the name of the file; each returns its figure, to be drawn in the house style.
    """

    checks: list[Check]
    tables: dict[str, pd.DataFrame]
    figures: dict[str, Callable[[], Figure]]


def optical_report(folder: Path) -> OpticalReport:
    """Verdicts, tables and figures of the optical side.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.
    """
    samples, events = curve_samples(folder), event_table(folder)
    curves = curve_table(samples)
    checks = [*curve_checks(curves), *event_checks(events), *_other_checks(folder)]
    return OpticalReport(
        checks,
        {
            "optical_curves": curves,
            "optical_events": events,
            "optical_event_methods": method_table(folder),
        },
        {"optical_angles": lambda: figure_angles(samples, f"{SAME_RUNNER} at 2.5 m/s")},
    )


def curve_checks(table: pd.DataFrame) -> list[Check]:
    """Sagittal curves of the same runner are judged; all else is reported.

    Parameters
    ----------
    table : DataFrame
        From :func:`swaystride.validation.running_optical_tables.curve_table`.
    """
    checks = []
    for row in table[table["angle"] == "flexion"].to_dict("records"):
        quantity = (
            f"{row['trial']}, {row['side']} {row['joint']} flexion, centres {row['centres']}: "
            "RMSD, deg"
        )
        note = (
            f"after a constant of {row['offset_deg']:.1f}°; {row['in_phase_rmsd_deg']:.2f}° if "
            f"shifted by {row['shift_percent']:.1f} % of the stride; range "
            f"{row['range_deg']:.0f}°, authors' {row['range_authors_deg']:.0f}°"
        )
        if row["trial"].startswith(f"{SAME_RUNNER} "):
            source = f"authors' mean curve, {note}"
            checks.append(Check(MARKERS, quantity, row["rmsd_deg"], 0.0, source, CURVE_DEG))
        else:
            checks.append(reported(MARKERS, quantity, row["rmsd_deg"], note))
    others = table[table["angle"] != "flexion"]
    for (trial, centres, angle), rows in others.groupby(["trial", "centres", "angle"], sort=False):
        worst = rows.sort_values("rmsd_deg").to_dict("records")[-1]
        quantity = f"{trial}, {angle}, centres {centres}: largest RMSD, deg"
        note = f"{worst['side']} {worst['joint']}; median {rows['rmsd_deg'].median():.1f}°"
        checks.append(reported(MARKERS, quantity, float(worst["rmsd_deg"]), note))
    return checks


def event_checks(table: pd.DataFrame) -> list[Check]:
    """Stride and contact times against the force plates.

    Parameters
    ----------
    table : DataFrame
        From :func:`swaystride.validation.running_optical_tables.event_table`.
    """
    checks = []
    source = "force plates, 50 N after 30 Hz; thresholds of the markers chosen on these trials"
    for row in table.to_dict("records"):
        foot = f"{row['trial']}, {row['side']} foot"
        checks += [
            Check(MARKERS, f"{foot}: stride time, RMS of single strides, ms",
                  row["stride_time_rms_ms"], 0.0, source, 1e3 * STRIDE_S),
            Check(MARKERS, f"{foot}: contact time, RMS of single contacts, ms",
                  row["contact_time_rms_ms"], 0.0, source, 1e3 * CONTACT_S),
            reported(MARKERS, f"{foot}: first touch, bias, ms", row["touch_bias_ms"],
                     f"SD {row['touch_sd_ms']:.1f} ms"),
            reported(MARKERS, f"{foot}: toe-off, bias, ms", row["toe_off_bias_ms"],
                     f"SD {row['toe_off_sd_ms']:.1f} ms"),
            Check(MARKERS, f"{foot}: contacts without a partner", float(row["unpaired"]), 0.0,
                  f"{row['contacts']} contacts paired", 0.0),
        ]  # fmt: skip
    return checks


def _other_checks(folder: Path) -> list[Check]:
    """Identity of the runners, exchanged labels, gaps, average axes."""
    checks = []
    for found in optical_runs(folder):
        for side in SIDES if found.plates else ():
            quantity = (
                f"{found.run.label}, {side}: vertical force from the authors' mean, RMS, N/kg"
            )
            apart = force_difference(folder, found, side)
            if found.run.runner == SAME_RUNNER:
                checks.append(Check(MARKERS, quantity, apart, 0.0, "the same runner", FORCE_N_KG))
            else:
                note = f"above {FORCE_N_KG:g}: the published mean is of another runner or trial"
                checks.append(reported(MARKERS, quantity, apart, note))
        seen = findings_from_json(found.angles["medial_markers"].attrs["findings"])
        changed = sum(finding.check == "segment_changed_its_shape" for finding in seen)
        checks.append(
            Check(MARKERS, f"{found.run.label}: segments that changed their shape", changed, 0.0,
                  f"labels exchanged back: {len(found.run.exchanged)} pair", 0.0)
        )  # fmt: skip
        stay = sum(finding.check == "marker_gap_stays" for finding in seen)
        filled = sum(finding.check == "marker_gap_filled" for finding in seen)
        checks.append(reported(MARKERS, f"{found.run.label}: gaps that stay", stay,
                               f"{filled} were filled"))  # fmt: skip
    for recipe in RECIPES:
        ours, shipped = recomputed_axes(folder, recipe), public_joint_axes(recipe)
        for joint in ("knee", "ankle"):
            turn = np.arccos(np.clip(getattr(ours, joint) @ getattr(shipped, joint), -1.0, 1.0))
            checks.append(
                Check(MARKERS, f"average {joint} axis ({recipe}) of {ours.n_people} people, from "
                      "the one in use, deg", float(turn) * DEG_PER_RAD, 0.0,
                      "average_joint_axes.csv", 0.01)
            )  # fmt: skip
    return checks
