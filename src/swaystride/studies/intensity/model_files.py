"""Files that the model jobs of this study leave in their folder."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import pandas as pd

#: Tables of results, in the order of the chapter.
_RESULTS: Final = (
    ("difficulty", "results"),
    ("kinematics", "correlations"),
    ("reliability", "results"),
    ("self_ratings", "results"),
    ("kinematics", "results"),
)


def model_table(folder: Path, block: str, name: str) -> pd.DataFrame:
    """One table of one block of the analysis.

    Parameters
    ----------
    folder : Path
        ``results/<cohort>/intensity/<variant>/models``.
    block : str
        As ``reliability``.
    name : str
        As ``components``.
    """
    return pd.read_parquet(folder / block / f"{name}.parquet")


def all_results(folder: Path) -> pd.DataFrame:
    """Results of all blocks, one row per quantity.

    Parameters
    ----------
    folder : Path
        ``results/<cohort>/intensity/<variant>/models``.
    """
    parts = [model_table(folder, block, name) for block, name in _RESULTS]
    return pd.concat(parts, ignore_index=True)
