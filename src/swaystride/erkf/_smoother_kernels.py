"""Compiled backward pass of the modified Bryson-Frazier smoother.

The smoother carries an adjoint λ and its covariance Λ backwards through every prediction, update
and reset; the smoothed error is ``P λ`` and its covariance ``P − P Λ P``. No covariance is
inverted, so the unobservable common translation does no harm.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from swaystride.erkf._angle_kernels import angle_variance, joint_angles
from swaystride.erkf._filter_kernels import KernelModel, StepRecord, copy_rows
from swaystride.erkf._predict_kernels import retreat
from swaystride.erkf._update_kernels import inject, reset, reset_adjoint, retract_constraint

Array = NDArray[np.float64]


@njit(cache=True, fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def _smoothed_angles(
    model: KernelModel,
    p: Array,
    information: Array,
    state: Array,
    angles: Array,
    variances: Array,
    spread: Array,
) -> None:
    """Angles of a sample and the diagonal of ``J (P − P Λ P) Jᵀ``."""
    d, size = model.noise.shape[0], p.shape[1]
    jacobian = np.empty((3, 6))
    row = np.empty(size)
    for i in range(model.joints.shape[0]):
        one, two = model.joints[i, 0], model.joints[i, 1]
        joint_angles(
            state[one],
            state[two],
            model.anatomical[one],
            model.anatomical[two],
            angles[i],
            jacobian,
        )
        angle_variance(p, one, two, d, jacobian, variances[i])
        for a in range(3):
            target = 3 * i + a
            for c in range(size):
                spread[target, c] = 0.0
            for b in range(6):
                source = d * (one if b < 3 else two) + 6 + b % 3
                factor = jacobian[a, b]
                for c in range(size):
                    spread[target, c] += factor * p[source, c]
    for target in range(spread.shape[0]):
        for c in range(size):
            row[c] = 0.0
        for b in range(p.shape[0]):
            factor = spread[target, b]
            for c in range(size):
                row[c] += factor * information[b, c]
        total = 0.0
        for c in range(size):
            total += row[c] * spread[target, c]
        variances[target // 3, target % 3] -= total


@njit(cache=True, fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def smooth_piece(
    model: KernelModel,
    begin: int,
    end: int,
    adjoint: Array,
    information: Array,
    record: StepRecord,
    states: Array,
    angles: Array,
    variances: Array,
) -> None:
    """Smooth the samples from `end` (excluded) down to `begin`.

    Parameters
    ----------
    model : KernelModel
    begin, end : int
        Samples.
    adjoint, information : array, shape (m · d,) and (m · d, w)
        λ and Λ after sample ``end - 1``; overwritten by those before sample `begin`.
    record : StepRecord
        As :func:`~swaystride.erkf._filter_kernels.filter_piece` filled it.
    states, angles, variances : array, shape (n, m, 13), (n, j, 3), (n, j, 3)
        Overwritten in these rows by smoothed states, angles and variances of the angles.
    """
    d, size = model.noise.shape[0], information.shape[1]
    error = np.empty(size)
    spread = np.empty((3 * model.joints.shape[0], size))
    for k in range(end - 1, begin - 1, -1):
        slot = k - begin
        p = record.covariance[slot]
        for j in range(size):
            error[j] = 0.0
        for i in range(adjoint.shape[0]):
            factor = adjoint[i]
            for j in range(size):
                error[j] += factor * p[i, j]
        copy_rows(record.state[slot], states[k])
        inject(states[k], error, d)
        _smoothed_angles(model, p, information, states[k], angles[k], variances[k], spread)
        reset_adjoint(adjoint, record.change[slot], d)
        reset(information, record.change[slot], d, True)
        for c in range(model.kind.shape[0] - 1, -1, -1):
            if record.used[slot, c]:
                retract_constraint(
                    information,
                    adjoint,
                    model.first[c],
                    model.second[c],
                    d,
                    record.jacobian[slot, c],
                    record.gain[slot, c],
                    record.weighted[slot, c],
                    record.inverse[slot, c],
                )
        if k > 0:
            retreat(adjoint, information, record.transition[slot], model.step_s, d)
