"""Running patterns by duty factor, as run and at one speed."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from swaystride.errors import ConfigurationError
from swaystride.studies.experience.observations import pattern_counts
from swaystride.studies.experience.patterns import (
    PatternRules,
    duty_factor_at_12_km_h,
    running_patterns,
)
from swaystride.studies.experience.plan import PATTERNS

RULES = PatternRules(0.276, 0.288, -0.033, "run_mean")


@given(st.lists(st.floats(0.1, 0.6), max_size=20))
def test_every_known_duty_factor_has_one_pattern(values):
    named = running_patterns(values, RULES)
    assert set(named) <= set(PATTERNS)
    for value, name in zip(values, named, strict=True):
        assert (name == "aerial") == (value < 0.276)
        assert (name == "terrestrial") == (value > 0.288)


def test_runners_on_one_line_have_one_duty_factor_at_12_km_h():
    speed = np.array([2.5, 12.0 / 3.6, 4.5])
    line = 0.29 - 0.033 * (speed - 12.0 / 3.6)
    np.testing.assert_allclose(duty_factor_at_12_km_h(line, speed, RULES), 0.29, atol=1e-15)
    assert running_patterns(line, RULES) == ["terrestrial", "terrestrial", "aerial"]
    flat = PatternRules(0.276, 0.288, 0.0, "run_mean")
    np.testing.assert_array_equal(duty_factor_at_12_km_h(line, speed, flat), line)


def test_overlapping_cut_offs_are_refused():
    with pytest.raises(ConfigurationError, match="aerial and terrestrial"):
        PatternRules(0.29, 0.28, 0.0, "run_mean")


def test_runs_between_the_cut_offs_are_counted():
    named = pd.Series(running_patterns([0.25, 0.28, 0.281, 0.3, np.nan], RULES))
    counts = pattern_counts(named)
    assert counts == {"aerial": 1, "intermediate": 2, "terrestrial": 1, "unknown": 1}
