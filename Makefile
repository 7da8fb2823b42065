# Two commands do all the set-up that they need: `make reproduce` and `make test`.
PYTHON ?= python3
VENV ?= .venv
OUT ?= out
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --disable-pip-version-check install --quiet --constraint constraints.txt

.PHONY: help c-example reproduce test test-matrix derive check-generated figures bench lint clean

help:
	@echo "make reproduce        derive, check, emit, integrate, draw; the table of printed and computed numbers"
	@echo "make test             all fast tests, lint and the check of the generated modules"
	@echo "make test-matrix      laws of mechanics for each of 1200 described membranes (long)"
	@echo "make derive           derive the equations, check the printed ones, write generated/"
	@echo "make check-generated  regenerate aside and compare byte for byte"
	@echo "make figures          Figs. 4-12 as PNG and PDF with their data, in $(OUT)/figures"
	@echo "make c-example        a run in C, without Python (examples/one_run.c)"
	@echo "make bench            sweeps timed against other packages, in $(OUT)/bench (about ten minutes)"

$(VENV)/.python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "Python 3.11 or later is needed; $(PYTHON) is older. Try: make PYTHON=python3.12 ..."; exit 1; }
	$(PYTHON) -m venv $(VENV)
	@touch $@

$(VENV)/.installed: $(VENV)/.python pyproject.toml constraints.txt
	$(PIP) --editable .
	@touch $@

$(VENV)/.tested: $(VENV)/.installed
	$(PIP) --editable '.[test]'
	@touch $@

reproduce: $(VENV)/.installed
	$(BIN)/delagrange reproduce --out $(OUT)

figures: $(VENV)/.installed
	$(BIN)/delagrange figures --out $(OUT)/figures

$(VENV)/.benched: $(VENV)/.installed
	$(PIP) --editable '.[bench]'
	@touch $@

bench: $(VENV)/.benched
	$(BIN)/python -m benchmarks --out $(OUT)/bench

derive: $(VENV)/.installed
	$(BIN)/python -m delagrange.derive

c-example:
	mkdir -p $(OUT)
	$(CC) -std=c99 -O2 -ffp-contract=off -DDELAGRANGE_MODEL='"equal_biaxial.h"' -Igenerated -Isrc/delagrange/core/c \
	  examples/one_run.c src/delagrange/core/c/trajectory.c -lm -o $(OUT)/one_run
	$(OUT)/one_run

check-generated: $(VENV)/.installed
	$(BIN)/python -m delagrange.derive --check

# A file of tests stays on one worker, which makes its fixtures once; the files that take long come first.
PYTEST := $(BIN)/python -m pytest --numprocesses auto
BY_FILE := --dist loadfile --no-loadscope-reorder

test: $(VENV)/.tested lint
	$(PYTEST) $(BY_FILE) --durations 10

test-matrix: $(VENV)/.tested
	$(PYTEST) tests/matrix/whole_matrix.py

lint: $(VENV)/.tested
	$(BIN)/ruff check .
	$(BIN)/lint-imports

clean:
	rm -rf $(VENV) $(OUT) build *.egg-info src/*.egg-info
