"""Read and check ratings of affect and questionnaires of all runs."""

from pathlib import Path

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.studies.experience.answers import read_answers, read_checks
from swaystride.studies.experience.design import read_design
from swaystride.studies.experience.settings import answer_rules


def main() -> None:
    """Parse paths, call the library, write the files."""
    parser = script_parser(__doc__)
    parser.add_argument("--raw", type=Path, required=True)
    parser.add_argument("--quality", type=Path, required=True, help="folder of <run>.json")
    parser.add_argument("--spans", type=Path, required=True, help="folder of <run>.parquet")
    parser.add_argument("--parameters", type=json_file, required=True)
    parser.add_argument("--affect", type=Path, required=True)
    parser.add_argument("--scores", type=Path, required=True)
    parser.add_argument("--findings", type=Path, required=True)
    arguments = parser.parse_args()
    design = read_design(arguments.raw)
    checks = read_checks(design.run_names, arguments.quality, arguments.spans)
    rules = answer_rules(arguments.parameters["answers"])
    answers = read_answers(arguments.raw, design, checks, rules)
    answers.affect.to_parquet(arguments.affect, index=False)
    answers.scores.to_parquet(arguments.scores, index=False)
    answers.findings.to_csv(arguments.findings, index=False, lineterminator="\n")
    print(f"{len(answers.scores)} runs, {len(answers.affect)} ratings")


if __name__ == "__main__":
    run_script(main)
