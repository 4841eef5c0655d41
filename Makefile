# brakechain: 'make run' and 'make test' need nothing but Python 3.11+ and make.
CASE   ?= disc_brake
PYTHON ?= python3
ARGS   ?=
TESTS  ?= tests
KERNELS ?= Haswell Nehalem
ROUNDING ?= tests/physics tests/systems tests/stages tests/inference tests/diagnosis tests/chain/test_every_case.py
PRACTICE ?= data/runs/trial_practice
SEALED ?= data/trial/sealed_3
SEED   ?= 1
SECONDS ?= 600
AGAIN ?= data/runs/trial_again
# Python keeps bytecode, whatever the surroundings say: runs start dozens of processes, tests thousands
export PYTHONDONTWRITEBYTECODE :=
STAGES := surface effects micro_friction friction_map structure reduced_model complex_modes multibody response squeal comparison report convergence limit_cycle probability sensitivities design_search countermeasures interface_law friction_descriptions pin_on_disc transient lock_in lumped matrices matrix_modes rupture beam_on_beam motion_scatter beam_geometry recording noise_events orders response_functions modal_test model_update bench diagnosis line_evidence noise_matrix friction_update

CONFIG := configs/$(CASE).yaml
READY  := .venv/.ready
TESTED := .venv/.tested
BIN    := .venv/bin
#: another interpreter, as 3.13 or python3.13, and its environment; the same tests as 'make test' in an environment
INTERPRETER = $(patsubst 3.%,python3.%,$(PYTHON))
OTHER  = .venv-$(subst python,,$(notdir $(PYTHON)))
FAST  := -m pytest -q -rs -m "not slow" -n auto --dist loadfile
#: tests of the trial and of the studies have a target of their own, unless they are asked for
IGNORED = $(if $(filter tests,$(TESTS)),--ignore=tests/blind_trial/generators --ignore=tests/studies)

.DEFAULT_GOAL := help
.PHONY: help setup setup-tests run test test-trial test-default coverage test-kernels test-python test-oldest test-newest test-slow test-study bench fuzz fuzz_diagnosis trial trial_sealed trial_again study_diagnosis study_squeal study_brake study_concealed study_lines study_knock_out study_sharp paper_micro study_micro study_several study_disturbed study_second_family study_draws study_kills pin_bench brake_bench worn_bench lint licences clean $(STAGES)

help:            ## show this list
	@echo "usage: make TARGET [CASE=disc_brake] [ARGS=...]      cases: $(basename $(notdir $(wildcard configs/*.yaml)))"
	@grep -hE '^[a-z_-]+:.*##' Makefile | sed -E 's/:.*## */ /' | awk '{name = $$1; sub(/^[^ ]* */, ""); printf "  %-15s %s\n", name, $$0}'
	@echo "  one stage:   $(STAGES)"

setup: $(READY)  ## create the virtual environment .venv from the pinned lock of users, wheels only

$(READY): requirements.lock pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "error: PYTHON=$(PYTHON): expected Python 3.11 or newer; try: make PYTHON=python3.12 $(MAKECMDGOALS)"; exit 2; }
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --require-hashes --only-binary :all: -r requirements.lock
	$(BIN)/python -m pip install --quiet --no-deps --no-build-isolation --editable .
	$(BIN)/brakechain compile
	@touch $@

$(TESTED): $(READY) requirements-dev.lock
	$(BIN)/python -m pip install --quiet --require-hashes --only-binary :all: -r requirements-dev.lock
	@touch $@

run: $(READY)    ## run the chain of CASE; up-to-date stages are skipped
	$(BIN)/brakechain run $(CONFIG) $(ARGS)

test: $(TESTED)   ## all tests except slow ones and those of the trial; lists skipped tests with reasons
	$(BIN)/python $(FAST) $(IGNORED) $(ARGS) $(TESTS)

setup-tests: $(TESTED)   ## create the virtual environment with all that tests need

test-trial: $(TESTED)    ## tests of the trial's generators and of the studies, if what they depend on has changed since they passed
	$(BIN)/python -m tests.trial_changes $(ARGS)

test-default: $(TESTED)  ## the default case in full, with a fifth of its draws, against the published facts
	$(BIN)/python -m pytest -q "tests/chain/test_every_case.py::test_a_case_runs_to_its_report[disc_brake]" $(ARGS)

coverage: $(TESTED)  ## the same tests, with line coverage of pipeline/ and stages/
	$(BIN)/python $(FAST) --cov=pipeline --cov=stages --cov-report=term:skip-covered $(ARGS) $(TESTS)

test-kernels: $(TESTED)  ## tests sensitive to rounding, with the kernels of other processors (KERNELS of OpenBLAS, MKL, numba)
	@for kernel in $(KERNELS); do echo "OpenBLAS kernel $$kernel"; \
		OPENBLAS_CORETYPE=$$kernel MKL_ENABLE_INSTRUCTIONS=SSE4_2 NUMBA_CPU_NAME=generic \
		$(BIN)/python $(FAST) $(ARGS) $(ROUNDING) || exit 1; done

test-python:     ## the same tests under another Python with the same lock: PYTHON=3.13
	@$(INTERPRETER) -c '' 2>/dev/null || { echo "error: PYTHON=$(PYTHON): expected an interpreter, found no $(INTERPRETER);" \
		"install it, as by 'uv python install $(subst python,,$(notdir $(PYTHON)))'"; exit 2; }
	$(INTERPRETER) -m venv $(OTHER)
	$(OTHER)/bin/python -m pip install --quiet --require-hashes --only-binary :all: -r requirements-dev.lock
	$(OTHER)/bin/python -m pip install --quiet --no-deps --no-build-isolation --editable .
	$(OTHER)/bin/python $(FAST) $(ARGS) $(TESTS)

test-oldest:     ## the same tests with the oldest versions that pyproject.toml allows (found by uv)
	$(call tested_with,oldest,lowest-direct)

test-newest:     ## the same tests with the newest versions
	$(call tested_with,newest,highest)

define tested_with
$(PYTHON) -m venv --clear .venv-$(1)
.venv-$(1)/bin/python -m pip install --quiet uv
.venv-$(1)/bin/python -m uv pip install --quiet --python .venv-$(1)/bin/python --only-binary :all: --resolution $(2) \
	-r pyproject.toml --extra build --extra bench --extra test
.venv-$(1)/bin/python -m pip install --quiet --no-deps --no-build-isolation --editable .
.venv-$(1)/bin/python $(FAST) $(ARGS) $(TESTS)
endef

test-slow: $(TESTED)  ## slow tests: full cases, kill and resume in every stage
	$(BIN)/python -m pytest -q -m "slow and not study" -n auto --dist worksteal --durations=20 --durations-min=30 $(ARGS) $(TESTS)

test-study: $(TESTED)  ## long diagnoses: every kind of case, samples of the studies
	$(BIN)/python -m pytest -q -m study $(ARGS) $(TESTS)

bench: $(TESTED)  ## benchmarks: wall and CPU seconds of kernels, other codes, stages, diagnoses; ARGS="--compare COMMIT" adds an earlier run
	$(BIN)/python -m tests.benchmarks $(ARGS)

fuzz: $(TESTED)  ## damaged files to every reader, cases, quantities and products, for SECONDS (600); failures are kept as tests
	$(BIN)/python -m tests.fuzz --seconds $(SECONDS) --seed $(SEED) $(ARGS)

fuzz_diagnosis: $(TESTED)  ## CASES (100) random benches through 'brakechain run': each ends with an answer or a sentence
	$(BIN)/python -m tests.fuzz.diagnoses --cases $(or $(CASES),100) --seed $(SEED) $(ARGS)

trial: $(READY)  ## open practice trial: make, solve and score, up to half an hour on two cores; resumes
	@test -e $(PRACTICE)/set.yaml || $(BIN)/brakechain trial make $(PRACTICE) --cases 48 --seed 1 --systems forced_rig,coarse_rig
	$(BIN)/brakechain trial solve $(PRACTICE) $(ARGS)
	$(BIN)/brakechain trial score $(PRACTICE)
	$(BIN)/brakechain trial show $(PRACTICE)

trial_sealed: $(READY)  ## sealed trial SEALED: make and seal; after its commitment is in Git, solve and score
	@test -e $(SEALED)/set.yaml || $(BIN)/brakechain trial make $(SEALED) --cases 310 --sealed
	@git ls-files --error-unmatch $(SEALED)/set.yaml >/dev/null 2>&1 || { \
		echo "commit $(SEALED)/{set.yaml,code.json,truth.sealed} before solving; then run this again"; exit 2; }
	@test -e $(SEALED)/result.json || { $(BIN)/brakechain trial solve $(SEALED) $(ARGS) && $(BIN)/brakechain trial score $(SEALED); }
	$(BIN)/brakechain trial show $(SEALED)
	$(BIN)/brakechain trial verify $(SEALED)

trial_again: $(READY)  ## remake the published trial SEALED as an open one; solve and score it with the current code; resumes
	@test -e $(AGAIN)/set.yaml || $(BIN)/brakechain trial remake $(SEALED) $(AGAIN)
	$(BIN)/brakechain trial solve $(AGAIN) $(ARGS)
	$(BIN)/brakechain trial score $(AGAIN)
	$(BIN)/brakechain trial show $(AGAIN)

study_diagnosis: $(TESTED)  ## identification rates for hidden physics on forced rigs; resumes case by case
	$(BIN)/python -m tests.studies.forced $(ARGS)

study_squeal: $(TESTED)  ## identification rates on the practice pin-on-disc bench; resumes case by case
	$(BIN)/python -m tests.studies.self_excited $(ARGS)

study_brake: $(TESTED)  ## identification rates on the practice disc brake; resumes case by case
	$(BIN)/python -m tests.studies.brake $(ARGS)

study_concealed: $(TESTED)  ## whether brakes with concealed physics squeal, how likely, and what helps, beside the truth
	$(BIN)/python -m tests.studies.concealed_squeal $(ARGS)

study_lines: $(TESTED)  ## whether a disc flexible in the loop is named from lines heard on concealed benches; resumes case by case
	$(BIN)/python -m tests.studies.lines $(ARGS)

study_knock_out: $(TESTED)  ## whether physics that the catalogue lacks is taken for a known law; resumes case by case
	$(BIN)/python -m tests.studies.knock_out $(ARGS)

study_sharp: $(TESTED)  ## whether friction that sticks, play and stops are named from event-driven recordings; resumes case by case
	$(BIN)/python -m tests.studies.sharp $(ARGS)

study_micro: $(TESTED)  ## how far friction, real area and wear hang on grid, patch, layers, cycles and stroke
	$(BIN)/python -m tests.studies.micro_convergence $(ARGS)

paper_micro: $(TESTED)  ## friction, real area and wear of the 2021 paper beside ours, over several pairs of surfaces
	$(BIN)/python -m tests.studies.paper_micro $(ARGS)

study_several: $(TESTED)  ## joints with one to three laws at once, by simulation or (--equation) the equation of motion
	$(BIN)/python -m tests.studies.several $(ARGS)

study_disturbed: $(TESTED)  ## false alarms where noise, clocks, samples and joints are not as assumed; resumes case by case
	$(BIN)/python -m tests.studies.disturbed $(ARGS)

study_draws: $(TESTED)  ## growing roots of 200 draws of the default brake, which has been run, beside all roots by LAPACK
	$(BIN)/python -m tests.studies.draws $(ARGS)

study_kills: $(TESTED)  ## 324 deaths of runs and of Dask workers at random moments, over nine chains; adds to data/studies/kills.csv
	$(BIN)/python -m tests.studies.kills $(ARGS)

study_second_family: $(TESTED)  ## identification rates on rigs that truly switch, the set of SEED; resumes case by case
	$(BIN)/python -m tests.studies.second_family --seed $(SEED) $(ARGS)

pin_bench: $(READY)  ## write the practice recordings of configs/pin_on_disc_bench.yaml to data/runs/practice
	$(BIN)/python -m tests.studies.self_excited --practice

brake_bench: $(READY)  ## write the practice recordings of configs/disc_brake_bench.yaml and squealing_brake_bench.yaml to data/runs/practice
	$(BIN)/python -m tests.studies.brake --practice

worn_bench: $(READY)  ## write the practice recordings of configs/worn_pad.yaml to data/runs/practice
	$(BIN)/python -m tests.studies.worn

lint: $(TESTED)   ## check code style
	$(BIN)/python -m ruff check .

licences: $(TESTED)  ## the licence of every package, and which of the two locks asks for it
	$(BIN)/python -m tests.licences

clean:           ## delete the products of CASE
	rm -rf data/runs/$(CASE)

$(filter-out bench,$(STAGES)): $(READY)
	$(BIN)/brakechain $(subst _,-,$@) $(CONFIG) $(ARGS)
