"""Forward and backward pass over a recording, in pieces between checkpoints.

The forward pass of the smoother keeps the state and its covariance at checkpoints only; the steps
between two of them are computed again when the backward pass arrives there. So memory grows with
the number of checkpoints, not with that of the samples. Positions are re-centred at checkpoints:
the common part of all of them moves into an origin, which the result gets back.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from swaystride.erkf._filter_kernels import KernelModel, empty_record, filter_piece, padded_width
from swaystride.erkf._smoother_kernels import smooth_piece
from swaystride.erkf.body import Body
from swaystride.erkf.constraints import Constraint, as_row
from swaystride.erkf.noise import NoiseSet
from swaystride.erkf.options import FilterOptions
from swaystride.erkf.start import Start

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


class Estimate(NamedTuple):
    """Result of :func:`run_passes`.

    ``states`` (n_samples, n_segments, 13); ``angles`` and ``variances`` (n_samples, n_joints, 3),
    Cardan angles in rad without signs, and their variances; ``refused`` (n_constraints,);
    ``covariance``, that of the filter at the last sample.
    """

    states: Array
    angles: Array
    variances: Array
    refused: NDArray[np.int64]
    covariance: Array


def kernel_model(
    signals: Array,
    rate_hz: float,
    body: Body,
    noise: NoiseSet,
    options: FilterOptions,
    constraints: list[Constraint],
    active: Flags,
) -> KernelModel:
    """Everything that the compiled passes read, as plain arrays.

    Parameters
    ----------
    signals : ndarray, shape (n_samples, n_segments, 6)
        Accelerometers and gyroscopes.
    rate_hz : float
        Sampling rate.
    body : Body
    noise : NoiseSet
    options : FilterOptions
    constraints : list of Constraint
    active : ndarray of bool, shape (n_samples, n_constraints)

    Returns
    -------
    KernelModel
    """
    rows = [as_row(constraint) for constraint in constraints]
    return KernelModel(
        signals=signals,
        step_s=1.0 / rate_hz,
        midpoint=options.integrator == "midpoint",
        noise=np.array(noise.step_noise(rate_hz, with_bias=options.gyro_bias)),
        roughness=noise.integration_noise(signals, rate_hz),
        kind=np.array([row[0] for row in rows], dtype=np.int64),
        first=np.array([row[1] for row in rows], dtype=np.int64),
        second=np.array([row[2] for row in rows], dtype=np.int64),
        vectors=np.array([row[3] for row in rows]).reshape(-1, 6),
        sd=np.array([row[4] for row in rows]).reshape(-1, 3),
        active=active,
        gate=options.gate,
        patience=options.patience(rate_hz),
        joints=np.array(
            [(body.index(j.proximal), body.index(j.distal)) for j in body.joints], dtype=np.int64
        ).reshape(-1, 2),
        anatomical=np.ascontiguousarray(body.r_anatomical_from_sensor, dtype=np.float64),
    )


def run_passes(model: KernelModel, start: Start, options: FilterOptions, method: str) -> Estimate:
    """Forward pass and, for the smoother, the backward pass.

    Parameters
    ----------
    model : KernelModel
    start : Start
    options : FilterOptions
    method : {"filter", "smoother"}

    Returns
    -------
    Estimate
    """
    n, m = model.signals.shape[:2]
    smooth = method == "smoother"
    state, start_covariance = start.states(), start.covariance(with_bias=options.gyro_bias)
    size = len(start_covariance)
    p = np.zeros((size, padded_width(size)))
    p[:, :size] = start_covariance
    sizes = (m, len(model.noise), len(model.kind))
    spacing = options.checkpoint_spacing
    pieces = [(k, min(n, k + spacing)) for k in range(0, n, spacing)]
    states, angles, variances = _results(model)
    # the forward pass of the smoother leaves the results to the backward pass
    forward = (states[:0], angles, variances) if smooth else (states, angles, variances)
    refused = np.zeros(len(model.kind), dtype=np.int64)
    waiting = np.zeros_like(refused)
    origin = np.zeros(3)
    origins, checkpoints = [], []
    record = empty_record(1, *sizes)
    for begin, end in pieces:
        common = state[:, 0:3].mean(axis=0)
        state[:, 0:3] -= common
        origin = origin + common
        origins.append(origin)
        if smooth:
            checkpoints.append((state.copy(), p.copy(), waiting.copy()))
        filter_piece(model, begin, end, state, p, waiting, record, *forward, refused)
    if smooth:
        _smooth(model, pieces, checkpoints, (states, angles, variances))
    for (begin, end), shift in zip(pieces, origins, strict=True):
        states[begin:end, :, 0:3] += shift
    return Estimate(states, angles, variances, refused, p[:, :size])


def _smooth(
    model: KernelModel,
    pieces: list[tuple[int, int]],
    checkpoints: list[tuple[Array, Array, NDArray[np.int64]]],
    results: tuple[Array, Array, Array],
) -> None:
    """Backward pass: every piece once more forward with a full record, then back."""
    m, d, c = model.signals.shape[1], len(model.noise), len(model.kind)
    longest = max(end - begin for begin, end in pieces)
    # two slots at least: a record with one slot is overwritten at every sample
    record = empty_record(max(2, longest), m, d, c)
    adjoint, information = np.zeros(m * d), np.zeros((m * d, padded_width(m * d)))
    nothing = (results[0][:0], results[1], results[2])
    uncounted = np.zeros(c, dtype=np.int64)
    for begin, end in reversed(pieces):
        state, p, waiting = checkpoints.pop()
        filter_piece(model, begin, end, state, p, waiting, record, *nothing, uncounted)
        smooth_piece(model, begin, end, adjoint, information, record, *results)


def _results(model: KernelModel) -> tuple[Array, Array, Array]:
    """Empty states, angles and variances."""
    n, m = model.signals.shape[:2]
    angles, variances = np.empty((2, n, len(model.joints), 3))
    return np.empty((n, m, 13)), angles, variances
