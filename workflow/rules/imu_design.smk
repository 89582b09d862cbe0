# Which IMU a foot-worn stride estimate needs (Potter et al. 2019, Sensors 19(11):2601).
# Stages: design, simulate | import | metrics | observations, models | tables, figures | page

from imu_design_rules import (
    FIGURE_MODELS,
    RAW_FIGURES,
    RECOVERY_SEEDS,
    TABLE_MODELS,
    ImuDesignRules,
)

imu_design = ImuDesignRules(project)


rule imu_design_design:
    input:
        code("scripts/imu_design_design.py"),
        parameters=imu_design.parameters("simulation"),
    output:
        participants="data/raw/{cohort}/imu_design/participants.tsv",
        trials="data/raw/{cohort}/imu_design/trials.tsv",
    log:
        "logs/{cohort}/imu_design/design.log",
    wildcard_constraints:
        cohort=project.simulated_pattern,
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=imu_design.raw,
        seed=project.seed,
    shell:
        "python scripts/imu_design_design.py --parameters {input.parameters:q}"
        " --seed {params.seed} --folder {params.raw:q} 2>&1 | tee {log:q}"


rule imu_design_simulate:
    input:
        code("scripts/imu_design_simulate.py"),
        parameters=imu_design.parameters("simulation"),
    output:
        recordings=directory(r"data/raw/{cohort}/imu_design/{participant,P\d+}"),
        truth=r"data/raw/{cohort}/imu_design/truth/{participant,P\d+}.json",
    log:
        "logs/{cohort}/imu_design/simulate_{participant}.log",
    wildcard_constraints:
        cohort=project.simulated_pattern,
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=imu_design.raw,
        seed=project.seed,
    shell:
        "python scripts/imu_design_simulate.py --participant {wildcards.participant:q}"
        " --parameters {input.parameters:q} --seed {params.seed}"
        " --folder {params.raw:q} --truth {output.truth:q}"
        " 2>&1 | tee {log:q}"


rule imu_design_import:
    input:
        code("scripts/imu_design_import.py"),
        tables=imu_design.design_tables,
        recordings=imu_design.recordings,
        parameters=imu_design.parameters("analysis.recording", "analysis.sensors"),
    output:
        recordings="results/{cohort}/imu_design/recordings/{participant}.nc",
        findings="results/{cohort}/imu_design/quality/findings/{participant}.csv",
        exclusions="results/{cohort}/imu_design/quality/exclusions/{participant}.csv",
        ranges="results/{cohort}/imu_design/quality/ranges/{participant}.csv",
    log:
        "logs/{cohort}/imu_design/import_{participant}.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=imu_design.raw,
    shell:
        "python scripts/imu_design_import.py --raw {params.raw:q}"
        " --participant {wildcards.participant:q} --parameters {input.parameters:q}"
        " --recordings {output.recordings:q} --findings {output.findings:q}"
        " --exclusions {output.exclusions:q} --ranges {output.ranges:q} 2>&1 | tee {log:q}"


rule imu_design_metrics:
    input:
        code("scripts/imu_design_metrics.py"),
        tables=imu_design.design_tables,
        recordings="results/{cohort}/imu_design/recordings/{participant}.nc",
        parameters=imu_design.parameters("analysis.experiments", "analysis.measurement"),
    output:
        metrics="results/{cohort}/imu_design/{variant}/metrics/{participant}.parquet",
        strides="results/{cohort}/imu_design/{variant}/strides/{participant}.parquet",
        findings="results/{cohort}/imu_design/{variant}/findings/{participant}.csv",
    log:
        "logs/{cohort}/imu_design/{variant}/metrics_{participant}.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=imu_design.raw,
    shell:
        "python scripts/imu_design_metrics.py --raw {params.raw:q}"
        " --participant {wildcards.participant:q} --recordings {input.recordings:q}"
        " --parameters {input.parameters:q} --metrics {output.metrics:q}"
        " --strides {output.strides:q} --findings {output.findings:q} 2>&1 | tee {log:q}"


rule imu_design_quality:
    input:
        code("scripts/imu_design_quality.py"),
        tables=imu_design.design_tables,
        parts=imu_design.quality_parts,
    output:
        findings="results/{cohort}/imu_design/quality/findings.csv",
        exclusions="results/{cohort}/imu_design/quality/exclusions.csv",
        flow="results/{cohort}/imu_design/quality/flow.json",
    log:
        "logs/{cohort}/imu_design/quality.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=imu_design.raw,
        parts=lambda wildcards, output: Path(output.findings).parent,
        measured=f"results/{{cohort}}/imu_design/{project.base_variant}",
        participants=imu_design.participants,
    shell:
        "python scripts/imu_design_quality.py --raw {params.raw:q} --parts {params.parts:q}"
        " --measured {params.measured:q} --participants {params.participants:q}"
        " --findings {output.findings:q} --exclusions {output.exclusions:q}"
        " --flow {output.flow:q} 2>&1 | tee {log:q}"


rule imu_design_observations:
    input:
        code("scripts/imu_design_observations.py"),
        metrics=imu_design.metrics,
    output:
        "results/{cohort}/imu_design/{variant}/models/observations.parquet",
    log:
        "logs/{cohort}/imu_design/{variant}/observations.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        "python scripts/imu_design_observations.py --output {output:q} {input.metrics:q}"
        " 2>&1 | tee {log:q}"


rule imu_design_models:
    input:
        code("scripts/imu_design_models.py"),
        observations="results/{cohort}/imu_design/{variant}/models/observations.parquet",
        parameters=imu_design.parameters("analysis.model"),
    output:
        effects="results/{cohort}/imu_design/{variant}/models/effects.parquet",
        components="results/{cohort}/imu_design/{variant}/models/components.parquet",
        residuals="results/{cohort}/imu_design/{variant}/models/residuals.parquet",
    log:
        "logs/{cohort}/imu_design/{variant}/models.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        folder=lambda wildcards, output: Path(output.effects).parent,
    shell:
        "python scripts/imu_design_models.py --observations {input.observations:q}"
        " --parameters {input.parameters:q} --folder {params.folder:q} 2>&1 | tee {log:q}"


rule imu_design_table:
    input:
        code("scripts/imu_design_table.py"),
        imu_design.table_models,
        tables=imu_design.design_tables,
        ranges=imu_design.ranges,
        parameters=imu_design.parameters("analysis.sensors", "analysis.model"),
    output:
        multiext(
            "results/{cohort}/imu_design/{variant}/tables/{table}",
            csv=".csv",
            md=".md",
            tex=".tex",
            html=".html",
        ),
    log:
        "logs/{cohort}/imu_design/{variant}/{table}.log",
    wildcard_constraints:
        table="|".join(TABLE_MODELS),
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=imu_design.raw,
        models="results/{cohort}/imu_design/{variant}/models",
        simulated=project.simulated_flag,
    shell:
        "python scripts/imu_design_table.py --table {wildcards.table:q} --raw {params.raw:q}"
        " --ranges {input.ranges:q} --models {params.models:q}"
        " --parameters {input.parameters:q} {params.simulated} --output {output.csv:q}"
        " 2>&1 | tee {log:q}"


rule imu_design_stride_errors:
    input:
        code("scripts/imu_design_stride_errors.py"),
        tables=imu_design.design_tables,
        recordings="results/{cohort}/imu_design/recordings/{participant}.nc",
        truth="data/raw/{cohort}/imu_design/truth/{participant}.json",
        parameters=imu_design.parameters("analysis.gaits"),
        methods=imu_design.methods,
    output:
        "results/{cohort}/imu_design/stride_errors/{participant}.parquet",
    log:
        "logs/{cohort}/imu_design/stride_errors_{participant}.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=imu_design.raw,
        variants=imu_design.measuring_variants,
    shell:
        "python scripts/imu_design_stride_errors.py --raw {params.raw:q}"
        " --participant {wildcards.participant:q} --recordings {input.recordings:q}"
        " --truth {input.truth:q} --parameters {input.parameters:q}"
        " --methods {input.methods:q} --variants {params.variants:q} --output {output:q}"
        " 2>&1 | tee {log:q}"


rule imu_design_truth:
    input:
        code("scripts/imu_design_truth.py"),
        errors=imu_design.stride_errors,
    output:
        multiext(
            "results/{cohort}/imu_design/{variant}/tables/truth",
            csv=".csv",
            md=".md",
            tex=".tex",
            html=".html",
        ),
    log:
        "logs/{cohort}/imu_design/{variant}/truth.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        "python scripts/imu_design_truth.py --output {output.csv:q} {input.errors:q}"
        " 2>&1 | tee {log:q}"


rule imu_design_figure:
    input:
        code("scripts/imu_design_figure.py"),
        imu_design.figure_models,
        printed="data/published/imu_design_text.csv",
        parameters=imu_design.parameters("analysis.model"),
    output:
        multiext(
            "results/{cohort}/imu_design/{variant}/figures/{figure}",
            svg=".svg",
            png=".png",
            pdf=".pdf",
        ),
    log:
        "logs/{cohort}/imu_design/{variant}/{figure}.log",
    wildcard_constraints:
        figure="|".join(FIGURE_MODELS),
    conda:
        "../envs/swaystride.yaml"
    params:
        results="results/{cohort}/imu_design/{variant}",
        simulated=project.simulated_flag,
    shell:
        "python scripts/imu_design_figure.py --figure {wildcards.figure:q}"
        " --results {params.results:q} --printed {input.printed:q}"
        " --parameters {input.parameters:q} {params.simulated} --output {output.svg:q}"
        " 2>&1 | tee {log:q}"


rule imu_design_raw_figure:
    input:
        code("scripts/imu_design_raw_figure.py"),
        imu_design.all_recordings,
        imu_design.strides,
        observations="results/{cohort}/imu_design/{variant}/models/observations.parquet",
        parameters=imu_design.parameters("analysis.experiments", "analysis.model"),
    output:
        multiext(
            "results/{cohort}/imu_design/{variant}/figures/{figure}",
            svg=".svg",
            png=".png",
            pdf=".pdf",
        ),
    log:
        "logs/{cohort}/imu_design/{variant}/{figure}.log",
    wildcard_constraints:
        figure="|".join(RAW_FIGURES),
    conda:
        "../envs/swaystride.yaml"
    params:
        strides=imu_design.strides_folder,
        recordings="results/{cohort}/imu_design/recordings",
        simulated=project.simulated_flag,
    shell:
        "python scripts/imu_design_raw_figure.py --figure {wildcards.figure:q}"
        " --observations {input.observations:q} --strides {params.strides:q}"
        " --recordings {params.recordings:q} --parameters {input.parameters:q}"
        " {params.simulated} --output {output.svg:q} 2>&1 | tee {log:q}"


rule imu_design:
    input:
        expand(
            "results/{cohort}/imu_design/{variant}/report.html",
            cohort=project.cohort,
            variant=project.base_variant,
        ),


# Recovery: many cohorts, from raw files to slopes, against the print. A target of its own.


rule imu_design_recovery_cohort:
    input:
        code("scripts/imu_design_recovery_cohort.py"),
        parameters="results/recovery/imu_design/parameters/"
        "simulation+analysis.recording+analysis.sensors+analysis.experiments+"
        "analysis.measurement+analysis.model.json",
    output:
        r"results/recovery/imu_design/{seed,\d+}.parquet",
    log:
        "logs/recovery/imu_design_{seed}.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        "python scripts/imu_design_recovery_cohort.py --parameters {input.parameters:q}"
        " --seed {wildcards.seed} --output {output:q} 2>&1 | tee {log:q}"


rule imu_design_recovery:
    input:
        code("scripts/imu_design_recovery.py"),
        printed=expand(
            "data/published/{table}.csv",
            table=["table_a1", "table_a2", "table_a3", "table_a4"],
        ),
        cohorts=expand(
            "results/recovery/imu_design/{seed}.parquet", seed=RECOVERY_SEEDS
        ),
    output:
        recovery="results/recovery/imu_design.csv",
        slopes="results/recovery/imu_design/slopes.csv",
    log:
        "logs/recovery/imu_design.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        printed=lambda wildcards, input: Path(input.printed[0]).parent,
    shell:
        "python scripts/imu_design_recovery.py --printed {params.printed:q}"
        " --output {output.recovery:q} --slopes {output.slopes:q} {input.cohorts:q}"
        " 2>&1 | tee {log:q}"
