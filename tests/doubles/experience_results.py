"""Results of the experience study as its stages write them, from closed-form courses.

Seven runs of three runners. Every measure is a straight line over the runs with a small wave of its
own; ratings rise with the contact time, which itself drifts over the run.
"""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd

from swaystride.studies.experience.plan import HEART_RATE, MEASURE_KEYS, SCALES, SENSORS

RUNS = ("P01_01", "P01_02", "P01_03", "P02_01", "P02_02", "P03_01", "P03_02")
#: The last run is left out by the import; the one before it is terrestrial.
MEASURED = RUNS[:-1]
DURATION_S, WARM_UP_S, STRIDE_S = 600.0, 180.0, 0.7
TURN_S = (300.0, 310.0)
AERIAL, TERRESTRIAL = 0.26, 0.30
#: Drift of the contact time of each run over its length, ms.
DRIFT_MS = dict(zip(MEASURED, (20.0, 12.0, 6.0, 0.0, -6.0, 3.0), strict=True))


def participant(run):
    return run.split("_")[0]


def duty_factor(run):
    return TERRESTRIAL if run == "P03_01" else AERIAL


def contact_time_s(run, time_s):
    """Contact time over the run."""
    drift_s = DRIFT_MS[run] / 1000.0
    return STRIDE_S * duty_factor(run) + drift_s * (np.asarray(time_s) / DURATION_S - 0.5)


def stride_rows(run):
    """Strides of both feet; warm-up and turn do not count."""
    parts = []
    for side, lag in (("right", 0.0), ("left", STRIDE_S / 2)):
        start = np.arange(lag, DURATION_S - STRIDE_S, STRIDE_S)
        contact = contact_time_s(run, start)
        outside = (start < WARM_UP_S) | ((start > TURN_S[0]) & (start < TURN_S[1]))
        parts.append(
            pd.DataFrame(
                {
                    "side": side,
                    "start_s": start,
                    "stop_s": start + STRIDE_S,
                    "contact_time_s": contact,
                    "stride_time_s": STRIDE_S,
                    "duty_factor": contact / STRIDE_S,
                    "is_valid": np.arange(start.size) % 100 != 0,
                    "is_steady": ~outside,
                }
            )
        )
    return pd.concat(parts, ignore_index=True)


def affect_rows(run):
    """Ratings every two minutes: one more each time, or always 3 in the fourth run."""
    time = np.arange(60.0, DURATION_S, 120.0)
    value = np.full(time.size, 3) if run == MEASURED[3] else np.minimum(1 + np.arange(time.size), 5)
    return pd.DataFrame({"run": run, "time_s": time, "feeling_scale": value.astype(int)})


def window_rows(run):
    """Windows of 60 s every 20 s, with the rating that holds in their middle."""
    start = np.arange(WARM_UP_S, DURATION_S - 60.0 + 1e-9, 20.0)
    ratings = affect_rows(run)
    middle = start + 30.0
    at = np.searchsorted(ratings["time_s"], middle, side="right") - 1
    frame = {
        "run": run,
        "participant": participant(run),
        "pattern": pattern(run),
        "start_s": start,
        "stop_s": start + 60.0,
        "n_strides": 170,
        **dict.fromkeys(MEASURE_KEYS, 1.0),
        "affective_valence": ratings["feeling_scale"].to_numpy()[at].astype(float),
    }
    frame["contact_time_s"] = contact_time_s(run, middle)
    return pd.DataFrame(frame)


def pattern(run):
    return "terrestrial" if duty_factor(run) > 0.288 else "aerial"


def run_observations():
    """One row per measured run."""
    at = np.arange(len(MEASURED), dtype=float)
    columns = {key: 10.0 + at + 0.3 * np.sin(k + 3.0 * at) for k, key in enumerate(MEASURE_KEYS)}
    columns["duty_factor"] = np.array([duty_factor(run) for run in MEASURED])
    columns["speed_m_s"] = 3.2 + 0.1 * at
    columns[HEART_RATE] = np.array([150.0, 152, 154, 156, 158, np.nan])
    columns["peak_head_g"] = np.array([1.0, 2, 3, 4, np.nan, 6])
    return pd.DataFrame(
        {
            "run": list(MEASURED),
            "participant": [participant(run) for run in MEASURED],
            "n_strides": 1000,
            "n_rejected": 7,
            **columns,
            "affective_valence": 2.0 + 0.2 * at + 0.1 * np.cos(at),
            "activity_enjoyment": 90.0 + 3.0 * at,
            "flow": 60.0 + 4.0 * at + np.cos(2.0 * at),
            "pattern": [pattern(run) for run in MEASURED],
            "duty_factor_at_12_km_h": columns["duty_factor"] + 0.002,
            "pattern_at_12_km_h": [pattern(run) for run in MEASURED],
        }
    )


def score_rows():
    """Questionnaires of all runs, and how often affect was rated."""
    own = run_observations().set_index("run").reindex(list(RUNS)).reset_index()
    return pd.DataFrame(
        {
            "run": own["run"],
            "participant": [participant(run) for run in RUNS],
            "activity_enjoyment": own["activity_enjoyment"],
            "flow": own["flow"],
            "ratings_known_until_s": DURATION_S,
            "n_ratings": [5, 5, 5, 5, 5, 5, 0],
            "reason": "",
        }
    )


def association_rows():
    """Every third association is significant, with alternating signs."""
    rows = []
    for group, n in (("all", 6), ("aerial", 5)):
        for k, (measure, scale) in enumerate((m, s) for m in MEASURE_KEYS for s in SCALES):
            r = (0.8 if k % 3 == 0 else 0.1) * (-1) ** k
            rows.append(
                {
                    "group": group,
                    "measure": measure,
                    "scale": scale,
                    "n": n,
                    "r": r,
                    "ci_low": r - 0.15,
                    "ci_high": r + 0.15,
                    "p": 0.01 if k % 3 == 0 else 0.5,
                    "q": 0.04 if k % 6 == 0 else 0.6,
                    "beta": 2.0 * r,
                    "rating_sd": 2.0,
                    "ci_low_cluster": r - 0.3,
                    "ci_high_cluster": r + 0.3,
                    "n_participants": 3,
                }
            )
    rows[5] |= dict.fromkeys(("r", "ci_low", "ci_high", "p", "q", "beta", "rating_sd"), np.nan)
    return pd.DataFrame(rows)


def within_rows():
    """Contact time goes with affect in two aerial runs, one way each; time explains the second."""
    values = {
        "P01_01": (0.8, 0.3, 0.6),
        "P01_02": (0.7, 0.2, 0.1),
        "P01_03": (0.1, 0.4, 0.0),
        "P02_02": (-0.6, 0.2, -0.5),
        "P03_01": (0.2, 0.5, 0.1),
    }
    rows = []
    for run, (r, half, given_time) in values.items():
        for measure in MEASURE_KEYS:
            size = 1.0 if measure == "contact_time_s" else 0.2
            rows.append(
                {
                    "run": run,
                    "participant": participant(run),
                    "pattern": pattern(run),
                    "measure": measure,
                    "n_windows": 19,
                    "r": size * r,
                    "ci_low": size * r - half,
                    "ci_high": size * r + half,
                    "r_partial": size * given_time,
                    "ci_low_partial": size * given_time - half,
                    "ci_high_partial": size * given_time + half,
                    "p_time": 0.01,
                    "rho": np.nan,
                    "ci_low_ar1": np.nan,
                    "ci_high_ar1": np.nan,
                    "ci_low_block": np.nan,
                    "ci_high_block": np.nan,
                }
            )
    return pd.DataFrame(rows)


def truth_rows(run):
    """Each judged error is half of its limit in the first run, and grows by 9 % of it per run."""
    size = 0.5 + 0.09 * MEASURED.index(run)
    rows = [(key, 1.0, 1.0) for key in MEASURE_KEYS]
    known = {
        "stride_time_s": (STRIDE_S, 0.001),
        "contact_time_s": (0.18, 0.012),
        "duty_factor": (0.26, -0.018),
        "stride_length_m": (2.5, -0.05),
        "hip_range_deg": (50.0, 2.0),
        "knee_range_deg": (90.0, 2.0),
        "peak_tibial_g": (5.0, 0.15),
    }
    rows = [
        (key, known[key][0] + size * known[key][1], known[key][0]) if key in known else row
        for key, row in zip(MEASURE_KEYS, rows, strict=True)
    ]
    rows += [("initial_contact_bias_ms", -8.0 * size, 0.0), ("initial_contact_sd_ms", 5 * size, 0)]
    for sensor in SENSORS:
        rows.append((f"alignment_{sensor}_vertical_deg", 2.0 * size, 0.0))
        limit = {"foot": 6.0, "shank": 6.0, "thigh": 10.0}.get(sensor.split("_")[0], 90.0)
        rows.append((f"alignment_{sensor}_ml_deg", limit * size, 0.0))
    table = pd.DataFrame(rows, columns=["measure", "estimate", "truth"])
    table.insert(0, "run", run)
    return table.assign(error=table["estimate"] - table["truth"])


def checks():
    """What the import says of every run."""
    excluded = [run not in MEASURED for run in RUNS]
    return pd.DataFrame(
        {
            "run": list(RUNS),
            "participant": [participant(run) for run in RUNS],
            "excluded": excluded,
            "reason": ["too short" if out else "" for out in excluded],
            "duration_s": [0.0 if out else DURATION_S for out in excluded],
            "missing_sensors": ["", "", "", "", "head", "", ""],
        }
    )


def lab_runs():
    """The lab's table of runs."""
    names = [run.split("_") for run in RUNS]
    return pd.DataFrame(names, columns=["participant", "run"])


PEOPLE = pd.DataFrame(
    {
        "participant": ["P01", "P02", "P03"],
        "sex": ["F", "F", "M"],
        "age_years": [20.0, 30.0, 40.0],
        "height_m": [1.6, 1.7, 1.8],
        "mass_kg": [50.0, 60.0, 70.0],
        "highest_level": ["college", "", "high school"],
        "current_level": ["college", "recreational", ""],
    }
)


@cache
def joined() -> dict[str, pd.DataFrame]:
    """Tables of all runs, by the name that the stages give them."""
    return {
        "observations/runs": run_observations(),
        "observations/windows": pd.concat(map(window_rows, MEASURED), ignore_index=True),
        "models/associations": association_rows(),
        "models/within_runs": within_rows(),
        "answers/affect": pd.concat(map(affect_rows, MEASURED), ignore_index=True),
        "answers/scores": score_rows(),
    }


def write_stages(cohort: Path, variant: Path) -> None:
    """Write everything as the stages do."""
    for name, table in joined().items():
        folder = cohort if name.startswith("answers/") else variant
        file = folder / f"{name}.parquet"
        file.parent.mkdir(parents=True, exist_ok=True)
        table.to_parquet(file, index=False)
    for kind, rows in (("strides", stride_rows), ("truth", truth_rows)):
        (variant / kind).mkdir(parents=True, exist_ok=True)
        for run in RUNS:
            table = rows(run) if run in MEASURED else rows(MEASURED[0]).iloc[:0]
            table.to_parquet(variant / kind / f"{run}.parquet", index=False)
    folder = cohort / "quality" / "runs"
    folder.mkdir(parents=True, exist_ok=True)
    for row in checks().to_dict("records"):
        missing = [name for name in [row["missing_sensors"]] if name]
        text = json.dumps({**row, "missing_sensors": missing})
        (folder / f"{row['run']}.json").write_text(text, encoding="utf-8")
