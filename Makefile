# Every target sets itself up on a fresh clone: .venv/ from environment.lock, Python 3.11, pip.
PYTHON ?= python3.11
CORES ?= 2
SUITE ?= quick
SHARE ?= 1
BIN := .venv/bin
export PYTHONHASHSEED := 0
# compiled once, not anew in each of the hundred processes of a workflow or of the tests
unexport PYTHONDONTWRITEBYTECODE

.PHONY: help setup study thesis test test-thorough test-ui fuzz kills crowd commands soak test-slurm wheel-test walk ui screenshots check bench bench-ui benchmark-blind catalogue docs clean lock

help:
	@echo "make study   the whole study on the default campaign, into results/"
	@echo "make thesis  the thesis' own runs, each held out once, beside its published numbers"
	@echo "make ui      the workbench in the browser (CAMPAIGN=DIR opens one)"
	@echo "make test    every test but the longest"
	@echo "make test-thorough   these: physics hidden in whole campaigns, the workbench in a browser"
	@echo "make test-ui the workbench in a real Chromium, which is installed if need be"
	@echo "make fuzz    hostile input at every door: TRIES=2000 FIRST=1000"
	@echo "make kills   commands killed at random moments: KILLS=20 each"
	@echo "make crowd   two studies, two sweeps and a workbench at once on one database"
	@echo "make soak    a long day at the workbench: 1,000 replays, 20 campaigns"
	@echo "make test-slurm   study, folds, thesis, blind cases and a sweep through a real Slurm on this machine (root, slurm-wlm)"
	@echo "make commands   every command of README and docs, in a fresh shell"
	@echo "make walk    a newcomer with a watch: fresh clone to a fallen error, own csv files to a verdict"
	@echo "make check   formatting, lint, types, layers, workflow"
	@echo "make wheel-test   the wheel alone, in an empty environment (PYTHON=, 3.11 to 3.13)"
	@echo "make bench   replay and inference speed, into results/bench.json"
	@echo "make benchmark-blind   known physics hidden in the tank: is it found? SUITE=quick|standard|full|recordings|equations|laboratory|strong SHARE=0.25"
	@echo "make catalogue   docs/catalogue.md and its pictures, from the declarations of the effects"
	@echo "make docs    the documentation as a site that works offline: site/index.html"
	@echo "make setup   the environment alone"

.venv/.complete: environment.lock pyproject.toml
	test -x $(BIN)/python || $(PYTHON) -m venv .venv || python3 -m venv .venv
	$(BIN)/python -c "import sys; assert sys.version_info[:2] == (3, 11), 'Python 3.11 is needed: make PYTHON=/path/to/python3.11'"
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -r environment.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation -e .
	touch $@

setup: .venv/.complete

study: setup
	$(BIN)/snakemake --cores $(CORES)

# Needs the recordings (docs/thesis.md); puts its tables into that page.
thesis: setup
	$(BIN)/snakemake --cores $(CORES) --config overrides="+experiment=kth_tank_2025"
	$(BIN)/python -m rovsim.reporting.pages.leave_one_run_out results/kth_tank_2025 docs/thesis.md

test: setup
	$(BIN)/python -m pytest -n $(CORES) --dist worksteal -m "not thorough and not browser"

test-thorough: setup
	$(BIN)/python -m pytest -n $(CORES) --dist worksteal -m "thorough or browser"

# Minutes, and it needs a package index: what a newcomer types, timed.
walk: setup
	$(BIN)/python tests/walk.py

wheel-test: setup
	.ci/wheel-test $(PYTHON)

ui: setup
	$(BIN)/rovsim ui $(if $(CAMPAIGN),campaign=$(CAMPAIGN))

# Seeds that no test tries, from FIRST on, TRIES at each door.
TRIES ?= 2000
FIRST ?= 1000
fuzz: setup
	ROVSIM_FUZZ=$(TRIES) ROVSIM_FUZZ_FIRST=$(FIRST) ROVSIM_MUTATIONS=500 $(BIN)/python -m pytest -n $(CORES) tests/fuzz tests/contracts/test_damaged_recordings.py

# Each command killed that often, at random moments: it must end as if nothing had happened.
KILLS ?= 20
kills: setup
	$(BIN)/python tests/kills.py $(KILLS)

crowd: setup
	$(BIN)/python tests/crowd.py

# Half an hour and more: every command of README and docs as it stands there.
commands: setup
	PYTHONPATH=tests $(BIN)/python tests/commands.py $(PAGES)

soak: setup chromium
	PYTHONPATH=tests $(BIN)/python tests/browser/soak.py

# As root, with Debian's slurm-wlm: a cluster of one node on this machine. CHAPTER=whole: an hour.
CHAPTER ?= short
test-slurm: setup
	ROVSIM_SLURM=$(CHAPTER) $(BIN)/python -m pytest -rPs tests/cluster

test-ui: setup chromium
	$(BIN)/python -m pytest tests/browser

# The pictures of the docs, taken by the tests on the practice campaign.
screenshots: setup chromium
	ROVSIM_SCREENSHOTS=$(CURDIR)/docs/images/workbench $(BIN)/python -m pytest tests/browser

.PHONY: chromium
chromium: setup
	for name in chromium chromium-browser google-chrome google-chrome-stable chrome; do \
	  command -v $$name >/dev/null && exit 0; done; $(BIN)/playwright install chromium

check: setup
	$(BIN)/ruff format --check src tests workflow docs/site
	$(BIN)/ruff check src tests workflow docs/site
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/snakefmt --check Snakefile workflow

bench-ui: setup chromium
	PYTHONPATH=tests $(BIN)/python tests/browser/speed.py

bench: setup
	$(BIN)/rovsim bench

benchmark-blind: setup
	$(BIN)/snakemake -s workflow/blind.smk --cores $(CORES) --quiet rules --config overrides="blind.suite=$(SUITE) blind.share=$(SHARE)"

catalogue: setup
	$(BIN)/python -m rovsim.reporting.catalogue

docs: setup
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --quiet

# What Add and train wrote into results/ goes as well, so that is said first.
clean:
	@echo "This removes all in results/ that is not of the repository, models you saved there too:"
	@git clean -ndx results .snakemake
	@test -n "$(YES)" || { echo "make clean YES=1 does it."; exit 2; }
	git clean -fdxq results .snakemake

# After a change of pyproject.toml: exact pins of what is installed now, setuptools (--all) included.
lock:
	$(BIN)/python -m pip freeze --all --exclude-editable --exclude rovsim --exclude pip > environment.lock
