"""Designs with known structure, and a slow independent twin of the likelihood."""

from collections.abc import Callable

import numpy as np
import pandas as pd
import pytest


@pytest.fixture
def one_way() -> Callable[..., pd.DataFrame]:
    """Balanced one-way layout with a covariate within groups and one between groups."""

    def make(groups: int = 8, size: int = 5, sd: float = 1.0, seed: int = 0) -> pd.DataFrame:
        rng = np.random.default_rng(seed)
        who = np.repeat(np.arange(groups), size)
        frame = pd.DataFrame({"who": who, "x": np.tile(np.arange(size), groups) - (size - 1) / 2})
        frame["z"] = rng.normal(size=groups)[who]
        frame["y"] = 1.0 + 0.5 * frame["x"] + sd * rng.normal(size=groups)[who]
        frame["y"] += rng.normal(size=len(frame))
        return frame

    return make


@pytest.fixture
def crossed() -> Callable[..., pd.DataFrame]:
    """Unbalanced ratings: exercises within patients, raters across them, three trials."""

    def make(seed: int = 0) -> pd.DataFrame:
        rng = np.random.default_rng(seed)
        rows = [
            (p, e, r, t)
            for p in range(6)
            for e in rng.permutation(5)[:4]
            for r in rng.permutation(5)[:3]
            for t in range(3)
        ]
        frame = pd.DataFrame(rows, columns=["p", "e", "r", "t"])
        frame = frame.sample(frac=0.9, random_state=seed).reset_index(drop=True)
        frame["x"] = rng.normal(size=len(frame))
        frame["y"] = frame["x"] + rng.normal(size=len(frame))
        for names, sd in [(["p"], 0.8), (["p", "e"], 0.7), (["r"], 0.5), (["p", "r"], 0.4)]:
            code = frame.groupby(names).ngroup().to_numpy()
            frame["y"] += sd * rng.normal(size=code.max() + 1)[code]
        return frame

    return make


@pytest.fixture(scope="session")
def twin_deviance() -> Callable[..., float]:
    """Minus twice the (restricted) log-likelihood with V written out."""

    def deviance(X, codes, y, gamma, *, reml, sigma2=None) -> float:
        n, p = X.shape
        H = np.eye(n)
        for ratio, code in zip(gamma, codes, strict=True):
            H += ratio * (code[:, None] == code[None, :])
        inverse = np.linalg.inv(H)
        A = X.T @ inverse @ X
        beta = np.linalg.solve(A, X.T @ inverse @ y) if p else np.empty(0)
        rest = y - X @ beta
        S = rest @ inverse @ rest
        nu = n - p if reml else n
        sigma2 = S / nu if sigma2 is None else sigma2
        value = nu * np.log(2 * np.pi * sigma2) + S / sigma2 + np.linalg.slogdet(H)[1]
        return float(value + (np.linalg.slogdet(A)[1] if reml else 0.0))

    return deviance
