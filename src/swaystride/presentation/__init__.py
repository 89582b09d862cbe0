"""How numbers, tables and figures look; knows no study."""

from swaystride.lazy import lazy_exports

__getattr__, __dir__, __all__ = lazy_exports(
    __name__,
    {
        "ColumnFormat": "number_format",
        "format_integer": "number_format",
        "format_interval": "number_format",
        "format_number": "number_format",
        "format_p": "number_format",
        "parse_format": "number_format",
        "SIMULATED_NOTE": "table_files",
        "read_table": "table_files",
        "write_table": "table_files",
        "OKABE_ITO": "figure_style",
        "figure_style": "figure_style",
        "new_figure": "figure_style",
        "save_figure": "figure_style",
    },
)
