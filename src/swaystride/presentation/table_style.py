"""How one result table is presented: caption, notes and number formats."""

from __future__ import annotations

from collections.abc import Callable, Mapping
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
    arrange : callable, optional
        Arranges the table for people; the CSV keeps its rows.
    arranged_formats : mapping of str to str or int
        Formats of the columns of the arranged table.
    labels : mapping of str to str
        Words for columns, in the renderings for people.
    """

    caption: str
    notes: tuple[str, ...] = ()
    formats: Mapping[str, str | int] = field(default_factory=dict)
    arrange: Callable[[pd.DataFrame], pd.DataFrame] | None = None
    arranged_formats: Mapping[str, str | int] = field(default_factory=dict)
    labels: Mapping[str, str] = field(default_factory=dict)

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
            labels=self.labels,
            shown=None if self.arrange is None else self.arrange(frame),
            shown_formats=self.arranged_formats,
        )
