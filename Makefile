# The front doors; each installs what is missing (Debian 12: root or sudo), does only what is not done yet, and may be
# repeated. CMakePresets.json has the builds for those who would rather call CMake.
.DEFAULT_GOAL := help
SHELL := /bin/bash
.DELETE_ON_ERROR:

PREFIX ?= /usr/local
JOBS ?= $(shell nproc)
# Warnings stop the build where nobody reads them.
WERROR ?= $(if $(CI),ON,OFF)
# A first build takes less time with ON. OFF suits those who change a file and build again.
JOIN_SOURCES ?= ON
CONFIGURE_FLAGS ?=

configure = cmake --preset $(1) -DVANTAGE_WERROR=$(WERROR) -DVANTAGE_JOIN_SOURCES=$(JOIN_SOURCES) $(2) $(CONFIGURE_FLAGS) --log-level=WARNING >/dev/null
compile = $(call configure,$(1),$(3)) && cmake --build --preset $(1) --parallel $(JOBS) --target $(2)

.PHONY: help
help:  ## this list
	@grep -hE '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z]+):.*## /  make \1\t/' | expand -t 18

.PHONY: demo
demo: build  ## build, then a volume, a flight with its bound, and a picture of it, of an invented town
	@mkdir -p build/demo
	build/bin/vantage scene examples/town/town.osm --center 48,11 --radius 120 -o build/demo/town.glb
	build/bin/vantage compute examples/town/mission.yaml -o build/demo/volume.ply
	build/bin/vantage tour examples/town/tour.yaml -o build/demo/tour.plan --certificate build/demo/tour.cert \
	  --picture build/demo/tour.png
	python3 tools/check_tour.py build/demo/tour.cert
	build/bin/vantage check examples/town/tour.yaml build/demo/tour.plan -o build/demo/check.json
	@echo
	@echo "A volume:     $(CURDIR)/build/demo/volume.ply (with town.glb beside it in Blender: File > Import)"
	@echo "A flight:     $(CURDIR)/build/demo/tour.plan (QGroundControl: Plan > File > Open)"
	@echo "Its bound:    $(CURDIR)/build/demo/tour.cert (no flight that sees all targets is shorter)"
	@echo "When is what seen: $(CURDIR)/build/demo/check.json"
	@echo "A picture:    $(CURDIR)/build/demo/tour.png"

.PHONY: build
build: prepare  ## the program, at build/bin/vantage
	@$(call compile,release,vantage_cli)

.PHONY: test
test: tested  ## build and run all tests but those that `make nightly` adds
	ctest --preset release --parallel $(JOBS) --label-exclude nightly

.PHONY: check
check: tested tools  ## before a commit: build, unit tests, format, and lint of what changed
	@ctest --preset release --parallel $(JOBS) --label-exclude 'heavy|consumer'
	@status=0; scripts/format.sh --check || status=1; JOBS=$(JOBS) scripts/lint.sh --changed || status=1; exit $$status

# Leaks are looked for with ALL=1 only: LeakSanitizer of clang 14 crashes now and then, where threads end while it looks.
.PHONY: asan
asan: tools  ## unit tests under AddressSanitizer and UndefinedBehaviorSanitizer (ALL=1: also those that take long there)
	@$(call compile,asan,vantage_tests,-DVANTAGE_SANITIZE_ALL=$(if $(ALL),ON,OFF))
	ctest --preset $(if $(ALL),asan-leaks,asan) --parallel $(JOBS)

.PHONY: tsan
tsan: tools  ## the tests of what runs on threads under ThreadSanitizer
	@$(call compile,tsan,vantage_thread_tests)
	ctest --preset tsan --parallel $(JOBS)

.PHONY: bench
bench: benchmarks  ## the benchmarks (RECORD=1 keeps the figures in bench/results)
	build/bin/vantage_bench --benchmark_filter='-^(engine|plain|prepare|depth|spheres)/' $(BENCH_FLAGS)
	bench/run.sh $(if $(RECORD),,--no-file)

.PHONY: fuzz
fuzz: tools  ## each fuzz target for a minute (SECONDS_EACH=60; PRESET=asan: in the build of `make asan`, not guided)
	@$(call compile,$(or $(PRESET),fuzz),vantage_fuzzers)
	BUILD=build-$(or $(PRESET),fuzz) scripts/fuzz.sh $(or $(SECONDS_EACH),60)

.PHONY: nightly
nightly: tested benchmarks package  ## what takes too long for every change: lint and sanitizers over all, wheel, QGIS, Blender, builds, attack
	@$(MAKE) --no-print-directory lint ALL=1
	@$(MAKE) --no-print-directory asan ALL=1
	@$(MAKE) --no-print-directory tsan wheelcheck qgis blender cesium jupyter npm wheelwasm
	ctest --preset release --parallel $(JOBS) --label-regex nightly
	cmake --build --preset asan --parallel $(JOBS) --target vantage_attack
	build-asan/bin/vantage_attack --scenes 200 --seed $(or $(SEED),$(shell date +%Y%m%d)) --jobs $(JOBS)
	build-asan/bin/vantage_attack --meshes 500 --seed $(or $(SEED),$(shell date +%Y%m%d)) --jobs $(JOBS)
	JOBS=$(JOBS) scripts/build_variants.sh
	python3 tests/check_hostile_files.py build/bin/vantage --mutants 300 --bombs --jobs $(JOBS) \
	  --seed $(or $(SEED),$(shell date +%Y%m%d)) --keep build/hostile
	python3 tests/check_damaged_maps.py build/bin/vantage --damages $(or $(DAMAGES),1000) --jobs $(JOBS) \
	  --seed $(or $(SEED),$(shell date +%Y%m%d)) --keep build/damaged
	build/bin/vantage_attack --scenes $(or $(SCENES),2000) --seed $(or $(SEED),$(shell date +%Y%m%d)) \
	  --jobs $(JOBS) --out build/attack
	build/bin/vantage_attack --meshes $(or $(MESHES),20000) --seed $(or $(SEED),$(shell date +%Y%m%d)) \
	  --jobs $(JOBS) --out build/attack
	python3 tests/forge/forge_certificates.py --mutants $(or $(MUTANTS),5000) --seed $(or $(SEED),$(shell date +%Y%m%d))
	build/bin/vantage_attack --missions $(or $(MISSIONS),2000) --seed $(or $(SEED),$(shell date +%Y%m%d)) \
	  --jobs $(JOBS) --out build/attack
	build/bin/vantage_attack --flights $(or $(FLIGHTS),500) --seed $(or $(SEED),$(shell date +%Y%m%d)) \
	  --seconds 300 --jobs $(JOBS) --out build/attack
	build/bin/vantage_attack --tours $(or $(TOURS),200) --seed $(or $(SEED),$(shell date +%Y%m%d)) \
	  --seconds 300 --jobs $(JOBS) --out build/attack
	VANTAGE_BATCH_KILLS=20 PYTHONPATH=build/python .deps/python/bin/python -m pytest -q python/tests/test_batch_faults.py

.PHONY: install
install: build  ## into PREFIX (/usr/local)
	cmake --install build --prefix "$(PREFIX)"

.PHONY: format
format: tools  ## format our sources in place
	@scripts/format.sh

# Few files are checked soonest one by one, all of them as they are joined.
.PHONY: lint
lint: tools  ## formatting, and clang-tidy over what recent commits changed (ALL=1: over everything)
	@$(call configure,release,$(if $(ALL),,-B build-lint -DVANTAGE_JOIN_SOURCES=OFF))
	@status=0; scripts/format.sh --check || status=1; \
	  BUILD=build$(if $(ALL),,-lint) JOBS=$(JOBS) scripts/lint.sh $(if $(ALL),,--recent) || status=1; exit $$status

.PHONY: python
python: package  ## build the Python package in build/python, and run its tests
	PYTHONPATH=build/python .deps/python/bin/python -m pytest -q python/tests

.PHONY: blender
blender: package  ## the Blender add-on, dist/vantage_blender.zip, and its tests in Debian's Blender
	@scripts/install_packages.sh --blender
	integrations/blender/tests/run.sh

.PHONY: jupyter
jupyter: web package  ## a volume in a real JupyterLab and in the notebook that it exports, in Chromium; build/jupyter
	@scripts/fetch_python.sh jupyter
	PYTHONPATH=$(CURDIR)/build/python .deps/jupyter/bin/python python/jupyter/check_jupyter.py build/jupyter

.PHONY: site
site: package  ## the documentation as a site, in build/site; its tutorials are run
	PYTHONPATH=$(CURDIR)/build/python .deps/python/bin/python -m sphinx -q -W --keep-going -c docs/site docs build/site
	@echo "site: $$(find build/site -name '*.html' | wc -l) pages, build/site/index.html"

# For aarch64, tried by emulation: make wheelcheck TARGETS=aarch64-linux-gnu.2.17
TARGETS = x86_64-linux-gnu.2.17
.PHONY: wheel wheels
wheel wheels:  ## wheels with all that they need in them, in dist/: for Python 3.11, and for 3.12 and newer
	@scripts/install_packages.sh --wheels
	@scripts/fetch_sources.sh
	@scripts/build_portable_wheels.py --jobs $(JOBS) --targets $(TARGETS)

.PHONY: wheelcheck wheelscheck
wheelcheck wheelscheck: wheel  ## try each of them in a root with Python and numpy alone
	@$(MAKE) --no-print-directory check_wheels

# The program of `make build` computes the same volumes, without the wheels' libraries.
PROCESSORS = $(foreach target,$(TARGETS),$(firstword $(subst -, ,$(target))))
.PHONY: check_wheels
check_wheels: build
	@for processor in $(PROCESSORS); do \
	  wheels=$$(ls dist/vantage-*manylinux*_$$processor.whl) || { echo "dist/ has no wheel for $$processor" >&2; exit 1; }; \
	  for wheel in $$wheels; do scripts/check_wheel.sh $$wheel || exit 1; done; \
	done

.PHONY: winecheck
winecheck: build  ## the wheel for Windows, and try it in wine with a Python for Windows; needs Maven
	@scripts/install_packages.sh --wine
	@$(MAKE) --no-print-directory wheels TARGETS=x86_64-windows-gnu
	@scripts/check_wheel_wine.py dist/vantage-*-cp312-abi3-win_amd64.whl

.PHONY: web
web:  ## the page, in web/dist/index.html: one file
	@scripts/install_packages.sh --web
	@JOBS=$(JOBS) scripts/build_web.sh

.PHONY: webtest
webtest: web build  ## the page's tests: its engine beside the program, and the page in Chromium
	cd web && npm test

# Debian's QGIS runs Debian's Python, which the package in build/python is for.
.PHONY: qgis
qgis: package  ## the plugin of QGIS: its zip, in dist/, and its tests in QGIS without a screen
	@scripts/install_packages.sh --qgis
	/usr/bin/python3 integrations/qgis/build_zip.py
	@status=0; for test in integrations/qgis/tests/test_*.py; do echo "== $$test"; \
	  PYTHONPATH=$(CURDIR)/build/python QT_QPA_PLATFORM=offscreen /usr/bin/python3 $$test || status=1; done; exit $$status

# A volume as 3D Tiles, and a flight as CZML, in CesiumJS, from files of this machine.
.PHONY: cesium
cesium: package  ## a volume in CesiumJS, picked, its place compared with PROJ's; and a flight
	@scripts/install_packages.sh --web
	@integrations/cesium/check.sh
	@integrations/cesium/check_czml.sh

.PHONY: npm
npm: build  ## the npm package, dist/vantage-engine-*.tgz: the engine in WebAssembly; its tests in Node.js and Chromium
	@scripts/install_packages.sh --web
	@JOBS=$(JOBS) scripts/build_web.sh --package
	@scripts/build_npm.sh

.PHONY: wheelwasm
wheelwasm: build  ## a wheel for machines without a native one, in dist/, over WebAssembly; its tests
	@scripts/install_packages.sh --web
	@JOBS=$(JOBS) scripts/build_web.sh --package
	@scripts/build_wasm_wheel.py
	@scripts/check_wasm_wheel.sh

# For aarch64, too: make programcheck PROGRAM_TARGETS=aarch64-linux-gnu.2.17
PROGRAM_TARGETS = x86_64-linux-gnu.2.17 x86_64-linux-musl
.PHONY: program
program: web  ## the program as tarballs that run where they are unpacked, in dist/
	@scripts/install_packages.sh --wheels
	@scripts/fetch_sources.sh
	@scripts/build_program.py --jobs $(JOBS) --targets $(PROGRAM_TARGETS)

.PHONY: programcheck
programcheck: program build  ## try those in dist/ in roots of Debian 11, 12 and 13 that hold the C library alone
	@scripts/check_program.py dist/vantage-*-linux-*.tar.xz --program build/bin/vantage

.PHONY: source
source:  ## the source tarball and Debian's source package, of the last commit, in dist/
	@scripts/install_packages.sh --release
	@scripts/build_source.sh

# The source first: it refuses a tree that differs from the last commit.
AARCH64 = aarch64-linux-gnu.2.17
.PHONY: release
release:  ## all files of a release, in dist/, with SHA256SUMS and a bill of materials (docs/release.md)
	rm -rf dist
	@$(MAKE) --no-print-directory source
	@$(MAKE) --no-print-directory program PROGRAM_TARGETS="$(PROGRAM_TARGETS) $(AARCH64)"
	@$(MAKE) --no-print-directory wheels TARGETS="$(TARGETS) $(AARCH64)"
	@$(MAKE) --no-print-directory npm
	@$(MAKE) --no-print-directory wheelwasm
	python3 integrations/qgis/build_zip.py
	python3 integrations/blender/build_zip.py
	@$(MAKE) --no-print-directory releasecheck

.PHONY: releasecheck
releasecheck:  ## the bill of materials and SHA256SUMS of what is in dist/, and whether all of it agrees
	@scripts/install_packages.sh --release
	@scripts/fetch_python.sh packaging
	@scripts/write_sbom.py
	@.deps/packaging/bin/python scripts/check_dist.py --write $(if $(PARTIAL),--partial)

.PHONY: packaging
packaging:  ## what other package systems are given: hadolint, and a parser of conda recipes
	@scripts/install_packages.sh --release
	@scripts/fetch_python.sh packaging
	.deps/packaging/bin/hadolint packaging/Containerfile
	@.deps/packaging/bin/python packaging/check_recipe.py

.PHONY: gallery
gallery: web build  ## reports of the real scenes of docs/gallery, in build/gallery
	@mkdir -p build/gallery
	@for mission in docs/gallery/*.yaml; do \
	  build/bin/vantage report $$mission -o build/gallery/$$(basename $$mission .yaml).html || exit 1; done

.PHONY: clean
clean:  ## remove all builds; fetched sources stay
	rm -rf build build-*/ dist/ web/dist/ web/node_modules/ integrations/cesium/node_modules/ web/npm/dist/ web/npm/example/dist/

# All that the installed packages allow: `make build` needs neither those of the tests nor those of the benchmarks.
.PHONY: tested
tested:
	@scripts/install_packages.sh --tests
	@scripts/fetch_sources.sh
	@$(call compile,release,all vantage_tests)

.PHONY: benchmarks
benchmarks: tools
	@$(call compile,release,vantage_benchmarks)

.PHONY: package
package:
	@scripts/install_packages.sh --python
	@scripts/fetch_sources.sh
	@scripts/fetch_python.sh
	@$(call compile,release,vantage_python vantage_cli,-DVANTAGE_BUILD_PYTHON=ON -DPython_EXECUTABLE=$(CURDIR)/.deps/python/bin/python)

.PHONY: prepare
prepare:
	@scripts/install_packages.sh
	@scripts/fetch_sources.sh

.PHONY: tools
tools:
	@scripts/install_packages.sh --tools
	@scripts/fetch_sources.sh
