"""Settings of all tests."""

from __future__ import annotations

from hypothesis import settings

# How long an example takes says nothing about its result: timing belongs in benchmarks.
settings.register_profile("no_deadline", deadline=None)
settings.load_profile("no_deadline")
