"""Tables between the stages are joined in the order of the participants; one trial is representative."""

import kinematics_results as made
import pandas as pd
import pytest

from swaystride.errors import DesignError
from swaystride.studies.kinematics.representative import (
    representative_trial,
    trial_contacts,
    trial_rows,
)
from swaystride.studies.kinematics.table_inputs import StageTables

KINDS = ("strides", "agreement", "planar")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    root = tmp_path_factory.mktemp("printed")
    made.write_tables(root, {kind: made.frames()[kind] for kind in KINDS})
    return root


@pytest.mark.parametrize("kind", KINDS)
def test_what_was_written_is_read(folder, kind):
    found = StageTables(folder, made.PARTICIPANTS).read(kind)
    pd.testing.assert_frame_equal(found, made.frames()[kind], check_dtype=False)


def test_participants_stand_in_the_order_of_the_lab(folder):
    found = StageTables(folder, ["P03", "P01"]).read("planar")
    assert found["participant"].unique().tolist() == ["P03", "P01"]


def test_a_participant_without_trials_adds_nothing(folder):
    empty = made.frames()["agreement"].iloc[:0]
    empty.to_parquet(folder / "agreement" / "P00.parquet", index=False)
    stages = StageTables(folder, ["P00", *made.PARTICIPANTS])
    agreement = stages.read("agreement")
    assert len(agreement) == len(made.frames()["agreement"])
    assert representative_trial(agreement) == ("P01", "01")
    assert StageTables(folder, ["P00"]).read("agreement").empty


def test_tables_of_one_participant_are_named_after_it(folder):
    (folder / "curves").mkdir()
    pd.DataFrame({"trial": [1]}).to_parquet(folder / "curves" / "P02.parquet")
    own = StageTables(folder, ["P02"]).read_participant("curves", "P02")
    assert own.to_numpy().tolist() == [["P02", "1"]]


def test_without_a_trial_there_is_no_representative():
    with pytest.raises(DesignError, match="no trial was analysed"):
        representative_trial(made.frames()["agreement"].iloc[:0])


def test_a_stride_of_many_features_is_one_contact():
    own = trial_rows(made.frames()["strides"], "P02", "02")
    contacts = trial_contacts(own)
    assert len(contacts) == 2 * made.N_STRIDES
    right = contacts[contacts["side"] == "right"]
    assert right["stride"].tolist() == list(range(11, 11 + made.N_STRIDES))
    assert (right["next_contact_s"] > right["initial_contact_s"]).all()
