"""True effects of a simulated cohort: what the printed models would estimate without scatter.

For ML RMS and MV these are the effects that were put in. For AP RMS they differ a little, because
its printed model lacks ``block:trial_number``, which is not zero in the population. Those of
Phi RMS, PL and EA follow from the other three: the best linear summary of the true expectations
under the printed model. Only tests and error tables use this module.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from swaystride.stats.mixed_design import model_matrix
from swaystride.studies.feedback.models import PARTICIPANT, model_frame
from swaystride.studies.feedback.plan import FEATURES, ModelPlan, effects


def true_effects(
    variables: pd.DataFrame,
    expected_log: pd.DataFrame,
    plan: ModelPlan,
    variance_ratios: Mapping[str, float],
) -> pd.DataFrame:
    """Effects of Tables 2.3 and 2.4 in the expectations of a cohort.

    Parameters
    ----------
    variables : DataFrame
        Model variables of every trial
        (:func:`swaystride.studies.feedback.design.model_variables`).
    expected_log : DataFrame
        Expected logarithm of the six features, rows as in `variables`.
    plan : ModelPlan
        Exponents and terms as printed.
    variance_ratios : mapping of str to float
        Variance between participants over the variance between trials of each feature, which
        weighs comparisons within against comparisons between participants as the model does.

    Returns
    -------
    DataFrame
        ``panel``, ``feature``, ``effect``, ``exponent``, ``truth``.
    """
    rows = []
    for feature in FEATURES:
        exponent = plan.printed_exponents[feature]
        frame = variables.assign(**{feature: np.exp(expected_log[feature].to_numpy())})
        for effect in effects(exponent, plan.last_training_trial):
            printed = plan.printed_terms[feature]
            terms = [*printed, *(term for term in effect.required if term not in printed)]
            beta = _projection(
                model_frame(frame, feature, exponent), terms, variance_ratios[feature]
            )
            value = sum(w * beta[term] for term, w in effect.weights.items() if term in beta)
            rows.append((effect.panel, feature, effect.name, exponent, value))
    return pd.DataFrame(rows, columns=["panel", "feature", "effect", "exponent", "truth"])


def _projection(
    frame: pd.DataFrame, terms: Sequence[str], variance_ratio: float
) -> dict[str, float]:
    """Generalised least squares with a random intercept of known variance ratio."""
    columns = np.column_stack([model_matrix(frame, list(terms)), frame["log_feature"]])
    code = frame[PARTICIPANT].astype("category").cat.codes.to_numpy()
    n_trials = np.bincount(code)
    sums = np.zeros((n_trials.size, columns.shape[1]))
    np.add.at(sums, code, columns)
    # subtracting this share of the group means turns the model into ordinary least squares
    share = 1.0 - 1.0 / np.sqrt(1.0 + n_trials * variance_ratio)
    independent = columns - (share / n_trials)[code, None] * sums[code]
    beta = np.linalg.lstsq(independent[:, :-1], independent[:, -1], rcond=None)[0]
    return dict(zip(terms, beta[1:].tolist(), strict=True))
