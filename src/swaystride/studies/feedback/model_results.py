"""What the model jobs wrote, read back for tables and figures."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from swaystride.studies.feedback.plan import FEATURES


def collect(folder: Path, name: str) -> pd.DataFrame:
    """Read one table of all six features, in the order of the chapter.

    Parameters
    ----------
    folder : Path
        ``…/models``, with one subfolder per feature.
    name : str
        For example ``contrasts``.
    """
    tables = [pd.read_parquet(folder / feature / f"{name}.parquet") for feature in FEATURES]
    return pd.concat(tables, ignore_index=True)
