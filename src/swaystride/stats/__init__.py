"""Statistics that know no biomechanics: mixed models, selection of terms, resampling."""

from swaystride.lazy import lazy_exports

__getattr__, __dir__, __all__ = lazy_exports(
    __name__,
    {
        "fit_mixed_model": "mixed_model",
        "MixedModelFit": "mixed_model",
        "Refits": "mixed_refits",
        "MixedDesign": "mixed_design",
        "design_from_terms": "mixed_design",
        "DesignFit": "mixed_fit",
        "fit_design": "mixed_fit",
        "search_exponent": "selection",
        "eliminate_terms": "selection",
        "raise_to_exponent": "selection",
        "reliability_formula": "reliability",
        "intraclass_correlation": "reliability",
        "reliability_class": "reliability",
        "bootstrap_icc": "reliability",
        "two_way_icc": "reliability",
        "pearson": "correlation",
        "spearman": "correlation",
        "cluster_weights": "cluster_bootstrap",
        "bootstrap_interval": "cluster_bootstrap",
        "resampled_fixed_effects": "clustered_mixed_model",
    },
)
