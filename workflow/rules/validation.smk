# The library on public real recordings (real_data_dir, or SWAYSTRIDE_REAL_DATA).

from project import VALIDATION_DATASETS


rule validation_dataset:
    input:
        code("scripts/validation_dataset.py"),
    output:
        multiext(
            "results/validation/{dataset}/figure", svg=".svg", png=".png", pdf=".pdf"
        ),
        checks="results/validation/{dataset}/checks.csv",
        trials="results/validation/{dataset}/trials.csv",
    log:
        "logs/validation/{dataset}.log",
    wildcard_constraints:
        dataset="|".join(VALIDATION_DATASETS),
    conda:
        "../envs/swaystride.yaml"
    params:
        real_data=str(project.real_data_dir),
    shell:
        "python scripts/validation_dataset.py --dataset {wildcards.dataset:q}"
        " --real-data {params.real_data:q} --checks {output.checks:q} --trials {output.trials:q}"
        " --figure {output.svg:q} 2>&1 | tee {log:q}"


rule validation:
    input:
        code("scripts/validation_page.py"),
        expand(
            "results/validation/{dataset}/{file}",
            dataset=project.validation_datasets,
            file=["checks.csv", "figure.svg", "figure.png"],
        ),
        "workflow/report/validation.yaml",
    output:
        summary="results/validation/summary.csv",
        page="results/validation/report.html",
    log:
        "logs/validation/page.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        available=project.validation_datasets,
        skipped=[
            name
            for name in VALIDATION_DATASETS
            if name not in project.validation_datasets
        ],
    shell:
        "python scripts/validation_page.py --available {params.available:q}"
        " --skipped {params.skipped:q} --summary {output.summary:q} --page {output.page:q}"
        " 2>&1 | tee {log:q}"
