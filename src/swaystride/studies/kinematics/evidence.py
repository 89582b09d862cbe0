"""Everything that the claims of the chapter are judged by, built from the tables of the stages."""

from __future__ import annotations

import pandas as pd

from swaystride.studies.kinematics import tables
from swaystride.studies.kinematics.claims import Evidence
from swaystride.studies.kinematics.range_tests import table_4_4
from swaystride.studies.kinematics.summaries import TRIAL_KEYS
from swaystride.studies.kinematics.table_inputs import StageTables
from swaystride.studies.kinematics.table_options import TableOptions


def collect_evidence(
    stages: StageTables, published_4_4: pd.DataFrame, options: TableOptions
) -> Evidence:
    """Build the tables that the claims ask for.

    Parameters
    ----------
    stages : StageTables
    published_4_4 : DataFrame
        Printed Table 4.4, for its reference columns.
    options : TableOptions
    """
    strides, agreement = stages.read("strides"), stages.read("agreement")
    return Evidence(
        {
            "table_4_3": tables.table_4_3(agreement),
            "table_4_4": table_4_4(strides, published_4_4, options),
            "table_4_5": tables.table_4_5(strides),
            "table_4_6": tables.table_4_6(strides, options),
            "table_4_7": tables.table_4_7(strides),
            "table_4_8": tables.table_4_8(stages.read("perturbation"), None),
        },
        stages.read("course"),
        stages.read("planar"),
        len(strides.drop_duplicates([*TRIAL_KEYS, "side", "stride"])),
        options,
    )
