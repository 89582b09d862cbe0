"""Compiled forward pass: predict, update by every active constraint, inject and reset."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from swaystride.erkf._angle_kernels import angle_variance, joint_angles
from swaystride.erkf._constraint_kernels import linearise
from swaystride.erkf._predict_kernels import predict_covariance, predict_segment
from swaystride.erkf._rotation_kernels import to_matrix
from swaystride.erkf._update_kernels import apply_constraint, inject, reset

Array = NDArray[np.float64]
Index = NDArray[np.int64]


class KernelModel(NamedTuple):
    """What stays the same during a recording, as plain arrays.

    m segments, c constraints, j joints, d = 9 or 12 states per segment, n samples.
    """

    signals: Array  # (n, m, 6)
    step_s: float
    midpoint: bool
    noise: Array  # (d,)
    roughness: Array  # (n, m, 2)
    kind: Index  # (c,)
    first: Index  # (c,)
    second: Index  # (c,)
    vectors: Array  # (c, 6)
    sd: Array  # (c, 3)
    active: NDArray[np.bool_]  # (n, c)
    gate: float
    patience: int  # samples
    joints: Index  # (j, 2)
    anatomical: Array  # (m, 3, 3)


class StepRecord(NamedTuple):
    """What the smoother needs of each step; `s` slots, w = ``padded_width(m d)``."""

    state: Array  # (s, m, 13)
    covariance: Array  # (s, m d, w)
    transition: Array  # (s, m, 9, 6)
    change: Array  # (s, m d)
    jacobian: Array  # (s, c, 2, 3, 12)
    gain: Array  # (s, c, 3, w)
    weighted: Array  # (s, c, 3)
    inverse: Array  # (s, c, 3, 3)
    used: NDArray[np.bool_]  # (s, c)


def padded_width(size: int) -> int:
    """Columns of a matrix whose rows are processed by vector instructions: a multiple of 16.

    Parameters
    ----------
    size : int
        Columns in use; the others stay nil.
    """
    return -(-size // 16) * 16


def empty_record(slots: int, m: int, d: int, c: int) -> StepRecord:
    """Make a record of some slots.

    Parameters
    ----------
    slots, m, d, c : int
        Steps, segments, states per segment, constraints.
    """
    width = padded_width(m * d)
    return StepRecord(
        np.empty((slots, m, 13)),
        np.empty((slots, m * d, width)),
        np.empty((slots, m, 9, 6)),
        np.empty((slots, m * d)),
        np.empty((slots, c, 2, 3, 12)),
        np.empty((slots, c, 3, width)),
        np.empty((slots, c, 3)),
        np.empty((slots, c, 3, 3)),
        np.zeros((slots, c), dtype=np.bool_),
    )


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def advance(
    model: KernelModel,
    k: int,
    state: Array,
    p: Array,
    waiting: Index,
    record: StepRecord,
    slot: int,
) -> None:
    """From the sample before to sample `k`, in place; sample 0 has no prediction.

    Parameters
    ----------
    model : KernelModel
    k : int
        Sample.
    state, p : array, shape (m, 13) and (m · d, w)
        Nominal states and covariance.
    waiting : array of int, shape (c,)
        Samples since each constraint was believed last; one that has waited longer than
        ``model.patience`` passes whatever the gate says.
    record : StepRecord
        All but `state` and `covariance` is written.
    slot : int
        Where.
    """
    m, d = state.shape[0], model.noise.shape[0]
    transition = record.transition[slot]
    if k > 0:
        for j in range(m):
            predict_segment(
                state[j],
                model.signals[k - 1, j],
                model.signals[k, j],
                model.step_s,
                model.midpoint,
                transition[j],
            )
        predict_covariance(p, transition, model.step_s, model.noise)
        for j in range(m):
            for a in range(3):
                p[d * j + 3 + a, d * j + 3 + a] += model.roughness[k, j, 0]
                p[d * j + 6 + a, d * j + 6 + a] += model.roughness[k, j, 1]
    change = record.change[slot]
    change[:] = 0.0
    rotation = np.empty((m, 3, 3))
    for j in range(m):
        to_matrix(state[j, 6:10], rotation[j])
    residual = np.empty(3)
    any_used = False
    for c in range(model.kind.shape[0]):
        record.used[slot, c] = False
        waiting[c] += 1
        if not model.active[k, c]:
            continue
        variance = linearise(
            model.kind[c],
            model.first[c],
            model.second[c],
            model.vectors[c],
            model.sd[c],
            state,
            rotation,
            model.signals[k],
            residual,
            record.jacobian[slot, c],
        )
        record.used[slot, c] = apply_constraint(
            p,
            change,
            model.first[c],
            model.second[c],
            d,
            residual,
            record.jacobian[slot, c],
            variance,
            model.gate if waiting[c] <= model.patience else np.inf,
            record.gain[slot, c],
            record.weighted[slot, c],
            record.inverse[slot, c],
        )
        if record.used[slot, c]:
            waiting[c] = 0
            any_used = True
    if any_used:
        inject(state, change, d)
        reset(p, change, d, False)


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def copy_rows(source: Array, target: Array) -> None:
    """Copy a matrix; a slice assignment would take seconds to compile.

    Parameters
    ----------
    source, target : array, two dimensions
    """
    for i in range(source.shape[0]):
        for j in range(source.shape[1]):
            target[i, j] = source[i, j]


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def filter_piece(
    model: KernelModel,
    begin: int,
    end: int,
    state: Array,
    p: Array,
    waiting: Index,
    record: StepRecord,
    states: Array,
    angles: Array,
    variances: Array,
    refused: Index,
) -> None:
    """Run the filter over the samples from `begin` to `end` (excluded).

    Parameters
    ----------
    model : KernelModel
    begin, end : int
        Samples.
    state, p : array, shape (m, 13) and (m · d, w)
        At the sample before `begin`; overwritten by those at the last sample.
    waiting : array of int, shape (c,)
        As in :func:`advance`, in place.
    record : StepRecord
        With one slot, which is overwritten, or with a slot per sample, which are filled.
    states : array, shape (n, m, 13)
        Overwritten in these rows. May be empty, as the next ones.
    angles, variances : array, shape (n, j, 3)
    refused : array of int, shape (c,)
        Counts the samples at which each constraint did not pass the gate.
    """
    d = model.noise.shape[0]
    keep = record.state.shape[0] > 1
    jacobian = np.empty((3, 6))
    for k in range(begin, end):
        slot = k - begin if keep else 0
        advance(model, k, state, p, waiting, record, slot)
        if keep:
            copy_rows(state, record.state[slot])
            copy_rows(p, record.covariance[slot])
        for c in range(model.kind.shape[0]):
            if model.active[k, c] and not record.used[slot, c]:
                refused[c] += 1
        if states.shape[0]:
            copy_rows(state, states[k])
            for i in range(model.joints.shape[0]):
                one, two = model.joints[i, 0], model.joints[i, 1]
                joint_angles(
                    state[one],
                    state[two],
                    model.anatomical[one],
                    model.anatomical[two],
                    angles[k, i],
                    jacobian,
                )
                angle_variance(p, one, two, d, jacobian, variances[k, i])
