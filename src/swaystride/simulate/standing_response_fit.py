"""Fitting the response surface of standing sway on a designed set of simulated trials."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from itertools import product
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from swaystride.errors import ConfigurationError
from swaystride.simulate.response_terms import MAX_LN_NOISE_RATIO, monomials, scatter_terms
from swaystride.simulate.sampling import decimation_factor
from swaystride.simulate.seeds import generator
from swaystride.simulate.standing_body import lean_angles_deg, pendulum_paths, slow_movement
from swaystride.simulate.standing_model import StandingModel, TrialSettings
from swaystride.simulate.standing_response import FEATURES, INPUTS
from swaystride.sway.metrics import sway_metrics

Array = NDArray[np.float64]

#: The scatter is taken from this middle part of the range of both noise torques: at its ends drift
#: and breathing (small torques) or the sine of the lean (large ones) change it.
_WORKING_PART: Final = 0.5


@dataclass(frozen=True)
class ResponseDesign:
    """Size and range of the designed set.

    Parameters
    ----------
    ln_noise_ap, ln_noise_ml, activity, pendulum_height_m : tuple of float
        Lowest and highest value of each input.
    n_runs : int
        Points of a scrambled Sobol sequence, one simulated run each; a power of two.
    trials_per_run : int
        Consecutive trials that are cut from one run.
    degree : int
        Total degree of the polynomials.
    seed : int
        Seed of the sequence and of the noise.
    """

    ln_noise_ap: tuple[float, float]
    ln_noise_ml: tuple[float, float]
    activity: tuple[float, float]
    pendulum_height_m: tuple[float, float]
    n_runs: int
    trials_per_run: int
    degree: int
    seed: int


def fit_standing_response(
    model: StandingModel, trial: TrialSettings, design: ResponseDesign
) -> dict[str, Any]:
    """Simulate the designed set and fit the surface.

    Parameters
    ----------
    model, trial : StandingModel, TrialSettings
        Settings of body and trial.
    design : ResponseDesign
        The designed set.

    Returns
    -------
    dict
        Record of ``standing_response.json``.

    Raises
    ------
    ConfigurationError
        If a trial of the designed set is not one of a standing person.
    """
    points = design_points(design)
    runs = [
        simulate_run(model, trial, point, design.trials_per_run, generator(design.seed, f"run {i}"))
        for i, point in enumerate(points)
    ]
    features = np.stack([run[0] for run in runs])
    if not np.all(np.isfinite(features)) or np.exp(features[..., 0].max()) > 45.0:
        raise ConfigurationError("the designed set reaches into falling", place="activity")
    return {
        "ranges": {name: list(getattr(design, name)) for name in INPUTS},
        **_fitted(features, np.stack([run[1] for run in runs]), points, design),
        "model": asdict(model),
        "trial": asdict(trial),
    }


def design_points(design: ResponseDesign) -> Array:
    """Inputs of the designed set, shape (n_runs, 4).

    A scrambled Sobol sequence, drawn towards the middle of each range, where people stand, with
    a density that falls off like a cosine.

    Parameters
    ----------
    design : ResponseDesign
        Size, ranges and seed.
    """
    sequence = qmc.Sobol(d=len(INPUTS), rng=generator(design.seed, "design"))
    unit = sequence.random_base2(int(np.log2(design.n_runs)))
    ranges = np.array([getattr(design, name) for name in INPUTS])
    centred = np.arcsin(2.0 * unit - 1.0) * 2.0 / np.pi
    return np.asarray(ranges.mean(axis=1) + centred * np.ptp(ranges, axis=1) / 2.0)


def simulate_run(
    model: StandingModel,
    trial: TrialSettings,
    point: Array,
    n_trials: int,
    rng: np.random.Generator,
) -> tuple[Array, Array]:
    """Log features of consecutive trials of one long run.

    Consecutive trials share the physical inputs and the warm-up; drift and breathing have phases
    of their own in each trial.

    Parameters
    ----------
    model, trial : StandingModel, TrialSettings
        Settings of body and trial.
    point : ndarray, shape (4,)
        Inputs of the response surface.
    n_trials : int
        How many trials.
    rng : numpy.random.Generator
        Source of all random numbers.

    Returns
    -------
    ln_features : ndarray, shape (n_trials, 3)
        In the order of :data:`~swaystride.simulate.standing_response.FEATURES`.
    fisher_z : ndarray, shape (n_trials,)
        Fisher's z of the correlation of AP and ML sway.
    """
    # Mass cancels: all torques are proportional to it.
    parameters = model.parameters(
        ln_noise_ap=point[0],
        ln_noise_ml=point[1],
        activity=point[2],
        coupling=model.draw_coupling(rng),
        mass_kg=model.reference_mass_kg,
        pendulum_height_m=point[3],
    )
    factor = decimation_factor(trial.simulation_rate_hz, trial.rate_hz)
    n_warm_up = round(trial.warm_up_s * trial.simulation_rate_hz)
    n_steps = n_warm_up + n_trials * trial.n_samples * factor
    angle, _ = pendulum_paths(
        parameters, n_steps=n_steps, rate_hz=trial.simulation_rate_hz, rng=rng
    )
    windows = angle[:, n_warm_up:-1:factor].reshape(2, n_trials, trial.n_samples).swapaxes(0, 1)
    time_s = np.arange(trial.n_samples) / trial.rate_hz
    slow = slow_movement(parameters, time_s, rng.uniform(0.0, 2.0 * np.pi, size=(n_trials, 3)))
    sway = trial.filtered(lean_angles_deg(windows + slow[0]))
    measures = [sway_metrics(ap, ml, trial.rate_hz) for ap, ml in sway]
    centred = sway - sway.mean(axis=-1, keepdims=True)
    correlation = np.prod(centred, axis=1).mean(axis=-1) / np.prod(sway.std(axis=-1), axis=-1)
    ln_features = np.log([[row[name] for name in FEATURES] for row in measures])
    return ln_features, np.arctanh(correlation)


def _fitted(
    features: Array, fisher_z: Array, points: Array, design: ResponseDesign
) -> Mapping[str, Any]:
    """Coefficients of surface and scatter by least squares, and the quality of the fit."""
    n_runs, n_trials, _ = features.shape
    ranges = np.array([getattr(design, name) for name in INPUTS])
    scaled = (2.0 * points - ranges.sum(axis=1)) / np.ptp(ranges, axis=1)
    exponents = np.array(
        [
            e
            for e in product(range(design.degree + 1), repeat=len(INPUTS))
            if sum(e) <= design.degree
        ]
    )
    terms = monomials(scaled, exponents)
    means = features.mean(axis=1)
    coefficients = np.zeros((len(exponents), len(FEATURES)))
    lack = np.zeros(len(FEATURES))
    for f in range(len(FEATURES)):
        # AP sway does not depend on the ML noise, nor the other way round.
        used = exponents[:, 1 - f] == 0 if f < 2 else np.ones(len(exponents), dtype=bool)
        coefficients[used, f] = np.linalg.lstsq(terms[:, used], means[:, f], rcond=None)[0]
        misfit = means[:, f] - terms @ coefficients[:, f]
        # Variance of the runs' means about the surface, beyond what single trials explain.
        within = features[:, :, f].var(axis=1, ddof=1).mean() / n_trials
        lack[f] = misfit @ misfit / (n_runs - used.sum()) - within
    residual = features - (terms @ coefficients)[:, None, :]
    rows, columns = np.triu_indices(len(FEATURES))
    products = (residual[..., rows] * residual[..., columns]).mean(axis=1)
    ln_ratio = points[:, 0] - points[:, 1]
    working = (np.abs(scaled[:, :2].mean(axis=1)) <= _WORKING_PART) & (
        np.abs(ln_ratio) <= MAX_LN_NOISE_RATIO
    )
    basis = scatter_terms(scaled[working, 2], ln_ratio[working])
    scatter = np.linalg.lstsq(basis, products[working], rcond=None)[0]
    fisher = np.linalg.lstsq(basis, (fisher_z[working] ** 2).mean(axis=1), rcond=None)[0]
    rmse = np.sqrt((residual**2).mean(axis=(0, 1)))
    return {
        "exponents": exponents.tolist(),
        "coefficients": {name: _rounded(coefficients[:, f]) for f, name in enumerate(FEATURES)},
        "scatter_covariance": [_rounded(column) for column in scatter.T],
        "fisher_z_variance": _rounded(fisher),
        "fit": {
            "n_trials": n_runs * n_trials,
            "n_runs": n_runs,
            "trials_per_run": n_trials,
            "degree": design.degree,
            "seed": design.seed,
            "rmse_single_trial": {
                n: round(float(v), 5) for n, v in zip(FEATURES, rmse, strict=True)
            },
            "variance_beyond_scatter_of_trials": {
                n: round(float(v), 7) for n, v in zip(FEATURES, lack, strict=True)
            },
        },
    }


def _rounded(values: Array) -> list[float]:
    """Ten significant digits: more than the fit is worth, and the same text everywhere."""
    return [float(f"{value:.10g}") for value in values]
