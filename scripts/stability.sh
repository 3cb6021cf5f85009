#!/bin/sh
# Asks every method about every hard case: COUNTS.csv and COST.csv. Peers that are not installed are left out; coal comes from PyPI
# into an environment of its own in build/.
#
#   stability.sh COUNTS.csv COST.csv
set -e
cd "${0%/*}/.."
cmake -S . -B build -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTING=ON
cmake --build build --target stability_runners
cargo build --locked --release --manifest-path benches/compare/Cargo.toml
rm -rf build/hard
cargo run --locked --release --example hard_cases -- build/hard
if [ ! -x build/coal/bin/python ]; then
    { python3 -m venv build/coal && build/coal/bin/pip install -q coal==3.0.3; } || rm -rf build/coal
fi
python3 benches/stability/stability.py build/hard --build build --coal build/coal/bin/python \
    --compare "${CARGO_TARGET_DIR:-benches/compare/target}/release/compare" --csv "$1" --cost "$2"
