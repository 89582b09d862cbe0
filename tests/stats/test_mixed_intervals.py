import numpy as np
import pandas as pd
import pytest
from scipy.optimize import minimize
from scipy.stats import chi2

from swaystride.stats.mixed_model import fit_mixed_model

# Davies and Goldsmith 1972, the Dyestuff example of lme4: yield of five samples of six batches.
DYESTUFF = pd.DataFrame(
    {
        "A": [1545, 1440, 1440, 1520, 1580],
        "B": [1540, 1555, 1490, 1560, 1495],
        "C": [1595, 1550, 1605, 1510, 1560],
        "D": [1445, 1440, 1595, 1465, 1545],
        "E": [1595, 1630, 1515, 1635, 1625],
        "F": [1520, 1455, 1450, 1480, 1445],
    }
).melt(var_name="batch", value_name="y")


def test_dyestuff_fits_and_profiles_as_printed_for_lme4():
    """Bates, Maechler, Bolker and Walker, lme4 documentation and book, chapter 1."""
    reml = fit_mixed_model("y ~ 1 + (1|batch)", DYESTUFF)
    assert -2 * reml.loglik == pytest.approx(319.6543, abs=5e-5)
    np.testing.assert_allclose(np.sqrt(reml.variance_components), [42.001, 49.510], atol=5e-4)
    ml = fit_mixed_model("y ~ 1 + (1|batch)", DYESTUFF, reml=False)
    assert -2 * ml.loglik == pytest.approx(327.3271, abs=5e-5)
    limits = ml.confint("profile")[["ci_low", "ci_high"]]
    np.testing.assert_allclose(limits.loc["Intercept"], [1486.4515, 1568.5485], rtol=1e-6)
    sd = np.sqrt(limits.iloc[1:])
    np.testing.assert_allclose(sd.loc["var(batch)"], [12.1975, 84.0634], rtol=2e-4)
    np.testing.assert_allclose(sd.loc["var(Residual)"], [38.2300, 67.6577], rtol=1e-5)
    pd.testing.assert_frame_equal(reml.confint("profile"), ml.confint("profile"))


def test_profile_ends_lie_where_the_written_out_deviance_says(crossed, twin_deviance):
    frame = crossed(seed=9)
    fit = fit_mixed_model("y ~ x + (1|p) + (1|r)", frame, reml=False)
    design, y = fit.estimates.design, frame["y"].to_numpy()
    codes = [factor.codes for factor in design.factors]
    limits = fit.confint("profile", level=0.9)
    rise = chi2.ppf(0.9, 1)

    def smallest(objective, start):
        options = {"xatol": 1e-7, "fatol": 1e-9, "maxiter": 2000}
        found = minimize(objective, np.log(start), method="Nelder-Mead", options=options)
        return found.fun + 2 * fit.loglik

    for end in limits.loc["x", ["ci_low", "ci_high"]]:
        held = smallest(
            lambda u, end=end: twin_deviance(
                design.X[:, :1], codes, y - end * design.X[:, 1], np.exp(u), reml=False
            ),
            fit.estimates.gamma,
        )
        assert held == pytest.approx(rise, abs=1e-5)
    variances = fit.estimates.variances
    for at, name in enumerate(["var(p)", "var(r)", "var(Residual)"]):
        for end in limits.loc[name, ["ci_low", "ci_high"]]:

            def deviance(u, at=at, end=end):
                full = np.insert(np.exp(u), at, end)
                return twin_deviance(
                    design.X, codes, y, full[:2] / full[2], reml=False, sigma2=full[2]
                )

            assert smallest(deviance, np.delete(variances, at)) == pytest.approx(rise, abs=1e-5)


def test_profile_of_a_component_at_zero_starts_at_zero(one_way):
    frame = one_way(sd=0.0, seed=3)
    frame["y"] -= frame.groupby("who")["y"].transform("mean")
    limits = fit_mixed_model("y ~ x + (1|who)", frame).confint("profile")
    assert limits.loc["var(who)", "ci_low"] == 0.0
    assert limits.loc["var(who)", "estimate"] == 0.0
    assert limits.loc["var(who)", "ci_high"] > 0.0


def test_bootstrap_spreads_as_the_standard_errors_say_and_repeats(one_way):
    frame = one_way(groups=20, size=6, seed=2)
    fit = fit_mixed_model("y ~ x + z + (1|who)", frame)
    limits = fit.confint("bootstrap", n=4000, seed=[1, 2])
    wald = fit.confint("wald")
    width = (limits["ci_high"] - limits["ci_low"])[wald.index]
    np.testing.assert_allclose(width, wald["ci_high"] - wald["ci_low"], rtol=0.12)
    assert (limits.loc["var(who)", "ci_low"] < fit.variance_components["who"]).all()
    pd.testing.assert_frame_equal(limits, fit.confint("bootstrap", n=4000, seed=[1, 2]))
    sequence = np.random.SeedSequence([1, 2])
    pd.testing.assert_frame_equal(limits, fit.confint("bootstrap", n=4000, seed=sequence))
