# The library on public real recordings (real_data_dir, or SWAYSTRIDE_REAL_DATA).

VALIDATION_DATASETS = ["standing_force_plate", "lumbar_imu_standing"]


def validation_available():
    folder = project.real_data_dir
    return [
        name for name in VALIDATION_DATASETS if folder and (folder / name).is_dir()
    ]


rule validation_dataset:
    wildcard_constraints:
        dataset="|".join(VALIDATION_DATASETS),
    input:
        code("scripts/validation_dataset.py"),
    output:
        checks="results/validation/{dataset}/checks.csv",
        trials="results/validation/{dataset}/trials.csv",
        figures=multiext("results/validation/{dataset}/figure", ".svg", ".png", ".pdf"),
    params:
        real_data=str(project.real_data_dir),
    log:
        "logs/validation/{dataset}.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        "{PYTHON:q} scripts/validation_dataset.py --dataset {wildcards.dataset:q}"
        " --real-data {params.real_data:q} --checks {output.checks:q} --trials {output.trials:q}"
        " --figure {output.figures[0]:q} 2>&1 | tee {log:q}"


rule validation:
    input:
        code("scripts/validation_page.py"),
        expand(
            "results/validation/{dataset}/{file}",
            dataset=validation_available(),
            file=["checks.csv", "figure.svg", "figure.png"],
        ),
        "workflow/report/validation.yaml",
    output:
        summary="results/validation/summary.csv",
        page="results/validation/report.html",
    params:
        available=validation_available(),
        skipped=[
            name for name in VALIDATION_DATASETS if name not in validation_available()
        ],
    log:
        "logs/validation/page.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        "{PYTHON:q} scripts/validation_page.py --available {params.available:q}"
        " --skipped {params.skipped:q} --summary {output.summary:q} --page {output.page:q}"
        " 2>&1 | tee {log:q}"
