"""Recovery over many cohorts: verdicts on print, estimator and coverage."""

from __future__ import annotations

import numpy as np
import pandas as pd

from swaystride.studies.intensity.recovery import (
    KNOWN_DEVIATIONS,
    printed_quantities,
    recovery_table,
)

ICC, EFFECT = "study3_text/icc_pt_per_trial", "table_3_2/stance/per_trial"


def cohorts(n: int = 400, width: float = 1.96) -> list[pd.DataFrame]:
    rng = np.random.default_rng(1)
    frames = []
    for _ in range(n):
        effect, icc = 0.6 + 0.1 * rng.standard_normal(), 0.86 + 0.02 * rng.standard_normal()
        frames.append(
            pd.DataFrame(
                {
                    "quantity": [ICC, EFFECT],
                    "estimate": [icc, effect],
                    "participant_ci_low": [np.nan, effect - 0.1 * width],
                    "participant_ci_high": [np.nan, effect + 0.1 * width],
                }
            )
        )
    return frames


def verdicts(table: pd.DataFrame) -> dict[tuple[str, str], str]:
    return {(row["quantity"], row["check"]): row["within"] for row in table.to_dict("records")}


def test_a_right_simulation_passes() -> None:
    printed = pd.Series({ICC: 0.868, EFFECT: 0.607})
    table = recovery_table(cohorts(), printed, pd.Series({ICC: 0.861}), {})
    assert set(table["within"]) == {"yes"}
    found = verdicts(table)
    assert (EFFECT, "coverage") in found
    assert (ICC, "mean of the estimator") in found


def test_a_print_outside_the_cohorts_fails_unless_it_is_explained() -> None:
    printed = pd.Series({ICC: 0.868, EFFECT: 1.2})
    population = pd.Series({ICC: 0.861})
    failed = verdicts(recovery_table(cohorts(), printed, population, {}))
    explained = verdicts(recovery_table(cohorts(), printed, population, {EFFECT: "because"}))
    assert failed[EFFECT, "printed number"] == "no"
    assert explained[EFFECT, "printed number"] == "explained"


def test_a_biased_icc_and_a_narrow_interval_fail() -> None:
    printed = pd.Series({ICC: 0.868, EFFECT: 0.607})
    biased = verdicts(recovery_table(cohorts(), printed, pd.Series({ICC: 0.90}), {}))
    narrow = verdicts(recovery_table(cohorts(width=1.0), printed, pd.Series({ICC: 0.86}), {}))
    assert biased[ICC, "mean of the estimator"] == "no"
    assert narrow[EFFECT, "coverage"] == "no"


def test_every_printed_number_has_one_name() -> None:
    folder = "data/published"
    printed = printed_quantities(
        *(pd.read_csv(f"{folder}/{name}.csv") for name in ("table_3_2", "table_3_3", "study3_text"))
    )
    assert len(printed) == 8 + 16 + 21
    assert printed.index.is_unique
    assert set(KNOWN_DEVIATIONS) <= set(printed.index)
