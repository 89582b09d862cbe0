"""Write provenance.json of a cohort: commit, configuration, versions, seed, inputs and outputs."""

from pathlib import Path

from swaystride.command_line import json_argument, run_script, script_parser
from swaystride.report.provenance import collect_provenance, write_json


def main() -> None:
    """Parse paths, call the library, write the file."""
    parser = script_parser(__doc__)
    parser.add_argument("--commit", required=True)
    parser.add_argument("--config", type=json_argument, required=True)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--packages", nargs="+", required=True)
    parser.add_argument("--inputs", nargs="+", type=Path, required=True)
    parser.add_argument("--outputs", nargs="+", type=Path, required=True)
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()

    def files(roots: list[Path]) -> list[Path]:
        found = [path for root in roots for path in ([root] if root.is_file() else root.rglob("*"))]
        hidden = {path for path in found if path.name.startswith(".")}
        return sorted({path for path in found if path.is_file()} - hidden)

    provenance = collect_provenance(
        commit=arguments.commit,
        config=arguments.config,
        seed=arguments.seed,
        packages=arguments.packages,
        inputs=files(arguments.inputs),
        outputs=files(arguments.outputs),
    )
    write_json(provenance, arguments.output)


if __name__ == "__main__":
    run_script(main)
