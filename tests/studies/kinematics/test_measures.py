"""All measures of a trial in closed form."""

from dataclasses import replace

import numpy as np
import pytest
from closed_form_run import (
    FIRST,
    RATE_HZ,
    STRIDE,
    STRIDE_M,
    TOE_OFF,
    TRIOS,
    WIDTH_M,
    estimates,
    wave_deg,
)

from swaystride.errors import ConfigurationError, RecordingError
from swaystride.gait.initial_contact import RUNNING_IMPACT
from swaystride.gait.toe_off import PITCH_MINIMUM
from swaystride.studies.kinematics.measures import (
    MeasureParameters,
    foot_strides,
    measure_parameters,
    trial_measures,
)
from swaystride.studies.kinematics.plan import ANGLE_NAMES, SIDES, SOURCES
from swaystride.studies.kinematics.stride_selection import StrideRule

PARAMETERS = MeasureParameters(
    RUNNING_IMPACT, PITCH_MINIMUM, StrideRule(3, 12, 0.25), horizontal_length=True
)


def biased(phase, angle, side):
    """Offset by angle, larger wave on the left; the same in every stride."""
    a = ANGLE_NAMES.index(angle)
    return a - 4.0 + (0.5 if side == "right" else 1.0) * np.cos(2 * np.pi * phase)


@pytest.fixture(scope="module")
def trial():
    return estimates(20, biased)


@pytest.fixture(scope="module")
def measures(trial):
    return trial_measures(trial, PARAMETERS)


def values(measures, feature, source="erkf", side="right"):
    table = measures.strides
    rows = table[
        (table["feature"] == feature) & (table["source"] == source) & (table["side"] == side)
    ]
    return rows.set_index("stride")["value"]


def test_strides_that_count_and_their_times(measures):
    for side, first in (("right", FIRST), ("left", FIRST + STRIDE // 2)):
        rows = measures.strides[measures.strides["side"] == side].drop_duplicates("stride")
        assert rows["stride"].tolist() == list(range(4, 16))
        found = np.round(rows[["initial_contact_s", "next_contact_s"]].to_numpy() * RATE_HZ)
        begin = first + STRIDE * (rows["stride"].to_numpy() - 1)
        assert np.array_equal(found, np.stack([begin, begin + STRIDE], axis=1))


def test_columns_of_the_contract(measures):
    assert list(measures.strides) == [
        "side",
        "stride",
        "initial_contact_s",
        "next_contact_s",
        "source",
        "feature",
        "value",
    ]
    assert len(measures.strides) == 2 * 12 * 2 * 18
    assert list(measures.curves)[:4] == ["source", "side", "angle", "phase_pct"]
    assert len(measures.curves) == 2 * 2 * 9 * 101
    assert len(measures.agreement) == 18
    assert list(measures.planar) == ["trio", "mean_deg", "sd_deg"]


@pytest.mark.parametrize("side", SIDES)
def test_lengths_and_widths(measures, side):
    for source in SOURCES:
        for feature, expected in (
            ("stride_length_m", STRIDE_M),
            ("stride_width_m", WIDTH_M),
            ("stride_width_signed_m", WIDTH_M),
        ):
            assert np.allclose(values(measures, feature, source, side), expected, atol=1e-4)


@pytest.mark.parametrize("side", SIDES)
def test_ranges_and_peaks(measures, side):
    phase = np.arange(STRIDE) / STRIDE
    for a, angle in enumerate(ANGLE_NAMES):
        assert np.allclose(
            values(measures, f"rom_{angle}", "optic", side), 2 * (10 + 5 * a), rtol=1e-2
        )
    ankle = wave_deg(phase, "ankle_dorsiflexion", side)
    knee = wave_deg(phase, "knee_flexion", side)
    hip = wave_deg(phase, "hip_flexion", side) + biased(phase, "hip_flexion", side)
    for feature, source, expected in (
        ("ankle_dorsiflexion_at_initial_contact", "optic", ankle[0]),
        ("ankle_peak_plantarflexion", "optic", -ankle.min()),
        ("knee_peak_flexion_stance", "optic", knee[: round(TOE_OFF * STRIDE) + 1].max()),
        ("hip_peak_flexion", "erkf", hip.max()),
        ("hip_peak_extension", "erkf", -hip.min()),
    ):
        # toe-off lies within a sample of where it was put
        assert np.allclose(values(measures, feature, source, side), expected, atol=0.4)
    assert knee.max() > knee[: round(TOE_OFF * STRIDE) + 1].max() + 1.0 or side == "left"


def test_agreement_and_curves(measures):
    rows = measures.agreement.set_index(["side", "angle"]).sort_index()
    curves = measures.curves.set_index(["source", "side", "angle", "phase_pct"])[
        "mean_deg"
    ].sort_index()
    phase = np.linspace(0.0, 1.0, 101)
    for side, wave in (("right", 0.5), ("left", 1.0)):
        for a, angle in enumerate(ANGLE_NAMES):
            row = rows.loc[side, angle]
            assert row["n_strides"] == 12
            assert row["bias_deg"] == pytest.approx(a - 4.0, abs=1e-4)
            assert row["rmsd_trial_deg"] == pytest.approx(wave / np.sqrt(2), abs=1e-3)
            assert row["rmsd_ensemble_deg"] < 0.01
            found = curves.loc["optic", side, angle].to_numpy()
            assert np.allclose(found, wave_deg(phase, angle, side), atol=0.05)
    assert measures.curves["sd_deg"].max() < 1e-3


def test_planar_angles(measures):
    assert measures.planar["trio"].tolist() == list(TRIOS)
    assert np.allclose(measures.planar["mean_deg"], 10.0 + np.arange(6))
    assert np.allclose(measures.planar["sd_deg"], 0.0, atol=1e-6)


def test_findings_of_a_whole_trial(measures):
    assert [(f.check, f.severity) for f in measures.findings] == [("strides_counted", "info")] * 2
    assert measures.findings[0].expected == "strides 4 to 15"
    assert measures.findings[0].found.startswith("12 of ")


def test_what_is_missing_is_said_and_left_open(trial):
    broken = trial.copy(deep=True)
    foot = foot_strides(trial, "right", PARAMETERS)
    stride = [slice(foot.contacts[k - 1], foot.contacts[k]) for k in (6, 8, 10, 12)]
    broken["angle_deg"][0, 0, 3, stride[0].start + 5 : stride[0].start + 9] = np.nan
    broken["zero_velocity"][0, stride[1]] = False
    # a foot that turns faster and faster towards the toes
    broken["foot_pitch_rate_rad_s"][0, stride[2]] = -8.0 * np.arange(STRIDE) / STRIDE
    # an impact that is not there: two strides become one
    broken["foot_acc_m_s2"][0, stride[3].start - 50 : stride[3].start + 50] = 3.0
    found = trial_measures(broken, PARAMETERS)
    right = {f.check: f for f in found.findings if f.place.startswith("right foot")}
    assert set(right) == {
        "strides_counted",
        "irregular_strides",
        "incomplete_strides",
        "strides_without_toe_off",
        "strides_without_length",
    }
    assert right["irregular_strides"].found == "1 others, with about 1 missed contacts"
    assert right["incomplete_strides"].place == "right foot, optic"
    assert {f.severity for f in right.values()} == {"warning"}
    assert np.isnan(values(found, "rom_knee_flexion", "optic")).to_numpy().nonzero()[
        0
    ].tolist() == [2]
    assert not np.isnan(values(found, "rom_knee_flexion", "erkf")).any()
    assert np.isnan(values(found, "knee_peak_flexion_stance")).sum() == 1
    lengths = values(found, "stride_length_m")
    assert lengths.index[np.isnan(lengths)].tolist() == [7, 8]
    row = found.agreement.set_index(["side", "angle"]).loc["right", "n_strides"]
    assert row["knee_flexion"] == row["hip_flexion"] - 1
    assert len([f for f in found.findings if f.place.startswith("left")]) >= 1


def test_a_gap_that_was_cut_starts_the_count_anew(trial):
    late = trial.copy(deep=True)
    late.attrs["first_usable_s"] = 3.0
    late["foot_acc_m_s2"][:, :500] = np.nan
    found = trial_measures(late, PARAMETERS)
    assert found.strides["stride"].min() == 4
    assert found.strides["initial_contact_s"].min() > 3.0 + 3 * STRIDE / RATE_HZ - 1e-9
    whole = trial_measures(trial, PARAMETERS).strides
    shared = whole.merge(found.strides, on=["side", "initial_contact_s", "source", "feature"])
    assert len(shared) > 200
    assert np.allclose(shared["value_x"], shared["value_y"], atol=1e-9)


def test_too_few_strides_and_a_foot_that_does_not_run(trial):
    with pytest.raises(
        RecordingError, match=r"right foot: no stride counts; expected strides after the first 50"
    ):
        trial_measures(trial, replace(PARAMETERS, strides=StrideRule(50, None, 0.25)))
    still = trial.copy(deep=True)
    still["foot_gyr_rad_s"][1] = 0.01
    with pytest.raises(RecordingError, match="left foot: this foot does not run"):
        trial_measures(still, PARAMETERS)
    few = trial_measures(trial, replace(PARAMETERS, strides=StrideRule(10, 150, 0.25)))
    assert few.findings[0].severity == "warning"
    assert few.findings[0].expected == "strides 11 to 160"


def test_parameters_from_the_configuration():
    contacts = dict(vars(RUNNING_IMPACT))
    groups = {
        "toe_off": dict(vars(PITCH_MINIMUM)),
        "strides": {"n_dropped": 3, "n_used": 12, "time_tolerance": 0.25},
        "footfalls": {"horizontal_length": True},
    }
    assert measure_parameters(contacts, groups) == PARAMETERS
    groups["strides"]["n_usd"] = groups["strides"].pop("n_used")
    with pytest.raises(ConfigurationError, match=r"analysis\.measures\.strides: keys do not match"):
        measure_parameters(contacts, groups)
