#!/bin/sh
# Measures the figures of the paper, of levels and builds: CSV files in benches/results, each a minute or two. TIMED, a
# command, goes before each measurement.
set -e
cd "${0%/*}/.."
cargo build --locked --release --manifest-path benches/compare/Cargo.toml
compare="$TIMED ${CARGO_TARGET_DIR:-benches/compare/target}/release/compare"
results=benches/results/figures
$compare --figures 5,6,7,8,9,10,11,12 --count 1800 --passes 5 --csv $results-paper.csv
$compare --figures choice --count 1800 --passes 15 --csv $results-choice.csv
$compare --figures error --count 1800 --passes 5 --csv $results-error.csv
$compare --figures size --count 900 --passes 3 --csv $results-size.csv
$compare --build --n 1002,10002,100002 --passes 2 --csv $results-build.csv
