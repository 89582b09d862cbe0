"""How one result table is presented: caption, notes and number formats."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd

from swaystride.presentation.table_files import write_table


@dataclass(frozen=True)
class TableStyle:
    """How one table is written.

    Parameters
    ----------
    caption : str
    notes : tuple of str
    formats : mapping of str to str or int
        See :func:`swaystride.presentation.number_format.parse_format`.
    """

    caption: str
    notes: tuple[str, ...] = ()
    formats: Mapping[str, str | int] = field(default_factory=dict)

    def write(self, frame: pd.DataFrame, output: Path, *, simulated: bool) -> None:
        """Write a table in all renderings.

        Parameters
        ----------
        frame : DataFrame
            The table.
        output : Path
            Any of its files; the suffix is replaced.
        simulated : bool
            Whether the cohort is simulated.
        """
        write_table(
            frame,
            output.with_suffix(""),
            caption=self.caption,
            notes=self.notes,
            formats=self.formats,
            simulated=simulated,
        )
