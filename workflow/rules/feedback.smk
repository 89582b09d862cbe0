# Balance training with concurrent or terminal visual feedback (dissertation, chapter 2).
# Stages: design, simulate | import | metrics | observations, models | tables, figures | page

FEEDBACK = "results/{cohort}/feedback"
FEEDBACK_LOG = "logs/{cohort}/feedback"
FEEDBACK_FEATURES = [
    "phi_rms",
    "ap_rms",
    "ml_rms",
    "phi_mv",
    "path_length",
    "ellipse_area",
]
FEEDBACK_MODEL_FILES = [
    "fixed_effects",
    "contrasts",
    "exponents",
    "elimination",
    "predictions",
]
def feedback_raw(wildcards):
    return project.raw_folder(wildcards.cohort, "feedback")


def feedback_parameters(*sections):
    """File with the parameters of these sections: of the variant, or of the base variant."""

    def file(wildcards):
        variant = getattr(wildcards, "variant", project.base_variant)
        folder = f"results/{wildcards.cohort}/feedback/{variant}/parameters"
        return f"{folder}/{'+'.join(sections)}.json"

    return file


def feedback_participants(cohort):
    return project.units("feedback", cohort)


def feedback_design_tables(wildcards):
    raw = feedback_raw(wildcards)
    return [f"{raw}/participants.tsv", f"{raw}/trials.tsv"]


def feedback_recordings(wildcards):
    """Raw files of one participant; what trials.tsv names but is not there is the import's to say."""
    raw = feedback_raw(wildcards)
    if project.is_simulated(wildcards.cohort):
        return [f"{raw}/{wildcards.participant}"]
    return project.existing_files("feedback", wildcards.cohort, wildcards.participant)


def feedback_metrics_files(wildcards):
    variant = project.source_variant("feedback", wildcards.variant, "metrics")
    return [
        f"results/{wildcards.cohort}/feedback/{variant}/metrics/{participant}.parquet"
        for participant in feedback_participants(wildcards.cohort)
    ]


def feedback_truth(wildcards):
    if not project.is_simulated(wildcards.cohort):
        return []
    return [f"{feedback_raw(wildcards)}/truth/effects.csv"]


rule feedback_design:
    wildcard_constraints:
        cohort=project.simulated_pattern,
    input:
        code("scripts/feedback_design.py"),
        parameters=feedback_parameters("simulation", "analysis.model"),
    output:
        participants="data/raw/{cohort}/feedback/participants.tsv",
        trials="data/raw/{cohort}/feedback/trials.tsv",
        truth="data/raw/{cohort}/feedback/truth/effects.csv",
    params:
        raw=feedback_raw,
        seed=project.seed,
    log:
        FEEDBACK_LOG + "/design.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        "{PYTHON:q} scripts/feedback_design.py --parameters {input.parameters:q} --seed {params.seed}"
        " --folder {params.raw:q} --truth {output.truth:q} 2>&1 | tee {log:q}"


rule feedback_simulate:
    wildcard_constraints:
        cohort=project.simulated_pattern,
    input:
        code("scripts/feedback_simulate.py"),
        parameters=feedback_parameters("simulation"),
    output:
        recordings=directory(r"data/raw/{cohort}/feedback/{participant,P\d+}"),
        truth=r"data/raw/{cohort}/feedback/truth/{participant,P\d+}.tsv",
    params:
        raw=feedback_raw,
        seed=project.seed,
    log:
        FEEDBACK_LOG + "/simulate_{participant}.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        "{PYTHON:q} scripts/feedback_simulate.py --participant {wildcards.participant:q}"
        " --parameters {input.parameters:q} --seed {params.seed}"
        " --folder {params.raw:q} --truth {output.truth:q}"
        " 2>&1 | tee {log:q}"


rule feedback_import:
    input:
        code("scripts/feedback_import.py"),
        tables=feedback_design_tables,
        recordings=feedback_recordings,
        parameters=feedback_parameters("analysis.recording"),
    output:
        recordings=FEEDBACK + "/recordings/{participant}.nc",
        findings=FEEDBACK + "/quality/findings/{participant}.csv",
        exclusions=FEEDBACK + "/quality/exclusions/{participant}.csv",
    params:
        raw=feedback_raw,
    log:
        FEEDBACK_LOG + "/import_{participant}.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        "{PYTHON:q} scripts/feedback_import.py --raw {params.raw:q} --participant {wildcards.participant:q}"
        " --parameters {input.parameters:q} --recordings {output.recordings:q}"
        " --findings {output.findings:q} --exclusions {output.exclusions:q}"
        " 2>&1 | tee {log:q}"


rule feedback_quality:
    input:
        code("scripts/feedback_quality.py"),
        tables=feedback_design_tables,
        parts=lambda wildcards: expand(
            FEEDBACK + "/quality/{kind}/{participant}.csv",
            cohort=wildcards.cohort,
            kind=["findings", "exclusions"],
            participant=feedback_participants(wildcards.cohort),
        ),
    output:
        findings=FEEDBACK + "/quality/findings.csv",
        exclusions=FEEDBACK + "/quality/exclusions.csv",
        flow=FEEDBACK + "/quality/flow.json",
    params:
        raw=feedback_raw,
        parts=FEEDBACK + "/quality",
        participants=lambda wildcards: feedback_participants(wildcards.cohort),
    log:
        FEEDBACK_LOG + "/quality.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        "{PYTHON:q} scripts/feedback_quality.py --raw {params.raw:q} --parts {params.parts:q}"
        " --participants {params.participants:q} --findings {output.findings:q}"
        " --exclusions {output.exclusions:q} --flow {output.flow:q} 2>&1 | tee {log:q}"


rule feedback_metrics:
    input:
        code("scripts/feedback_metrics.py"),
        recordings=FEEDBACK + "/recordings/{participant}.nc",
        parameters=feedback_parameters("analysis.measurement"),
    output:
        FEEDBACK + "/{variant}/metrics/{participant}.parquet",
    log:
        FEEDBACK_LOG + "/{variant}/metrics_{participant}.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        "{PYTHON:q} scripts/feedback_metrics.py --participant {wildcards.participant:q}"
        " --recordings {input.recordings:q} --parameters {input.parameters:q} --output {output:q}"
        " 2>&1 | tee {log:q}"


rule feedback_observations:
    input:
        code("scripts/feedback_observations.py"),
        tables=feedback_design_tables,
        metrics=feedback_metrics_files,
        exclusions=FEEDBACK + "/quality/exclusions.csv",
        parameters=feedback_parameters("analysis.model"),
    output:
        FEEDBACK + "/{variant}/models/observations.parquet",
    params:
        raw=feedback_raw,
    log:
        FEEDBACK_LOG + "/{variant}/observations.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        "{PYTHON:q} scripts/feedback_observations.py --raw {params.raw:q}"
        " --parameters {input.parameters:q} --exclusions {input.exclusions:q} --output {output:q}"
        " {input.metrics:q} 2>&1 | tee {log:q}"


rule feedback_model:
    input:
        code("scripts/feedback_model.py"),
        observations=FEEDBACK + "/{variant}/models/observations.parquet",
        parameters=feedback_parameters("analysis.model"),
    output:
        [
            FEEDBACK + f"/{{variant}}/models/{{feature}}/{name}.parquet"
            for name in FEEDBACK_MODEL_FILES
        ],
    params:
        folder=FEEDBACK + "/{variant}/models/{feature}",
    log:
        FEEDBACK_LOG + "/{variant}/model_{feature}.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        "{PYTHON:q} scripts/feedback_model.py --observations {input.observations:q}"
        " --feature {wildcards.feature:q} --parameters {input.parameters:q}"
        " --folder {params.folder:q} 2>&1 | tee {log:q}"


def feedback_models(wildcards):
    return expand(
        FEEDBACK + "/{variant}/models/{feature}/{name}.parquet",
        cohort=wildcards.cohort,
        variant=wildcards.variant,
        feature=FEEDBACK_FEATURES,
        name=FEEDBACK_MODEL_FILES,
    )


rule feedback_table:
    input:
        code("scripts/feedback_table.py"),
        feedback_models,
        tables=feedback_design_tables,
        observations=FEEDBACK + "/{variant}/models/observations.parquet",
        printed="data/published/table_2_3.csv",
        truth=feedback_truth,
        parameters=feedback_parameters("analysis.model"),
    output:
        multiext(
            FEEDBACK + "/{variant}/tables/{table}", ".csv", ".md", ".tex", ".html"
        ),
    params:
        raw=feedback_raw,
        models=FEEDBACK + "/{variant}/models",
        simulated=simulated_flag,
    log:
        FEEDBACK_LOG + "/{variant}/{table}.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        "{PYTHON:q} scripts/feedback_table.py --table {wildcards.table:q} --raw {params.raw:q}"
        " --models {params.models:q} --parameters {input.parameters:q} {params.simulated}"
        " --printed {input.printed:q} --output {output[0]:q} 2>&1 | tee {log:q}"


rule feedback_figure:
    input:
        code("scripts/feedback_figure.py"),
        feedback_models,
        tables=feedback_design_tables,
        observations=FEEDBACK + "/{variant}/models/observations.parquet",
        recordings=lambda wildcards: expand(
            FEEDBACK + "/recordings/{participant}.nc",
            cohort=wildcards.cohort,
            participant=feedback_participants(wildcards.cohort)[0],
        ),
        effects=FEEDBACK + "/{variant}/tables/table_2_3.csv",
        printed="data/published/table_2_3.csv",
        parameters=feedback_parameters("analysis.measurement", "analysis.model"),
    output:
        multiext(FEEDBACK + "/{variant}/figures/{figure}", ".svg", ".png", ".pdf"),
    params:
        models=FEEDBACK + "/{variant}/models",
        simulated=simulated_flag,
    log:
        FEEDBACK_LOG + "/{variant}/{figure}.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        "{PYTHON:q} scripts/feedback_figure.py --figure {wildcards.figure:q}"
        " --models {params.models:q} --recordings {input.recordings:q} --effects {input.effects:q}"
        " --printed {input.printed:q} --parameters {input.parameters:q} {params.simulated}"
        " --output {output[0]:q} 2>&1 | tee {log:q}"


rule feedback:
    input:
        expand(
            "results/{cohort}/feedback/{variant}/report.html",
            cohort=project.cohort,
            variant=project.base_variant,
        ),
