# Running kinematics and positive experience (dissertation, chapter 5). The unit of work is a run.
# Stages: design, simulate, ratings | import | metrics, truth | answers, observations,
#         associations, within_runs | tables, figures | page
#
# Half an hour of 13 sensors at 500 Hz is some 300 MB raw and as much imported, for each of 23 runs. So
# simulated raw recordings and imported ones are temporary, and a run goes all its way before the
# next is begun (priorities). A variant that is built later finds them gone, and simulates and imports
# again; `make variants` from nothing needs each once. Recordings of a lab have no rule that makes
# them, and are never deleted.

from experience_rules import SIMULATION, ExperienceRules

experience = ExperienceRules(project)


rule experience_design:
    input:
        code("scripts/experience_design.py"),
        people="data/published/table_5_1.csv",
        parameters=experience.parameters(*SIMULATION),
    output:
        participants="data/raw/{cohort}/experience/participants.tsv",
        runs="data/raw/{cohort}/experience/runs.tsv",
    log:
        "logs/{cohort}/experience/design.log",
    wildcard_constraints:
        cohort=project.simulated_pattern,
    # every import waits for it
    priority: 30
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=experience.raw,
        seed=project.seed,
    shell:
        "python scripts/experience_design.py --people {input.people:q}"
        " --parameters {input.parameters:q} --seed {params.seed}"
        " --folder {params.raw:q} 2>&1 | tee {log:q}"


rule experience_simulate:
    input:
        code("scripts/experience_simulate.py"),
        people="data/published/table_5_1.csv",
        parameters=experience.parameters(*SIMULATION, "analysis.measures"),
    output:
        # the chest strap's file comes too, where the run has not lost it
        imu=temp(
            r"data/raw/{cohort}/experience/{participant,P\d+}/{participant}_{number,\d+}.h5"
        ),
        standing=temp(
            "data/raw/{cohort}/experience/{participant}/{participant}_{number}_standing.h5"
        ),
        walking=temp(
            "data/raw/{cohort}/experience/{participant}/{participant}_{number}_walking.h5"
        ),
        events="data/raw/{cohort}/experience/{participant}/{participant}_{number}_events.tsv",
        motion="data/raw/{cohort}/experience/truth/{participant}_{number}.npz",
        values="data/raw/{cohort}/experience/truth/{participant}_{number}.json",
        strides="data/raw/{cohort}/experience/truth/{participant}_{number}_strides.parquet",
    log:
        "logs/{cohort}/experience/simulate_{participant}_{number}.log",
    wildcard_constraints:
        cohort=project.simulated_pattern,
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=experience.raw,
        truth=lambda wildcards, output: Path(output.motion).parent,
        seed=project.seed,
    shell:
        "python scripts/experience_simulate.py"
        " --run {wildcards.participant:q}_{wildcards.number:q} --people {input.people:q}"
        " --parameters {input.parameters:q} --seed {params.seed} --folder {params.raw:q}"
        " --truth {params.truth:q} 2>&1 | tee {log:q}"


rule experience_ratings:
    input:
        code("scripts/experience_ratings.py"),
        truth=experience.true_values,
        printed=expand("data/published/{table}.csv", table=["table_5_3", "study5_text"]),
        parameters=experience.parameters("simulation"),
    output:
        # the ratings over time come too, one file per run
        questionnaires="data/raw/{cohort}/experience/questionnaires.tsv",
        population="data/raw/{cohort}/experience/truth/population.json",
        null="data/raw/{cohort}/experience/truth/null.parquet",
    log:
        "logs/{cohort}/experience/ratings.log",
    wildcard_constraints:
        cohort=project.simulated_pattern,
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=experience.raw,
        printed=lambda wildcards, input: Path(input.printed[0]).parent,
        seed=project.seed,
    shell:
        "python scripts/experience_ratings.py --parameters {input.parameters:q}"
        " --seed {params.seed} --printed {params.printed:q} --folder {params.raw:q}"
        " 2>&1 | tee {log:q}"


rule experience_import:
    input:
        code("scripts/experience_import.py"),
        tables=experience.design_tables,
        recordings=experience.recordings,
        parameters=experience.parameters(
            "analysis.recording",
            "analysis.sensors",
            "analysis.alignment",
            "analysis.steady",
        ),
    output:
        recordings=temp("results/{cohort}/experience/recordings/{run}.nc"),
        alignment="results/{cohort}/experience/alignment/{run}.parquet",
        heart_rate="results/{cohort}/experience/heart_rate/{run}.parquet",
        spans="results/{cohort}/experience/spans/{run}.parquet",
        run_json="results/{cohort}/experience/quality/runs/{run}.json",
        findings="results/{cohort}/experience/quality/findings/{run}.csv",
        exclusions="results/{cohort}/experience/quality/exclusions/{run}.csv",
    log:
        "logs/{cohort}/experience/import_{run}.log",
    wildcard_constraints:
        run="[^/]+",
    priority: 10
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=experience.raw,
    shell:
        "python scripts/experience_import.py --raw {params.raw:q} --run {wildcards.run:q}"
        " --parameters {input.parameters:q} --recordings {output.recordings:q}"
        " --alignment {output.alignment:q} --heart-rate {output.heart_rate:q}"
        " --spans {output.spans:q} --run-json {output.run_json:q}"
        " --findings {output.findings:q} --exclusions {output.exclusions:q}"
        " 2>&1 | tee {log:q}"


rule experience_metrics:
    input:
        code("scripts/experience_metrics.py"),
        tables=experience.design_tables,
        recordings="results/{cohort}/experience/recordings/{run}.nc",
        heart_rate="results/{cohort}/experience/heart_rate/{run}.parquet",
        spans="results/{cohort}/experience/spans/{run}.parquet",
        run_json="results/{cohort}/experience/quality/runs/{run}.json",
        parameters=experience.parameters(
            "analysis.sensors",
            "analysis.alignment",
            "analysis.events",
            "analysis.trajectory",
            "analysis.measures",
            "analysis.steady",
            "analysis.windows",
        ),
    output:
        strides="results/{cohort}/experience/{variant}/strides/{run}.parquet",
        windows="results/{cohort}/experience/{variant}/windows/{run}.parquet",
        runs="results/{cohort}/experience/{variant}/runs/{run}.parquet",
        findings="results/{cohort}/experience/{variant}/findings/{run}.csv",
    log:
        "logs/{cohort}/experience/{variant}/metrics_{run}.log",
    wildcard_constraints:
        run="[^/]+",
    priority: 20
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=experience.raw,
    shell:
        "python scripts/experience_metrics.py --raw {params.raw:q} --run {wildcards.run:q}"
        " --parameters {input.parameters:q} --recordings {input.recordings:q}"
        " --heart-rate {input.heart_rate:q} --spans {input.spans:q}"
        " --run-json {input.run_json:q} --strides {output.strides:q}"
        " --windows {output.windows:q} --runs {output.runs:q}"
        " --findings {output.findings:q} 2>&1 | tee {log:q}"


rule experience_truth:
    input:
        code("scripts/experience_truth.py"),
        alignment="results/{cohort}/experience/alignment/{run}.parquet",
        strides="results/{cohort}/experience/{variant}/strides/{run}.parquet",
        runs="results/{cohort}/experience/{variant}/runs/{run}.parquet",
        motion="data/raw/{cohort}/experience/truth/{run}.npz",
        values="data/raw/{cohort}/experience/truth/{run}.json",
        true_strides="data/raw/{cohort}/experience/truth/{run}_strides.parquet",
    output:
        "results/{cohort}/experience/{variant}/truth/{run}.parquet",
    log:
        "logs/{cohort}/experience/{variant}/truth_{run}.log",
    wildcard_constraints:
        cohort=project.simulated_pattern,
        run=r"P\d+_\d+",
    conda:
        "../envs/swaystride.yaml"
    params:
        truth=lambda wildcards, input: Path(input.motion).parent,
    shell:
        "python scripts/experience_truth.py --run {wildcards.run:q}"
        " --truth-folder {params.truth:q} --strides {input.strides:q} --runs {input.runs:q}"
        " --alignment {input.alignment:q} --output {output:q} 2>&1 | tee {log:q}"


rule experience_answers:
    input:
        code("scripts/experience_answers.py"),
        tables=experience.design_tables,
        answers=experience.rated_files,
        checks=experience.checks,
        spans=experience.spans,
        parameters=experience.parameters("analysis.answers"),
    output:
        affect="results/{cohort}/experience/answers/affect.parquet",
        scores="results/{cohort}/experience/answers/scores.parquet",
        findings="results/{cohort}/experience/answers/findings.csv",
    log:
        "logs/{cohort}/experience/answers.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=experience.raw,
        quality=lambda wildcards, input: Path(input.checks[0]).parent,
        spans=lambda wildcards, input: Path(input.spans[0]).parent,
    shell:
        "python scripts/experience_answers.py --raw {params.raw:q} --quality {params.quality:q}"
        " --spans {params.spans:q} --parameters {input.parameters:q}"
        " --affect {output.affect:q} --scores {output.scores:q}"
        " --findings {output.findings:q} 2>&1 | tee {log:q}"


rule experience_observations:
    input:
        code("scripts/experience_observations.py"),
        experience.measured("runs"),
        experience.measured("windows"),
        affect="results/{cohort}/experience/answers/affect.parquet",
        scores="results/{cohort}/experience/answers/scores.parquet",
        parameters=experience.parameters(
            "analysis.steady", "analysis.answers", "analysis.model"
        ),
    output:
        runs="results/{cohort}/experience/{variant}/observations/runs.parquet",
        windows="results/{cohort}/experience/{variant}/observations/windows.parquet",
    log:
        "logs/{cohort}/experience/{variant}/observations.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        cohort=experience.results,
        measured=experience.measured_folder,
        names=experience.runs,
    shell:
        "python scripts/experience_observations.py --cohort {params.cohort:q}"
        " --variant {params.measured:q} --names {params.names:q}"
        " --parameters {input.parameters:q} --runs {output.runs:q}"
        " --windows {output.windows:q} 2>&1 | tee {log:q}"


rule experience_associations:
    input:
        code("scripts/experience_associations.py"),
        observations="results/{cohort}/experience/{variant}/observations/runs.parquet",
        parameters=experience.parameters("analysis.model"),
    output:
        "results/{cohort}/experience/{variant}/models/associations.parquet",
    log:
        "logs/{cohort}/experience/{variant}/associations.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        "python scripts/experience_associations.py --observations {input.observations:q}"
        " --parameters {input.parameters:q} --output {output:q} 2>&1 | tee {log:q}"


rule experience_within_runs:
    input:
        code("scripts/experience_within_runs.py"),
        runs="results/{cohort}/experience/{variant}/observations/runs.parquet",
        windows="results/{cohort}/experience/{variant}/observations/windows.parquet",
        parameters=experience.parameters("analysis.model", "analysis.windows"),
    output:
        within="results/{cohort}/experience/{variant}/models/within_runs.parquet",
        excluded="results/{cohort}/experience/{variant}/models/excluded_runs.parquet",
        summary="results/{cohort}/experience/{variant}/models/significant_within.parquet",
    log:
        "logs/{cohort}/experience/{variant}/within_runs.log",
    conda:
        "../envs/swaystride.yaml"
    shell:
        "python scripts/experience_within_runs.py --runs {input.runs:q}"
        " --windows {input.windows:q} --parameters {input.parameters:q}"
        " --output {output.within:q} --excluded {output.excluded:q}"
        " --summary {output.summary:q} 2>&1 | tee {log:q}"


rule experience_quality:
    input:
        code("scripts/experience_quality.py"),
        tables=experience.design_tables,
        parts=experience.quality_parts,
        answers="results/{cohort}/experience/answers/findings.csv",
        scores="results/{cohort}/experience/answers/scores.parquet",
    output:
        findings="results/{cohort}/experience/quality/findings.csv",
        exclusions="results/{cohort}/experience/quality/exclusions.csv",
        flow="results/{cohort}/experience/quality/flow.json",
    log:
        "logs/{cohort}/experience/quality.log",
    conda:
        "../envs/swaystride.yaml"
    params:
        raw=experience.raw,
        runs=experience.runs,
        results=experience.results,
        measured=f"results/{{cohort}}/experience/{project.base_variant}",
    shell:
        "python scripts/experience_quality.py --raw {params.raw:q} --runs {params.runs:q}"
        " --cohort-results {params.results:q} --measured {params.measured:q}"
        " --answer-findings {input.answers:q} --findings {output.findings:q}"
        " --exclusions {output.exclusions:q} --flow {output.flow:q} 2>&1 | tee {log:q}"


include: "experience_results.smk"
