"""Both passes against their slow plain twins; covariance over six minutes; memory of the smoother."""

from dataclasses import replace

import numpy as np
import pytest
from plain_erkf import Segment, minus, plain_filter, plain_smoother

from swaystride.erkf.constraints import constraints_of
from swaystride.erkf.noise import WALKING
from swaystride.erkf.options import PRINTED_OPTIONS, RECOMMENDED_OPTIONS
from swaystride.erkf.passes import kernel_model, run_passes
from swaystride.erkf.start import START_AT_REST, StartUncertainty

UNGATED = replace(RECOMMENDED_OPTIONS, gate=np.inf)
#: Integration that misses a part of every change.
ROUGH = replace(WALKING, acc_step_share=0.05, gyr_step_share=0.02)


def prepared(walk, options, n_samples, repeats=1, every=1, noise=WALKING):
    signals = np.concatenate([walk.acc, walk.gyr], axis=1).transpose(2, 0, 1)[:n_samples:every]
    signals = np.ascontiguousarray(np.tile(signals, (repeats, 1, 1)))
    stance = np.tile(walk.stance[:, :n_samples:every], repeats)
    rate_hz = 100.0 / every
    still = np.zeros((7, len(signals)), bool)
    still[5:7] = stance & (options is not PRINTED_OPTIONS)
    constraints, active = constraints_of(walk.body, noise, options, rate_hz, stance, still)
    return (
        kernel_model(signals, rate_hz, walk.body, noise, options, constraints, active),
        constraints,
    )


def largest_difference(states, plain, d):
    return max(
        np.abs(minus(Segment.of(a), b, d)).max()
        for row, segments in zip(states, plain, strict=True)
        for a, b in zip(row, segments, strict=True)
    )


@pytest.mark.parametrize(
    ("options", "n_samples", "noise"),
    [(PRINTED_OPTIONS, 500, WALKING), (UNGATED, 3000, WALKING), (UNGATED, 200, ROUGH)],
    ids=["nine", "twelve", "rough"],
)
def test_filter_equals_its_plain_twin_for_up_to_thirty_seconds(walk, options, n_samples, noise):
    # half the rate: half the time of the twin
    model, constraints = prepared(walk, options, n_samples, every=2, noise=noise)
    assert model.roughness.any() == (noise is ROUGH)
    start = walk.start(START_AT_REST, 0.03)
    found = run_passes(model, start, options, "filter")
    p0 = start.covariance(with_bias=options.gyro_bias)
    twin = plain_filter(model, constraints, start.states(), p0)
    assert largest_difference(found.states, twin["x"], len(model.noise)) < 1e-9
    np.testing.assert_allclose(found.covariance, twin["p"][-1], atol=1e-9)


@pytest.mark.parametrize(
    ("options", "noise"),
    [(PRINTED_OPTIONS, WALKING), (UNGATED, WALKING), (UNGATED, ROUGH)],
    ids=["nine", "twelve", "rough"],
)
def test_smoother_equals_rauch_tung_striebel(walk, options, noise):
    model, constraints = prepared(walk, options, 100, noise=noise)
    start, d = walk.start(START_AT_REST, 0.03), len(model.noise)
    found = run_passes(model, start, options, "smoother")
    twin = plain_filter(
        model, constraints, start.states(), start.covariance(with_bias=options.gyro_bias)
    )
    states, covariances = plain_smoother(twin, d)
    assert largest_difference(found.states, states, d) < 1e-7
    knee = variance_of_flexion(covariances, states, walk.body, 2)
    np.testing.assert_allclose(found.variances[:, 2, 0], knee, rtol=1e-5)


def variance_of_flexion(covariances, states, body, joint):
    """By finite differences of the angle, from a dense covariance."""
    one, two = (body.index(s) for s in (body.joints[joint].proximal, body.joints[joint].distal))
    d = len(covariances[0]) // 7
    out = []
    for p, row in zip(covariances, states, strict=True):
        slope = np.zeros(7 * d)
        for place in (one, two):
            for c in range(6, 9):
                ends = []
                for h in (-1e-5, 1e-5):
                    r = {one: row[one].r, two: row[two].r}
                    r[place] = row[place].plus(h * np.eye(12)[c]).r
                    a = body.r_anatomical_from_sensor
                    between = a[one] @ r[one].T @ r[two] @ a[two].T
                    ends.append(np.arctan2(-between[0, 1], between[1, 1]))
                slope[d * place + c] = (ends[1] - ends[0]) / 2e-5
        out.append(slope @ p @ slope)
    return np.array(out)


def test_pieces_between_checkpoints_do_not_change_the_result(walk):
    results = []
    for spacing in (10, 64, 5000):
        options = replace(UNGATED, checkpoint_spacing=spacing)
        model, _ = prepared(walk, options, 700)
        start = walk.start(START_AT_REST, 0.03)
        results.append(run_passes(model, start, options, "smoother"))
    for other in results[1:]:
        np.testing.assert_allclose(other.states, results[0].states, atol=1e-9)
        np.testing.assert_allclose(other.variances, results[0].variances, atol=1e-12)


def test_the_last_sample_of_the_smoother_is_the_filter(walk):
    model, _ = prepared(walk, UNGATED, 500)
    start = walk.start(START_AT_REST, 0.03)
    one, two = (run_passes(model, start, UNGATED, method) for method in ("filter", "smoother"))
    np.testing.assert_allclose(two.states[-1], one.states[-1], atol=1e-12)
    np.testing.assert_allclose(two.variances[-1], one.variances[-1], atol=1e-15)
    assert (two.variances <= one.variances + 1e-12).all()


@pytest.mark.parametrize("options", [PRINTED_OPTIONS, RECOMMENDED_OPTIONS], ids=["nine", "twelve"])
def test_covariance_is_symmetric_and_positive_over_six_minutes(walk, options):
    # whole strides, so that the end of a copy meets the start of the next
    model, _ = prepared(walk, options, 2990, repeats=12)
    assert len(model.signals) > 35_000
    p = run_passes(model, walk.start(START_AT_REST, 0.03), options, "filter").covariance
    np.testing.assert_array_equal(p, p.T)
    scale = 1.0 / np.sqrt(np.diag(p))
    assert np.linalg.eigvalsh(p * scale * scale[:, None]).min() > 0.0


#: Six seconds that begin at 5 m/s beside the truth: far beyond a gate of five standard deviations.
PATIENT = replace(RECOMMENDED_OPTIONS, gate=25.0, longest_refusal_s=1.5)
STUBBORN = replace(PATIENT, longest_refusal_s=np.inf)
SURE = StartUncertainty(0.005, 0.1, 0.003, 0.003, 1e-4)


def started_wrongly(walk, options, method, **changes):
    options = replace(options, **changes)
    model, constraints = prepared(walk, options, 600, noise=replace(ROUGH, tilt_sd=10.0))
    start = walk.start(SURE)
    start = replace(start, velocity_m_s=start.velocity_m_s + np.array([5.0, 0.0, 0.0]))
    return run_passes(model, start, options, method), model, constraints


def test_what_is_refused_for_long_is_believed_once(walk):
    """All feet say that the filter is wrong; without end of patience it stays so."""
    late = slice(400, 600)
    errors, refused = {}, {}
    for options in (PATIENT, STUBBORN):
        found, model, _ = started_wrongly(walk, options, "filter")
        gap = found.states[late, 0, 3:6] - walk.velocity[late, 0]
        errors[options], refused[options] = np.sqrt(np.mean(gap**2)), found.refused[:2]
    assert errors[PATIENT] < 0.05
    assert errors[STUBBORN] > 2.5
    # refused until patience ends, then hardly ever; or at every stance
    assert (refused[PATIENT] < 200).all()
    np.testing.assert_array_equal(refused[STUBBORN], model.active[:, :2].sum(axis=0))


def test_patience_ends_at_its_sample(walk):
    """The foot is believed at the first stance sample after 1.5 s, and not before."""
    found, model, _ = started_wrongly(walk, PATIENT, "filter")
    standing = np.flatnonzero(model.active[:, 0] | model.active[:, 1])
    first = standing[standing >= PATIENT.patience(100.0)][0]
    speed = np.linalg.norm(found.states[:, 0, 3:6] - walk.velocity[:600, 0], axis=1)
    assert speed[:first].min() > 4.0
    assert speed[first] < 2.0


@pytest.mark.parametrize("options", [PATIENT, STUBBORN], ids=["patient", "stubborn"])
def test_waiting_goes_on_across_checkpoints(walk, options):
    filtered = started_wrongly(walk, options, "filter")[0]
    results = [
        started_wrongly(walk, options, "smoother", checkpoint_spacing=spacing)[0]
        for spacing in (7, 5000)
    ]
    for one in results:
        np.testing.assert_array_equal(one.refused, filtered.refused)
        np.testing.assert_allclose(one.states, results[0].states, atol=1e-8)
        np.testing.assert_allclose(one.states[-1], filtered.states[-1], atol=1e-9)
