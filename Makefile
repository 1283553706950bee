# Everything runs in .venv, which any target makes by itself: only Python 3.11 or newer,
# pip and make are needed. Another interpreter: make PYTHON=python3.12 test

PYTHON ?= python3
BIN := .venv/bin
STAMP := .venv/.installed
UV := $(shell command -v uv 2>/dev/null)
# The interpreter's own pip, so that Debian's Python without ensurepip will do.
PIP := $(PYTHON) -m pip --python $(BIN)/python

# No display is needed by any target.
export MPLBACKEND := Agg

.PHONY: demo test check lock clean

demo: $(STAMP)
	$(BIN)/sinuous teleop

test: $(STAMP)
	$(BIN)/python -m pytest -n 2

check: $(STAMP)
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/basedpyright
	$(BIN)/lint-imports
	@set -e; for example in examples/*.py; do \
		echo "$$example"; $(BIN)/python -W error "$$example"; \
	done
	@set -e; for paper in qin2020 hachen2025; do \
		PYTHONWARNINGS=error $(BIN)/sinuous reproduce $$paper --quick --out out/check/$$paper; \
	done

# Versions and hashes of all dependencies, for every platform and Python version.
# Versions stay as they are where they can; make lock UPGRADE=--upgrade raises them.
# The --no options keep paths, addresses and commands of this machine out of the file.
LOCKER := $(if $(UV),$(UV),.venv/lock/bin/uv)
lock:
	test -n "$(UV)" || $(PYTHON) -m venv --without-pip .venv/lock
	test -n "$(UV)" || $(PYTHON) -m pip --python .venv/lock/bin/python install --quiet uv
	cp requirements.lock requirements.lock.part
	$(LOCKER) pip compile pyproject.toml --extra dev --universal --generate-hashes --quiet \
		--no-header --no-annotate --no-emit-index-url --no-emit-find-links $(UPGRADE) \
		--output-file requirements.lock.part > /dev/null
	echo "# Every dependency with its hashes, from pyproject.toml by: make lock" > requirements.lock
	cat requirements.lock.part >> requirements.lock
	rm requirements.lock.part

clean:
	rm -rf .venv out dist build .pytest_cache .ruff_cache .hypothesis .import_linter_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(STAMP): pyproject.toml requirements.lock
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and \
	    "$(PYTHON) is too old, Python 3.11 is needed: make PYTHON=... $(MAKECMDGOALS)" or 0)'
ifeq ($(UV),)
	test -x $(BIN)/python || $(PYTHON) -m venv --without-pip .venv
	$(PIP) install --quiet --require-hashes -r requirements.lock
	$(PIP) install --quiet --no-deps -e .
else
	test -x $(BIN)/python || $(UV) venv --quiet --python $(PYTHON) .venv
	VIRTUAL_ENV=$(CURDIR)/.venv $(UV) pip sync --quiet --require-hashes requirements.lock
	VIRTUAL_ENV=$(CURDIR)/.venv $(UV) pip install --quiet --no-deps -e .
endif
	$(BIN)/python -m sinuous.precompile
	touch $@
