"""Result tables keep the columns and rows of the print; requirements, sentences and claims follow."""

import numpy as np
import pandas as pd
import pytest

from import_graph import REPOSITORY
from swaystride.presentation.table_files import write_table
from swaystride.studies.imu_design import tables
from swaystride.studies.imu_design.claims import CLAIMS, claims_table
from swaystride.studies.imu_design.design import read_design
from swaystride.studies.imu_design.experiments import EXPERIMENTS
from swaystride.studies.imu_design.models import effects, variance_components
from swaystride.studies.imu_design.plan import TABLES
from swaystride.studies.imu_design.recommendation import recommendation_table
from swaystride.studies.imu_design.requirements import requirements
from swaystride.studies.imu_design.sensors import SensorSpecification
from swaystride.studies.imu_design.table_styles import TABLE_STYLES

SENSORS = {
    "imu_1": SensorSpecification("Opal", "APDM", 200.0, 2000.0),
    "imu_2": SensorSpecification("custom design", "Insight Sports", 32.0, 4000.0),
}


def printed(name):
    return pd.read_csv(REPOSITORY / "data" / "published" / f"{name}.csv")


@pytest.fixture(scope="module")
def cohort(observations_with, plan):
    observations = observations_with(participant_sd=0.4, trial_sd=0.5, row_sd=0.2)
    found = pd.concat([effects(observations, name, plan) for name in EXPERIMENTS])
    return observations, found


@pytest.fixture(scope="module")
def ranges():
    rows = [
        ("A", "01", "left", imu, rate, 20.0, peak, 900.0, share, 0.0)
        for imu, rate, peak, share in (
            ("imu_1", 128.0, 41.0, 0.0),
            ("imu_1", 128.02, 44.0, 0.0),
            ("imu_2", 1000.0, 32.0, 0.5),
        )
    ]
    names = "participant trial foot imu rate_hz duration_s peak_acc_g peak_gyr_deg_s"
    columns = [*names.split(), "acc_at_range_percent", "gyr_at_range_percent"]
    return pd.DataFrame(rows, columns=columns)


@pytest.fixture
def built(cohort, ranges, folder, plan):
    observations, found = cohort
    needs = requirements(observations, found, plan)
    return {
        "table_1": tables.table_1(ranges, SENSORS),
        **{
            table: tables.effect_table(found, experiment, plan.model)
            for experiment, table in TABLES.items()
        },
        "imu_design_text": tables.imu_design_text(observations, needs, plan),
        "model_comparison": tables.model_comparison(found),
        "variance_components": variance_components(observations, "gyro_range"),
        "requirements": needs,
        "recommendation": recommendation_table(needs, observations["speed_m_s"].max(), plan),
        "cohort": tables.cohort_table(read_design(folder)),
        "speeds": tables.speed_table(observations),
        "claims": claims_table(observations, found, plan),
    }


@pytest.mark.parametrize("name", ["table_1", *TABLES.values(), "imu_design_text"])
def test_printed_tables_keep_their_columns_and_rows(built, name):
    theirs = printed(name).drop(columns="p_is_upper_bound", errors="ignore")
    ours = built[name]
    assert list(ours)[: theirs.shape[1]] == list(theirs)
    keys = [column for column in theirs if not pd.api.types.is_numeric_dtype(theirs[column])]
    assert ours[keys].values.tolist() == theirs[keys].values.tolist()


@pytest.mark.parametrize("name", sorted(set(TABLE_STYLES) - {"truth"}))
def test_every_table_can_be_written_in_its_style(built, name, tmp_path):
    style = TABLE_STYLES[name]
    write_table(
        built[name],
        tmp_path / name,
        caption=style.caption,
        notes=style.notes,
        formats=style.formats,
        simulated=True,
    )
    assert (tmp_path / f"{name}.csv").stat().st_size > 0


def test_the_specification_stands_beside_what_was_recorded(built):
    table = built["table_1"]
    assert table["rate_hz"].tolist() == [128.01, 1000.0]
    assert table["peak_acc_g"].tolist() == [44.0, 32.0]
    assert table["n_acc_at_range"].tolist() == [0, 1]


def test_participants_are_summarised(built):
    row = built["cohort"].iloc[0]
    assert (row["n"], row["n_female"], row["age_years_mean"]) == (2, 1, 25.5)
    assert row["height_m_sd"] == pytest.approx(np.std([1.62, 1.81], ddof=1))


def test_requirements_follow_from_hand_made_errors(cohort, plan):
    """Exact errors: 1 − 0.39 v at the baseline, so that limits are crossed at known speeds."""
    observations, found = cohort
    exact = observations.copy()
    base = 1.0 - 0.39 * exact["speed_m_s"]
    extra = {"24g": -0.3, "16g": -0.8, "10g": -2.0, "6g": -5.7}
    added = exact["condition"].map(extra).fillna(0.0) * exact["speed_m_s"]
    exact["error_pct"] = base + added
    row = requirements(exact, found, plan).set_index("experiment").loc["accelerometer_range"]
    # fastest 6.3 m/s: −1.46 % at the baseline, −3.35 % at 24 g, −6.5 % at 16 g
    assert row["level_needed"] == 24.0
    assert row["level_needed_added"] == 24.0
    beyond = exact[(exact["experiment"] == "accelerometer_range") & (exact["error_pct"] < -5)]
    assert row["loss_limit_percent"] == beyond["loss_percent"].min()
    assert row["loss_limit_is_reached"]
    assert row["n_beyond_at_baseline"] == 0
    assert row["largest_error_at_baseline_pct"] == pytest.approx(1 - 0.39 * 6.3)


def test_levels_need_not_be_significant(built):
    """With the printed slopes and little scatter: 24 g and 750 °/s change the slope."""
    needs = built["requirements"].set_index("experiment")["level_not_significant"]
    assert needs["accelerometer_range"] == 50.0
    assert needs["gyro_range"] == 1000.0


def test_the_recommendation_is_built_from_the_results(built, cohort, plan):
    texts = dict(built["recommendation"].values.tolist())
    needs = built["requirements"].set_index("experiment")
    acc, gyr = needs.loc["accelerometer_range"], needs.loc["gyro_range"]
    assert texts["distance error"] == (
        "To keep the distance error within ±5 % at mean speeds up to 6.3 m/s, take an "
        f"accelerometer of at least ±{acc['level_needed']:g} g and a gyroscope of at least "
        f"±{gyr['level_needed']:g} °/s."
    )
    assert (
        f"while less than {acc['loss_limit_percent']:.1f} % of the accelerometer"
        in texts["data loss"]
    )
    assert "down to ±50 g, ±1000 °/s, " in texts["mixed models"]


def test_the_recommendation_says_when_no_range_suffices(cohort, plan):
    observations, found = cohort
    worse = observations.assign(error_pct=observations["error_pct"] - 4.0)
    needs = requirements(worse, found, plan)
    assert needs["level_needed"].isna().iloc[0]
    text = recommendation_table(needs, 6.3, plan)["recommendation"][0]
    row = needs.iloc[0]
    assert text.startswith(
        "No range keeps all distance errors within ±5 % up to 6.3 m/s: with the "
    )
    assert f"{row['n_beyond_at_baseline']} of 60 trials" in text
    assert "−" in text


def test_both_models_stand_side_by_side(built):
    table = built["model_comparison"]
    assert len(table) == 7 + 5 + 5 + 5
    np.testing.assert_allclose(table["se_ratio"], table["se_with_trial"] / table["se"])
    assert table["experiment"].drop_duplicates().tolist() == list(EXPERIMENTS)


def test_speeds_are_summarised_by_trial(built):
    table = built["speeds"]
    assert table["n"].tolist() == [6] * 10
    assert (table["speed_mean_m_s"].diff().dropna() > 0).all()
    assert table["imu_1_strides_per_foot"].tolist() == [30.0] * 10


def test_claims_hold_where_the_printed_slopes_support_them(built):
    """Printed slopes and almost no scatter: all claims on slopes are reproduced."""
    table = built["claims"].set_index("claim")["reproduced"]
    assert len(table) == len(CLAIMS)
    for text in (
        "The error falls with speed for all full-range, full-rate recordings.",
        "Nothing is clipped at 100 g and at 2000 °/s.",
        "16, 10 and 6 g make the fall steeper.",
        "24 g makes the fall steeper.",
        "75 and 50 g change nothing.",
        "500 °/s makes the fall steeper.",
        "750 °/s makes the fall steeper.",
        "Errors at 6 g exceed 30 %.",
        "Single strides scatter more at higher speed and at lower range or rate.",
    ):
        assert table[text] == "yes", text


def test_claims_fail_when_slopes_turn(cohort, plan):
    observations, found = cohort
    turned = found.assign(slope_pct_per_m_s=-found["slope_pct_per_m_s"])
    table = claims_table(observations, turned, plan).set_index("claim")["reproduced"]
    assert table["The error falls with speed for all full-range, full-rate recordings."] == "no"
    assert table["16, 10 and 6 g make the fall steeper."] == "no"
    assert table["The smaller the range, the steeper the fall."] != "yes"


def test_a_claim_on_a_condition_that_is_not_there_is_left_out(cohort, plan):
    observations, found = cohort
    fewer = found[~found["effect"].isin(["24g"])]
    table = claims_table(observations, fewer, plan)
    assert "24 g makes the fall steeper." not in set(table["claim"])
