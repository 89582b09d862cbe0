"""Random numbers belong to names, not to positions."""

import hashlib

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from swaystride.simulate.seeds import generator

NAMES = st.lists(st.text(min_size=1, max_size=8), min_size=1, max_size=3).map(tuple)


@given(st.integers(0, 2**63), NAMES)
def test_a_name_always_gives_the_same_numbers(seed, ids):
    first, second = (generator(seed, *ids).random(4) for _ in range(2))
    assert np.array_equal(first, second)


@given(st.integers(0, 2**63), NAMES, NAMES)
def test_different_names_give_different_numbers(seed, ids, others):
    same = np.array_equal(generator(seed, *ids).random(2), generator(seed, *others).random(2))
    assert same == (ids == others)


def test_numbers_do_not_depend_on_who_else_is_there():
    def cohort(names):
        return {name: generator(3, "feedback", name).standard_normal(5) for name in names}

    small, large = cohort(["P01", "P02"]), cohort(["P00", "P02", "P01", "P99"])
    assert all(np.array_equal(small[name], large[name]) for name in small)


def test_the_spawn_key_is_the_first_bytes_of_the_sha256():
    key = int(hashlib.sha256(b"P01").hexdigest()[:8], 16)
    expected = np.random.default_rng(np.random.SeedSequence(11, spawn_key=(key,)))
    assert np.array_equal(generator(11, "P01").random(3), expected.random(3))


def test_streams_of_participants_are_uncorrelated():
    draws = np.array([generator(5, f"P{i:02d}").standard_normal(2000) for i in range(20)])
    correlation = np.corrcoef(draws)[np.triu_indices(20, 1)]
    assert np.abs(correlation).max() < 5 / np.sqrt(2000)
