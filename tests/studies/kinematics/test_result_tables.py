"""Result tables keep the columns and rows of the print; their numbers follow from the frames."""

import kinematics_results as made
import numpy as np
import pandas as pd
import pytest

from import_graph import REPOSITORY
from swaystride.configuration import load_yaml
from swaystride.erkf.noise import WALKING
from swaystride.studies.kinematics import tables
from swaystride.studies.kinematics.course import trial_course
from swaystride.studies.kinematics.literature_tables import read_literature, table_4_9, table_4_10
from swaystride.studies.kinematics.range_tests import table_4_4
from swaystride.studies.kinematics.representative import trial_contacts, trial_rows
from swaystride.studies.kinematics.summaries import summary_table, trial_features
from swaystride.studies.kinematics.table_options import TableOptions
from swaystride.studies.kinematics.table_styles import TABLE_STYLES
from swaystride.studies.kinematics.text_table import study4_text
from swaystride.studies.kinematics.truth_tables import truth_angles, truth_strides, truth_summary

PUBLISHED = REPOSITORY / "data" / "published"
OPTIONS = TableOptions(0.05, 2.0, 30.0, 1.0, 10, 5.0)
PRINTED_NOISE = {
    "acc_sd_m_s2": 0.179,
    "gyr_sd_deg_s": 2.46,
    "gyr_bias_walk_rad_s_rts": 5e-5,
    "zero_velocity_sd_m_s": 0.11,
    "contact_lever_sd_m": 0.02,
    "hip_centre_sd_m": 0.01,
    "knee_centre_sd_m": 0.04,
    "ankle_centre_sd_m": 0.01,
    "hip_axis_sd_deg": 0.75,
    "knee_axis_sd_deg": 45.84,
}
PEOPLE = pd.DataFrame(
    {
        "participant": ["P01", "P02"],
        "sex": ["M", "F"],
        "age_years": [30.0, 40.0],
        "height_m": [1.8, 1.7],
        "mass_kg": [70.0, 60.0],
        "years_running": [">15", "5"],
        "typical_pace_min_per_km": ["4:40", "4:50-5:10"],
        "race_5km_min": ["17:00", ""],
    }
)


@pytest.fixture(scope="module")
def frames():
    return made.frames()


@pytest.fixture(scope="module")
def course(frames):
    tables = []
    for participant, trial in made.TRIALS:
        contacts = trial_contacts(trial_rows(frames["strides"], participant, trial))
        own = trial_course(made.estimates(), contacts, OPTIONS)
        tables.append(own.assign(participant=participant, trial=trial))
    return pd.concat(tables, ignore_index=True)


@pytest.fixture(scope="module")
def built(frames, course):
    strides, agreement = frames["strides"], frames["agreement"]
    printed_4_4 = pd.read_csv(PUBLISHED / "table_4_4.csv")
    planned = pd.DataFrame([*made.TRIALS, ("P03", "02")], columns=["participant", "trial"])
    literature = {
        name: read_literature(PUBLISHED / f"{name}.csv") for name in ("table_4_9", "table_4_10")
    }
    return {
        "table_4_1": tables.table_4_1(PEOPLE),
        "table_4_2": tables.table_4_2(PRINTED_NOISE, WALKING),
        "table_4_3": tables.table_4_3(agreement),
        "table_4_4": table_4_4(strides, printed_4_4, OPTIONS),
        "table_4_5": tables.table_4_5(strides),
        "table_4_6": tables.table_4_6(strides, OPTIONS),
        "table_4_7": tables.table_4_7(strides),
        "table_4_8": tables.table_4_8(frames["perturbation"], frames["truth"]),
        "table_4_9": table_4_9(literature["table_4_9"], agreement, 6.0, simulated=True),
        "table_4_10": table_4_10(literature["table_4_10"], agreement, 6.0, simulated=False),
        "study4_text": study4_text(planned, strides, agreement, frames["planar"], course, 0.02),
        "cohort": tables.cohort_table(PEOPLE),
        "agreement_by_trial": tables.agreement_by_trial(agreement),
        "truth_angles": truth_angles(frames["truth"]),
        "truth_summary": truth_summary(frames["truth"]),
        "truth_strides": truth_strides(frames["truth_strides"]),
    }


@pytest.mark.parametrize("name", [*(f"table_4_{n}" for n in range(1, 11)), "study4_text"])
def test_printed_tables_keep_their_columns_and_rows(built, name):
    theirs = pd.read_csv(PUBLISHED / f"{name}.csv")
    ours = built[name]
    assert list(ours)[: theirs.shape[1]] == list(theirs)
    keys = [key for key in ("gait", "angle", "feature", "measure", "quantity") if key in theirs]
    keys += ["side"] if "side" in theirs and keys else []
    if name in ("table_4_9", "table_4_10"):
        printed = read_literature(PUBLISHED / f"{name}.csv")
        pd.testing.assert_frame_equal(ours[list(printed)].head(len(printed)), printed)
    elif keys:
        assert ours[keys].to_numpy().tolist() == theirs[keys].to_numpy().tolist()


@pytest.mark.parametrize("name", sorted(set(TABLE_STYLES) - {"claims"}))
def test_every_table_can_be_written_in_its_style(built, name, tmp_path):
    TABLE_STYLES[name].write(built[name], tmp_path / name, simulated=True)
    assert (tmp_path / f"{name}.csv").stat().st_size > 0


def test_the_page_asks_for_columns_that_the_tables_have(built):
    page = load_yaml(REPOSITORY / "workflow" / "report" / "kinematics.yaml")
    for item in page["items"]:
        name = item["file"].rsplit("/", 1)[-1].removesuffix(".csv")
        if item["kind"] in ("figure", "assumption") or name == "claims":
            continue
        asked = [*item.get("columns", []), *item.get("keys", [])]
        asked += [value["estimate"] for value in item.get("values", [])]
        asked += [value["se"] for value in item.get("values", []) if "se" in value]
        assert set(asked) <= set(built[name].columns), name


def test_printed_noise_gives_the_printed_table(built):
    theirs = pd.read_csv(PUBLISHED / "table_4_2.csv")
    columns = [name for name in theirs if name != "gait"]
    np.testing.assert_allclose(built["table_4_2"][columns], theirs[columns], rtol=1e-12)


def test_an_axis_that_is_not_used_is_missing():
    noise = {**PRINTED_NOISE, "hip_axis_sd_deg": None}
    table = tables.table_4_2(noise, WALKING).set_index("gait")
    assert np.isnan(table.loc["running", "sigma_joint_axis_hip_deg"])
    assert table.loc["walking", "sigma_joint_axis_hip_deg"] == pytest.approx(57.30)


def hand_made_strides(feature, values):
    """Values by (participant, trial): pairs of optic and filter, one per stride; right side only."""
    rows = [
        (person, trial, "right", number, source, feature, pair[at])
        for (person, trial), pairs in values.items()
        for number, pair in enumerate(pairs, start=11)
        for at, source in enumerate(("optic", "erkf"))
    ]
    columns = ["participant", "trial", "side", "stride", "source", "feature", "value"]
    return pd.DataFrame(rows, columns=columns)


def test_features_of_a_trial_by_hand():
    strides = hand_made_strides(
        "rom_hip_flexion", {("A", "01"): [(10, 13), (20, 16), (30, np.nan)]}
    )
    row = trial_features(strides).iloc[0]
    assert (row["n_strides"], row["optic"], row["erkf"], row["difference"]) == (2, 15, 14.5, -0.5)
    assert row["rmsd"] == pytest.approx(np.sqrt((9 + 16) / 2))
    assert row["rrmsd_pct"] == pytest.approx(100 * np.sqrt(12.5) / 15)


def test_table_4_5_by_hand():
    values = {("A", "01"): [(50, 52)], ("A", "02"): [(50, 54)], ("B", "01"): [(40, 41)]}
    row = tables.table_4_5(hand_made_strides("rom_hip_flexion", values)).iloc[0]
    assert row["rom_rmsd_deg_mean"] == pytest.approx((2 + 4 + 1) / 3)
    assert row["rom_rmsd_deg_sd"] == pytest.approx(np.std([2, 4, 1], ddof=1))
    assert row["rom_rrmsd_pct_mean"] == pytest.approx((4 + 8 + 2.5) / 3)
    # two participants with 3 and 1 degrees
    assert row["rom_rmsd_deg_se"] == pytest.approx(np.std([3, 1], ddof=1) / np.sqrt(2))
    assert row["n_trials"] == 3


def test_a_relative_difference_is_left_out_where_its_denominator_is_small(built):
    table = built["table_4_6"].set_index(["feature", "side"])
    small = ("ankle_dorsiflexion_at_initial_contact", "left")
    assert np.isnan(table.loc[small, "rrmsd_pct_mean"])
    assert np.isnan(table.loc[small, "rrmsd_pct_sd"])
    assert table.loc[("hip_peak_flexion", "left"), "rrmsd_pct_mean"] > 0


def test_the_sign_of_the_mean_difference_is_that_of_the_print():
    """Optic − filter for lengths, filter − optic for widths (register I-21)."""
    strides = pd.concat(
        [
            hand_made_strides("stride_length_m", {("A", "01"): [(2.7, 2.5)]}),
            hand_made_strides("stride_width_m", {("A", "01"): [(0.04, 0.07)]}),
            hand_made_strides("stride_width_signed_m", {("A", "01"): [(0.04, -0.07)]}),
        ]
    )
    table = tables.table_4_7(strides).set_index(["measure", "side"])
    length, width = table.loc[("stride_length", "right")], table.loc[("stride_width", "right")]
    assert (length["md_m_mean"], length["bias_m_mean"]) == pytest.approx((0.2, -0.2))
    assert length["bias_pct_mean"] == pytest.approx(-100 * 0.2 / 2.7)
    assert (width["md_m_mean"], width["bias_m_mean"]) == pytest.approx((0.03, 0.03))
    assert np.isnan(width["rrmsd_pct_mean"])
    assert width["erkf_signed_m_mean"] == pytest.approx(-0.07)
    assert np.isnan(length["erkf_signed_m_mean"])


def test_readings_of_table_4_3_stand_in_their_columns(frames, built):
    own = frames["agreement"]
    own = own[(own["angle"] == "knee_adduction") & (own["side"] == "left")]
    table = built["table_4_3"].set_index(["angle", "side"])
    row = table.loc[("knee_adduction", "left")]
    for stem, column in {**tables.AGREEMENT_COLUMNS, **tables.ALTERNATIVE_COLUMNS}.items():
        assert row[f"{stem}_mean"] == pytest.approx(own[column].mean())
        assert row[f"{stem}_sd"] == pytest.approx(own[column].std(ddof=1))


def test_an_angle_without_trials_has_an_empty_row():
    empty = pd.DataFrame(columns=["participant", "side", "angle", "x"]).astype({"x": float})
    table = summary_table(empty, "angle", ["hip_flexion"], {"x": "x"})
    assert table["n_trials"].tolist() == [0, 0]
    assert table["x_mean"].isna().all()


def test_shifts_and_truth_stand_beside_the_expectation(built, frames):
    table = built["table_4_8"].set_index("angle")
    assert table.loc["knee_rotation", "largest_offset_deg"] == pytest.approx(4.0)
    assert table.loc["hip_rotation", "largest_shape_deg"] == pytest.approx(0.2)
    assert table.loc["hip_flexion", "optic_true_bias_deg"] == pytest.approx(3.0)
    assert table.loc["hip_flexion", "erkf_true_rmsd_trial_deg"] == pytest.approx(1.0)
    without = tables.table_4_8(frames["perturbation"], None)
    assert without["optic_true_bias_deg"].isna().all()


def test_rows_of_this_pipeline_follow_the_literature(built, frames):
    table = built["table_4_9"]
    ours = table[table["reference"] == "this pipeline"]
    assert ours["origin"].unique().tolist() == ["simulated"]
    assert set(table["origin"]) == {"as printed", "simulated"}
    assert ours["trial_duration"].iloc[0] == "6 min"
    agreement = frames["agreement"]
    knee = agreement[(agreement["angle"] == "knee_flexion") & (agreement["side"] == "left")]
    row = ours[(ours["metric"] == "rmsd") & (ours["side"] == "left")].iloc[0]
    assert row["knee_flexion_mean"] == f"{knee['rmsd_deg'].mean():.1f}"
    others = built["table_4_10"]
    assert (others.loc[others["reference"] == "this pipeline", "origin"] == "recorded").all()


def test_numbers_of_the_text_by_hand(built):
    text = built["study4_text"].set_index("quantity")
    value = text["value"]
    assert value["planar_angle_thigh"] == pytest.approx(13.5)
    assert text.loc["planar_angle_shank", "sd"] == pytest.approx(0.5)
    assert (value["participants"], value["trials_per_participant"]) == (3, 2)
    assert (value["trials_excluded"], value["trials_analysed"]) == (1, 5)
    assert value["strides_discarded_at_start"] == 10
    assert value["gait_cycles_of_the_representative_trial"] == made.N_STRIDES
    assert value["strides_analysed_more_than"] == 2 * 5 * made.N_STRIDES
    assert value["treadmill_speed"] == pytest.approx(14.0)
    assert value["gyroscopic_energy_window"] == 0.02


def test_a_window_that_is_not_used_is_not_told(frames, course):
    planned = pd.DataFrame(made.TRIALS, columns=["participant", "trial"])
    tables_read = (frames[name] for name in ("strides", "agreement", "planar"))
    text = study4_text(planned, *tables_read, course, None).set_index("quantity")
    assert np.isnan(text.loc["gyroscopic_energy_window", "value"])


def test_people_are_summarised(built):
    row = built["cohort"].iloc[0]
    assert (row["n"], row["n_female"], row["age_years_mean"]) == (2, 1, 35.0)
    assert row["height_m_sd"] == pytest.approx(np.std([1.8, 1.7], ddof=1))
    assert built["table_4_1"]["race_5km_min"].tolist() == ["17:00", ""]


def test_errors_against_the_truth_are_told_apart(built):
    angles = built["truth_angles"]
    assert len(angles) == 18
    assert angles["optic_bias_deg_mean"].tolist() == pytest.approx([-3.0] * 18)
    assert angles["erkf_rmsd_deg_mean"].tolist() == pytest.approx([np.hypot(4, 1)] * 18)
    assert angles["erkf_coverage_95"].tolist() == pytest.approx([0.5] * 18)
    assert angles["erkf_coverage_95_trial"].tolist() == pytest.approx([0.95] * 18)
    summary = built["truth_summary"].set_index(["source", "plane"])
    assert summary.loc[("optic", "other"), "mean_rmsd_trial_deg"] == pytest.approx(2.0)


def test_the_worst_angle_of_a_plane_is_named(frames):
    truth = frames["truth"].copy()
    worse = (truth["angle"] == "knee_rotation") & (truth["side"] == "left")
    worse &= truth["source"] == "erkf"
    truth.loc[worse, "rmsd_trial_deg"] = 7.0
    row = truth_summary(truth).set_index(["source", "plane"]).loc[("erkf", "other")]
    assert (row["largest_angle"], row["largest_rmsd_trial_deg"]) == ("left knee_rotation", 7.0)
    # eleven of twelve angles and sides of the other planes have an error of one degree
    assert row["mean_rmsd_trial_deg"] == pytest.approx((11 * 1 + 7) / 12)


def test_strides_against_the_truth_by_hand(built):
    table = built["truth_strides"].set_index(["measure", "side", "source"])
    row = table.loc[("stride_length", "left", "erkf")]
    assert (row["n_strides"], row["bias_m"], row["rmsd_m"]) == pytest.approx((10, -0.2, 0.2))
    assert row["bias_pct"] == pytest.approx(-100 * 0.2 / 2.7)
