"""From the study's configuration to the rules of answers and statistics."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from swaystride.configuration import from_mapping
from swaystride.errors import ConfigurationError
from swaystride.stats.parametric_bootstrap import ERROR_KINDS
from swaystride.studies.experience.answers import AnswerRules
from swaystride.studies.experience.between_runs import BetweenRules, ClusterRule
from swaystride.studies.experience.patterns import PatternRules
from swaystride.studies.experience.within_runs import WithinRules

Section = Mapping[str, Any]


def answer_rules(answers: Section) -> AnswerRules:
    """Ends of the scales and the mean of the ratings.

    Parameters
    ----------
    answers : mapping
        Plain values of ``analysis.answers``.
    """
    values = {**answers["scales"], "mean": answers["mean"]}
    return from_mapping(AnswerRules, values, place="analysis.answers")


def pattern_rules(model: Section) -> PatternRules:
    """Cut-offs of the running patterns and the slope of the duty factor.

    Parameters
    ----------
    model : mapping
        Plain values of ``analysis.model``.
    """
    values = {**model["cutoffs"], **model["patterns"]}
    return from_mapping(PatternRules, values, place="analysis.model.patterns")


def between_rules(model: Section) -> BetweenRules:
    """How associations between runs are estimated.

    Parameters
    ----------
    model : mapping
        Plain values of ``analysis.model``.
    """
    cluster = from_mapping(ClusterRule, model["cluster"], place="analysis.model.cluster")
    return BetweenRules(model["level"], cluster)


def within_rules(model: Section) -> WithinRules:
    """How associations within runs are estimated.

    Parameters
    ----------
    model : mapping
        Plain values of ``analysis.model``.

    Raises
    ------
    ConfigurationError
        If a kind of errors is unknown.
    """
    place = "analysis.model.within"
    unknown = set(model["within"]["errors"]) - set(ERROR_KINDS)
    if unknown:
        raise ConfigurationError(
            "unknown kind of errors",
            place=f"{place}.errors",
            expected="any of " + ", ".join(ERROR_KINDS),
            found=", ".join(sorted(unknown)),
        )
    return from_mapping(WithinRules, {"level": model["level"], **model["within"]}, place=place)
