"""Simulated bodies, sensors and cohorts: raw files in vendor formats with known truth."""

from swaystride.lazy import lazy_exports

__getattr__, __dir__, __all__ = lazy_exports(
    __name__,
    {
        "cohort_from_config": "feedback_parameters",
        "design_tables": "feedback_cohort",
        "draw_features": "feedback_population",
        "expected_log_features": "feedback_population",
        "generator": "seeds",
        "simulate_standing": "standing_body",
        "write_participant": "feedback_recordings",
    },
)
