# Everything runs in the virtual environment .venv, made when it is first needed.

PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
OTHERS := build/bench-others
DEMO   := build/demo
PAPER  := build/paper
DRAWN  := $(wildcard src/fcm/contact/*.py src/fcm/plot/*.py src/fcm/cli/coefficients.py)

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.PHONY: help bench-others demo picture figures test check tables clean bench study

help:  ## this list
	@sed -n 's/^\([a-z-]*\):.*##/  make \1  -/p' $(MAKEFILE_LIST)

demo: $(VENV)/installed  ## figure 13 of the paper: its response curves and their picture, in build/demo
	@mkdir -p $(DEMO)
	$(BIN)/fcm respond yang1998 -o $(DEMO)/yang1998.nc
	$(BIN)/fcm plot response $(DEMO)/yang1998.nc -o $(DEMO)/figure13.png

picture: demo  ## the same, and its picture as the one of README.md
	cp $(DEMO)/figure13.png .github/figure13.png

figures: $(PAPER)/figure10.png $(PAPER)/figure11.png $(PAPER)/figure12.png $(PAPER)/figure15.png  ## figures 10, 11, 12 and 15 of the paper, in build/paper

$(PAPER)/figure10.png: WHAT := surface --coefficient F_s --coefficient F_c --phi 0
$(PAPER)/figure11.png: WHAT := surface --coefficient F_c --phi 15deg --phi 30deg
$(PAPER)/figure12.png: WHAT := normal

$(PAPER)/figure%.png: $(DRAWN) $(VENV)/installed
	@mkdir -p $(@D)
	$(BIN)/fcm plot $(WHAT) -o $@

$(PAPER)/figure15.nc: src/fcm/scenes/yang1998-jump.toml $(wildcard src/fcm/simulate/*.py) $(VENV)/installed
	@mkdir -p $(@D)
	$(BIN)/fcm respond yang1998-jump -o $@

$(PAPER)/figure15.png: $(PAPER)/figure15.nc $(DRAWN)
	$(BIN)/fcm plot history $< -o $@

test: check  ## format, lint, types, then all tests
	$(BIN)/python -m pytest -n 2

check: $(VENV)/installed-dev  ## format, lint and types only
	$(BIN)/ruff format --check src tests
	$(BIN)/ruff check src tests
	$(BIN)/mypy

tables: $(VENV)/installed  ## build the shipped tables again
	$(BIN)/fcm tabulate -o tables/default.nc
	$(BIN)/fcm tabulate --preset fast -o tables/fast.nc

study: $(VENV)/installed  ## two hundred random scenes, each with three step limits: do the answers agree?
	$(BIN)/python tests/response/random_scenes.py

bench: $(VENV)/installed  ## run times beside one another: closed form, table, scipy, curves
	$(BIN)/python tests/benchmarks/speed.py

bench-others: $(OTHERS)/installed  ## run times beside another package, pyHarm-os, in an environment of its own
	OPENBLAS_NUM_THREADS=1 $(OTHERS)/bin/python tests/benchmarks/pyharm.py

clean:  ## remove what was made, but for the environment
	rm -rf build dist .mypy_cache .pytest_cache .ruff_cache .hypothesis
	find src tests -name __pycache__ -type d -prune -exec rm -rf {} +

$(VENV)/installed: pyproject.toml
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable .
	@touch $@

$(OTHERS)/installed: pyproject.toml
	@mkdir -p $(@D)
	test -x $(OTHERS)/bin/python || $(PYTHON) -m venv $(OTHERS)
	$(OTHERS)/bin/python -m pip install --quiet --disable-pip-version-check --editable '.[benchmark]'
	@touch $@

$(VENV)/installed-dev: $(VENV)/installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	@touch $@
