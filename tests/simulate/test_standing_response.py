"""The response surface: unbiased on fresh trials, exactly invertible, honest about its range."""

import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml

from swaystride.configuration import load_yaml
from swaystride.errors import ConfigurationError
from swaystride.simulate.seeds import generator
from swaystride.simulate.standing_response import (
    PhysicalInputs,
    checked_response,
    response_from_record,
    standing_response,
)
from swaystride.simulate.standing_response_fit import (
    ResponseDesign,
    design_points,
    fit_standing_response,
    simulate_run,
)

REPOSITORY = Path(__file__).parents[2]


def random_inputs(n, rng, part=1.0):
    """Inputs from the middle part of the fitted range, shape (n, 4)."""
    response = standing_response()
    middle, half = (response.low + response.high) / 2, (response.high - response.low) / 2
    return middle + part * half * rng.uniform(-1, 1, size=(n, 4))


@pytest.fixture(scope="module")
def fresh_trials():
    """Inputs and trials that the surface has never seen."""
    response = standing_response()
    points = random_inputs(500, generator(77, "points"), part=0.6)
    runs = [
        simulate_run(response.model, response.trial, point, 8, generator(77, f"run {i}"))
        for i, point in enumerate(points)
    ]
    return points, np.array([run[0] for run in runs]), np.array([run[1] for run in runs])


def test_expected_features_are_unbiased_over_the_working_range(fresh_trials):
    points, features, _ = fresh_trials
    residual = features.mean(axis=1) - standing_response().expected(points)
    assert np.abs(residual.mean(axis=0)).max() < 0.01
    # Nor is there a trend along any input beyond what the scatter of 4000 trials allows.
    for column in range(4):
        halves = points[:, column] > np.median(points[:, column])
        for half in (halves, ~halves):
            error = residual[half].std(axis=0) / np.sqrt(half.sum())
            assert np.all(np.abs(residual[half].mean(axis=0)) < 0.01 + 2.5 * error)


def test_scatter_of_single_trials_is_the_stated_one(fresh_trials):
    points, features, fisher_z = fresh_trials
    response = standing_response()
    inputs = PhysicalInputs(*points[:, :3].T, np.ones(len(points), dtype=bool))
    expected = response.process_covariance(inputs).mean(axis=0)
    residual = (features - response.expected(points)[:, None]).reshape(-1, 3)
    observed = residual.T @ residual / len(residual)
    sd = np.sqrt(np.diag(expected))
    np.testing.assert_allclose(np.sqrt(np.diag(observed)), sd, rtol=0.05)
    np.testing.assert_allclose(observed / np.outer(sd, sd), expected / np.outer(sd, sd), atol=0.1)
    assert fisher_z.std() == pytest.approx(
        np.sqrt((response.fisher_z_sd(inputs) ** 2).mean()), rel=0.05
    )
    # Standard error: .33 within and .15 between 500 runs of 8 trials.
    assert abs(fisher_z.mean()) < 4 * np.hypot(0.33 / np.sqrt(4000), 0.15 / np.sqrt(500))


def test_scatter_is_a_covariance_everywhere_in_the_range():
    response = standing_response()
    points = random_inputs(2000, np.random.default_rng(1))
    inputs = PhysicalInputs(*points[:, :3].T, np.ones(len(points), dtype=bool))
    assert np.linalg.eigvalsh(response.process_covariance(inputs)).min() > 0
    assert response.fisher_z_sd(inputs).min() > 0


def test_inverse_returns_the_inputs():
    response = standing_response()
    points = random_inputs(3000, np.random.default_rng(2), part=0.8)
    found = response.invert(response.expected(points), points[:, 3])
    assert found.n_clipped == 0
    recovered = np.stack([found.ln_noise_ap, found.ln_noise_ml, found.activity], axis=1)
    np.testing.assert_allclose(recovered, points[:, :3], atol=1e-7)


def test_inverse_of_many_is_the_inverse_of_each():
    response = standing_response()
    points = random_inputs(20, np.random.default_rng(3), part=0.8)
    wanted = response.expected(points)
    together = response.invert(wanted, points[:, 3])
    for i in range(20):
        alone = response.invert(wanted[i : i + 1], points[i, 3])
        assert alone.activity[0] == pytest.approx(together.activity[i], abs=1e-9)


def test_what_cannot_be_had_is_flagged_and_keeps_the_rms():
    response = standing_response()
    wanted = np.log([[1.2, 1.0, 1.4], [1.2, 1.0, 9.0], [1.2, 1.0, 0.4]])
    found = response.invert(wanted, 0.88)
    assert found.in_range.tolist() == [True, False, False]
    assert found.n_clipped == 2
    assert found.activity[1] == pytest.approx(response.high[2])
    assert found.activity[2] == pytest.approx(response.low[2])
    inputs = np.stack(
        [found.ln_noise_ap, found.ln_noise_ml, found.activity, np.full(3, 0.88)], axis=1
    )
    np.testing.assert_allclose(response.expected(inputs)[:, :2], wanted[:, :2], atol=1e-8)


def test_far_outside_everything_stays_within_the_range():
    response = standing_response()
    found = response.invert(np.log([[80.0, 0.01, 1.0], [0.001, 0.001, 50.0]]), 0.88)
    assert not found.in_range.any()
    for values, k in ((found.ln_noise_ap, 0), (found.ln_noise_ml, 1), (found.activity, 2)):
        assert np.all((values >= response.low[k] - 1e-12) & (values <= response.high[k] + 1e-12))


def test_a_giant_has_no_response():
    with pytest.raises(ConfigurationError, match=r"pendulum height outside .* found 1\.2 m"):
        standing_response().invert(np.log([[1.2, 1.0, 1.4]]), 1.2)


def test_other_settings_are_refused(cohort):
    population = cohort.population
    assert checked_response(population.standing, population.trial) is standing_response()
    with pytest.raises(ConfigurationError, match=r"delay_s: .* another setting; expected 0.12, or"):
        checked_response(replace(population.standing, delay_s=0.1), population.trial)
    with pytest.raises(ConfigurationError, match="cutoff_hz: "):
        checked_response(population.standing, replace(population.trial, cutoff_hz=3.0))


def test_directions_respond_alike():
    # AP and ML are the same pendulum, the breath aside.
    response = standing_response()
    base = np.array([[-4.9, -4.9, a, h] for a in (-0.8, 0.0, 0.8) for h in (0.8, 0.9)])
    expected = response.expected(base)
    np.testing.assert_allclose(expected[:, 0], expected[:, 1], atol=0.02)


def test_features_grow_with_the_noise_as_in_a_linear_system():
    response = standing_response()
    base = np.array([[-5.0, -5.1, 0.0, 0.88]])
    step = response.expected(base + np.array([0.1, 0.1, 0.0, 0.0])) - response.expected(base)
    # Slightly less than proportional: drift and breathing do not grow.
    assert np.all((step > 0.085) & (step < 0.102))


def test_path_of_activity_passes_through_both_sets(cohort):
    standing = cohort.population.standing
    person = {"coupling": 0.0, "mass_kg": 70.0, "pendulum_height_m": 0.9}
    noise = {"ln_noise_ap": -5.0, "ln_noise_ml": -5.0}
    base = standing.parameters(activity=0.0, **noise, **person)
    active = standing.parameters(activity=1.0, **noise, **person)
    assert (base.stiffness_ratio, base.damping_nm_s_rad, base.noise_time_s) == (1.25, 250.0, 1.0)
    assert active.stiffness_ratio == pytest.approx(1.45)
    assert active.damping_nm_s_rad == pytest.approx(220.0)
    assert active.noise_time_s == pytest.approx(0.7)
    assert base.noise_ap_nm == pytest.approx(70.0 * 9.80665 * 0.9 * np.exp(-5.0))


def test_damping_ratio_does_not_depend_on_the_size_of_the_person(cohort):
    standing = cohort.population.standing
    ratios = []
    for mass, height in ((50.0, 0.75), (70.0, 0.9), (110.0, 1.0)):
        p = standing.parameters(
            ln_noise_ap=-5.0,
            ln_noise_ml=-5.0,
            activity=0.4,
            coupling=0.0,
            mass_kg=mass,
            pendulum_height_m=height,
        )
        inertia = p.inertia_factor * mass * height**2
        stiffness = p.gravity_torque_nm * (p.stiffness_ratio - 1)
        ratios.append(p.damping_nm_s_rad / (2 * np.sqrt(inertia * stiffness)))
    assert ratios == pytest.approx([ratios[0]] * 3)


def test_a_small_fit_describes_its_own_set(cohort):
    design = ResponseDesign(
        ln_noise_ap=(-5.2, -4.4),
        ln_noise_ml=(-5.4, -4.6),
        activity=(-0.5, 0.8),
        pendulum_height_m=(0.8, 0.95),
        n_runs=64,
        trials_per_run=4,
        degree=1,
        seed=3,
    )
    population = cohort.population
    trial = replace(population.trial, warm_up_s=20.0)
    record = fit_standing_response(population.standing, trial, design)
    again = fit_standing_response(population.standing, trial, design)
    assert record == again
    assert record["fit"]["n_trials"] == 256
    assert record["fit"]["rmse_single_trial"]["ap_rms"] == pytest.approx(0.19, abs=0.04)
    points = design_points(design)
    assert points.shape == (64, 4)
    low, high = np.array([record["ranges"][name] for name in record["ranges"]]).T
    assert np.all((points >= low) & (points <= high))
    # AP sway does not answer to ML noise.
    exponents = np.array(record["exponents"])
    coefficients = np.array(record["coefficients"]["ap_rms"])
    assert not coefficients[exponents[:, 1] > 0].any()
    assert coefficients[(exponents == [1, 0, 0, 0]).all(axis=1)][0] > 0


def test_the_script_writes_a_surface_that_the_library_reads(tmp_path):
    settings = load_yaml(REPOSITORY / "config" / "studies" / "feedback.yaml")
    settings["simulation"]["response"]["n_runs"]["value"] = 128
    settings["simulation"]["response"]["degree"]["value"] = 2
    (tmp_path / "feedback.yaml").write_text(yaml.safe_dump(settings), encoding="utf-8")
    subprocess.run(
        [
            sys.executable,
            REPOSITORY / "scripts" / "fit_standing_response.py",
            "--config",
            tmp_path / "feedback.yaml",
            "--output",
            tmp_path / "response.json",
        ],
        check=True,
        env={**os.environ, "PYTHONPATH": str(REPOSITORY / "src")},
    )
    rough = response_from_record(json.loads((tmp_path / "response.json").read_text()))
    assert (rough.model, rough.trial) == (standing_response().model, standing_response().trial)
    points = random_inputs(200, np.random.default_rng(5), part=0.5)
    difference = rough.expected(points) - standing_response().expected(points)
    # 1024 trials and a parabola against 65 536 and a quartic.
    assert np.sqrt((difference**2).mean(axis=0)).max() < 0.06


def test_the_stored_surface_is_the_one_that_the_configuration_describes():
    """Ranges, size, degree and seed of the fit stand in config/studies/feedback.yaml."""
    tree = load_yaml(REPOSITORY / "config" / "studies" / "feedback.yaml")["simulation"]["response"]
    wanted = {name: leaf["value"] for name, leaf in tree.items()}
    record = json.loads(
        (REPOSITORY / "src/swaystride/simulate/standing_response.json").read_text(encoding="utf-8")
    )
    assert {name: wanted[name] for name in record["ranges"]} == record["ranges"]
    for name in ("n_runs", "trials_per_run", "degree", "seed"):
        assert record["fit"][name] == wanted[name], name
