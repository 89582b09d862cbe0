import numpy as np
import pandas as pd

from swaystride.gait.foot_methods import RECOMMENDED
from swaystride.validation.foot_method_choice import GRID, leave_one_trial_out


def test_the_chosen_values_lie_inside_their_grid():
    for name, values in GRID.items():
        chosen = getattr(RECOMMENDED, name)
        assert chosen in values
        assert min(values) < chosen < max(values)


def test_a_trial_never_chooses_for_itself():
    """Setting 0 is perfect on trial a alone; a is judged by what the others prefer."""
    rng = np.random.default_rng(1)
    trials = np.repeat(["a", "b", "c"], 20)
    table = pd.DataFrame({"trial": trials, "gait": "walk"})
    table["0"] = np.where(trials == "a", 0.0, 1.0)
    table["1"] = 0.1 + 0.01 * rng.standard_normal(60)
    left_out = leave_one_trial_out(table)
    assert set(left_out["setting"]) == {"1"}
    assert np.allclose(left_out["error_m"], table["1"])


def test_gaits_weigh_alike_in_the_choice():
    """Many good strides of one gait do not outvote bad ones of another."""
    table = pd.DataFrame(
        {"trial": ["x"] * 2 + ["y"] * 99 + ["z"], "gait": ["walk"] * 101 + ["run"]}
    )
    table["0"] = np.where(table["gait"] == "walk", 0.01, 0.5)
    table["1"] = np.where(table["gait"] == "walk", 0.05, 0.05)
    own = leave_one_trial_out(table).set_index("trial")["setting"]
    assert own["x"].unique().tolist() == ["1"]
    assert own["z"] == "0"
