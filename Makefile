# make demo                   flies polyhedra around each other: a table, and build/demo.svg; then build/demo.html, a tower and a pile
#                             in 3-D, for a browser; MODELS="a.obj b.stl": your own fly, in 3-D, too
# make check                  the daily loop, minutes of it: unit tests, C tests and lint
# make test                   everything that is tested: lint, test-rust, test-c, proofs and loom, side by side
# make proofs                 bounds on rounding, proved of the code by Gappa and Coq: docs/proofs.md (a part of make test, too)
# make fuzz                   the fuzz targets, SECONDS=900 each (default: 15), or one: TARGET=pairs; fuzz/README.md says more
# make asan                   tests under the address sanitizer, C ones under that of undefined behaviour, too
# make tsan                   tests with threads under the thread sanitizer
# make miri                   unit tests under Miri
# make loom                   the library's own threads under loom, in every order of their steps: loom/src/main.rs
# make valgrind               C tests under valgrind and helgrind (a part of make test, too)
# make bench                  the benchmark against parry3d and FCL: a CSV in benches/results and the charts in docs/charts
# make figures                the figures of the paper, of levels and builds: CSV files, docs/charts/figure-*.svg, tables of
#                             docs/research/figures.md and docs/research/levels.md; TIMED=COMMAND goes before each of its measurements, e.g. taskset -c 1
# make stability              the failure chart: every method on every hard case; CSV files, docs/charts/failures.svg, docs/stability.md
# make legacy-bench           SWIFT.h beside figures of SWIFT 1.x and SWIFT++: time, and instructions where valgrind is
# make crowds                 scenes of 100 to 100,000 bodies beside parry3d, FCL and a sweep and prune: benches/results/crowds.csv, charts
# make bodies                 every method on ellipsoids, real hulls and CAD-like bodies, answers held against integers, and their
#                             instructions where valgrind is: some half an hour; benches/results/bodies*.csv, docs/charts/bodies-*.svg.
#                             QUICK=--quick: a minute, build/bodies*.csv
# make depths                 depths beside coal, MuJoCo, Jolt, parry3d, Bullet, libccd and FCL: benches/results/depths*.csv, charts
# make casts                  casts beside parry3d, FCL, Bullet and samples, rays beside parry3d: benches/results/casts.csv, the chart and
#                             tables of docs/motions.md
# make grounds                contacts of 1,000 bodies with 20,000 triangles, and rays, beside parry3d and Jolt: benches/results/grounds.csv, grounds-rays.csv
# make compounds              bodies of many pieces beside parry3d, coal, FCL and Bullet: verdicts, distances, contacts, an arm and scenes,
#                             some minutes; benches/results/compounds.csv, charts and tables of docs/compounds.md, its picture
# make python-bench           the Python package beside coal, python-fcl and MuJoCo: the table of docs/python.md
# make hard-motions           casts MOTIONS=800000 adversarial motions and judges each: examples/hard_motions.rs, twenty minutes
# make engines                scenes in MuJoCo, Bullet and DART, with their colliders and with swiftprox: docs/engines.md, its tables,
#                             chart and pictures, benches/results/engines.csv; DART takes more than half an hour of it
# make steps                  the worst queries over the number of vertices: benches/results/worst-case.csv, docs/charts/steps.svg
# make charts                 all of docs/charts drawn anew from the CSV files, and the tables of the pages; nothing is measured
# make cases CASES=DIR        judges the answers to cases with known truth, see scripts/cases.py; ANSWERS=DIR keeps them
# make hard                   flies the hard families, writes them with their exact truth to build/hard, and judges them as cases
# make site                   the pages, the references of C, C++, Rust and Python and a crowd in 3-D as HTML in build/site: docs/site
# make release                all that a release hands out, made and tried as a dry run in build/release: scripts/release.sh; URL=FOLDER
#                             is where its archive will be, TAG=--tag makes the tag
# make packages               packages for Debian, Conan and cargo-c, tried as installed: scripts/debian.sh, conan.sh, cargo_c.sh
# make cross                  the library checked for other systems, the C tests on AArch64, i686 and Windows: scripts/cross.sh
# make build                  the libraries, tools and examples, in build/
# make clean                  removes what was built

# What scripts/rust.sh has installed comes first: the Rust of the system was not new enough.
export PATH := $(CURDIR)/.rust/bin:$(PATH):$(HOME)/.cargo/bin
MAKEFLAGS += --no-print-directory
BUILD = build
MODELS =
URL =
TAG =
CASES =
ANSWERS =
TESTING = OFF
SECONDS = 15
TARGET =
# gcc alone comes without the headers and start-up files of the C library, which it merely recommends.
CC_PACKAGES = cc=gcc /usr/include/stdio.h=libc6-dev
PEERS = /usr/include/ccd/ccd.h=libccd-dev /usr/include/fcl/fcl.h=libfcl-dev
DEPTH_PEERS = $(PEERS) pkg-config=pkg-config /usr/include/bullet=libbullet-dev /usr/include/eigen3=libeigen3-dev cmake=cmake curl=curl
# What draws charts: Debian's own Python has Debian's matplotlib, even where another one comes first in PATH.
# DRAW=python3 takes that.
DRAW = $(firstword $(wildcard /usr/bin/python3) python3)
MATPLOTLIB = $(DRAW):matplotlib=python3-matplotlib
PAGES = $(DRAW):markdown_it=python3-markdown-it $(DRAW):pygments=python3-pygments
STABILITY = benches/results/stability
STABILITY_PAGE = $(DRAW) benches/stability/report.py $(STABILITY).csv $(STABILITY)-cost.csv docs/charts/failures.svg docs/stability.md
DEPTHS = benches/results/depths
BODIES = benches/results/bodies
QUICK =
FIGURES = benches/results/figures
CASTS = benches/results/casts.csv
GROUNDS = benches/results/grounds.csv
COMPOUNDS = benches/results/compounds.csv
ENGINES = benches/results/engines.csv
MOTIONS = 800000
TIMED =
RESULTS = benches/results/$(shell date +%F)-$(shell uname -m).csv

.PHONY: build demo check test lint test-rust test-c test-fuzz test-proofs proofs fuzz asan tsan miri loom valgrind bench figures stability crowds bodies depths casts grounds compounds python-bench hard-motions engines steps charts cases hard legacy-bench site packages release cross clean

build:
	@scripts/require.sh $(CC_PACKAGES) cmake=cmake
	cmake -S . -B $(BUILD) -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTING=$(TESTING)
	+cmake --build $(BUILD)

demo: build
	$(BUILD)/examples/demo --svg $(BUILD)/demo.svg $(if $(MODELS),--record $(BUILD)/demo.swiftprox) $(MODELS)
	$(if $(MODELS),,$(BUILD)/examples/tower --seconds 4 --record $(BUILD)/demo.swiftprox)
	$(BUILD)/tools/swiftprox-replay $(BUILD)/demo.swiftprox --html $(BUILD)/demo.html $(if $(MODELS),,--query contact --max-distance 0.05)
	@echo "to open in a browser: $(abspath $(BUILD)/demo.html)"

# The library is made once, for unit tests and C tests. What takes long is left to `make test`: valgrind, programs that are installed,
# other libraries, further compilers, a browser.
LONG := _under_|^(package|subdirectory|fetch_content|find_package|legacy_(clang_)?cxx|legacy_float|cpp_(c|g|clang)\+\+)
LONG := $(LONG)|^(tower_|instructions|ratios|replay_page$$|reference|samples|setup)
check:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ cmake=cmake python3=python3
	@scripts/rust.sh cargo-fmt cargo-clippy
	cargo test --locked --profile daily --lib --features allocator
	cmake -S . -B $(BUILD)/check -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTING=ON -DSWIFTPROX_CARGO_PROFILE=daily -DSWIFTPROX_TEST_PEERS=OFF
	+cmake --build $(BUILD)/check
	ctest --test-dir $(BUILD)/check --parallel 2 --output-on-failure --exclude-regex '$(LONG)'
	scripts/lint.sh

# Side by side, the longest first: what one compiles on a single core leaves the others to another. Each prints when it is done.
test:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ nm=binutils cmake=cmake python3=python3
	-@scripts/require.sh valgrind=valgrind pkg-config=pkg-config $(PEERS)
	@scripts/rust.sh cargo-fmt cargo-clippy
	$(MAKE) --jobs=$(shell nproc) --output-sync=recurse test-rust test-c test-proofs lint loom

lint:
	@scripts/require.sh $(CC_PACKAGES) python3=python3
	@scripts/rust.sh cargo-fmt cargo-clippy
	scripts/lint.sh

# Optimised as for release, with overflow checks and debug assertions on.
test-rust:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ nm=binutils
	cargo test --locked --profile checked --package swiftprox --package proofs --package swiftprox-fuzz

# Without valgrind or the peers their tests are left out; CMake says so. Where the peers differ from the exact answer is printed
# in the end: it fails no test, but nobody should have to look for it.
test-c:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ cmake=cmake python3=python3
	-@scripts/require.sh valgrind=valgrind pkg-config=pkg-config $(PEERS) $(PAGES)
	$(MAKE) build TESTING=ON
	ctest --test-dir $(BUILD) --parallel 2 --output-on-failure
	@grep -E '^( +verdicts|scene +poses|all )' $(BUILD)/Testing/Temporary/LastTest.log || true

# The committed inputs of the fuzz targets, a part of test-rust.
test-fuzz:
	cargo test --locked --profile checked --package swiftprox-fuzz

# Where Gappa and Coq cannot be had the tapes are compared all the same, by test-rust.
PROVERS = gappa=gappa coqc=coq $(shell coqc -where 2>/dev/null)/user-contrib/Flocq=libcoq-flocq
test-proofs:
	-@scripts/require.sh $(CC_PACKAGES) $(PROVERS)
	scripts/proofs.sh --if-there

proofs:
	@scripts/require.sh $(CC_PACKAGES) $(PROVERS)
	scripts/proofs.sh

# Each target begins with its corpus in fuzz/corpus. Without nightly Rust the address sanitizer is left out; the script says so.
fuzz:
	@scripts/require.sh $(CC_PACKAGES) c++=g++
	scripts/fuzz.sh $(SECONDS) $(TARGET)

asan:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ cmake=cmake
	scripts/sanitizers.sh address

tsan:
	@scripts/require.sh $(CC_PACKAGES)
	scripts/sanitizers.sh thread

miri:
	@scripts/require.sh $(CC_PACKAGES)
	scripts/sanitizers.sh miri

# Where the crates cannot be had it says so, and that is no failure.
loom:
	@scripts/require.sh $(CC_PACKAGES)
	@if ! cargo fetch --locked --quiet --manifest-path loom/Cargo.toml; then echo "loom: skipped: its crates cannot be had"; \
	else cargo run --locked --release --manifest-path loom/Cargo.toml; fi

valgrind:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ cmake=cmake valgrind=valgrind
	$(MAKE) build TESTING=ON
	ctest --test-dir $(BUILD) --parallel 2 --output-on-failure --tests-regex '_under_(valgrind|helgrind)$$'

# Without FCL, or pkg-config to find it, FCL is left out.
bench:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ $(MATPLOTLIB)
	-@scripts/require.sh pkg-config=pkg-config $(PEERS)
	mkdir -p $(dir $(RESULTS))
	cargo run --locked --release --manifest-path benches/compare/Cargo.toml -- --csv $(RESULTS)
	$(DRAW) benches/plot.py $(RESULTS)

figures:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ $(MATPLOTLIB)
	-@scripts/require.sh pkg-config=pkg-config $(PEERS)
	TIMED='$(TIMED)' scripts/figures.sh
	$(DRAW) benches/figures.py $(FIGURES)-*.csv

stability:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ cmake=cmake python3=python3 $(MATPLOTLIB)
	-@scripts/require.sh $(PEERS)
	scripts/stability.sh $(STABILITY).csv $(STABILITY)-cost.csv
	$(STABILITY_PAGE)

legacy-bench:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ cmake=cmake python3=python3
	-@scripts/require.sh valgrind=valgrind
	$(MAKE) build TESTING=ON
	python3 benches/legacy.py $(BUILD)/c_tests

crowds:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ $(MATPLOTLIB)
	-@scripts/require.sh pkg-config=pkg-config $(PEERS)
	cargo run --locked --release --manifest-path benches/compare/Cargo.toml -- --crowd 100,1000,10000,100000 --count 256 \
	    --csv benches/results/crowds.csv
	$(DRAW) benches/plot.py benches/results/crowds.csv

bodies:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ python3=python3 $(MATPLOTLIB)
	-@scripts/require.sh $(DEPTH_PEERS) valgrind=valgrind
	mkdir -p $(BUILD)
	TIMED='$(TIMED)' scripts/bodies.sh $(if $(QUICK),$(BUILD)/bodies --quick,$(BODIES))
	$(if $(QUICK),,$(DRAW) benches/bodies.py --again)

depths:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ python3=python3 $(MATPLOTLIB)
	-@scripts/require.sh $(DEPTH_PEERS)
	TIMED='$(TIMED)' scripts/depths.sh $(DEPTHS).csv $(DEPTHS)-resting.csv $(DEPTHS)-failures.csv
	$(DRAW) benches/plot.py $(DEPTHS).csv
	$(DRAW) benches/plot.py $(DEPTHS)-failures.csv

casts:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ $(MATPLOTLIB)
	-@scripts/require.sh pkg-config=pkg-config $(PEERS) /usr/include/bullet=libbullet-dev
	cargo build --locked --release --manifest-path benches/compare/Cargo.toml
	$(TIMED) benches/compare/target/release/compare --casts all --count 600 --passes 5 --csv $(CASTS)
	$(DRAW) benches/casts.py $(CASTS)

grounds:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ python3=python3 $(MATPLOTLIB)
	-@scripts/require.sh cmake=cmake curl=curl
	. scripts/jolt.sh; export PEERS_JOLT; cargo build --locked --release --manifest-path benches/compare/Cargo.toml
	$(TIMED) benches/compare/target/release/compare --grounds --count 10000 --passes 5 --csv $(GROUNDS)
	$(DRAW) benches/grounds.py $(GROUNDS) $(GROUNDS:.csv=-rays.csv)

compounds:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ python3=python3 $(MATPLOTLIB)
	-@scripts/require.sh pkg-config=pkg-config $(PEERS) /usr/include/bullet=libbullet-dev /usr/include/eigen3=libeigen3-dev
	. scripts/peers.sh; export PEERS_PYTHON; cargo build --locked --release --manifest-path benches/compare/Cargo.toml
	$(TIMED) benches/compare/target/release/compare --compounds --count 120 --passes 3 --csv $(COMPOUNDS)
	$(DRAW) benches/compounds.py $(COMPOUNDS)
	cargo run --locked --release --example compound_tree >docs/pictures/compound-tree.svg

# Where pip cannot have one of the others, it is left out.
python-bench:
	$(MAKE) build
	python3 -m venv $(BUILD)/python/bench
	$(BUILD)/python/bench/bin/pip install --quiet . scipy
	-for peer in coal python-fcl mujoco; do $(BUILD)/python/bench/bin/pip install --quiet $$peer; done
	$(TIMED) $(BUILD)/python/bench/bin/python python/bench.py $(BUILD)/lib/libswiftprox.so

hard-motions:
	@scripts/require.sh $(CC_PACKAGES)
	cargo run --locked --release --example hard_motions -- --count $(MOTIONS) $(if $(SEED),--seed $(SEED))

engines:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ cmake=cmake python3=python3 $(MATPLOTLIB)
	-@scripts/require.sh /usr/include/bullet=libbullet-dev
	-@scripts/require.sh /usr/include/dart=libdart-dev
	. scripts/peers.sh
	$(MAKE) build
	$(TIMED) python3 benches/engines.py --play $(BUILD)/examples/engines $(ENGINES)
	$(DRAW) benches/engines.py $(ENGINES)

steps:
	@scripts/require.sh $(CC_PACKAGES) $(MATPLOTLIB)
	cargo bench --locked --bench worst_case -- --csv $(CURDIR)/benches/results/worst-case.csv
	$(DRAW) benches/plot.py benches/results/worst-case.csv

charts:
	@scripts/require.sh $(MATPLOTLIB)
	$(DRAW) benches/plot.py --again
	$(DRAW) benches/bodies.py --again
	$(DRAW) benches/figures.py $(FIGURES)-*.csv
	$(DRAW) benches/casts.py $(CASTS)
	$(DRAW) benches/grounds.py $(GROUNDS) $(GROUNDS:.csv=-rays.csv)
	$(DRAW) benches/compounds.py $(COMPOUNDS)
	$(DRAW) benches/engines.py $(ENGINES)
	$(STABILITY_PAGE)

cases:
	$(if $(CASES),,$(error make cases CASES=DIR: the folder of cases is missing))
	$(MAKE) build
	@scripts/require.sh python3=python3
	python3 scripts/cases.py $(BUILD)/tools/swiftprox-query $(CASES) $(if $(ANSWERS),--answers $(ANSWERS))

# SEED and COUNT, the sequences a family, make others.
hard:
	@scripts/require.sh $(CC_PACKAGES)
	rm -rf $(BUILD)/hard
	cargo run --locked --release --example hard_cases -- $(BUILD)/hard $(if $(SEED),--seed $(SEED)) $(if $(COUNT),--count $(COUNT))
	$(MAKE) cases CASES=$(BUILD)/hard

site: build
	@scripts/require.sh doxygen=doxygen $(PAGES)
	PYTHON=$(DRAW) docs/site/make.sh $(BUILD)

packages:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ cmake=cmake python3=python3
	scripts/debian.sh
	scripts/conan.sh
	scripts/cargo_c.sh

release:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ cmake=cmake python3=python3 git=git
	URL='$(URL)' scripts/release.sh $(TAG)

cross:
	@scripts/require.sh $(CC_PACKAGES) cmake=cmake python3=python3
	scripts/cross.sh

clean:
	cargo clean
	rm -rf $(BUILD) benches/compare/target fuzz/target loom/target
