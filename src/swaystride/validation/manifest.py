"""Which public recordings validation uses: source, licence and SHA-256 of every file.

The recordings themselves are not part of this repository. ``manifest.csv`` beside this module
names each file that validation opens, so that a reader can fetch the same bytes.
"""

from __future__ import annotations

from importlib.resources import files
from io import StringIO
from pathlib import Path

import pandas as pd

from swaystride.checksums import file_sha256
from swaystride.errors import RecordingError


def load_manifest(dataset: str) -> pd.DataFrame:
    """Files of one `dataset`: ``dataset``, ``file``, ``sha256``, ``source``, ``licence``.

    Raises
    ------
    RecordingError
        If the manifest knows no such data set.
    """
    text = files("swaystride.validation").joinpath("manifest.csv").read_text(encoding="utf-8")
    manifest = pd.read_csv(StringIO(text), dtype=str)
    chosen = manifest[manifest["dataset"] == dataset].reset_index(drop=True)
    if chosen.empty:
        raise RecordingError(
            "data set is not in the manifest",
            file="manifest.csv",
            expected="one of " + ", ".join(manifest["dataset"].unique()),
            found=dataset,
        )
    return chosen


def verified_files(folder: Path, dataset: str) -> list[Path]:
    """Paths of the files of a data set, after a check of every byte.

    Parameters
    ----------
    folder : Path
        The folder with public recordings (``real_data_dir``).
    dataset : str
        Name of the data set and of its subfolder.

    Raises
    ------
    RecordingError
        If a file is missing or differs from the one that the manifest describes.
    """
    paths = []
    for row in load_manifest(dataset).itertuples(index=False):
        path = folder / dataset / str(row.file)
        if not path.is_file():
            raise RecordingError("no such file", file=path, expected=f"from {row.source}")
        found = file_sha256(path)
        if found != row.sha256:
            raise RecordingError(
                "not the file that validation was written for",
                file=path,
                expected=f"sha256 {row.sha256}",
                found=found,
            )
        paths.append(path)
    return paths
