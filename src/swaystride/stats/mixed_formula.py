"""Read a mixed-model formula: the fixed part as text, the random intercepts as group names."""

from __future__ import annotations

import re
from dataclasses import dataclass

from swaystride.errors import ModelError

_GROUP = re.compile(r"[A-Za-z_.][\w.]*")


@dataclass(frozen=True)
class MixedFormula:
    """A mixed-model formula in parts.

    Attributes
    ----------
    text : str
        The formula as written.
    fixed : str
        Outcome and fixed effects, ``"y ~ x*z"``, for :mod:`formulaic`.
    groups : tuple of str
        Grouping factors of the random intercepts as written, ``("a", "a:b")``.
    """

    text: str
    fixed: str
    groups: tuple[str, ...]


def parse_mixed_formula(text: str) -> MixedFormula:
    """Split ``"y ~ x*z + (1|a) + (1|a:b)"`` into fixed part and grouping factors.

    ``(1|a/b)`` stands for ``(1|a) + (1|a:b)``, as in lme4.

    Parameters
    ----------
    text : str
        The formula.

    Returns
    -------
    MixedFormula

    Raises
    ------
    ModelError
        If there is no outcome or no random intercept, a random slope is asked for, or a group
        appears twice.

    Examples
    --------
    >>> parse_mixed_formula("log(y) ~ x*z + (1|patient/exercise) + (1|rater)")
    ... # doctest: +ELLIPSIS
    MixedFormula(text=..., fixed='log(y) ~ x*z', groups=('patient', 'patient:exercise', 'rater'))
    """
    outcome, tilde, right = text.partition("~")
    if not tilde or not outcome.strip() or not right.strip() or "~" in right:
        raise ModelError(
            "the formula cannot be read", place=text, expected="'outcome ~ terms + (1|group)'"
        )
    fixed: list[str] = []
    groups: list[str] = []
    for piece in _split_sum(right, text):
        if _has_bar(piece):
            groups.extend(_random_intercept(piece, text))
        else:
            fixed.append(piece)
    if not groups:
        raise ModelError("the formula has no random intercept", place=text, expected="'(1|group)'")
    repeated = sorted({group for group in groups if groups.count(group) > 1})
    if repeated:
        raise ModelError(f"the random intercept of {', '.join(repeated)} appears twice", place=text)
    return MixedFormula(text, f"{outcome.strip()} ~ {' + '.join(fixed) or '1'}", tuple(groups))


def _split_sum(right: str, text: str) -> list[str]:
    """Split at the plus signs that stand outside parentheses."""
    pieces, depth, start = [], 0, 0
    for at, character in enumerate(right):
        depth += (character in "([{") - (character in ")]}")
        if character == "+" and depth == 0:
            pieces.append(right[start:at].strip())
            start = at + 1
    pieces.append(right[start:].strip())
    if depth != 0 or not all(pieces):
        raise ModelError(
            "the formula cannot be read",
            place=text,
            found="an unmatched parenthesis" if depth else "a plus sign without a term",
        )
    return pieces


def _has_bar(piece: str) -> bool:
    return "|" in re.sub(r"`[^`]*`", "", piece)


def _random_intercept(piece: str, text: str) -> list[str]:
    """Read ``(1|a:b)``; everything else with a bar in it is refused with the reason."""
    match = re.fullmatch(r"\(([^|()]*)\|([^()]*)\)", piece)
    if match is None or match[2].startswith("|"):
        raise ModelError(
            f"the random term {piece} cannot be read", place=text, expected="'(1|group)'"
        )
    if match[1].strip() != "1":
        raise ModelError(
            f"random slopes are out of scope: {piece}",
            place=text,
            expected="random intercepts only, '(1|group)'",
        )
    written = re.sub(r"\s+", "", match[2])
    if (":" in written and "/" in written) or not all(
        _GROUP.fullmatch(name) for name in re.split("[:/]", written)
    ):
        raise ModelError(
            f"the group of {piece} cannot be read", place=text, expected="'a', 'a:b' or 'a/b'"
        )
    nested = written.split("/")
    return [":".join(nested[: depth + 1]) for depth in range(len(nested))]
