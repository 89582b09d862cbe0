"""The walking chain that several tests use."""

import pytest
from rigid_chain import WALKING, chain


@pytest.fixture(scope="session")
def walk():
    return chain(WALKING, duration_s=30.0, rate_hz=100.0)
