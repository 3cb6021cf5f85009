#!/bin/sh
# What is checked without running anything: formatting, clippy, links of comments, the width of comments, the tables of the pages
# against their CSV files, versions, and the ABI against the last tag.
set -e
cd "${0%/*}/.."
for manifest in Cargo.toml benches/compare/Cargo.toml loom/Cargo.toml; do
    cargo fmt --all --check --manifest-path "$manifest"
done
cargo clippy --locked --profile checked --workspace --all-targets -- -D warnings
RUSTDOCFLAGS='-D warnings' cargo doc --locked --profile checked --no-deps --quiet
if LC_ALL=C.UTF-8 grep -rnE '^.{133}' . --include='*.rs' --include='*.c' --include='*.cpp' --include='*.h' \
    --exclude-dir=target --exclude-dir=build --exclude-dir=.rust | grep -E ':[0-9]+: *(//|/?\*)' | grep -v '|$'; then
    echo 'comments are at most 132 columns wide' >&2
    exit 1
fi
python3 benches/figures.py --check benches/results/figures-*.csv
python3 benches/plot.py --check
python3 benches/casts.py --check benches/results/casts.csv
python3 benches/grounds.py --check benches/results/grounds.csv benches/results/grounds-rays.csv
python3 benches/compounds.py --check benches/results/compounds.csv
python3 benches/engines.py --check benches/results/engines.csv
python3 benches/bodies.py --check
python3 benches/sentences.py
scripts/versions.sh >/dev/null
python3 scripts/abi.py
python3 benches/stability/report.py benches/results/stability.csv benches/results/stability-cost.csv docs/charts/failures.svg \
    docs/stability.md --check
