"""Fits by lme4 and lmerTest, wherever their reference folders are at hand.

The folders are named by SWAYSTRIDE_REFERENCE_DATA and SWAYSTRIDE_REAL_DATA and else expected
beside the repository; where they are absent this module holds no test.
"""

import json
import os
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from swaystride.stats.mixed_model import fit_mixed_model

_SHARED = Path(__file__).parents[3] / "shared"
MODELS = Path(os.environ.get("SWAYSTRIDE_REFERENCE_DATA", _SHARED / "reference")) / "mixed_models"
REAL = Path(os.environ.get("SWAYSTRIDE_REAL_DATA", _SHARED / "realdata"))
PRINTED = REAL / "reliability_and_mixed_models" / "R_lmm_bds_reference_output.txt"
CLASSICS = PRINTED.with_name("R_icc_lme4_reference_output.txt")
PLATE = REAL / "standing_force_plate" / "ref" / "BDSinfoCOP.txt.gz"

_FORMULAS = {
    "a": "logy ~ speed_p + load + slope + age + mass + height + sex + x1 + x2 + x3 + x4"
    " + (1|subject)",
    "b1": "rating ~ dimension + (1|patient) + (1|rater)",
    "s": "y ~ x + (1|subject)",
}


def _cases() -> list:
    """File, formula and reference of every fit that is there."""
    cases = []
    if (MODELS / "lme4_reference.json").exists():
        references = json.loads((MODELS / "lme4_reference.json").read_text())
        for key, reference in references.items():
            model = key.split("_")[0]
            if model in _FORMULAS:
                file = MODELS / f"{model[0]}.csv"
                cases.append(pytest.param(file, _FORMULAS[model], reference, id=key))
    if (MODELS / "i_reference.json").exists():
        references = json.loads((MODELS / "i_reference.json").read_text())
        for key, reference in references.items():
            if not key.endswith("default_optimizer"):
                cases.append(
                    pytest.param(MODELS / "i.csv", reference["formula"], reference, id=key)
                )
    return cases


if CASES := _cases():

    @pytest.mark.parametrize(("file", "formula", "reference"), CASES)
    def test_fit_equals_lme4(file, formula, reference):
        fit = fit_mixed_model(formula, pd.read_csv(file), reml=reference["REML"])
        assert fit.converged
        assert fit.is_singular == reference["singular"]
        assert fit.loglik == pytest.approx(reference["logLik"], abs=1e-8)
        assert fit.loglik > reference["logLik"] - 1e-9  # lme4 stops a little short, never we
        assert fit.aic == pytest.approx(reference["AIC"], abs=2e-8)
        table = fit.fixed_effects()
        np.testing.assert_allclose(table["estimate"], reference["beta"], rtol=0, atol=1e-7)
        np.testing.assert_allclose(table["se"], reference["se"], rtol=0, atol=2e-6)
        # Where lme4 stopped on i9 and i13, the deviance still has a slope of 1.5e-4 (ours: 1e-12);
        # that leaves its largest variances 1.1e-6 off.
        atol = 2e-6 if "formula" in reference else 1e-6
        expected = pd.Series(reference["varcomp"], dtype=float)[fit.variance_components.index]
        np.testing.assert_allclose(fit.variance_components, expected, rtol=0, atol=atol)
        if "satt_df" in reference:
            np.testing.assert_allclose(table["df"], reference["satt_df"], rtol=1e-5)
            np.testing.assert_allclose(table["p"], reference["satt_p"], rtol=1e-3, atol=1e-6)
            p = fit.fixed_effects("residual")["p"]
            np.testing.assert_allclose(p, reference["p_resid_df"], rtol=1e-3, atol=1e-6)
            for name, effects in reference["ranef"].items():
                found = fit.random_effects()[name][list(effects)]
                np.testing.assert_allclose(found, list(effects.values()), rtol=0, atol=1e-7)


def _section(text: str, title: str) -> dict:
    """Coefficients, variances and REML criterion of one printed model."""
    block = text[text.index(f"### {title}") :]
    block = block[: block.index("###", 3)]
    rows = re.findall(r"^(\S+) +((?:-?[\d.e+-]+ +){4}-?[\d.e+-]+)$", block, re.MULTILINE)
    n = len({name for name, _ in rows})
    return {
        "fixed": np.array([[float(v) for v in values.split()] for _, values in rows[:n]]),
        "variances": {
            name: float(value)
            for name, value in re.findall(
                r"^\d +(Subject|cell|Residual) +([\d.]+) +[\d.]+$", block, re.MULTILINE
            )
        },
        "criterion": float(re.search(r"REMLcrit (\S+)", block)[1]),
    }


if PRINTED.exists() and PLATE.exists():

    @pytest.mark.parametrize(
        ("title", "formula", "rows"),
        [
            ("M1", "log(COParea) ~ Vision*Surface + AgeGroup + (1|Subject)", 1930),
            (
                "M2",
                "log(COPvelo) ~ Vision*Surface*AgeGroup + (1|Subject) + (1|Subject:Vision:Surface)",
                1930,
            ),
            ("M4", "log(COParea) ~ Vision*Surface + (1|Subject)", 200),
        ],
    )
    def test_a_real_study_equals_the_printed_lme4_output(title, formula, rows):
        frame = pd.read_csv(PLATE, sep="\t").iloc[:rows]
        for name, levels in {
            "Vision": ["Open", "Closed"],
            "Surface": ["Firm", "Foam"],
            "AgeGroup": ["Young", "Old"],
        }.items():
            frame[name] = pd.Categorical(frame[name], levels)
        printed = _section(PRINTED.read_text(), title)
        fit = fit_mixed_model(formula, frame)
        table = fit.fixed_effects()
        assert -2 * fit.loglik == pytest.approx(printed["criterion"], abs=6e-7)
        # the default optimiser of lme4 stops at about seven digits
        np.testing.assert_allclose(table["estimate"], printed["fixed"][:, 0], rtol=0, atol=5e-9)
        np.testing.assert_allclose(table["se"], printed["fixed"][:, 1], rtol=0, atol=2e-8)
        np.testing.assert_allclose(table["df"], printed["fixed"][:, 2], rtol=2e-6)
        np.testing.assert_allclose(table["t"], printed["fixed"][:, 3], rtol=5e-7)
        names = {"Subject:Vision:Surface": "cell"}
        for name, variance in fit.variance_components.items():
            assert variance == pytest.approx(printed["variances"][names.get(name, name)], abs=1e-7)


if CLASSICS.exists():

    @pytest.mark.parametrize(
        ("name", "formula"),
        [
            ("Dyestuff", "Yield ~ 1 + (1|Batch)"),
            ("Penicillin", "diameter ~ 1 + (1|plate) + (1|sample)"),
            ("Pastes", "strength ~ 1 + (1|sample) + (1|batch)"),
        ],
    )
    def test_the_classics_equal_lme4(name, formula):
        frame = pd.read_csv(CLASSICS.parent / f"{name}_lme4.csv")
        pattern = rf"{name} REML (\S+) fixef (\S+) se (\S+) sd (.*)"
        line = re.search(pattern, CLASSICS.read_text())
        fit = fit_mixed_model(formula, frame)
        assert -2 * fit.loglik == pytest.approx(float(line[1]), abs=1e-6)
        table = fit.fixed_effects()
        assert table["estimate"].iloc[0] == pytest.approx(float(line[2]), rel=1e-9)
        assert table["se"].iloc[0] == pytest.approx(float(line[3]), rel=1e-4)
        sd = [float(value) for value in line[4].split()]
        np.testing.assert_allclose(np.sqrt(fit.variance_components), sd, rtol=1e-4)
