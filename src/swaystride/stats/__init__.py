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
    },
)
