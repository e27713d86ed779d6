# Needs Python 3.11 or newer, make and the package index; everything else is installed into .venv.

PYTHON ?= $(shell for p in python3.11 python3 python3.14 python3.13 python3.12; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && { echo $$p; break; }; done)
VENV := .venv
BIN := $(VENV)/bin
OUT ?= out/demo
# The built wheel is tried in an environment of its own, outside the checkout, so that only what
# was packed can be imported.
WHEEL_VENV ?= $(or $(TMPDIR),/tmp)/enpointe-wheel$(subst /,-,$(CURDIR))
ROOMS := enpointe notation models motion choreography controllers sim hardware studio
SCRIPTS := tests benchmarks docs examples

.PHONY: help setup demo test lint types imports wheel wheel-venv wheel-tools bench lock floors clean FORCE

help:
	@echo "make demo     dance the third port de bras, happily, and say where the report is"
	@echo "make test     run the whole suite"
	@echo "make lint     style and formatting"
	@echo "make types    mypy, strict, on the built wheel, and on the tests and scripts against it"
	@echo "make imports  the direction of imports between the rooms, on the built wheel"
	@echo "make wheel    build dist/enpointe-*.whl"
	@echo "make bench    run every script in benchmarks/"
	@echo "make floors   run the suite on the oldest versions that pyproject.toml allows"
	@echo "make lock     renew constraints.txt and constraints-floors.txt (after changing pyproject.toml)"
	@echo "make clean    remove what the other targets built"

setup: $(VENV)/.installed

$(VENV)/.dependencies: constraints.txt
	@test -n "$(PYTHON)" || { echo "enpointe needs Python 3.11 or newer: install it, or say make PYTHON=..." >&2; exit 1; }
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --require-hashes -r constraints.txt
	@touch $@

# The editable install is a tree of links: it needs building again when a file comes or goes.
$(VENV)/.files: $(VENV)/.dependencies FORCE
	@find $(wildcard $(ROOMS)) -type f ! -path '*/__pycache__/*' | LC_ALL=C sort > $@.new
	@if cmp -s $@.new $@; then rm $@.new; else mv $@.new $@; fi

$(VENV)/.installed: $(VENV)/.files pyproject.toml
	$(BIN)/python -m pip install --quiet --no-deps --no-build-isolation \
		--config-settings editable_mode=strict --editable .
	@touch $@

demo: setup
	$(BIN)/enpointe perform third-port-de-bras --effort happy --controller pd --out $(OUT)
	@find "$(abspath $(OUT))" -name '*.html' -exec echo "The report: {}" \;

test: setup
	$(BIN)/pytest -n 2 $(PYTEST_ARGS)

lint: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

wheel: $(VENV)/.dependencies
	rm -rf build/lib build/bdist.* dist
	$(BIN)/python -m build --wheel --no-isolation --outdir dist . > /dev/null
	@ls dist/*.whl

# Only what the wheel itself asks for, at the pinned versions.
wheel-venv: wheel
	test -x $(WHEEL_VENV)/bin/python || $(PYTHON) -m venv $(WHEEL_VENV)
	sed -n 's/^\([a-zA-Z0-9][^\\]*==[^\\]*[^\\ ]\).*/\1/p' constraints.txt > $(WHEEL_VENV)/pins.txt
	$(WHEEL_VENV)/bin/python -m pip install --quiet --constraint $(WHEEL_VENV)/pins.txt dist/*.whl
	$(WHEEL_VENV)/bin/python -m pip install --quiet --force-reinstall --no-deps dist/*.whl

wheel-tools: wheel-venv
	$(WHEEL_VENV)/bin/python -m pip install --quiet --constraint $(WHEEL_VENV)/pins.txt \
		"$$(ls dist/*.whl)[dev,video,cluster,ros]"

# Links to the scripts, because from the checkout they would import its own folder enpointe/.
types: wheel-tools
	cd $(WHEEL_VENV) && bin/mypy --config-file $(CURDIR)/pyproject.toml -p enpointe
	rm -rf $(WHEEL_VENV)/scripts
	mkdir $(WHEEL_VENV)/scripts
	ln -s $(addprefix $(CURDIR)/,$(SCRIPTS)) $(WHEEL_VENV)/scripts
	cd $(WHEEL_VENV)/scripts && MYPYPATH=.:benchmarks:docs ../bin/mypy --explicit-package-bases \
		--cache-dir ../.mypy_cache --config-file $(CURDIR)/pyproject.toml $(SCRIPTS)

imports: wheel-tools
	cd $(WHEEL_VENV) && bin/lint-imports --no-cache --config $(CURDIR)/pyproject.toml

bench: setup
	@for script in $(sort $(wildcard benchmarks/[!_]*.py)); do \
		echo "== $$script"; $(BIN)/python $$script || exit 1; done

lock: $(VENV)/.dependencies
	$(BIN)/python -m venv $(VENV)/lock
	$(VENV)/lock/bin/python -m pip install --quiet uv
	$(VENV)/lock/bin/uv pip compile --quiet --universal --python-version 3.11 --fork-strategy fewest --upgrade \
		--generate-hashes --no-annotate --no-emit-index-url --extra video --extra cluster --extra ros --extra dev \
		--custom-compile-command "make lock" --output-file constraints.txt pyproject.toml
	$(VENV)/lock/bin/uv pip compile --quiet --universal --python-version 3.11 --fork-strategy fewest --upgrade \
		--resolution lowest-direct --only-binary :all: --no-annotate --no-emit-index-url --extra video --extra cluster --extra ros \
		--custom-compile-command "make lock" --output-file constraints-floors.txt pyproject.toml
	rm -rf $(VENV)/lock

# pytest and its friends come as new as they are; what the suite tests comes as old as may be.
floors: wheel
	rm -rf $(VENV)/floors
	$(PYTHON) -m venv $(VENV)/floors
	$(VENV)/floors/bin/python -m pip install --quiet --only-binary :all: -r constraints-floors.txt
	$(VENV)/floors/bin/python -m pip install --quiet --constraint constraints-floors.txt \
		"$$(ls dist/*.whl)[dev,video,cluster,ros]"
	$(VENV)/floors/bin/pytest -n 2 $(PYTEST_ARGS)

clean:
	rm -rf build dist out *.egg-info .mypy_cache .ruff_cache .pytest_cache .hypothesis
	rm -rf $(VENV)/floors $(WHEEL_VENV)
	rm -f $(VENV)/.installed $(VENV)/.files
	find . -name __pycache__ -not -path './$(VENV)/*' -prune -exec rm -rf {} +
