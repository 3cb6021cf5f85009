# make demo                   flies polyhedra around each other: a table, and build/demo.svg; MODELS="a.obj b.stl": your own
# make test                   everything that is tested: lint, test-rust, test-c and test-fuzz, side by side
# make fuzz                   the fuzz targets, SECONDS=900 each (default: 15), or one: TARGET=pairs; fuzz/README.md says more
# make asan                   tests under the address sanitizer, C ones under that of undefined behaviour, too
# make tsan                   tests with threads under the thread sanitizer
# make miri                   unit tests under Miri
# make valgrind               C tests under valgrind and helgrind (a part of make test, too)
# make bench                  the benchmark against parry3d and FCL: a CSV in benches/results and the charts in docs/charts
# make figures                the figures of the paper, of levels, builds and verdicts: CSV files, docs/charts/figure-*.svg, tables of
#                             docs/figures.md and docs/levels.md; TIMED=COMMAND goes before each of its measurements, e.g. taskset -c 1
# make stability              the failure chart: every method on every hard case; CSV files, docs/charts/failures.svg, docs/stability.md
# make steps                  the worst queries over the number of vertices: benches/results/worst-case.csv, docs/charts/steps.svg
# make charts                 all of docs/charts drawn anew from the CSV files, and the tables of the pages; nothing is measured
# make cases CASES=DIR        judges the answers to cases with known truth, see scripts/cases.py; ANSWERS=DIR keeps them
# make hard                   flies the hard families, writes them with their exact truth to build/hard, and judges them as cases
# make build                  the libraries, tools and examples, in build/
# make clean                  removes what was built

# What scripts/rust.sh has installed comes first: the Rust of the system was not new enough.
export PATH := $(CURDIR)/.rust/bin:$(PATH):$(HOME)/.cargo/bin
MAKEFLAGS += --no-print-directory
BUILD = build
MODELS =
CASES =
ANSWERS =
TESTING = OFF
SECONDS = 15
TARGET =
# gcc alone comes without the headers and start-up files of the C library, which it merely recommends.
CC_PACKAGES = cc=gcc /usr/include/stdio.h=libc6-dev
PEERS = /usr/include/ccd/ccd.h=libccd-dev /usr/include/fcl/fcl.h=libfcl-dev
# What draws charts: Debian's own Python has Debian's matplotlib, even where another one comes first in PATH.
# DRAW=python3 takes that.
DRAW = $(firstword $(wildcard /usr/bin/python3) python3)
MATPLOTLIB = $(DRAW):matplotlib=python3-matplotlib
COAL = $(BUILD)/coal/bin/python
STABILITY = benches/results/stability
FIGURES = benches/results/figures
TIMED =
RESULTS = benches/results/$(shell date +%F)-$(shell uname -m).csv

.PHONY: build demo test lint test-rust test-c test-fuzz fuzz asan tsan miri valgrind bench figures stability steps charts cases hard clean

build:
	@scripts/require.sh $(CC_PACKAGES) cmake=cmake
	cmake -S . -B $(BUILD) -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTING=$(TESTING)
	+cmake --build $(BUILD)

demo: build
	$(BUILD)/examples/demo --svg $(BUILD)/demo.svg $(MODELS)

# Side by side, the longest first: what one compiles on a single core leaves the others to another. Each prints when it is done.
test:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ nm=binutils cmake=cmake python3=python3
	-@scripts/require.sh valgrind=valgrind pkg-config=pkg-config $(PEERS)
	@scripts/rust.sh cargo-fmt cargo-clippy
	$(MAKE) --jobs=$(shell nproc) --output-sync=recurse test-rust test-c test-fuzz lint

lint:
	@scripts/require.sh $(CC_PACKAGES) python3=python3
	@scripts/rust.sh cargo-fmt cargo-clippy
	cargo fmt --check
	cargo clippy --locked --profile checked --all-targets -- -D warnings
	@! LC_ALL=C.UTF-8 grep -rnE '^.{133}' . --include='*.rs' --include='*.c' --include='*.cpp' --include='*.h' \
	    --exclude-dir=target --exclude-dir=build --exclude-dir=.rust | grep -E ':[0-9]+: *(//|/?\*)' | grep -v '|$$' || \
	    { echo 'comments are at most 132 columns wide'; exit 1; }
	python3 benches/figures.py --check $(FIGURES)-*.csv
	python3 benches/plot.py --check

# Optimised as for release, with overflow checks and debug assertions on.
test-rust:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ nm=binutils
	cargo test --locked --profile checked

# Without valgrind or the peers their tests are left out; CMake says so. Where the peers differ from the exact answer is printed
# in the end: it fails no test, but nobody should have to look for it.
test-c:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ cmake=cmake python3=python3
	-@scripts/require.sh valgrind=valgrind pkg-config=pkg-config $(PEERS)
	$(MAKE) build TESTING=ON
	ctest --test-dir $(BUILD) --parallel 2 --output-on-failure
	@grep -E '^( +verdicts|scene +poses|all )' $(BUILD)/Testing/Temporary/LastTest.log || true

# Every input of the corpora, and new ones, the same every time; an input that fails fails.
test-fuzz:
	scripts/fuzz.sh --as-test

# Each target begins with its corpus in fuzz/corpus. Without nightly Rust the address sanitizer is left out; the script says so.
fuzz:
	@scripts/require.sh $(CC_PACKAGES) c++=g++
	scripts/fuzz.sh $(SECONDS) $(TARGET)

# What needs nightly Rust, or a component of it, is skipped where that is missing; scripts/nightly.sh says so. The tests are those
# of unsafe code and of everything that reads what others wrote; C programs are compiled for both sanitizers, the library is not.
ASAN_TESTS = --lib --test c_interface --test mesh_io --test shape_file --test hull --test hull_check --test verify --test flat_edges
HOST = $(shell PATH='$(PATH)' rustc -vV | sed -n 's/^host: //p')
asan:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ cmake=cmake
	RUSTFLAGS=-Zsanitizer=address scripts/nightly.sh "" test --locked --profile checked --target $(HOST) $(ASAN_TESTS)
	cmake -S . -B $(BUILD)/asan -DCMAKE_BUILD_TYPE=Debug -DBUILD_TESTING=ON \
	    -DCMAKE_C_FLAGS="-fsanitize=address,undefined -fno-sanitize-recover=all"
	cmake --build $(BUILD)/asan --target scene_use results bad_input mesh_reader allocator memory files threads busy
	ctest --test-dir $(BUILD)/asan --output-on-failure --tests-regex '^(scene_use|results|bad_input|mesh_reader|allocator|memory|files|threads|busy)$$'

# The standard library is built for it, too: else its locks look like races.
tsan:
	@scripts/require.sh $(CC_PACKAGES)
	RUSTFLAGS=-Zsanitizer=thread scripts/nightly.sh rust-src test --locked --profile checked -Zbuild-std --target $(HOST) \
	    --lib --test c_interface --test threads --test lookup

miri:
	@scripts/require.sh $(CC_PACKAGES)
	MIRIFLAGS=-Zmiri-disable-isolation scripts/nightly.sh "miri rust-src" miri test --locked --lib

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

# Each measurement takes a minute or two.
COMPARE = $(TIMED) $${CARGO_TARGET_DIR:-benches/compare/target}/release/compare
figures:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ $(MATPLOTLIB)
	-@scripts/require.sh pkg-config=pkg-config $(PEERS)
	cargo build --locked --release --manifest-path benches/compare/Cargo.toml
	$(COMPARE) --figures 5,6,7,8,9,10,11,12 --count 1800 --passes 5 --csv $(FIGURES)-paper.csv
	$(COMPARE) --figures choice --count 1800 --passes 15 --csv $(FIGURES)-choice.csv
	$(COMPARE) --figures error --count 1800 --passes 5 --csv $(FIGURES)-error.csv
	$(COMPARE) --figures size --count 900 --passes 3 --csv $(FIGURES)-size.csv
	$(COMPARE) --build --n 1002,10002,100002 --passes 2 --csv $(FIGURES)-build.csv
	$(COMPARE) --query intersection --n 1002,10002 --count 1800 --passes 5 --csv $(FIGURES)-verdict.csv
	$(DRAW) benches/figures.py $(FIGURES)-*.csv

# Peers that are not installed are left out; coal comes from PyPI into an environment of its own in build/.
stability:
	@scripts/require.sh $(CC_PACKAGES) c++=g++ cmake=cmake python3=python3 $(MATPLOTLIB)
	-@scripts/require.sh $(PEERS)
	cmake -S . -B $(BUILD) -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTING=ON
	cmake --build $(BUILD) --target stability_runners
	cargo build --locked --release --manifest-path benches/compare/Cargo.toml
	rm -rf $(BUILD)/hard
	cargo run --locked --release --example hard_cases -- $(BUILD)/hard
	-@test -x $(COAL) || { python3 -m venv $(BUILD)/coal && $(BUILD)/coal/bin/pip install -q coal==3.0.3; } || rm -rf $(BUILD)/coal
	python3 benches/stability/stability.py $(BUILD)/hard --build $(BUILD) --coal $(COAL) \
		--compare $${CARGO_TARGET_DIR:-benches/compare/target}/release/compare --csv $(STABILITY).csv --cost $(STABILITY)-cost.csv
	$(DRAW) benches/stability/report.py $(STABILITY).csv $(STABILITY)-cost.csv docs/charts/failures.svg docs/stability.md

steps:
	@scripts/require.sh $(CC_PACKAGES) $(MATPLOTLIB)
	cargo bench --locked --bench worst_case -- --csv $(CURDIR)/benches/results/worst-case.csv
	$(DRAW) benches/plot.py benches/results/worst-case.csv

charts:
	@scripts/require.sh $(MATPLOTLIB)
	$(DRAW) benches/plot.py --again
	$(DRAW) benches/figures.py $(FIGURES)-*.csv
	$(DRAW) benches/stability/report.py $(STABILITY).csv $(STABILITY)-cost.csv docs/charts/failures.svg docs/stability.md

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

clean:
	cargo clean
	rm -rf $(BUILD) benches/compare/target fuzz/target
