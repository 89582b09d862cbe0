"""Recovery of a cohort with known errors."""

import kinematics_results as made
import numpy as np
import pytest

from swaystride.studies.kinematics.recovery import RECOVERY_COLUMNS, recovery_table


def test_known_errors_are_recovered():
    frames = made.frames()
    table = recovery_table(frames["truth"], frames["truth_strides"], "printed")
    assert list(table) == list(RECOVERY_COLUMNS)
    assert len(table) == 18 + 4
    rows = table.set_index("quantity")
    knee = rows.loc["left/knee_flexion_deg"]
    assert (knee["bias"], knee["coverage"], knee["rmsd_after_constant"]) == pytest.approx(
        (4.0, 0.5, 1.0)
    )
    length = rows.loc["right/stride_length_m"]
    assert (length["truth"], length["mean"], length["bias"]) == pytest.approx((2.7, 2.5, -0.2))
    assert np.isnan(length["coverage"])
    assert set(table["n_trials"]) == {len(made.TRIALS)}
