"""Everything that the claims of the chapter are judged by, built from the tables of the stages."""

from __future__ import annotations

import pandas as pd

from swaystride.studies.experience.claims import GROUPS, Evidence
from swaystride.studies.experience.run_tables import (
    confounded_share,
    runs_are_alike,
    within_runs_table,
)
from swaystride.studies.experience.table_inputs import StageTables
from swaystride.studies.experience.table_options import TableOptions
from swaystride.studies.experience.tables import association_table
from swaystride.studies.experience.text_table import study5_text


def collect_evidence(stages: StageTables, runs: pd.DataFrame, options: TableOptions) -> Evidence:
    """Build the tables that the claims ask for.

    Parameters
    ----------
    stages : StageTables
    runs : DataFrame
        The lab's ``runs.tsv``.
    options : TableOptions
    """
    associations = stages.joined("models/associations")
    within = stages.joined("models/within_runs")
    observations = stages.joined("observations/runs")
    affect, scores = stages.joined("answers/affect"), stages.joined("answers/scores")
    return Evidence(
        associations={
            group: association_table(associations, group, options.significance_level)
            for group in GROUPS
        },
        within=within_runs_table(within),
        confounded_share=confounded_share(within),
        text=study5_text(runs, observations, affect, scores, options),
        patterns=observations.loc[observations["pattern"] != "", "pattern"],
        runs_are_alike=runs_are_alike(observations),
        options=options,
    )
