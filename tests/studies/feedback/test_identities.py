"""Printed effects against the identities among the six features (register I-02c)."""

import numpy as np
import pandas as pd

from import_graph import REPOSITORY
from swaystride.studies.feedback.identities import attainability, block_change_attainability


def verdicts(table):
    marks = attainability(table, 15)
    return {(m.panel, m.feature, m.effect): m.attainable for m in marks.itertuples(index=False)}


def test_the_rows_that_the_register_names_are_not_attainable(printed):
    marked = verdicts(printed)
    assert not marked["training", "phi_rms", "concurrent"]
    assert not marked["training", "ellipse_area", "concurrent"]
    for panel, effect in (
        ("training", "concurrent"),
        ("training", "terminal_minus_concurrent"),
        ("removal", "concurrent"),
    ):
        assert not marked[panel, "path_length", effect]


def test_the_free_features_are_always_attainable(printed):
    marked = verdicts(printed)
    assert all(ok for key, ok in marked.items() if key[1] in {"ap_rms", "ml_rms", "phi_mv"})


def consistent_table(printed, share):
    """Table 2.3 rebuilt from AP, ML and MV for one share of AP in Phi², without rounding."""
    keys = ["panel", "feature", "effect"]
    estimate = printed.set_index(keys)["estimate"].to_dict()
    exponent = printed.set_index(keys)["exponent"].to_dict()

    def scale(*key):
        return 15 ** exponent[key] if key[0] == "training" else 1.0

    def at_15(*key):
        return estimate[key] * scale(*key)

    def phi(ap, ml):
        return 0.5 * np.log(share * np.exp(2 * ap) + (1 - share) * np.exp(2 * ml))

    for panel, effect in {(p, e) for p, _, e in exponent}:
        ap, ml = at_15(panel, "ap_rms", effect), at_15(panel, "ml_rms", effect)
        change = phi(ap, ml)
        if effect == "terminal_minus_concurrent":
            ap0, ml0 = (at_15(panel, name, "concurrent") for name in ("ap_rms", "ml_rms"))
            change = phi(ap0 + ap, ml0 + ml) - phi(ap0, ml0)
        implied = {
            "phi_rms": change,
            "ellipse_area": ap + ml,
            "path_length": at_15(panel, "phi_mv", effect),
        }
        for feature, value in implied.items():
            estimate[panel, feature, effect] = value / scale(panel, feature, effect)
    rows = [estimate[key] for key in zip(*(printed[name] for name in keys), strict=True)]
    return printed.assign(estimate=rows)


def test_a_table_that_obeys_the_identities_is_wholly_attainable(printed):
    for share in (0.1, 0.55, 0.9):
        rebuilt = consistent_table(printed, share)
        assert all(verdicts(rebuilt).values())
        rounded = rebuilt.assign(estimate=rebuilt["estimate"].round(3))
        assert all(verdicts(rounded).values())


def test_reasons_name_the_identity(printed):
    reasons = attainability(printed, 15).groupby("feature")["attainable_reason"].agg(" ".join)
    assert "PL = MV × duration" in reasons["path_length"]
    assert "Phi² = AP² + ML²" in reasons["phi_rms"]
    assert "EA ∝ AP × ML" in reasons["ellipse_area"]


def test_the_difference_of_the_text_does_not_follow_from_table_2_3(printed):
    """−.081 is printed; −.116·15^0.1 + (−.027 + .170) is −.009 (register I-02c)."""
    text = pd.read_csv(REPOSITORY / "data" / "published" / "table_2_4.csv")
    marks = block_change_attainability(printed, text, 15)
    row = marks[(marks["effect"] == "terminal_minus_concurrent") & (marks["feature"] == "phi_mv")]
    assert not row["attainable"].item()
    assert "implied -0.009" in row["attainable_reason"].item()
    text.loc[row.index, "estimate"] = -0.009
    assert block_change_attainability(printed, text, 15)["attainable"].all()
