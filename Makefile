# Every target sets up what it needs: Python 3.11 or later, cargo and make are all it asks of a machine.

# The first Python on the PATH that is new enough; `make PYTHON=... demo` takes another.
PYTHON ?= $(firstword $(foreach p,python3 python3.14 python3.13 python3.12 python3.11,\
	$(shell $(p) -c 'import sys; sys.exit(sys.version_info < (3, 11))' >/dev/null 2>&1 </dev/null && echo $(p))))

bin := .venv/bin
# PyO3 asks a Python what it builds for: always the same one, so that nothing is built twice.
export PYO3_PYTHON := $(CURDIR)/.venv/bin/python
# What is built here runs here: with the wider registers that nearly every x86-64 has, surveys take 5 percent less time.
# Not with all that this processor has, as what was built may be carried to another; the bytes of a survey are the same.
v3 := avx2 bmi1 bmi2 f16c fma lzcnt movbe
own = $(shell rustc --print cfg -C target-cpu=native 2>/dev/null </dev/null | sed -n 's/^target_feature="\(.*\)"$$/\1/p')
wide = $(if $(filter-out $(own),$(v3)),,RUSTFLAGS="$${RUSTFLAGS--C target-cpu=x86-64-v3}")
# Nothing here runs make again, and cargo warns of a job server that it cannot reach.
unexport MAKEFLAGS MFLAGS
# Directories too, so that a file that was taken away counts as a change.
rust := Cargo.toml Cargo.lock $(shell find crates -type d -o -name '*.rs' -o -name Cargo.toml)

.PHONY: help demo test check bench fuzz docs gallery format clean

help: ## Show this list
	@sed -n 's/^\([a-z]*\):.*## /\1\t/p' Makefile | expand -t 10

demo: .venv/.built ## Survey the example warehouse into out/demo
	@$(bin)/groundplan survey examples/warehouse.yaml -o out/demo --figures

test: .venv/.built ## Run the tests of both languages
	cargo test --quiet --locked --workspace
	$(bin)/python -m pytest

check: .venv/.built ## Check formatting, lints and types of both languages
	cargo fmt --all --check
	cargo clippy --quiet --locked --workspace --all-targets -- -D warnings
	$(bin)/ruff format --check
	$(bin)/ruff check
	$(bin)/mypy
	$(bin)/python -m mypy.stubtest groundplan._core

bench: .venv/.built ## Run every measurement in bench/
	@missed=0; for script in $(filter-out bench/_%,$(wildcard bench/*.py)); do $(bin)/python "$$script" || missed=1; done; exit $$missed

fuzz: ## Random arrangements for a minute; SECONDS=3600 for longer, SEED=n to start elsewhere
	GROUNDPLAN_FUZZ_SECONDS=$(or $(SECONDS),60) $(if $(SEED),GROUNDPLAN_FUZZ_SEED=$(SEED)) \
		cargo test --locked -p groundplan --test stress -- --ignored --nocapture

docs: .venv/.built ## Make anew what the docs show: parameters, scores, the README's picture
	$(bin)/groundplan parameters --markdown > docs/parameters.md
	$(bin)/python docs/make.py

gallery: .venv/.built ## Draw surveys and road maps of the maps in ../shared into gallery/; MAPS="name ..." for some
	$(bin)/python docs/gallery.py $(MAPS)

format: .venv/.installed ## Format both languages, and mend what the linter can
	cargo fmt --all
	$(bin)/ruff check --fix-only --quiet
	$(bin)/ruff format

clean: ## Remove all that was built, .venv included
	rm -rf .venv target out .mypy_cache .pytest_cache .ruff_cache .hypothesis python/groundplan/_core*.so

# The environment is made anew when a pin changes: what the lock does not name is not there.
.venv/.installed: requirements/dev.lock
	@"$(PYTHON)" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || { \
		echo "error: Python 3.11 or later is needed, and '$(or $(PYTHON),python3)' is not that" >&2; \
		echo "hint: make PYTHON=/path/to/python3 ..." >&2; exit 1; }
	@echo "Setting up .venv (once, a minute or so) ..."
	@"$(PYTHON)" -m venv --clear .venv || { echo "error: $(PYTHON) cannot make a virtual environment" >&2; \
		echo "hint: on Debian and Ubuntu, install python3-venv" >&2; exit 1; }
	@$(bin)/python -m pip install --quiet --no-input --disable-pip-version-check --require-hashes -r $<
	@touch $@

# The package is installed in place: Python sources are used as they lie, Rust sources are built on change.
.venv/.built: .venv/.installed pyproject.toml $(rust)
	@command -v cargo >/dev/null || { echo "error: cargo is not on the PATH" >&2; \
		echo "hint: install Rust 1.85 or later" >&2; exit 1; }
	@echo "Building the Rust core ..."
	@PATH="$(CURDIR)/$(bin):$$PATH" $(wide) MATURIN_PEP517_ARGS=--locked $(bin)/python -m pip install --quiet --no-input \
		--disable-pip-version-check --no-deps --no-build-isolation --editable .
	@touch $@
