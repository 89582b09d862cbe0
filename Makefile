# swaystride: `make` sets up the environment and builds every table and figure.
#
#   make              everything at published scale     make demo       the same in small
#   make feedback     one study (or intensity, imu_design, kinematics, experience)
#   make variants     every variant of every study
#   make test         tests                             make lint       style, types, workflow
#   make validation   public real recordings            make recovery   many simulated cohorts
#   make dry-run      what would be done                make benchmark  time and memory of the studies
#   make benchmark-models  mixed models beside other libraries (make peers installs them)
#   make benchmark-feet    foot trajectories beside vqf and gaitmap
#   make benchmark-running-body  time and memory of the simulated runner
#   make clean        remove results and generated data

SHELL := bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := all

CORES ?= $(shell nproc 2>/dev/null || echo 2)
COHORT ?=
PYTHON ?= $(shell command -v python3.11 || command -v python3)
BIN := .venv/bin
export PATH := $(CURDIR)/$(BIN):$(PATH)
SNAKEMAKE := snakemake --cores $(CORES) --keep-going --rerun-incomplete --quiet rules host \
	$(if $(COHORT),--config cohort=$(COHORT))

.PHONY: all setup demo feedback intensity imu_design kinematics experience variants validation benchmark benchmark-models benchmark-feet benchmark-running-body peers recovery dry-run test lint format lock clean

all: setup
	@$(SNAKEMAKE) -- all

demo: setup
	@$(MAKE) --no-print-directory all COHORT=synthetic_demo

feedback: setup
	@$(SNAKEMAKE) -- feedback

intensity: setup
	@$(SNAKEMAKE) -- intensity

imu_design: setup
	@$(SNAKEMAKE) -- imu_design

kinematics: setup
	@$(SNAKEMAKE) -- kinematics

experience: setup
	@$(SNAKEMAKE) -- experience

variants: setup
	@$(SNAKEMAKE) -- variants

validation: setup
	@$(SNAKEMAKE) -- validation
	@! grep ',no$$' results/validation/summary.csv \
		|| { echo "validation: the values above are not within tolerance" >&2; exit 1; }

benchmark: setup
	@OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 python scripts/benchmark_studies.py --cores $(CORES)

benchmark-models: setup
	@OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 RAYON_NUM_THREADS=1 python scripts/benchmark_mixed_models.py \
		$(if $(REFERENCE),--reference "$(REFERENCE)")

benchmark-feet: setup
	@OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 NUMBA_NUM_THREADS=1 python scripts/benchmark_foot_trajectories.py

benchmark-running-body: setup
	@OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 NUMBA_NUM_THREADS=1 python scripts/benchmark_running_body.py

peers: .venv-peers/.complete .venv-peers-gait/.complete .venv-peers-opal/.complete
	@python scripts/peers_opal.py

.venv-peers/.complete: requirements-peers.txt | .venv/.complete
	@echo "setting up .venv-peers (once)"
	@$(BIN)/python -m venv --clear .venv-peers
	@.venv-peers/bin/python -m pip install --quiet --disable-pip-version-check -r requirements-peers.txt
	@touch $@

.venv-peers-gait/.complete: requirements-peers-gait.txt | .venv/.complete
	@echo "setting up .venv-peers-gait (once)"
	@$(BIN)/python -m venv --clear .venv-peers-gait
	@.venv-peers-gait/bin/python -m pip install --quiet --disable-pip-version-check -r requirements-peers-gait.txt
	@touch $@

.venv-peers-opal/.complete: requirements-peers-opal.txt | .venv/.complete
	@echo "setting up .venv-peers-opal (once)"
	@$(BIN)/python -m venv --clear .venv-peers-opal
	@.venv-peers-opal/bin/python -m pip install --quiet --disable-pip-version-check -r requirements-peers-opal.txt
	@touch $@

recovery: setup
	@$(SNAKEMAKE) -- recovery
	@! grep ',no$$' results/recovery/*.csv \
		|| { echo "recovery: the effects above are biased or not covered as they must be" >&2; exit 1; }

dry-run: setup
	@snakemake --cores $(CORES) --dry-run all

test: setup
	@python -m pytest -n $(CORES) --dist loadscope --no-loadscope-reorder

lint: setup
	@ruff check .
	@ruff format --check .
	@mypy
	@snakefmt --check Snakefile workflow
	@snakemake --lint

format: setup
	@ruff check --fix .
	@ruff format .
	@snakefmt Snakefile workflow

setup: .venv/.complete

# The marker is written last: an interrupted set-up is started again.
.venv/.complete: requirements.txt pyproject.toml
	@command -v git >/dev/null || { echo "missing: git (Debian: apt-get install git)" >&2; exit 1; }
	@[ -n "$(PYTHON)" ] && "$(PYTHON)" -c 'import sys; sys.exit(sys.version_info[:2] != (3, 11))' \
		|| { echo "missing: Python 3.11 (set PYTHON=/path/to/python3.11)" >&2; exit 1; }
	@"$(PYTHON)" -c 'import ensurepip, venv' 2>/dev/null \
		|| { echo "missing: the venv module of Python 3.11 (Debian: apt-get install python3-venv)" >&2; exit 1; }
	@echo "setting up .venv (once)"
	@"$(PYTHON)" -m venv --clear .venv
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements.txt
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	@touch $@

# Resolve requirements.in anew (needs pip-tools in a Python of your own).
lock:
	pip-compile --quiet --upgrade --allow-unsafe --generate-hashes --strip-extras --no-emit-index-url \
		--no-emit-find-links --no-emit-trusted-host --output-file requirements.txt requirements.in

clean:
	rm -rf results logs data/raw/synthetic data/raw/synthetic_demo
