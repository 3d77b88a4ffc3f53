# Everything runs from a fresh clone: each target makes .venv when there is none and installs what it needs.

SHELL := /bin/bash
VENV ?= .venv
PYTHON ?= $(shell for p in python3.11 python3.12 python3.13 python3; do \
	$$p -c 'import sys; sys.exit(not (3, 11) <= sys.version_info[:2] < (3, 14))' 2>/dev/null && echo $$p && break; done)
RUN := $(VENV)/.installed-run
DEV := $(VENV)/.installed-dev
DOCS := $(VENV)/.installed-docs
# Blender as a Python module wants one version of Python, and an older numpy: a folder of its own
BLENDER_VENV ?= .venv-blender
BLENDER := $(BLENDER_VENV)/.installed-bpy

# Two test processes share the cores; more threads inside each would only wait for one another.
ONE_THREAD := OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 NUMBA_NUM_THREADS=1
PYTEST := $(ONE_THREAD) $(VENV)/bin/python -m pytest -n 2

.DEFAULT_GOAL := help
.PHONY: help demo test test-slow test-interop lint format bench docs clean

help: ## list the targets
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## /\1\t/' | expand -t 12

demo: $(RUN) ## motion onto built-in characters; pictures, a table and report.html in demo/
	$(VENV)/bin/tempose demo -o demo

test: $(DEV) ## the tests, without the slow ones (under ten minutes on two cores)
	$(PYTEST) -m "not slow and not interop"

test-slow: $(DEV) ## only the slow tests
	$(PYTEST) -m "slow and not interop" || test $$? -eq 5  # 5: there is none

test-interop: $(DEV) $(BLENDER) ## clips through Blender and back; fetches Blender (a gigabyte) the first time
	TEMPOSE_BLENDER=$(BLENDER_VENV)/bin/python $(ONE_THREAD) $(VENV)/bin/python -m pytest -m interop tests/interop

lint: $(DEV) ## style, types and docstrings
	$(VENV)/bin/ruff check .
	$(VENV)/bin/ruff format --check .
	$(VENV)/bin/pyright --pythonpath $(VENV)/bin/python
	find src -name '*.py' -print0 | sort -z | xargs -0 $(VENV)/bin/python -m numpydoc.hooks.validate_docstrings

format: $(DEV) ## rewrite the sources in the project's style
	$(VENV)/bin/ruff check --fix .
	$(VENV)/bin/ruff format .

bench: $(DEV) ## measure and renew docs/benchmarks.md; ONLY=transfer and JSON=FILE narrow and keep it
	$(VENV)/bin/python benchmarks/run.py $(if $(ONLY),--only $(ONLY)) $(if $(JSON),--json $(JSON))

docs: $(DOCS) ## the documentation, built into site/
	$(VENV)/bin/sphinx-build -W --keep-going -q -b html -d site/.doctrees docs site
	@echo "open site/index.html"

clean: ## remove what the other targets made, .venv included
	rm -rf $(VENV) $(BLENDER_VENV) site demo .pytest_cache .ruff_cache .hypothesis

$(VENV)/.made:
	@test -n "$(PYTHON)" || { echo "Tempose needs Python 3.11, 3.12 or 3.13: install one, or name it with PYTHON=..." >&2; exit 2; }
	$(PYTHON) -m venv $(VENV)
	@touch $@

$(RUN): pyproject.toml | $(VENV)/.made
	$(VENV)/bin/python -m pip install --quiet --editable ".[render]"
	@touch $@

$(DEV): pyproject.toml | $(VENV)/.made
	$(VENV)/bin/python -m pip install --quiet --editable ".[render,dev]"
	@touch $@

$(DOCS): pyproject.toml | $(VENV)/.made
	$(VENV)/bin/python -m pip install --quiet --editable ".[render,docs]"
	@touch $@

$(BLENDER):
	@command -v python3.11 >/dev/null || { echo "Blender as a module needs Python 3.11: install it" >&2; exit 2; }
	python3.11 -m venv $(BLENDER_VENV)
	$(BLENDER_VENV)/bin/python -m pip install --quiet "bpy==5.0.1" "numpy<2"
	@touch $@
