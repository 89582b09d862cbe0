"""Tables between the stages, joined over the participants, for the result tables and figures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from swaystride.studies.kinematics.summaries import TRIAL_KEYS


@dataclass(frozen=True)
class StageTables:
    """Folder of one variant, and whose files are read.

    Parameters
    ----------
    folder : Path
        Holds ``<kind>/<participant>.parquet``.
    participants : sequence of str
        In the order of the lab's table.
    """

    folder: Path
    participants: Sequence[str]

    def read(self, kind: str) -> pd.DataFrame:
        """Rows of one kind of all participants, trials and participants as text.

        Parameters
        ----------
        kind : str
            Name of the folder, for example ``strides``.
        """
        tables = [self.read_participant(kind, name) for name in self.participants]
        filled = [table for table in tables if len(table)]
        return pd.concat(filled, ignore_index=True) if filled else tables[0]

    def read_participant(self, kind: str, participant: str) -> pd.DataFrame:
        """Rows of one participant.

        Parameters
        ----------
        kind : str
        participant : str
        """
        table = pd.read_parquet(self.folder / kind / f"{participant}.parquet")
        if "participant" not in table:
            table.insert(0, "participant", participant)
        return table.astype(dict.fromkeys(TRIAL_KEYS, "str"))


def planned_trials(trials: pd.DataFrame) -> pd.DataFrame:
    """Trials that the lab lists, once each.

    Parameters
    ----------
    trials : DataFrame
        The lab's ``trials.tsv``, with several files per trial.

    Returns
    -------
    DataFrame
        ``participant`` and ``trial``, in the order of the table.
    """
    return trials[list(TRIAL_KEYS)].astype(str).drop_duplicates().reset_index(drop=True)
