import pytest

from swaystride.errors import ModelError
from swaystride.stats.mixed_formula import parse_mixed_formula


@pytest.mark.parametrize(
    ("text", "fixed", "groups"),
    [
        ("y ~ x*z + (1|a) + (1|b) + (1|a:b)", "y ~ x*z", ("a", "b", "a:b")),
        ("y~(1|a)", "y ~ 1", ("a",)),
        ("log(y) ~ 0 + x + ( 1 | a : b )", "log(y) ~ 0 + x", ("a:b",)),
        ("y ~ np.log(x + 1) - z + (1|a/b/c)", "y ~ np.log(x + 1) - z", ("a", "a:b", "a:b:c")),
    ],
)
def test_fixed_part_and_groups_are_separated(text, fixed, groups):
    parsed = parse_mixed_formula(text)
    assert (parsed.fixed, parsed.groups) == (fixed, groups)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("y ~ x + (x|g)", "random slopes are out of scope: (x|g)"),
        ("y ~ x + (1 + x|g)", "random slopes are out of scope"),
        ("y ~ x + (0 + x|g)", "random slopes are out of scope"),
        ("y ~ x + (1||g)", "the random term (1||g) cannot be read"),
        ("y ~ x + (1|g)*x", "the random term (1|g)*x cannot be read"),
        ("y ~ x + 1|g", "the random term 1|g cannot be read"),
        ("y ~ x + (1|g*h)", "the group of (1|g*h) cannot be read"),
        ("y ~ x", "the formula has no random intercept"),
        ("y ~ x + (1|g) + (1|g)", "the random intercept of g appears twice"),
        ("x + (1|g)", "the formula cannot be read"),
        ("~ x + (1|g)", "the formula cannot be read"),
        ("y ~ x + (1|g", "an unmatched parenthesis"),
        ("y ~ x + + (1|g)", "a plus sign without a term"),
    ],
)
def test_refusals_say_why(text, line):
    with pytest.raises(ModelError) as error:
        parse_mixed_formula(text)
    assert line in str(error.value)
    assert "\n" not in str(error.value)
