# Tables, figures and target of the experience study, and its recovery; included by its other rules.

from experience_rules import FIGURE_INPUTS, TABLE_INPUTS, TRUTH_TABLES

#: Sets of ratings of `make recovery`, resamples of runners in each, and whose measures are rated.
RECOVERY_COHORTS = 200
RECOVERY_RESAMPLES = 400
RECOVERY_VARIANTS = [
    variant
    for variant in project.variants("experience")
    if variant != "literal_toe_off"
]


rule experience_table:
    input:
        code("scripts/experience_table.py"),
        experience.table_inputs,
        tables=experience.design_tables,
        parameters=experience.parameters("analysis.model", "analysis.tables"),
    output:
        multiext(
            "results/{cohort}/experience/{variant}/tables/{table}",
            csv=".csv",
            md=".md",
            tex=".tex",
            html=".html",
        ),
    log:
        "logs/{cohort}/experience/{variant}/{table}.log",
    wildcard_constraints:
        table="|".join(TABLE_INPUTS),
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=experience.raw,
        runs=experience.runs,
        results=experience.results,
        measured=experience.measured_folder,
        models=experience.model_folder,
        simulated=project.simulated_flag,
    shell:
        "python scripts/experience_table.py --table {wildcards.table:q} --raw {params.raw:q}"
        " --runs {params.runs:q} --cohort-results {params.results:q}"
        " --measured {params.measured:q} --models {params.models:q}"
        " --parameters {input.parameters:q} {params.simulated}"
        " --output {output.csv:q} 2>&1 | tee {log:q}"


rule experience_truth_table:
    input:
        code("scripts/experience_truth_table.py"),
        experience.truth_inputs,
        published=expand("data/published/{table}.csv", table=["table_5_3", "table_5_4"]),
        parameters=experience.parameters("analysis.model", "analysis.tables"),
    output:
        multiext(
            "results/{cohort}/experience/{variant}/tables/{table}",
            csv=".csv",
            md=".md",
            tex=".tex",
            html=".html",
        ),
    log:
        "logs/{cohort}/experience/{variant}/{table}.log",
    wildcard_constraints:
        cohort=project.simulated_pattern,
        table="|".join(TRUTH_TABLES),
    conda:
        "../envs/swaystride.yaml"
    params:
        truth=experience.truth_folder,
        runs=experience.runs,
        results=experience.results,
        measured=experience.measured_folder,
        models=experience.model_folder,
        published=lambda wildcards, input: Path(input.published[0]).parent,
    shell:
        "python scripts/experience_truth_table.py --table {wildcards.table:q}"
        " --truth {params.truth:q} --runs {params.runs:q}"
        " --cohort-results {params.results:q} --measured {params.measured:q}"
        " --models {params.models:q} --published {params.published:q}"
        " --parameters {input.parameters:q} --output {output.csv:q} 2>&1 | tee {log:q}"


rule experience_figure:
    input:
        code("scripts/experience_figure.py"),
        experience.figure_inputs,
        parameters=experience.parameters(
            "analysis.windows", "analysis.model", "analysis.tables"
        ),
    output:
        multiext(
            "results/{cohort}/experience/{variant}/figures/{figure}",
            svg=".svg",
            png=".png",
            pdf=".pdf",
        ),
    log:
        "logs/{cohort}/experience/{variant}/{figure}.log",
    wildcard_constraints:
        figure="|".join(FIGURE_INPUTS),
    conda:
        "../envs/swaystride.yaml"
    params:
        runs=experience.runs,
        results=experience.results,
        measured=experience.measured_folder,
        models=experience.model_folder,
        simulated=project.simulated_flag,
    shell:
        "python scripts/experience_figure.py --figure {wildcards.figure:q}"
        " --runs {params.runs:q} --cohort-results {params.results:q}"
        " --measured {params.measured:q} --models {params.models:q}"
        " --parameters {input.parameters:q} {params.simulated}"
        " --output {output.svg:q} 2>&1 | tee {log:q}"


rule experience:
    input:
        expand(
            "results/{cohort}/experience/{variant}/report.html",
            cohort=project.cohort,
            variant=project.base_variant,
        ),


# Recovery: the measured runs of the published cohort, rated anew many times. A target of its own.


rule experience_recovery_variant:
    input:
        code("scripts/experience_recovery.py"),
        observations=experience.recovery_observations,
        population=experience.recovery_population,
        values=experience.recovery_true_values,
        printed=expand("data/published/{table}.csv", table=["table_5_3", "table_5_4"]),
        parameters="results/recovery/experience/parameters/simulation.json",
    output:
        "results/recovery/experience/{variant}.csv",
    log:
        "logs/recovery/experience_{variant}.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        truth=lambda wildcards, input: Path(input.population).parent,
        printed=lambda wildcards, input: Path(input.printed[0]).parent,
        seed=project.seed,
        cohorts=RECOVERY_COHORTS,
        resamples=RECOVERY_RESAMPLES,
        start_s=experience.recovery_start_s,
        mean=experience.recovery_mean,
        # errors of the printed toe-off are in its measures: said, not judged
        reported=lambda wildcards: (
            "--reported" if wildcards.variant == project.base_variant else ""
        ),
    shell:
        "python scripts/experience_recovery.py --parameters {input.parameters:q}"
        " --runs {input.observations:q} --truth-folder {params.truth:q}"
        " --printed {params.printed:q} --variant {wildcards.variant:q} --seed {params.seed}"
        " --cohorts {params.cohorts} --resamples {params.resamples}"
        " --start-s {params.start_s} --mean {params.mean} {params.reported} --output {output:q}"
        " 2>&1 | tee {log:q}"


rule experience_recovery:
    input:
        expand("results/recovery/experience/{variant}.csv", variant=RECOVERY_VARIANTS),
    output:
        "results/recovery/experience.csv",
    log:
        "logs/recovery/experience.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        # one header, then the rows of all variants
        "awk 'FNR > 1 || NR == 1' {input:q} 2> {log:q} > {output:q}"
