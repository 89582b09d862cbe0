# Error-state Kalman filter for the joint angles of runners (dissertation, chapter 4).
# Stages: design, simulate | import | estimate | measure, perturbation, course, truth
#         | tables, figures | page

from kinematics_rules import (
    FIGURE_INPUTS,
    TABLE_INPUTS,
    TRUTH_TABLES,
    KinematicsRules,
)

kinematics = KinematicsRules(project)


rule kinematics_design:
    input:
        code("scripts/kinematics_design.py"),
        parameters=kinematics.parameters("simulation"),
    output:
        participants="data/raw/{cohort}/kinematics/participants.tsv",
        trials="data/raw/{cohort}/kinematics/trials.tsv",
    log:
        "logs/{cohort}/kinematics/design.log",
    wildcard_constraints:
        cohort=project.simulated_pattern,
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=kinematics.raw,
        seed=project.seed,
    shell:
        "python scripts/kinematics_design.py --parameters {input.parameters:q}"
        " --seed {params.seed} --folder {params.raw:q} 2>&1 | tee {log:q}"


rule kinematics_simulate:
    input:
        code("scripts/kinematics_simulate.py"),
        parameters=kinematics.parameters("simulation"),
    output:
        recordings=directory(r"data/raw/{cohort}/kinematics/{participant,P\d+}"),
        truth=r"data/raw/{cohort}/kinematics/truth/{participant,P\d+}.npz",
    log:
        "logs/{cohort}/kinematics/simulate_{participant}.log",
    wildcard_constraints:
        cohort=project.simulated_pattern,
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=kinematics.raw,
        seed=project.seed,
    shell:
        "python scripts/kinematics_simulate.py --participant {wildcards.participant:q}"
        " --parameters {input.parameters:q} --seed {params.seed}"
        " --folder {params.raw:q} --truth {output.truth:q} 2>&1 | tee {log:q}"


rule kinematics_import:
    input:
        code("scripts/kinematics_import.py"),
        tables=kinematics.design_tables,
        recordings=kinematics.recordings,
        parameters=kinematics.parameters(
            "analysis.recording",
            "analysis.sensors",
            "analysis.markers",
            "analysis.contacts",
        ),
    output:
        recordings="results/{cohort}/kinematics/recordings/{participant}.nc",
        findings="results/{cohort}/kinematics/quality/findings/{participant}.csv",
        exclusions="results/{cohort}/kinematics/quality/exclusions/{participant}.csv",
    log:
        "logs/{cohort}/kinematics/import_{participant}.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=kinematics.raw,
    shell:
        "python scripts/kinematics_import.py --raw {params.raw:q} --participant {wildcards.participant:q}"
        " --parameters {input.parameters:q} --recordings {output.recordings:q}"
        " --findings {output.findings:q} --exclusions {output.exclusions:q} 2>&1 | tee {log:q}"


rule kinematics_estimate:
    input:
        code("scripts/kinematics_estimate.py"),
        tables=kinematics.design_tables,
        recordings="results/{cohort}/kinematics/recordings/{participant}.nc",
        parameters=kinematics.parameters(
            "analysis.optics",
            "analysis.erkf",
            "analysis.contacts",
            "analysis.zero_velocity",
            "analysis.markers",
        ),
    output:
        estimates="results/{cohort}/kinematics/{variant}/estimates/{participant}.nc",
        findings="results/{cohort}/kinematics/{variant}/findings/estimate/{participant}.csv",
    log:
        "logs/{cohort}/kinematics/{variant}/estimate_{participant}.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=kinematics.raw,
    shell:
        "python scripts/kinematics_estimate.py --raw {params.raw:q} --participant {wildcards.participant:q}"
        " --parameters {input.parameters:q} --recordings {input.recordings:q}"
        " --estimates {output.estimates:q} --findings {output.findings:q} 2>&1 | tee {log:q}"


rule kinematics_measure:
    input:
        code("scripts/kinematics_measure.py"),
        estimates="results/{cohort}/kinematics/{variant}/estimates/{participant}.nc",
        parameters=kinematics.parameters("analysis.contacts", "analysis.measures"),
    output:
        strides="results/{cohort}/kinematics/{variant}/strides/{participant}.parquet",
        agreement="results/{cohort}/kinematics/{variant}/agreement/{participant}.parquet",
        curves="results/{cohort}/kinematics/{variant}/curves/{participant}.parquet",
        planar="results/{cohort}/kinematics/{variant}/planar/{participant}.parquet",
        findings="results/{cohort}/kinematics/{variant}/findings/measure/{participant}.csv",
    log:
        "logs/{cohort}/kinematics/{variant}/measure_{participant}.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        "python scripts/kinematics_measure.py --participant {wildcards.participant:q}"
        " --parameters {input.parameters:q} --estimates {input.estimates:q}"
        " --strides {output.strides:q} --agreement {output.agreement:q}"
        " --curves {output.curves:q} --planar {output.planar:q}"
        " --findings {output.findings:q} 2>&1 | tee {log:q}"


rule kinematics_perturbation:
    input:
        code("scripts/kinematics_perturbation.py"),
        tables=kinematics.design_tables,
        recordings="results/{cohort}/kinematics/recordings/{participant}.nc",
        parameters=kinematics.parameters(
            "analysis.optics",
            "analysis.perturbation",
            "analysis.contacts",
            "analysis.markers",
        ),
    output:
        perturbation="results/{cohort}/kinematics/{variant}/perturbation/{participant}.parquet",
        curves="results/{cohort}/kinematics/{variant}/perturbation_curves/{participant}.parquet",
    log:
        "logs/{cohort}/kinematics/{variant}/perturbation_{participant}.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=kinematics.raw,
    shell:
        "python scripts/kinematics_perturbation.py --raw {params.raw:q} --participant {wildcards.participant:q}"
        " --parameters {input.parameters:q} --recordings {input.recordings:q}"
        " --perturbation {output.perturbation:q}"
        " --perturbation-curves {output.curves:q} 2>&1 | tee {log:q}"


rule kinematics_course:
    input:
        code("scripts/kinematics_course.py"),
        estimates="results/{cohort}/kinematics/{variant}/estimates/{participant}.nc",
        strides="results/{cohort}/kinematics/{variant}/strides/{participant}.parquet",
        parameters=kinematics.parameters("analysis.tables"),
    output:
        "results/{cohort}/kinematics/{variant}/course/{participant}.parquet",
    log:
        "logs/{cohort}/kinematics/{variant}/course_{participant}.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        "python scripts/kinematics_course.py --participant {wildcards.participant:q}"
        " --estimates {input.estimates:q} --strides {input.strides:q}"
        " --parameters {input.parameters:q} --output {output:q} 2>&1 | tee {log:q}"


rule kinematics_truth:
    input:
        code("scripts/kinematics_truth.py"),
        estimates="results/{cohort}/kinematics/{variant}/estimates/{participant}.nc",
        strides="results/{cohort}/kinematics/{variant}/strides/{participant}.parquet",
        truth="data/raw/{cohort}/kinematics/truth/{participant}.npz",
    output:
        angles="results/{cohort}/kinematics/{variant}/truth/{participant}.parquet",
        strides="results/{cohort}/kinematics/{variant}/truth_strides/{participant}.parquet",
    log:
        "logs/{cohort}/kinematics/{variant}/truth_{participant}.log",
    wildcard_constraints:
        cohort=project.simulated_pattern,
    conda:
        "../envs/swaystride.yaml"
    shell:
        "python scripts/kinematics_truth.py --participant {wildcards.participant:q}"
        " --estimates {input.estimates:q}"
        " --strides {input.strides:q} --truth {input.truth:q}"
        " --output {output.angles:q} --output-strides {output.strides:q} 2>&1 | tee {log:q}"


rule kinematics_quality:
    input:
        code("scripts/kinematics_quality.py"),
        tables=kinematics.design_tables,
        parts=kinematics.quality_parts,
    output:
        findings="results/{cohort}/kinematics/quality/findings.csv",
        exclusions="results/{cohort}/kinematics/quality/exclusions.csv",
        flow="results/{cohort}/kinematics/quality/flow.json",
    log:
        "logs/{cohort}/kinematics/quality.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=kinematics.raw,
        parts=lambda wildcards, output: Path(output.findings).parent,
        measured=f"results/{{cohort}}/kinematics/{project.base_variant}",
        participants=kinematics.participants,
    shell:
        "python scripts/kinematics_quality.py --raw {params.raw:q} --parts {params.parts:q}"
        " --measured {params.measured:q} --participants {params.participants:q}"
        " --findings {output.findings:q} --exclusions {output.exclusions:q}"
        " --flow {output.flow:q} 2>&1 | tee {log:q}"


rule kinematics_table:
    input:
        code("scripts/kinematics_table.py"),
        kinematics.table_inputs,
        tables=kinematics.design_tables,
        published=expand(
            "data/published/{table}.csv",
            table=["table_4_4", "table_4_9", "table_4_10"],
        ),
        parameters=kinematics.parameters(
            "analysis.erkf", "analysis.zero_velocity", "analysis.tables"
        ),
    output:
        multiext(
            "results/{cohort}/kinematics/{variant}/tables/{table}",
            csv=".csv",
            md=".md",
            tex=".tex",
            html=".html",
        ),
    log:
        "logs/{cohort}/kinematics/{variant}/{table}.log",
    wildcard_constraints:
        table="|".join(TABLE_INPUTS),
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=kinematics.raw,
        participants=kinematics.participants,
        results=kinematics.source_folder,
        published=lambda wildcards, input: Path(input.published[0]).parent,
        simulated=project.simulated_flag,
    shell:
        "python scripts/kinematics_table.py --table {wildcards.table:q} --raw {params.raw:q}"
        " --participants {params.participants:q} --results {params.results:q}"
        " --published {params.published:q} --parameters {input.parameters:q}"
        " {params.simulated} --output {output.csv:q} 2>&1 | tee {log:q}"


rule kinematics_truth_table:
    input:
        code("scripts/kinematics_truth_table.py"),
        kinematics.truth_inputs,
    output:
        multiext(
            "results/{cohort}/kinematics/{variant}/tables/{table}",
            csv=".csv",
            md=".md",
            tex=".tex",
            html=".html",
        ),
    log:
        "logs/{cohort}/kinematics/{variant}/{table}.log",
    wildcard_constraints:
        cohort=project.simulated_pattern,
        table="|".join(TRUTH_TABLES),
    conda:
        "../envs/swaystride.yaml"
    params:
        participants=kinematics.participants,
        results=kinematics.source_folder,
    shell:
        "python scripts/kinematics_truth_table.py --table {wildcards.table:q}"
        " --participants {params.participants:q} --results {params.results:q}"
        " --output {output.csv:q} 2>&1 | tee {log:q}"


rule kinematics_figure:
    input:
        code("scripts/kinematics_figure.py"),
        kinematics.figure_inputs,
        published="data/published/table_4_4.csv",
        parameters=kinematics.parameters("analysis.tables"),
    output:
        multiext(
            "results/{cohort}/kinematics/{variant}/figures/{figure}",
            svg=".svg",
            png=".png",
            pdf=".pdf",
        ),
    log:
        "logs/{cohort}/kinematics/{variant}/{figure}.log",
    wildcard_constraints:
        figure="|".join(FIGURE_INPUTS),
    conda:
        "../envs/swaystride.yaml"
    params:
        participants=kinematics.participants,
        results=kinematics.source_folder,
        published=lambda wildcards, input: Path(input.published).parent,
        simulated=project.simulated_flag,
    shell:
        "python scripts/kinematics_figure.py --figure {wildcards.figure:q}"
        " --participants {params.participants:q} --results {params.results:q}"
        " --published {params.published:q} --parameters {input.parameters:q}"
        " {params.simulated} --output {output.svg:q} 2>&1 | tee {log:q}"


rule kinematics:
    input:
        expand(
            "results/{cohort}/kinematics/{variant}/report.html",
            cohort=project.cohort,
            variant=project.base_variant,
        ),


# Recovery: every trial of the published cohort against its truth, all variants. A target of its own.


rule kinematics_recovery:
    input:
        code("scripts/kinematics_recovery.py"),
        kinematics.recovery_inputs,
    output:
        "results/recovery/kinematics.csv",
    log:
        "logs/recovery/kinematics.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        participants=kinematics.recovery_participants,
        results=kinematics.recovery_folder,
        variants=project.variants("kinematics"),
    shell:
        "python scripts/kinematics_recovery.py --participants {params.participants:q}"
        " --variants {params.variants:q} --results {params.results:q}"
        " --output {output:q} 2>&1 | tee {log:q}"
