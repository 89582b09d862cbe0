"""What every entry in ``scripts/`` shares: a parser, and errors as one readable line."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from swaystride.errors import SwaystrideError


def script_parser(description: str | None) -> argparse.ArgumentParser:
    """Create the parser of a script from its docstring.

    Parameters
    ----------
    description : str or None
        The script's ``__doc__``.

    Examples
    --------
    >>> script_parser("Compute the sway measures of one participant.").description
    'Compute the sway measures of one participant.'
    """
    return argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )


def json_argument(text: str) -> Any:
    """Parse an argument whose `text` carries parameters as JSON."""
    try:
        return json.loads(text)
    except json.JSONDecodeError as error:
        raise argparse.ArgumentTypeError(f"not valid JSON: {error}") from None


def json_file(path: str) -> Any:
    """Read an argument that is the `path` of a JSON file with parameters."""
    try:
        return json.loads(Path(path).read_text(encoding="utf-8"))
    except (OSError, json.JSONDecodeError) as error:
        raise argparse.ArgumentTypeError(f"cannot read {path}: {error}") from None


def run_script(main: Callable[[], None]) -> None:
    """Run a script's `main`; an error of this library becomes one line and exit status 1.

    Anything else is a defect of the program and keeps its traceback.
    """
    try:
        main()
    except SwaystrideError as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(1)
