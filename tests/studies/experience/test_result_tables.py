"""Result tables keep the columns and rows of the print; their numbers follow from the frames."""

import experience_results as made
import numpy as np
import pandas as pd
import pytest

from import_graph import REPOSITORY
from swaystride.presentation.table_files import read_table
from swaystride.studies.experience import chance_tables, run_tables, tables, truth_tables
from swaystride.studies.experience.plan import MEASURE_KEYS, MEASURES, SCALES
from swaystride.studies.experience.population_truth import null_associations
from swaystride.studies.experience.table_inputs import StageTables, participant_of
from swaystride.studies.experience.table_options import TableOptions, TruthLimits, table_options
from swaystride.studies.experience.table_styles import TABLE_STYLES
from swaystride.studies.experience.text_table import study5_text

LIMITS = TruthLimits(1.0, 12.0, 0.018, 2.0, 8.0, 5.0, 2.0, 2.0, 2.0, 6.0, 10.0, 3.0)
OPTIONS = TableOptions(0.05, 0.4, 0.7, 0.5, 0.276, 0.288, LIMITS)
PRINT_ONLY = "p_is_upper_bound"


def published(name):
    return read_table(REPOSITORY / "data" / "published" / f"{name}.csv")


@pytest.fixture(scope="module")
def joined():
    return made.joined()


@pytest.fixture(scope="module")
def errors():
    return pd.concat(map(made.truth_rows, made.MEASURED), ignore_index=True)


def text(joined):
    return study5_text(
        made.lab_runs(),
        joined["observations/runs"],
        joined["answers/affect"],
        joined["answers/scores"],
        OPTIONS,
    )


@pytest.fixture(scope="module")
def built(joined, errors):
    """Every table of the study."""
    rows = joined["models/associations"]
    return {
        "table_5_1": tables.table_5_1(made.PEOPLE),
        "table_5_2": tables.table_5_2(),
        "table_5_3": tables.association_table(rows, "all", 0.05),
        "table_5_4": tables.association_table(rows, "aerial", 0.05),
        "study5_text": text(joined),
        "cohort": tables.cohort_table(made.PEOPLE, made.lab_runs()),
        "runs": run_tables.runs_table(
            joined["observations/runs"],
            joined["observations/windows"],
            joined["answers/scores"],
            made.checks(),
        ),
        "classes": run_tables.classes_table(joined["observations/runs"], None),
        "within_runs": run_tables.within_runs_table(joined["models/within_runs"]),
        "truth_errors": truth_tables.truth_errors(errors, LIMITS),
        "truth_summary": truth_tables.truth_summary(errors, LIMITS),
        "attainable": chance_tables.attainable_table(population(), rows, 0.05),
        "null_cohort": chance_tables.null_cohort_table(rows, rows, printed(), 0.05),
    }


def population():
    rows = [("all", m, s, 0.8, 0.7) for m in MEASURE_KEYS for s in SCALES]
    return pd.DataFrame(rows, columns=["group", "measure", "scale", "printed", "attainable"])


def printed():
    return chance_tables.printed_associations(
        {group: published(table) for group, table in tables.GROUP_TABLES.items()}
    )


def test_every_table_can_be_written(built, tmp_path):
    for name, table in built.items():
        TABLE_STYLES[name].write(table, tmp_path / f"{name}.csv", simulated=True)
        again = read_table(tmp_path / f"{name}.csv")
        assert len(again) == len(table)
        assert (again["data"] == "simulated").all()
        assert "Simulated cohort" in (tmp_path / f"{name}.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "name", ["table_5_1", "table_5_2", "table_5_3", "table_5_4", "study5_text"]
)
def test_tables_of_the_print_have_its_columns_first(built, name):
    table, own = built[name], published(name)
    columns = [column for column in own.columns if column != PRINT_ONLY]
    assert list(table.columns[: len(columns)]) == columns


@pytest.mark.parametrize(
    ("name", "keys"),
    [
        ("table_5_2", ["measure"]),
        ("table_5_3", ["measure", "scale"]),
        ("table_5_4", ["measure", "scale"]),
        ("study5_text", ["quantity"]),
    ],
)
def test_rows_stand_in_the_printed_order(built, name, keys):
    table = built[name]
    assert table[keys].to_numpy().tolist() == published(name)[keys].to_numpy().tolist()


def test_printed_definitions_are_kept():
    assert (
        tables.table_5_2()["definition"].tolist() == published("table_5_2")["definition"].tolist()
    )


def test_significance_includes_the_level_and_needs_a_p():
    rows = made.association_rows()
    rows.loc[0, "p"] = 0.05
    table = tables.association_table(rows, "all", 0.05)
    assert table["significant"].iloc[0] == 1
    assert table["significant"].isna().sum() == 1
    assert pd.isna(table["significant"].iloc[5])


def test_people_read_the_scales_side_by_side(joined, tmp_path):
    table = tables.association_table(joined["models/associations"], "all", 0.05)
    wide = tables.wide_associations(table)
    assert len(wide) == len(MEASURES)
    own = table[(table["measure"] == "Knee ROM") & (table["scale"] == "flow")].iloc[0]
    row = wide[wide["measure"] == "Knee ROM"].iloc[0]
    assert (row["r_flow"], row["beta_flow"], row["p_flow"]) == (own["r"], own["beta"], own["p"])
    TABLE_STYLES["table_5_3"].write(table, tmp_path / "table_5_3.csv", simulated=False)
    lines = (tmp_path / "table_5_3.md").read_text(encoding="utf-8").splitlines()
    assert sum(line.startswith("| ") for line in lines) == 2 + len(MEASURES)
    assert len(read_table(tmp_path / "table_5_3.csv")) == len(MEASURES) * len(SCALES)


def test_numbers_of_the_text(joined):
    value = text(joined).set_index("quantity")["value"]
    assert value["n_participants"] == 3
    assert value["n_runs"] == 7
    assert (value["n_aerial_runs"], value["n_terrestrial_runs"]) == (5, 1)
    assert value["runs_per_participant_mean"] == pytest.approx(7 / 3)
    assert value["runs_per_participant_sd"] == pytest.approx(np.std([3, 2, 2], ddof=1))
    assert (value["ratings_per_run_min"], value["ratings_per_run_mean"]) == (5, 5)
    assert (value["feeling_scale_min"], value["feeling_scale_max"]) == (1, 5)
    assert (value["paces_min"], value["paces_median"], value["paces_max"]) == (90, 97.5, 105)
    assert (value["heart_rate_q1"], value["heart_rate_median"]) == (152, 154)
    own = joined["observations/runs"]
    assert value["r_fss_paces"] == pytest.approx(
        np.corrcoef(own["flow"], own["activity_enjoyment"])[0, 1]
    )


def test_correlations_of_the_text_need_four_runs_that_differ(joined):
    own = joined["observations/runs"].assign(affective_valence=3.0)
    found = study5_text(
        made.lab_runs(), own, joined["answers/affect"], joined["answers/scores"], OPTIONS
    ).set_index("quantity")
    assert pd.isna(found.loc["r_fs_fss", "value"])
    assert found.loc["r_fss_paces", "value"] > 0.9


def test_every_listed_run_has_a_row(built):
    table = built["runs"].set_index("run")
    assert list(table.index) == list(made.RUNS)
    assert table.loc["P03_02", "excluded"] == "too short"
    assert pd.isna(table.loc["P03_02", "n_strides"])
    assert table.loc["P01_01", "n_windows"] == len(made.window_rows("P01_01"))
    assert table.loc["P02_02", "missing_sensors"] == "head"


def test_patterns_are_compared_with_the_true_ones(joined):
    truth = pd.DataFrame(
        {
            "run": list(made.MEASURED),
            "duty_factor": [made.duty_factor(run) for run in made.MEASURED],
            "pattern": ["terrestrial", *(made.pattern(run) for run in made.MEASURED[1:])],
        }
    )
    table = run_tables.classes_table(joined["observations/runs"], truth)
    assert table["agrees"].tolist() == [0, 1, 1, 1, 1, 1]
    assert table["true_duty_factor"].tolist() == truth["duty_factor"].tolist()
    assert run_tables.classes_table(joined["observations/runs"], None)["agrees"].isna().all()


def test_counts_within_runs(joined):
    table = run_tables.within_runs_table(joined["models/within_runs"])
    assert table["interval"].unique().tolist() == ["printed", "given_time"]
    row = table[(table["measure"] == "Contact Time") & (table["interval"] == "printed")].iloc[0]
    assert (row["n_runs"], row["n_aerial"], row["n_terrestrial"]) == (5, 4, 1)
    assert (row["n_positive_all"], row["n_negative_all"]) == (2, 1)
    assert (row["n_positive_aerial"], row["n_positive_terrestrial"]) == (2, 0)
    assert (row["r_least"], row["r_largest"]) == (-0.6, 0.8)


def test_a_cohort_whose_ratings_never_vary_has_an_empty_table(joined, tmp_path):
    table = run_tables.within_runs_table(joined["models/within_runs"].iloc[:0])
    assert table.empty
    assert list(table.columns) == list(
        run_tables.within_runs_table(joined["models/within_runs"]).columns
    )
    TABLE_STYLES["within_runs"].write(table, tmp_path / "within_runs.csv", simulated=False)
    assert np.isnan(run_tables.confounded_share(joined["models/within_runs"].iloc[:0]))


def test_share_that_time_explains(joined):
    own = joined["models/within_runs"]
    contact = own[own["measure"] == "contact_time_s"]
    assert run_tables.confounded_share(contact) == pytest.approx(1 / 3)
    assert np.isnan(run_tables.confounded_share(contact[contact["run"] == "P03_01"]))


def test_repeated_runs_are_compared_with_other_runners():
    frame = pd.DataFrame({"participant": list("AABB"), "affective_valence": [1.0, 1.1, 4.0, 4.1]})
    assert run_tables.runs_are_alike(frame) is True
    frame["affective_valence"] = [1.0, 4.0, 1.1, 4.1]
    assert run_tables.runs_are_alike(frame) is False
    assert run_tables.runs_are_alike(frame.iloc[[0, 2]]) is None


def test_errors_are_judged_in_the_unit_of_their_limit(errors):
    table = truth_tables.truth_errors(errors, LIMITS)
    sizes = 0.5 + 0.09 * np.arange(len(made.MEASURED))
    signs = {"duty_factor": -1, "stride_length_pct": -1, "initial_contact_bias_ms": -1}
    for name, limit in vars(LIMITS).items():
        np.testing.assert_allclose(table[name], signs.get(name, 1) * sizes * limit, rtol=1e-9)
    assert (table["outside"] == 0).all()


def test_a_limit_that_one_run_exceeds_is_not_kept(errors):
    wrong = errors.copy()
    at = (wrong["run"] == "P02_01") & (wrong["measure"] == "contact_time_s")
    wrong.loc[at, "error"] = -0.0125
    table = truth_tables.truth_summary(wrong, LIMITS).set_index("measure")
    row = table.loc["Contact Time"]
    assert (row["within"], row["worst_run"], row["limit_unit"]) == ("no", "P02_01", "ms")
    assert row["worst_judged"] == pytest.approx(12.5)
    assert table.loc["Stride Time", "within"] == "yes"
    assert table.loc["Heart Rate", "within"] == ""
    outside = truth_tables.truth_errors(wrong, LIMITS).set_index("run")["outside"]
    assert outside["P02_01"] == 1
    assert outside.sum() == 1


def test_a_missing_error_is_not_judged(errors):
    lost = errors.copy()
    at = (lost["run"] == "P02_01") & (lost["measure"] == "peak_tibial_g")
    lost.loc[at, ["estimate", "error"]] = np.nan
    table = truth_tables.truth_errors(lost, LIMITS).set_index("run")
    assert np.isnan(table.loc["P02_01", "peak_tibial_pct"])
    assert table.loc["P02_01", "outside"] == 0


def test_attainable_beside_printed_and_measured():
    rows = made.association_rows()
    table = chance_tables.attainable_table(population(), rows, 0.05)
    assert len(table) == len(MEASURE_KEYS) * len(SCALES)
    first = table.iloc[0]
    assert (first["r_printed"], first["r_attainable"], first["r_measured"]) == (0.8, 0.7, 0.8)
    assert first["distance"] == pytest.approx(-0.1)
    assert (first["covered"], first["significant"]) == (1, 1)
    assert table["covered"].iloc[1] == 0
    assert pd.isna(table["covered"].iloc[5])


def test_chance_is_counted_beside_the_cohort(joined):
    null = null_associations(
        joined["observations/runs"],
        pd.DataFrame({"run": made.RUNS, **{scale: np.arange(7.0) ** 2 for scale in SCALES}}),
        0.95,
    )
    table = chance_tables.null_cohort_table(made.association_rows(), null, printed(), 0.05)
    row = table.iloc[0]
    assert (row["group"], row["scale"], row["n_rows"]) == ("all", "affective_valence", 37)
    assert row["expected_by_chance"] == pytest.approx(1.85)
    assert row["n_cohort"] == 37
    assert table.loc[(table["group"] == "all"), "n_printed"].tolist() == [3, 1, 3]
    assert table.loc[(table["group"] == "aerial"), "n_printed"].tolist() == [9, 1, 5]
    assert table["n_null"].tolist()[0] == int(
        (null[(null["group"] == "all") & (null["scale"] == "affective_valence")]["p"] <= 0.05).sum()
    )


def test_stages_are_read_from_their_folders(tmp_path):
    cohort, variant = tmp_path / "cohort", tmp_path / "cohort" / "printed"
    made.write_stages(cohort, variant)
    stages = StageTables(cohort, variant, made.RUNS)
    strides = stages.of_runs("strides")
    assert strides["run"].unique().tolist() == list(made.MEASURED)
    assert len(stages.joined("answers/scores")) == len(made.RUNS)
    assert stages.checks()["excluded"].tolist() == [False] * 6 + [True]
    assert stages.checks()["missing_sensors"].tolist()[4] == "head"
    shared = StageTables(cohort, tmp_path / "other", made.RUNS, measured=variant)
    assert len(shared.of_run("strides", "P01_01")) == len(made.stride_rows("P01_01"))
    assert participant_of("A_b_02") == "A_b"


def test_options_are_read_strictly():
    tables_section = {
        "significance_level": 0.05,
        "moderate_r": 0.4,
        "strong_r": 0.7,
        "majority": 0.5,
        "limits": vars(LIMITS),
    }
    cutoffs = {"aerial_below": 0.276, "terrestrial_above": 0.288}
    assert table_options(tables_section, cutoffs) == OPTIONS
    with pytest.raises(Exception, match="keys do not match"):
        table_options({**tables_section, "more": 1}, cutoffs)
