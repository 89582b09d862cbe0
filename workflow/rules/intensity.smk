# Balance exercise intensity: therapist ratings, self-ratings and sway (dissertation, chapter 3).
# Stages: design, simulate | import | metrics | ratings, sway, models | tables, figures | page

from intensity_rules import (
    FIGURE_FILES,
    LAB_TABLES,
    PRINTED_TABLES,
    RECOVERY_BATCH,
    RECOVERY_FIRST_SEEDS,
    TABLE_BLOCKS,
    IntensityRules,
    block_files,
)

intensity = IntensityRules(project)


rule intensity_design:
    input:
        code("scripts/intensity_design.py"),
        parameters=intensity.parameters("simulation"),
    output:
        [f"data/raw/{{cohort}}/intensity/{table}.tsv" for table in LAB_TABLES],
    log:
        "logs/{cohort}/intensity/design.log",
    wildcard_constraints:
        cohort=project.simulated_pattern,
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=intensity.raw,
        seed=project.seed,
    shell:
        "python scripts/intensity_design.py --parameters {input.parameters:q} --seed {params.seed}"
        " --folder {params.raw:q} 2>&1 | tee {log:q}"


rule intensity_simulate:
    input:
        code("scripts/intensity_simulate.py"),
        parameters=intensity.parameters("simulation"),
    output:
        recordings=directory(r"data/raw/{cohort}/intensity/{participant,P\d+}"),
        truth=r"data/raw/{cohort}/intensity/truth/{participant,P\d+}.tsv",
    log:
        "logs/{cohort}/intensity/simulate_{participant}.log",
    wildcard_constraints:
        cohort=project.simulated_pattern,
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=intensity.raw,
        seed=project.seed,
    shell:
        "python scripts/intensity_simulate.py --participant {wildcards.participant:q}"
        " --parameters {input.parameters:q} --seed {params.seed}"
        " --folder {params.raw:q} --truth {output.truth:q}"
        " 2>&1 | tee {log:q}"


rule intensity_population:
    input:
        code("scripts/intensity_population.py"),
        parameters=intensity.parameters("simulation"),
    output:
        "data/raw/{cohort}/intensity/truth/population.tsv",
    log:
        "logs/{cohort}/intensity/population.log",
    wildcard_constraints:
        cohort=project.simulated_pattern,
    conda:
        "../envs/swaystride.yaml"
    params:
        seed=project.seed,
    shell:
        "python scripts/intensity_population.py --parameters {input.parameters:q}"
        " --seed {params.seed} --output {output:q} 2>&1 | tee {log:q}"


rule intensity_import:
    input:
        code("scripts/intensity_import.py"),
        tables=intensity.design_tables,
        recordings=intensity.recordings,
        parameters=intensity.parameters("analysis.recording"),
    output:
        recordings="results/{cohort}/intensity/recordings/{participant}.nc",
        findings="results/{cohort}/intensity/quality/findings/{participant}.csv",
        exclusions="results/{cohort}/intensity/quality/exclusions/{participant}.csv",
    log:
        "logs/{cohort}/intensity/import_{participant}.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=intensity.raw,
    shell:
        "python scripts/intensity_import.py --raw {params.raw:q} --participant {wildcards.participant:q}"
        " --parameters {input.parameters:q} --recordings {output.recordings:q}"
        " --findings {output.findings:q} --exclusions {output.exclusions:q}"
        " 2>&1 | tee {log:q}"


rule intensity_quality:
    input:
        code("scripts/intensity_quality.py"),
        tables=intensity.design_tables,
        parts=intensity.quality_parts,
    output:
        findings="results/{cohort}/intensity/quality/findings.csv",
        exclusions="results/{cohort}/intensity/quality/exclusions.csv",
        flow="results/{cohort}/intensity/quality/flow.json",
    log:
        "logs/{cohort}/intensity/quality.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=intensity.raw,
        parts=lambda wildcards, output: Path(output.findings).parent,
        participants=intensity.participants,
    shell:
        "python scripts/intensity_quality.py --raw {params.raw:q} --parts {params.parts:q}"
        " --participants {params.participants:q} --findings {output.findings:q}"
        " --exclusions {output.exclusions:q} --flow {output.flow:q} 2>&1 | tee {log:q}"


rule intensity_metrics:
    input:
        code("scripts/standing_metrics.py"),
        recordings="results/{cohort}/intensity/recordings/{participant}.nc",
        parameters=intensity.parameters("analysis.measurement"),
    output:
        "results/{cohort}/intensity/{variant}/metrics/{participant}.parquet",
    log:
        "logs/{cohort}/intensity/{variant}/metrics_{participant}.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        "python scripts/standing_metrics.py --participant {wildcards.participant:q}"
        " --recordings {input.recordings:q} --parameters {input.parameters:q} --output {output:q}"
        " 2>&1 | tee {log:q}"


rule intensity_ratings:
    input:
        code("scripts/intensity_ratings.py"),
        tables=intensity.design_tables,
    output:
        "results/{cohort}/intensity/{variant}/models/ratings.parquet",
    log:
        "logs/{cohort}/intensity/{variant}/ratings.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=intensity.raw,
    shell:
        "python scripts/intensity_ratings.py --raw {params.raw:q} --output {output:q}"
        " 2>&1 | tee {log:q}"


rule intensity_sway:
    input:
        code("scripts/intensity_sway.py"),
        tables=intensity.design_tables,
        metrics=intensity.metrics,
        parameters=intensity.parameters("analysis.model"),
    output:
        "results/{cohort}/intensity/{variant}/models/sway.parquet",
    log:
        "logs/{cohort}/intensity/{variant}/sway.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=intensity.raw,
    shell:
        "python scripts/intensity_sway.py --raw {params.raw:q} --parameters {input.parameters:q}"
        " --output {output:q} {input.metrics:q} 2>&1 | tee {log:q}"


# Ratings need no recording: the long job of the reliability starts first.
rule intensity_reliability:
    input:
        code("scripts/intensity_reliability.py"),
        ratings="results/{cohort}/intensity/{variant}/models/ratings.parquet",
        parameters=intensity.parameters("analysis.model"),
    output:
        block_files("reliability"),
    log:
        "logs/{cohort}/intensity/{variant}/reliability.log",
    priority: 1
    conda:
        "../envs/swaystride.yaml"
    params:
        folder=lambda wildcards, output: Path(output[0]).parent,
    shell:
        "python scripts/intensity_reliability.py --ratings {input.ratings:q}"
        " --parameters {input.parameters:q} --folder {params.folder:q} 2>&1 | tee {log:q}"


rule intensity_difficulty:
    input:
        code("scripts/intensity_difficulty.py"),
        ratings="results/{cohort}/intensity/{variant}/models/ratings.parquet",
        parameters=intensity.parameters("analysis.model"),
    output:
        block_files("difficulty"),
    log:
        "logs/{cohort}/intensity/{variant}/difficulty.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        folder=lambda wildcards, output: Path(output[0]).parent,
    shell:
        "python scripts/intensity_difficulty.py --ratings {input.ratings:q}"
        " --parameters {input.parameters:q} --folder {params.folder:q} 2>&1 | tee {log:q}"


rule intensity_self_ratings:
    input:
        code("scripts/intensity_self_ratings.py"),
        ratings="results/{cohort}/intensity/{variant}/models/ratings.parquet",
        parameters=intensity.parameters("analysis.model"),
    output:
        block_files("self_ratings"),
    log:
        "logs/{cohort}/intensity/{variant}/self_ratings.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        folder=lambda wildcards, output: Path(output[0]).parent,
    shell:
        "python scripts/intensity_self_ratings.py --ratings {input.ratings:q}"
        " --parameters {input.parameters:q} --folder {params.folder:q} 2>&1 | tee {log:q}"


rule intensity_kinematics:
    input:
        code("scripts/intensity_kinematics.py"),
        ratings="results/{cohort}/intensity/{variant}/models/ratings.parquet",
        sway="results/{cohort}/intensity/{variant}/models/sway.parquet",
        parameters=intensity.parameters("analysis.model"),
    output:
        block_files("kinematics"),
    log:
        "logs/{cohort}/intensity/{variant}/kinematics.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        folder=lambda wildcards, output: Path(output[0]).parent,
    shell:
        "python scripts/intensity_kinematics.py --ratings {input.ratings:q} --sway {input.sway:q}"
        " --parameters {input.parameters:q} --folder {params.folder:q} 2>&1 | tee {log:q}"


rule intensity_table:
    input:
        code("scripts/intensity_table.py"),
        intensity.table_models,
        tables=intensity.design_tables,
        printed=expand(
            "data/published/{table}.csv",
            table=["table_3_2", "table_3_3", "study3_text"],
        ),
        parameters=intensity.parameters("analysis.model"),
    output:
        multiext(
            "results/{cohort}/intensity/{variant}/tables/{table}",
            csv=".csv",
            md=".md",
            tex=".tex",
            html=".html",
        ),
    log:
        "logs/{cohort}/intensity/{variant}/{table}.log",
    wildcard_constraints:
        table="|".join(TABLE_BLOCKS),
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=intensity.raw,
        models="results/{cohort}/intensity/{variant}/models",
        printed=lambda wildcards, input: Path(input.printed[0]).parent,
        simulated=project.simulated_flag,
    shell:
        "python scripts/intensity_table.py --table {wildcards.table:q} --raw {params.raw:q}"
        " --models {params.models:q} --parameters {input.parameters:q} {params.simulated}"
        " --printed {params.printed:q} --output {output.csv:q} 2>&1 | tee {log:q}"


rule intensity_truth:
    input:
        code("scripts/intensity_truth.py"),
        intensity.all_models,
        ratings="results/{cohort}/intensity/{variant}/models/ratings.parquet",
        population="data/raw/{cohort}/intensity/truth/population.tsv",
    output:
        multiext(
            "results/{cohort}/intensity/{variant}/tables/truth",
            csv=".csv",
            md=".md",
            tex=".tex",
            html=".html",
        ),
    log:
        "logs/{cohort}/intensity/{variant}/truth.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        models=lambda wildcards, input: Path(input.ratings).parent,
    shell:
        "python scripts/intensity_truth.py --models {params.models:q}"
        " --population {input.population:q} --output {output.csv:q} 2>&1 | tee {log:q}"


rule intensity_figure:
    input:
        code("scripts/intensity_figure.py"),
        intensity.figure_files,
        printed="data/published/table_3_2.csv",
    output:
        multiext(
            "results/{cohort}/intensity/{variant}/figures/{figure}",
            svg=".svg",
            png=".png",
            pdf=".pdf",
        ),
    log:
        "logs/{cohort}/intensity/{variant}/{figure}.log",
    wildcard_constraints:
        figure="|".join(FIGURE_FILES),
    conda:
        "../envs/swaystride.yaml"
    params:
        results="results/{cohort}/intensity/{variant}",
        simulated=project.simulated_flag,
    shell:
        "python scripts/intensity_figure.py --figure {wildcards.figure:q}"
        " --results {params.results:q} --printed {input.printed:q} {params.simulated}"
        " --output {output.svg:q} 2>&1 | tee {log:q}"


rule intensity:
    input:
        expand(
            "results/{cohort}/intensity/{variant}/report.html",
            cohort=project.cohort,
            variant=project.base_variant,
        ),


# Recovery: many cohorts against print and population. A target of its own.


rule intensity_recovery_population:
    input:
        code("scripts/intensity_population.py"),
        parameters="results/recovery/intensity/parameters/simulation.json",
    output:
        "results/recovery/intensity/population.tsv",
    log:
        "logs/recovery/intensity_population.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        seed=project.seed,
    shell:
        "python scripts/intensity_population.py --parameters {input.parameters:q}"
        " --seed {params.seed} --output {output:q} 2>&1 | tee {log:q}"


rule intensity_recovery_cohorts:
    input:
        code("scripts/intensity_recovery_cohorts.py"),
        parameters="results/recovery/intensity/parameters/simulation+analysis.model.json",
    output:
        r"results/recovery/intensity/{first,\d+}.parquet",
    log:
        "logs/recovery/intensity_{first}.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        cohorts=RECOVERY_BATCH,
    shell:
        "python scripts/intensity_recovery_cohorts.py --parameters {input.parameters:q}"
        " --first {wildcards.first} --cohorts {params.cohorts} --output {output:q}"
        " 2>&1 | tee {log:q}"


rule intensity_recovery:
    input:
        code("scripts/intensity_recovery.py"),
        printed=PRINTED_TABLES,
        population="results/recovery/intensity/population.tsv",
        cohorts=expand(
            "results/recovery/intensity/{first}.parquet", first=RECOVERY_FIRST_SEEDS
        ),
    output:
        "results/recovery/intensity.csv",
    log:
        "logs/recovery/intensity.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        printed=lambda wildcards, input: Path(input.printed[0]).parent,
    shell:
        "python scripts/intensity_recovery.py --printed {params.printed:q}"
        " --population {input.population:q} --output {output:q} {input.cohorts:q}"
        " 2>&1 | tee {log:q}"
