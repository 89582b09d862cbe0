import sys
from pathlib import Path

from snakemake.utils import min_version

min_version("9.27")

sys.path[:0] = [
    str(Path(workflow.basedir) / "src"),
    str(Path(workflow.basedir) / "workflow"),
]

from jobs import code, commit, look_once_a_second, prepare_environment
from project import Project


configfile: "config/config.yaml"


project = Project(config)
prepare_environment()
look_once_a_second()


wildcard_constraints:
    participant="[^/]+",
    cohort="|".join(project.cohorts),
    variant="|".join({v for s in project.studies for v in project.variants(s)}),


rule all:
    default_target: True
    input:
        f"results/{project.cohort}/report.html",
        f"results/{project.cohort}/provenance.json",


rule variants:
    input:
        [
            f"results/{project.cohort}/{study}/{variant}/report.html"
            for study in project.studies
            for variant in project.variants(study)
        ],


rule recovery:
    input:
        [f"results/recovery/{study}.csv" for study in project.studies],


include: "workflow/rules/report.smk"


for study in project.studies:

    include: f"workflow/rules/{study}.smk"


include: "workflow/rules/validation.smk"
