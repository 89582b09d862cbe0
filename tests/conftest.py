"""Settings of all tests."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import settings

# How long an example takes says nothing about its result: timing belongs in benchmarks.
settings.register_profile("no_deadline", deadline=None)
settings.load_profile("no_deadline")

_TESTS = Path(__file__).parent


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Keep the tests of a folder in one process, and begin with the longest ones.

    Folders share what is expensive to make (simulated recordings, built cohorts) by fixtures of the
    session, which every process would otherwise make for itself.
    """
    for item in items:
        item.add_marker(pytest.mark.xdist_group(str(item.path.parent)))
    items.sort(key=lambda item: not item.path.is_relative_to(_TESTS / "workflow"))
