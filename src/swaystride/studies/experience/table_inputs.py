"""Files between the stages, joined over the runs, for the result tables and figures."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import pandas as pd

#: Columns that are names even where they look like numbers.
NAME_COLUMNS: Final = ("run", "participant")


@dataclass(frozen=True)
class StageTables:
    """Folders of one cohort and variant, and whose files are read.

    Parameters
    ----------
    cohort : Path
        Holds what all variants share: ``answers`` and ``quality``.
    variant : Path
        Holds ``observations`` and ``models`` of all runs.
    runs : sequence of str
        Names of the runs in the order of the lab's table, ``P01_01``.
    measured : Path, optional
        Holds ``strides``, ``windows``, ``runs`` and ``truth`` of single runs, if the variant shares
        those of another; else they lie beside the models.
    """

    cohort: Path
    variant: Path
    runs: Sequence[str]
    measured: Path | None = None

    def of_runs(self, kind: str) -> pd.DataFrame:
        """Rows of one kind of all runs, with their column ``run``.

        Parameters
        ----------
        kind : str
            Name of the folder, for example ``strides``.
        """
        tables = [self.of_run(kind, run) for run in self.runs]
        filled = [table for table in tables if len(table)]
        return pd.concat(filled, ignore_index=True) if filled else tables[0]

    def of_run(self, kind: str, run: str) -> pd.DataFrame:
        """Rows of one run, with their column ``run``.

        Parameters
        ----------
        kind : str
        run : str
        """
        table = pd.read_parquet((self.measured or self.variant) / kind / f"{run}.parquet")
        if "run" not in table:
            table.insert(0, "run", run)
        return _named(table)

    def joined(self, name: str) -> pd.DataFrame:
        """A table of all runs that a stage wrote as one.

        Parameters
        ----------
        name : str
            For example ``models/associations`` or ``answers/scores``.
        """
        folder = self.cohort if name.startswith("answers/") else self.variant
        return _named(pd.read_parquet(folder / f"{name}.parquet"))

    def checks(self) -> pd.DataFrame:
        """What the import says of every run.

        Returns
        -------
        DataFrame
            ``run``, ``participant``, ``excluded``, ``reason``, ``duration_s``, ``missing_sensors``
            (joined by commas).
        """
        rows: list[dict[str, Any]] = []
        for run in self.runs:
            file = self.cohort / "quality" / "runs" / f"{run}.json"
            said = json.loads(file.read_text(encoding="utf-8"))
            missing = ", ".join(said.get("missing_sensors", ()))
            rows.append({**said, "participant": participant_of(run), "missing_sensors": missing})
        columns = ["run", "participant", "excluded", "reason", "duration_s", "missing_sensors"]
        return pd.DataFrame(rows).reindex(columns=columns)


def participant_of(run: str) -> str:
    """Participant of a run, from its name.

    Parameters
    ----------
    run : str

    Examples
    --------
    >>> participant_of("P01_02")
    'P01'
    """
    return run.rpartition("_")[0]


def _named(table: pd.DataFrame) -> pd.DataFrame:
    """Names as text."""
    return table.astype({name: "str" for name in NAME_COLUMNS if name in table})
