# Balance training with concurrent or terminal visual feedback (dissertation, chapter 2).
# Stages: design, simulate | import | metrics | observations, models | tables, figures | page

from feedback_rules import (
    MODEL_FILES,
    RECOVERY_COHORTS,
    RECOVERY_RAW_SEEDS,
    FeedbackRules,
)

feedback = FeedbackRules(project)


rule feedback_design:
    input:
        code("scripts/feedback_design.py"),
        parameters=feedback.parameters("simulation"),
    output:
        participants="data/raw/{cohort}/feedback/participants.tsv",
        trials="data/raw/{cohort}/feedback/trials.tsv",
        expected="data/raw/{cohort}/feedback/truth/expected.tsv",
        variance_ratios="data/raw/{cohort}/feedback/truth/variance_ratios.tsv",
    log:
        "logs/{cohort}/feedback/design.log",
    wildcard_constraints:
        cohort=project.simulated_pattern,
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=feedback.raw,
        seed=project.seed,
    shell:
        "python scripts/feedback_design.py --parameters {input.parameters:q} --seed {params.seed}"
        " --folder {params.raw:q} --expected {output.expected:q}"
        " --variance-ratios {output.variance_ratios:q} 2>&1 | tee {log:q}"


rule feedback_simulate:
    input:
        code("scripts/feedback_simulate.py"),
        parameters=feedback.parameters("simulation"),
    output:
        recordings=directory(r"data/raw/{cohort}/feedback/{participant,P\d+}"),
        truth=r"data/raw/{cohort}/feedback/truth/{participant,P\d+}.tsv",
    log:
        "logs/{cohort}/feedback/simulate_{participant}.log",
    wildcard_constraints:
        cohort=project.simulated_pattern,
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=feedback.raw,
        seed=project.seed,
    shell:
        "python scripts/feedback_simulate.py --participant {wildcards.participant:q}"
        " --parameters {input.parameters:q} --seed {params.seed}"
        " --folder {params.raw:q} --truth {output.truth:q}"
        " 2>&1 | tee {log:q}"


rule feedback_import:
    input:
        code("scripts/feedback_import.py"),
        tables=feedback.design_tables,
        recordings=feedback.recordings,
        parameters=feedback.parameters("analysis.recording"),
    output:
        recordings="results/{cohort}/feedback/recordings/{participant}.nc",
        findings="results/{cohort}/feedback/quality/findings/{participant}.csv",
        exclusions="results/{cohort}/feedback/quality/exclusions/{participant}.csv",
    log:
        "logs/{cohort}/feedback/import_{participant}.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=feedback.raw,
    shell:
        "python scripts/feedback_import.py --raw {params.raw:q} --participant {wildcards.participant:q}"
        " --parameters {input.parameters:q} --recordings {output.recordings:q}"
        " --findings {output.findings:q} --exclusions {output.exclusions:q}"
        " 2>&1 | tee {log:q}"


rule feedback_quality:
    input:
        code("scripts/feedback_quality.py"),
        tables=feedback.design_tables,
        parts=feedback.quality_parts,
    output:
        findings="results/{cohort}/feedback/quality/findings.csv",
        exclusions="results/{cohort}/feedback/quality/exclusions.csv",
        flow="results/{cohort}/feedback/quality/flow.json",
    log:
        "logs/{cohort}/feedback/quality.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=feedback.raw,
        parts=lambda wildcards, output: Path(output.findings).parent,
        participants=feedback.participants,
    shell:
        "python scripts/feedback_quality.py --raw {params.raw:q} --parts {params.parts:q}"
        " --participants {params.participants:q} --findings {output.findings:q}"
        " --exclusions {output.exclusions:q} --flow {output.flow:q} 2>&1 | tee {log:q}"


rule feedback_metrics:
    input:
        code("scripts/standing_metrics.py"),
        recordings="results/{cohort}/feedback/recordings/{participant}.nc",
        parameters=feedback.parameters("analysis.measurement"),
    output:
        "results/{cohort}/feedback/{variant}/metrics/{participant}.parquet",
    log:
        "logs/{cohort}/feedback/{variant}/metrics_{participant}.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        "python scripts/standing_metrics.py --participant {wildcards.participant:q}"
        " --recordings {input.recordings:q} --parameters {input.parameters:q} --output {output:q}"
        " 2>&1 | tee {log:q}"


rule feedback_observations:
    input:
        code("scripts/feedback_observations.py"),
        tables=feedback.design_tables,
        metrics=feedback.metrics,
        exclusions="results/{cohort}/feedback/quality/exclusions.csv",
        parameters=feedback.parameters("analysis.model"),
    output:
        "results/{cohort}/feedback/{variant}/models/observations.parquet",
    log:
        "logs/{cohort}/feedback/{variant}/observations.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=feedback.raw,
    shell:
        "python scripts/feedback_observations.py --raw {params.raw:q}"
        " --parameters {input.parameters:q} --exclusions {input.exclusions:q} --output {output:q}"
        " {input.metrics:q} 2>&1 | tee {log:q}"


rule feedback_model:
    input:
        code("scripts/feedback_model.py"),
        observations="results/{cohort}/feedback/{variant}/models/observations.parquet",
        parameters=feedback.parameters("analysis.model"),
    output:
        [
            f"results/{{cohort}}/feedback/{{variant}}/models/{{feature}}/{name}.parquet"
            for name in MODEL_FILES
        ],
    log:
        "logs/{cohort}/feedback/{variant}/model_{feature}.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        folder="results/{cohort}/feedback/{variant}/models/{feature}",
    shell:
        "python scripts/feedback_model.py --observations {input.observations:q}"
        " --feature {wildcards.feature:q} --parameters {input.parameters:q}"
        " --folder {params.folder:q} 2>&1 | tee {log:q}"


rule feedback_table:
    input:
        code("scripts/feedback_table.py"),
        feedback.models,
        tables=feedback.design_tables,
        observations="results/{cohort}/feedback/{variant}/models/observations.parquet",
        printed="data/published/table_2_3.csv",
        text="data/published/table_2_4.csv",
        parameters=feedback.parameters("analysis.model"),
    output:
        multiext(
            "results/{cohort}/feedback/{variant}/tables/{table}",
            csv=".csv",
            md=".md",
            tex=".tex",
            html=".html",
        ),
    log:
        "logs/{cohort}/feedback/{variant}/{table}.log",
    wildcard_constraints:
        table="(?!truth)[a-z0-9_]+",
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=feedback.raw,
        models=lambda wildcards, input: Path(input.observations).parent,
        simulated=project.simulated_flag,
    shell:
        "python scripts/feedback_table.py --table {wildcards.table:q} --raw {params.raw:q}"
        " --models {params.models:q} --parameters {input.parameters:q} {params.simulated}"
        " --printed {input.printed:q} --text {input.text:q} --output {output.csv:q} 2>&1 | tee {log:q}"


rule feedback_truth:
    input:
        code("scripts/feedback_truth.py"),
        feedback.models,
        tables=feedback.design_tables,
        observations="results/{cohort}/feedback/{variant}/models/observations.parquet",
        truth=feedback.truth,
        parameters=feedback.parameters("analysis.model"),
    output:
        multiext(
            "results/{cohort}/feedback/{variant}/tables/truth",
            csv=".csv",
            md=".md",
            tex=".tex",
            html=".html",
        ),
    log:
        "logs/{cohort}/feedback/{variant}/truth.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=feedback.raw,
        models=lambda wildcards, input: Path(input.observations).parent,
    shell:
        "python scripts/feedback_truth.py --raw {params.raw:q} --models {params.models:q}"
        " --parameters {input.parameters:q} --output {output.csv:q} 2>&1 | tee {log:q}"


rule feedback_figure:
    input:
        code("scripts/feedback_figure.py"),
        feedback.models,
        tables=feedback.design_tables,
        observations="results/{cohort}/feedback/{variant}/models/observations.parquet",
        recordings=feedback.all_recordings,
        effects="results/{cohort}/feedback/{variant}/tables/table_2_3.csv",
        printed="data/published/table_2_3.csv",
        parameters=feedback.parameters("analysis.measurement", "analysis.model"),
    output:
        multiext(
            "results/{cohort}/feedback/{variant}/figures/{figure}",
            svg=".svg",
            png=".png",
            pdf=".pdf",
        ),
    log:
        "logs/{cohort}/feedback/{variant}/{figure}.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        models=lambda wildcards, input: Path(input.observations).parent,
        recordings=lambda wildcards, input: Path(input.recordings[0]).parent,
        simulated=project.simulated_flag,
    shell:
        "python scripts/feedback_figure.py --figure {wildcards.figure:q}"
        " --models {params.models:q} --recordings {params.recordings:q} --effects {input.effects:q}"
        " --printed {input.printed:q} --parameters {input.parameters:q} {params.simulated}"
        " --output {output.svg:q} 2>&1 | tee {log:q}"


rule feedback:
    input:
        expand(
            "results/{cohort}/feedback/{variant}/report.html",
            cohort=project.cohort,
            variant=project.base_variant,
        ),


# Recovery: many cohorts against the truth. A target of its own; nothing else depends on it.


rule feedback_recovery_raw:
    input:
        code("scripts/feedback_recovery_raw.py"),
        parameters="results/recovery/feedback/parameters/"
        "simulation+analysis.recording+analysis.measurement+analysis.model.json",
    output:
        r"results/recovery/feedback/{seed,\d+}.parquet",
    log:
        "logs/recovery/feedback_{seed}.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        "python scripts/feedback_recovery_raw.py --parameters {input.parameters:q}"
        " --seed {wildcards.seed} --output {output:q} 2>&1 | tee {log:q}"


rule feedback_recovery:
    input:
        code("scripts/feedback_recovery.py"),
        parameters="results/recovery/feedback/parameters/simulation+analysis.model.json",
        printed="data/published/table_2_3.csv",
        raw=expand("results/recovery/feedback/{seed}.parquet", seed=RECOVERY_RAW_SEEDS),
    output:
        "results/recovery/feedback.csv",
    log:
        "logs/recovery/feedback.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        seed=project.seed,
        cohorts=RECOVERY_COHORTS,
    shell:
        "python scripts/feedback_recovery.py --parameters {input.parameters:q}"
        " --printed {input.printed:q} --seed {params.seed} --cohorts {params.cohorts}"
        " --raw {input.raw:q} --variant printed --output {output:q} 2>&1 | tee {log:q}"
