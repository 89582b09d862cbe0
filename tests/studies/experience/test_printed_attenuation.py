"""Printed correlations of attenuation against those of the peaks."""

import numpy as np
import pandas as pd
import pytest

from import_graph import REPOSITORY
from swaystride.studies.experience.plan import SCALES
from swaystride.studies.experience.printed_attenuation import PEAKS, attenuation_readings


@pytest.mark.parametrize("number", [3, 4])
def test_the_print_behaves_like_the_ratio_of_the_peaks(number):
    """In both tables; for shank and pelvis the ratio fits within the rounding of the print."""
    table = pd.read_csv(REPOSITORY / "data" / "published" / f"table_5_{number}.csv")
    found = attenuation_readings(table)
    as_printed = found[found["reading"] == "one minus the ratio"].set_index("measure")
    ratio = found[found["reading"] == "ratio"].set_index("measure")
    assert list(ratio.index) == list(PEAKS)
    assert as_printed["n_opposite"].sum() == 6
    assert ratio["n_opposite"].sum() == 0
    assert as_printed["rms"].min() > 0.4
    assert ratio["rms"].max() < 0.1
    # Three printed values within .005 each: the combination of two others leaves about .01.
    assert ratio.loc["Shank-to-Pelvis Attenuation", "rms"] < 0.012


@pytest.mark.parametrize("reading", ["one minus the ratio", "ratio"])
def test_means_over_steps_are_told_apart(reading):
    """Runs whose peaks scatter from step to step, with the mean of the quotients as the measure."""
    rng = np.random.default_rng(2)
    log_runs = rng.multivariate_normal([1.2, 2.1], [[0.02, 0.012], [0.012, 0.05]], size=400)
    steps = np.exp(log_runs[:, None, :] + 0.15 * rng.standard_normal((400, 300, 2)))
    ratio = np.mean(steps[..., 0] / steps[..., 1], axis=1)
    tabled = {
        "Peak Pelvic Acceleration": steps[..., 0].mean(axis=1),
        "Peak Tibial Acceleration": steps[..., 1].mean(axis=1),
        "Shank-to-Pelvis Attenuation": ratio if reading == "ratio" else 1.0 - ratio,
    }
    scores = log_runs @ [[2.0, -3.0, 0.5], [-1.0, 0.5, 3.0]] + rng.standard_normal((400, 3))
    rows = [
        (measure, scale, np.corrcoef(values, scores[:, at])[0, 1])
        for measure, values in tabled.items()
        for at, scale in enumerate(SCALES)
    ]
    found = attenuation_readings(pd.DataFrame(rows, columns=["measure", "scale", "r"]))
    rms = found.set_index("reading")["rms"]
    assert rms[reading] < 0.03
    assert rms.drop(reading).item() > 0.3
