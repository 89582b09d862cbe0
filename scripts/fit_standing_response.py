"""Fit the response surface of standing sway and write it beside its module.

Run by hand, and only after a setting of the standing model has changed: the result,
``src/swaystride/simulate/standing_response.json``, is part of the library.
"""

from __future__ import annotations

import json
from pathlib import Path

from swaystride.command_line import run_script, script_parser
from swaystride.configuration import from_mapping, load_yaml, plain_values
from swaystride.simulate.standing_model import StandingModel, TrialSettings
from swaystride.simulate.standing_response_fit import ResponseDesign, fit_standing_response


def main() -> None:
    """Read the settings, fit, write."""
    parser = script_parser(__doc__)
    parser.add_argument("--config", type=Path, required=True, help="config/studies/feedback.yaml")
    parser.add_argument("--output", type=Path, required=True, help="JSON file to write")
    arguments = parser.parse_args()
    section = plain_values(load_yaml(arguments.config)["simulation"])
    record = fit_standing_response(
        from_mapping(StandingModel, section["standing"], place="simulation.standing"),
        from_mapping(TrialSettings, section["trial"], place="simulation.trial"),
        from_mapping(ResponseDesign, section["response"], place="simulation.response"),
    )
    lines = [f"  {json.dumps(key)}: {json.dumps(part)}" for key, part in record.items()]
    arguments.output.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


if __name__ == "__main__":
    run_script(main)
