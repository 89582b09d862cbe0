"""Random numbers that belong to a named thing: a participant, a trial, a sensor."""

from __future__ import annotations

import hashlib

import numpy as np


def generator(seed: int, *ids: str) -> np.random.Generator:
    """Random generator of one named unit.

    The spawn key is a fixed hash of the ids, not a position in a list, so that adding or removing
    a participant changes nobody else's data, on any machine and in any order of the jobs.

    Parameters
    ----------
    seed : int
        Seed of the cohort.
    *ids : str
        Path of stable names from coarse to fine, for example ``"feedback", "P01", "trial 03"``.

    Returns
    -------
    numpy.random.Generator

    Examples
    --------
    >>> a = generator(7, "feedback", "P01").standard_normal(3)
    >>> b = generator(7, "feedback", "P01").standard_normal(3)
    >>> c = generator(7, "feedback", "P02").standard_normal(3)
    >>> bool((a == b).all()), bool((a == c).any())
    (True, False)
    """
    sequence = np.random.SeedSequence(seed, spawn_key=tuple(_key(name) for name in ids))
    return np.random.Generator(np.random.PCG64(sequence))


def _key(name: str) -> int:
    """First four bytes of the SHA-256 of a name, as an unsigned integer."""
    return int.from_bytes(hashlib.sha256(name.encode("utf-8")).digest()[:4], "big")
