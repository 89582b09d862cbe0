"""Runs that hang together as real ones do, and the parameters of their ratings."""

import numpy as np
import pandas as pd

from swaystride.simulate.experience_population import PrintedAssociations
from swaystride.simulate.experience_rating_parameters import (
    AffectCourse,
    AssociationModel,
    RatingModel,
    ScaleMargins,
)
from swaystride.simulate.experience_ratings import RatedRuns

RUNS_OF_EACH = (2, 2, 1, 2, 1, 5, 2, 2, 1, 2, 2, 1)
RUNNERS = [f"P{k + 1:02d}" for k, n in enumerate(RUNS_OF_EACH) for _ in range(n)]
NAMES = [f"P{k + 1:02d}_{j + 1:02d}" for k, n in enumerate(RUNS_OF_EACH) for j in range(n)]
BETWEEN = np.array([[1.0, -0.033, -0.172], [-0.033, 1.0, 0.439], [-0.172, 0.439, 1.0]])


def rated_runs():
    """Half hours of twelve runners; the last five minutes of ratings of one run are lost."""
    known = [1500.0 if name == "P10_02" else 1800.0 for name in NAMES]
    return RatedRuns(NAMES, RUNNERS, [1800.0] * len(NAMES), known, 600.0)


def rating_model(**association):
    """Parameters near those of the configuration."""
    values = {
        "distance": "standard_errors",
        "unexplained_share": 0.8,
        "runner_share": 0.0,
        "reversed_measures": (),
    }
    return RatingModel(
        association=AssociationModel(**(values | association)),
        affective_valence=ScaleMargins(2.7, 0.88, 0.0, 5.0),
        activity_enjoyment=ScaleMargins(94.0, 14.0, 18.0, 126.0),
        flow=ScaleMargins(71.0, 7.8, 13.0, 97.0),
        course=AffectCourse(
            least_ratings=2,
            most_ratings=14,
            first_within_s=60.0,
            shortest_gap_s=20.0,
            steady_share=0.1,
            drift_sd=0.3,
            sway_sd=0.3,
            sway_memory_s=300.0,
        ),
    )


def measures(keys, seed=1):
    """A table of measures by run; the first few follow from each other, others share a part.

    Parameters
    ----------
    keys : sequence of str
        Names of the columns.
    seed : int
        Of the runners.
    """
    rng = np.random.default_rng(seed)
    person = {runner: rng.standard_normal(len(keys)) for runner in dict.fromkeys(RUNNERS)}
    own = np.stack([person[runner] for runner in RUNNERS])
    values = 0.8 * own + 0.6 * rng.standard_normal(own.shape)
    values[:, ::3] += values[:, :1]
    values[:, 1] = (3.0 + 0.1 * values[:, 2]) / (0.7 + 0.02 * values[:, 3])
    return pd.DataFrame(values, index=NAMES, columns=list(keys))


def printed_like(correlation):
    """Correlations over 23 runs as if printed, between scales as in the document."""
    correlation = np.asarray(correlation, dtype=float)
    return PrintedAssociations(
        correlation=correlation,
        n_runs=np.full(len(correlation), 23.0),
        between_scales=BETWEEN.copy(),
        significant=np.abs(correlation) > 0.41,
    )
