"""Pages: printed beside reproduced, participant flow, data quality, parameters, provenance."""

from swaystride.lazy import lazy_exports

__getattr__, __dir__, __all__ = lazy_exports(
    __name__,
    {
        "Unattainable": "attainability",
        "Value": "comparison",
        "compare_numbers": "comparison",
        "compare_words": "comparison",
        "summarise": "comparison",
        "comparison_html": "comparison_view",
        "number_view": "comparison_view",
        "word_view": "comparison_view",
        "Exclusion": "content",
        "Flow": "content",
        "Parameter": "content",
        "StudyContent": "content",
        "load_page_text": "page_text",
        "build_items": "assemble",
        "study_content": "assemble",
        "render_study_page": "study_page",
        "render_cohort_page": "cohort_page",
        "collect_provenance": "provenance",
        "config_hash": "provenance",
        "write_json": "provenance",
    },
)
