"""Results of the kinematics study as its stages write them, from closed-form curves.

Five trials of three runners. Every joint angle is a fixed wave of the printed range; the filter
adds a known bias, a start error that decays, and scatter between strides.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from import_graph import REPOSITORY
from swaystride.lower_limb_joints import ANGLES, JOINT_NAMES
from swaystride.studies.kinematics.plan import ANGLE_NAMES, FEATURES, SIDES

TRIALS = (("P01", "01"), ("P01", "02"), ("P02", "01"), ("P02", "02"), ("P03", "01"))
PARTICIPANTS = ("P01", "P02", "P03")
STRIDE_S = 0.7
N_STRIDES = 24
FIRST_STRIDE = 11
RATE_HZ = 200.0
BELT_M_S = 14.0 / 3.6

#: Printed Table 4.4, by angle and side.
RANGES = {
    (row["angle"], row["side"]): (row["optic_deg_mean"], row["erkf_deg_mean"])
    for row in pd.read_csv(REPOSITORY / "data" / "published" / "table_4_4.csv").to_dict("records")
}
#: Mean of the optic and of the filter's feature, degrees (Table 4.6 in round numbers).
PEAKS = dict(zip(FEATURES, (54, 11, 35, 30, 16, -0.5), strict=True))


def wave(phase, angle, side):
    """A joint angle over the gait cycle (phase in cycles), degrees; its range is the printed one."""
    total = RANGES[angle, side][0]
    turn = 2 * np.pi * phase
    if angle == "knee_flexion":  # a small hump in stance, a large one in swing
        shape = 0.3 * np.exp(-((((phase % 1) - 0.15) / 0.08) ** 2)) + np.exp(
            -((((phase % 1) - 0.7) / 0.13) ** 2)
        )
        return total * shape
    return total * 0.5 * np.cos(turn + 0.4 * ANGLE_NAMES.index(angle))


def bias_deg(angle, side):
    """Constant by which the filter misses."""
    return (1.0 if side == "right" else -1.5) * (1 + 0.3 * ANGLE_NAMES.index(angle))


def stride_rows(participant, trial, rng):
    """Counted strides of one trial, all features of both sources."""
    rows = []
    person = PARTICIPANTS.index(participant)
    for side in SIDES:
        for number in range(FIRST_STRIDE, FIRST_STRIDE + N_STRIDES):
            begin = STRIDE_S * (number - 1) + (0.1 if side == "right" else 0.45)
            head = (participant, trial, side, number, begin, begin + STRIDE_S)
            features = {f"rom_{angle}": RANGES[angle, side] for angle in ANGLE_NAMES}
            features |= {name: (value, value + 2.0) for name, value in PEAKS.items()}
            features["stride_length_m"] = (2.71, 2.50)
            features["stride_width_m"] = (0.04, 0.08)
            features["stride_width_signed_m"] = (0.03, 0.01)
            for feature, values in features.items():
                scale = 0.005 if feature.endswith("_m") else 0.4
                for source, value in zip(("optic", "erkf"), values, strict=True):
                    shift = scale * (person - 1) + rng.normal(0, scale)
                    rows.append((*head, source, feature, value + shift))
    columns = "participant trial side stride initial_contact_s next_contact_s source feature value"
    return pd.DataFrame(rows, columns=columns.split())


def agreement_rows(participant, trial, rng):
    """Agreement whose identities hold: raw² = bias² + rest²."""
    rows = []
    for side in SIDES:
        for angle in ANGLE_NAMES:
            bias = bias_deg(angle, side) + rng.normal(0, 0.5)
            rest = 1.5 + 0.2 * rng.random()
            total = RANGES[angle, side][0]
            r2 = 1 - rest**2 / (total**2 / 8)
            raw = np.hypot(bias, rest)
            rows.append(
                {
                    "participant": participant,
                    "trial": trial,
                    "side": side,
                    "angle": angle,
                    "n_strides": N_STRIDES,
                    "rom_deg": total,
                    "bias_deg": bias,
                    "r2": r2,
                    "r2_squared_correlation": max(r2, 0.0),
                    "r2_raw": r2 - 0.1,
                    "mad_deg": abs(bias),
                    "mad_alt_deg": abs(bias) + 0.1,
                    "rmsd_deg": raw,
                    "nrmsd_pct": 100 * raw / total,
                    "rmsd_ensemble_deg": 0.5 * rest,
                    "nrmsd_ensemble_pct": 50 * rest / total,
                    "rmsd_trial_deg": rest,
                    "nrmsd_trial_pct": 100 * rest / total,
                    "rmsd_stride_deg": 0.9 * rest,
                    "nrmsd_stride_pct": 90 * rest / total,
                }
            )
    return pd.DataFrame(rows)


def curve_rows(participant, trial):
    """Mean curves of both sources."""
    phase = np.arange(101)
    parts = []
    for source in ("optic", "erkf"):
        for side in SIDES:
            for angle in ANGLE_NAMES:
                extra = bias_deg(angle, side) if source == "erkf" else 0.0
                parts.append(
                    pd.DataFrame(
                        {
                            "participant": participant,
                            "trial": trial,
                            "source": source,
                            "side": side,
                            "angle": angle,
                            "phase_pct": phase,
                            "mean_deg": wave(phase / 100, angle, side) + extra,
                            "sd_deg": 1.0 + 0.01 * phase,
                        }
                    )
                )
    return pd.concat(parts, ignore_index=True)


def planar_rows(participant, trial):
    """Planar angles: 13, 11 and 12 degrees on the right, one less on the left."""
    rows = [
        (participant, trial, f"{side}_{segment}", angle - (side == "left"), 0.5)
        for segment, angle in (("thigh", 14.0), ("shank", 12.0), ("foot", 11.0))
        for side in SIDES
    ]
    return pd.DataFrame(rows, columns=["participant", "trial", "trio", "mean_deg", "sd_deg"])


def perturbation_rows(participant, trial):
    """Shifts move the other planes more than flexion, and reshape only the three poor angles."""
    rows = []
    for kind in ("hip", "knee", "ankle"):
        for direction in ("AP", "CC", "ML"):
            for sign in (1.0, -1.0):
                for joint in JOINT_NAMES:
                    for angle in ANGLES:
                        own = joint.split("_")[1] == "knee" and angle == "adduction"
                        poor = (joint.split("_")[1], angle) in {
                            ("knee", "internal_rotation"),
                            ("ankle", "adduction"),
                            ("ankle", "internal_rotation"),
                        }
                        rows.append(
                            (participant, trial, kind, direction, 0.005 * sign, joint, angle,
                             sign * (4.0 if own or poor else 1.0), 3.0 if poor else 0.2)
                        )  # fmt: skip
    columns = "participant trial shifted direction shift_m joint angle offset_deg shape_deg"
    return pd.DataFrame(rows, columns=columns.split())


def perturbation_curve_rows(trial):
    """Curves of Figure 4.8: the wave, moved by a known offset per direction."""
    phase = np.arange(101)
    cases = [("none", "none", 0.0)] + [
        (kind, direction, sign)
        for kind in ("hip", "knee", "ankle")
        for direction in ("AP", "CC", "ML")
        for sign in (1.0, -1.0)
    ]
    size = {"none": 0.0, "AP": 1.0, "CC": 2.0, "ML": 3.0}
    parts = [
        pd.DataFrame(
            {
                "trial": trial,
                "shifted": kind,
                "direction": direction,
                "sign": sign,
                "side": side,
                "angle": angle,
                "phase_pct": phase,
                "mean_deg": wave(phase / 100, angle, side) + sign * size[direction],
            }
        )
        for kind, direction, sign in cases
        for side in SIDES
        for angle in ANGLE_NAMES
    ]
    return pd.concat(parts, ignore_index=True)


def truth_rows(participant, trial):
    """Markers miss by 2°, the filter by 1°, both with a bias; half of the truth in the band."""
    rows = [
        (participant, trial, source, side, angle, bias, np.hypot(bias, rest), rest,
         0.5 if source == "erkf" else np.nan, 0.95 if source == "erkf" else np.nan)
        for source, bias, rest in (("optic", -3.0, 2.0), ("erkf", 4.0, 1.0))
        for side in SIDES
        for angle in ANGLE_NAMES
    ]  # fmt: skip
    measures = "bias_deg rmsd_deg rmsd_trial_deg coverage_95 coverage_95_trial"
    columns = f"participant trial source side angle {measures}"
    return pd.DataFrame(rows, columns=columns.split())


def truth_stride_rows(participant, trial):
    """Strides of 2.7 m: markers 1 cm too long, the filter 20 cm too short."""
    rows = [
        (participant, trial, side, number, source, measure, truth + error, truth)
        for side in SIDES
        for number in (11, 12)
        for source, errors in (("optic", (0.01, 0.0)), ("erkf", (-0.2, 0.03)))
        for measure, truth, error in zip(
            ("stride_length_m", "stride_width_m"), (2.7, 0.04), errors, strict=True
        )
    ]
    columns = "participant trial side stride source measure estimate truth"
    return pd.DataFrame(rows, columns=columns.split())


def estimates(*, start_error_deg=8.0, drift_deg_s=1.5):
    """One trial of 40 s: the filter's start error decays within three strides."""
    time = np.arange(0, 40.0, 1 / RATE_HZ)
    shape = (2, len(ANGLE_NAMES), time.size)
    optic, erkf, raw = np.empty(shape), np.empty(shape), np.empty(shape)
    phases = {}
    for s, side in enumerate(SIDES):
        phase = (time - (0.1 if side == "right" else 0.45)) / STRIDE_S
        phases[side] = phase % 1
        for a, angle in enumerate(ANGLE_NAMES):
            optic[s, a] = wave(phase, angle, side)
            erkf[s, a] = optic[s, a] + bias_deg(angle, side)
            erkf[s, a] += start_error_deg * np.exp(-time / 0.8)
            raw[s, a] = optic[s, a] + drift_deg_s * (1 + a) * time
    stance = np.stack([phases[side] for side in SIDES])
    impact = np.exp(-((np.minimum(stance, 1 - stance) / 0.02) ** 2))
    foot = np.zeros((2, 2, 3, time.size))
    foot[..., 0, :] = BELT_M_S * time
    return xr.Dataset(
        {
            "angle_deg": (("source", "side", "angle", "time"), np.stack([optic, erkf])),
            "angle_sd_deg": (("side", "angle", "time"), np.full(shape, 1.0)),
            "integrated_deg": (("side", "angle", "time"), raw),
            "foot_position_m": (("source", "side", "axis", "time"), foot),
            "zero_velocity": (("side", "time"), (stance > 0.15) & (stance < 0.2)),
            "foot_acc_m_s2": (("side", "time"), 9.8 + 120 * impact),
            "foot_gyr_rad_s": (("side", "time"), np.abs(12 * np.sin(np.pi * (stance - 0.17)))),
            "foot_pitch_rate_rad_s": (("side", "time"), 12 * np.sin(np.pi * (stance - 0.17))),
        },
        coords={
            "source": ["optic", "erkf"],
            "side": list(SIDES),
            "angle": list(ANGLE_NAMES),
            "axis": ["x", "y", "z"],
            "time": time,
        },
        attrs={"rate_hz": RATE_HZ, "belt_speed_m_s": BELT_M_S, "first_usable_s": 0.0},
    )


@cache
def frames() -> dict[str, pd.DataFrame]:
    """Every table of the stages, by kind, of all trials."""
    rng = np.random.default_rng(4)
    build = {
        "strides": lambda p, t: stride_rows(p, t, rng),
        "agreement": lambda p, t: agreement_rows(p, t, rng),
        "curves": curve_rows,
        "planar": planar_rows,
        "perturbation": perturbation_rows,
        "truth": truth_rows,
        "truth_strides": truth_stride_rows,
    }
    return {
        kind: pd.concat([make(*trial) for trial in TRIALS], ignore_index=True)
        for kind, make in build.items()
    }


def write_tables(folder: Path, tables: dict[str, pd.DataFrame]) -> None:
    """Write the tables as the stages do: one file per kind and participant."""
    for kind, table in tables.items():
        (folder / kind).mkdir(parents=True, exist_ok=True)
        for participant in PARTICIPANTS:
            own = table[table["participant"] == participant]
            own.to_parquet(folder / kind / f"{participant}.parquet", index=False)
