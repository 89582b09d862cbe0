"""Settings of all tests."""

from __future__ import annotations

import os
from pathlib import Path, PurePosixPath

import pytest
from hypothesis import settings
from xdist.scheduler import LoadScopeScheduling

# The processes of a run share the processors: threads of linear algebra would wait for each other,
# ten times as long as they compute. Set before NumPy is loaded; processes of xdist inherit it.
for _library in ("OMP", "OPENBLAS"):
    os.environ.setdefault(f"{_library}_NUM_THREADS", "1")

# How long an example takes says nothing about its result: timing belongs in benchmarks.
settings.register_profile("no_deadline", deadline=None)
settings.load_profile("no_deadline")

_TESTS = Path(__file__).parent


class FolderScheduling(LoadScopeScheduling):
    """Keep the tests of a folder in one process.

    Folders share what is expensive to make (simulated recordings, built cohorts) by fixtures of the
    session, which every process would otherwise make for itself.
    """

    def _split_scope(self, nodeid: str) -> str:
        return str(PurePosixPath(nodeid.split("::")[0]).parent)


def pytest_xdist_make_scheduler(config: pytest.Config, log: object) -> FolderScheduling:
    """Schedule by folders, whatever ``--dist`` says."""
    return FolderScheduling(config, log)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with the folder that takes longest."""
    items.sort(key=lambda item: not item.path.is_relative_to(_TESTS / "workflow"))
