"""Claims of the chapter hold on results that support them and fail on results that do not."""

from dataclasses import replace

import pandas as pd
import pytest

from import_graph import REPOSITORY
from swaystride.presentation.table_files import read_table
from swaystride.studies.experience.claims import CLAIMS, Evidence, claims_table
from swaystride.studies.experience.plan import MEASURES
from swaystride.studies.experience.table_options import TableOptions, TruthLimits

OPTIONS = TableOptions(0.05, 0.4, 0.7, 0.5, 0.276, 0.288, TruthLimits(*[1.0] * 12))
#: What these recordings cannot say.
UNTESTABLE = {
    "Terrestrial runs may have other associations than aerial ones.",
    "Reporting affect during the run may have changed enjoyment and flow.",
}
#: A claim of abstract and conclusion that the tables break (register I-28).
BROKEN = {
    "Higher enjoyment with more attenuation of the lower body (the tables have none, register I-28)."
}


def printed(name):
    return read_table(REPOSITORY / "data" / "published" / f"{name}.csv")


@pytest.fixture
def evidence():
    """The printed tables, and counts within runs as the text describes them."""
    within = pd.DataFrame(
        {
            "measure": [measure.name for measure in MEASURES],
            "interval": "printed",
            "n_runs": 20,
            "n_aerial": 16,
            "n_terrestrial": 4,
            "n_positive_all": 5,
            "n_negative_all": 3,
            "n_positive_aerial": 5,
            "n_negative_aerial": 2,
            "n_positive_terrestrial": 0,
            "n_negative_terrestrial": 1,
        }
    )
    return Evidence(
        associations={"all": printed("table_5_3"), "aerial": printed("table_5_4")},
        within=within,
        confounded_share=0.7,
        text=printed("study5_text"),
        patterns=pd.Series(["aerial"] * 18 + ["terrestrial"] * 5),
        runs_are_alike=True,
        options=OPTIONS,
    )


def verdicts(evidence):
    return claims_table(evidence).set_index("claim")["reproduced"]


def test_the_print_supports_its_own_claims(evidence):
    found = verdicts(evidence)
    assert len(found) == len(CLAIMS)
    assert set(found[found == "not testable"].index) == UNTESTABLE
    assert set(found[found == "no"].index) == BROKEN
    assert (found.drop([*UNTESTABLE, *BROKEN]) == "yes").all()


def test_what_cannot_be_tested_has_no_parts(evidence):
    table = claims_table(evidence)
    assert (table.loc[table["reproduced"] == "not testable", "holds"] == "").all()


def changed(evidence, group, measure, scale, **columns):
    """One association replaced, for example by one without significance."""
    table = evidence.associations[group].copy()
    at = (table["measure"] == measure) & (table["scale"] == scale)
    table.loc[at, list(columns)] = list(columns.values())
    return replace(evidence, associations={**evidence.associations, group: table})


@pytest.mark.parametrize(
    ("group", "measure", "scale", "columns", "claim", "verdict"),
    [
        ("aerial", "Speed", "affective_valence", {"p": 0.06},
         "Higher affect with lower speed, aerial runs.", "no"),
        ("aerial", "Speed", "affective_valence", {"r": 0.5},
         "Higher affect with lower speed, aerial runs.", "no"),
        ("all", "Peak Head Acceleration", "flow", {"p": 0.2},
         "Higher flow with higher peak head acceleration.", "partly"),
        ("all", "Heart Rate", "affective_valence", {"p": 0.01},
         "Heart rate is not associated with affect.", "partly"),
        ("all", "Speed", "activity_enjoyment", {"p": 0.01},
         "Enjoyment is associated with nothing else.", "partly"),
        ("all", "Foot-Shank ES Coordination Variability", "affective_valence", {"p": 0.01},
         "Coordination variability is hardly associated with affect (at most one of twelve).",
         "partly"),
    ],
)  # fmt: skip
def test_another_result_breaks_a_claim(evidence, group, measure, scale, columns, claim, verdict):
    assert verdicts(changed(evidence, group, measure, scale, **columns))[claim] == verdict


def test_a_row_that_was_not_estimated_is_no_part(evidence):
    lost = changed(evidence, "all", "Heart Rate", "affective_valence", p=float("nan"))
    table = claims_table(lost).set_index("claim")
    assert table.loc["Heart rate is not associated with affect.", "holds"] == "1 of 1"


@pytest.mark.parametrize(
    ("changes", "claim", "verdict"),
    [
        ({"patterns": pd.Series(["aerial", "intermediate"])},
         "No run lies between the cut-offs.", "no"),
        ({"patterns": pd.Series(["aerial", "terrestrial"])}, "Most runs are aerial.", "no"),
        ({"runs_are_alike": None},
         "Affect of repeated runs of one runner is more alike than that of different runners.",
         "not testable"),
        ({"confounded_share": 0.2},
         "Many of them are confounded with time (most are not significant once time is held "
         "constant).", "no"),
        ({"confounded_share": float("nan")},
         "Many of them are confounded with time (most are not significant once time is held "
         "constant).", "not testable"),
    ],
)  # fmt: skip
def test_other_runs_break_a_claim(evidence, changes, claim, verdict):
    assert verdicts(replace(evidence, **changes))[claim] == verdict


def test_without_estimates_nothing_is_testable(evidence):
    empty = {group: table.assign(p=float("nan")) for group, table in evidence.associations.items()}
    found = verdicts(
        replace(
            evidence,
            associations=empty,
            within=evidence.within.iloc[:0],
            text=evidence.text.assign(p=float("nan")),
        )
    )
    assert found["Higher flow with higher peak head acceleration."] == "not testable"
    assert (
        found["Flow and enjoyment are moderately correlated, affect with neither."]
        == "not testable"
    )
    assert (
        found["Every measure has a significant correlation with affect within at least one run."]
        == "not testable"
    )
    assert found["Most runs are aerial."] == "yes"


def test_a_majority_in_one_pattern_is_one(evidence):
    within = evidence.within.copy()
    within.loc[0, "n_positive_terrestrial"] = 3
    claim = "No measure has it, with one sign, in the majority of all, aerial or terrestrial runs."
    table = claims_table(replace(evidence, within=within)).set_index("claim")
    assert table.loc[claim, "holds"] == "36 of 37"


def test_a_measure_without_any_significant_run(evidence):
    within = evidence.within.copy()
    within.loc[3, ["n_positive_all", "n_negative_all"]] = 0
    claim = "Every measure has a significant correlation with affect within at least one run."
    assert verdicts(replace(evidence, within=within))[claim] == "partly"
