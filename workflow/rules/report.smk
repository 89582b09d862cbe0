# Pages and provenance: one page per study and variant; one page and one provenance per cohort.

#: Installed distributions that the results depend on.
PACKAGES = (
    "snakemake numpy scipy pandas pyarrow xarray h5netcdf vqf numba matplotlib jinja2"
)


rule parameter_sections:
    output:
        "results/{cohort}/{study}/{variant}/parameters/{sections}.json",
    log:
        "logs/{cohort}/{study}/{variant}/parameters_{sections}.log",
    # a moment's work, for which no recording should wait
    priority: 100
    conda:
        "../envs/swaystride.yaml"
    params:
        values=lambda wildcards: project.parameters(
            wildcards.study,
            wildcards.cohort,
            wildcards.variant,
            *wildcards.sections.split("+"),
        ),
    shell:
        "printf '%s\\n' {params.values:q} 2> {log:q} > {output:q}"


rule recovery_parameter_sections:
    output:
        "results/recovery/{study}/parameters/{sections}.json",
    log:
        "logs/recovery/{study}/parameters_{sections}.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        values=lambda wildcards: project.recovery_parameters(
            wildcards.study, *wildcards.sections.split("+")
        ),
    shell:
        "printf '%s\\n' {params.values:q} 2> {log:q} > {output:q}"


rule study_parameters:
    input:
        code("scripts/write_parameters.py"),
    output:
        "results/{cohort}/{study}/{variant}/parameters.csv",
    log:
        "logs/{cohort}/{study}/{variant}/parameters.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        rows=lambda wildcards: project.parameter_rows(
            wildcards.study, wildcards.cohort, wildcards.variant
        ),
    shell:
        "python scripts/write_parameters.py --rows {params.rows:q} --output {output:q}"
        " 2>&1 | tee {log:q}"


rule study_page:
    input:
        code("scripts/study_page.py"),
        lambda wildcards: project.study_page_files(
            wildcards.study, wildcards.cohort, wildcards.variant
        ),
    output:
        "results/{cohort}/{study}/{variant}/report.html",
    log:
        "logs/{cohort}/{study}/{variant}/page.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        scale=project.cohort_scale,
        simulated=project.simulated_flag,
    shell:
        "python scripts/study_page.py --study {wildcards.study:q} --cohort {wildcards.cohort:q}"
        " --variant {wildcards.variant:q} --scale {params.scale:q} {params.simulated}"
        " --output {output:q} 2>&1 | tee {log:q}"


rule cohort_page:
    input:
        code("scripts/cohort_page.py"),
        lambda wildcards: [
            file
            for study in project.studies
            for file in project.study_page_files(
                study, wildcards.cohort, project.base_variant
            )
        ],
    output:
        "results/{cohort}/report.html",
    log:
        "logs/{cohort}/page.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        variant=project.base_variant,
        scale=project.cohort_scale,
        simulated=project.simulated_flag,
        studies=project.studies,
    shell:
        "python scripts/cohort_page.py --cohort {wildcards.cohort:q} --variant {params.variant:q}"
        " --scale {params.scale:q} {params.simulated} --output {output:q} {params.studies:q}"
        " 2>&1 | tee {log:q}"


rule provenance:
    input:
        code("scripts/provenance.py"),
        "requirements.txt",
        lambda wildcards: project.result_files(wildcards.cohort),
        page="results/{cohort}/report.html",
        pages=lambda wildcards: [
            f"results/{wildcards.cohort}/{study}/{project.base_variant}/report.html"
            for study in project.studies
        ],
    output:
        "results/{cohort}/provenance.json",
    log:
        "logs/{cohort}/provenance.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        commit=commit(),
        config=lambda wildcards: project.config_json(wildcards.cohort),
        seed=project.seed,
        packages=PACKAGES,
        inputs=lambda wildcards: [
            "data/published",
            "requirements.txt",
            *(
                project.raw_folder(wildcards.cohort, study)
                for study in project.studies
            ),
        ],
        outputs=lambda wildcards: project.result_files(wildcards.cohort),
    shell:
        "python scripts/provenance.py --commit {params.commit:q} --config {params.config:q}"
        " --seed {params.seed} --packages {params.packages} --inputs {params.inputs:q}"
        " --outputs {params.outputs:q} --output {output:q} 2>&1 | tee {log:q}"
