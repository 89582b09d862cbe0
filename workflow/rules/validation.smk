# The library on public real recordings (real_data_dir, or SWAYSTRIDE_REAL_DATA).

from project import FOOT_DATASETS, RUNNING_DATASETS, VALIDATION_DATASETS


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
        dataset="|".join(
            name
            for name in VALIDATION_DATASETS
            if name not in (*FOOT_DATASETS, *RUNNING_DATASETS)
        ),
    conda:
        "../envs/swaystride.yaml"
    params:
        real_data=str(project.real_data_dir),
    shell:
        "python scripts/validation_dataset.py --dataset {wildcards.dataset:q}"
        " --real-data {params.real_data:q} --checks {output.checks:q} --trials {output.trials:q}"
        " --figure {output.svg:q} 2>&1 | tee {log:q}"


# Foot recordings have several figures each: a rule for each data set, with the files of its page.
for dataset in FOOT_DATASETS:

    rule:
        name:
            f"validation_{dataset}"
        input:
            code("scripts/validation_feet.py"),
            project.gaitmap_table(dataset),
        output:
            project.validation_files(dataset)[1:],
            directory(f"results/validation/{dataset}/trial_figures"),
            checks=project.validation_files(dataset)[0],
        log:
            f"logs/validation/{dataset}.log",
        conda:
            "../envs/swaystride.yaml"
        params:
            dataset=dataset,
            real_data=str(project.real_data_dir),
            gaitmap=[f"--gaitmap {table}" for table in project.gaitmap_table(dataset)],
        shell:
            "python scripts/validation_feet.py --dataset {params.dataset:q}"
            " --real-data {params.real_data:q} {params.gaitmap} --checks {output.checks:q}"
            " 2>&1 | tee {log:q}"


# The simulated runner beside real ones.
for dataset in RUNNING_DATASETS:

    rule:
        name:
            f"validation_{dataset}"
        input:
            code("scripts/validation_running.py"),
        output:
            project.validation_files(dataset)[1:],
            checks=project.validation_files(dataset)[0],
        log:
            f"logs/validation/{dataset}.log",
        conda:
            "../envs/swaystride.yaml"
        params:
            dataset=dataset,
            real_data=str(project.real_data_dir),
        shell:
            "python scripts/validation_running.py --dataset {params.dataset:q}"
            " --real-data {params.real_data:q} --checks {output.checks:q} 2>&1 | tee {log:q}"


# gaitmap in its own environment, once `make peers` has set it up; a table at hand is used as it is.
if project.has_gaitmap:

    rule validation_gaitmap:
        input:
            "scripts/peers_gaitmap.py",
            "requirements-peers-gait.txt",
        output:
            "results/peers/gaitmap_{dataset}.csv",
        log:
            "logs/validation/gaitmap_{dataset}.log",
        wildcard_constraints:
            dataset="|".join(FOOT_DATASETS),
        conda:
            "../envs/swaystride.yaml"
        params:
            real_data=str(project.real_data_dir),
        shell:
            ".venv-peers-gait/bin/python scripts/peers_gaitmap.py {wildcards.dataset:q}"
            " --real-data {params.real_data:q} --table {output:q} 2>&1 | tee {log:q}"


rule validation:
    input:
        code("scripts/validation_page.py"),
        [
            file
            for dataset in project.validation_datasets
            for file in project.validation_files(dataset)
        ],
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
