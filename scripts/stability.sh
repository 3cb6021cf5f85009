#!/bin/sh
# Asks every method about every hard case: COUNTS.csv and COST.csv. Peers that are not installed are left out.
#
#   stability.sh COUNTS.csv COST.csv
set -e
cd "${0%/*}/.."
cmake -S . -B build -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTING=ON
cmake --build build --target stability_runners
cargo build --locked --release --manifest-path benches/compare/Cargo.toml
rm -rf build/hard
cargo run --locked --release --example hard_cases -- build/hard
. scripts/peers.sh
python3 benches/stability/stability.py build/hard --build build --coal "$PEERS_PYTHON" \
    --compare "${CARGO_TARGET_DIR:-benches/compare/target}/release/compare" --csv "$1" --cost "$2"
