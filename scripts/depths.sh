#!/bin/sh
# Times depths beside the peers, those of bodies at rest scene by scene, and asks all of them about the hard cases: TIMES.csv,
# RESTING.csv and FAILURES.csv. Peers that are not installed are left out.
#
#   depths.sh TIMES.csv RESTING.csv FAILURES.csv
#
# TIMED is a command that the timed program is run by.
set -e
cd "${0%/*}/.."
. scripts/peers.sh
. scripts/jolt.sh
export PEERS_PYTHON PEERS_JOLT
cargo build --locked --release --manifest-path benches/compare/Cargo.toml
compare="${CARGO_TARGET_DIR:-benches/compare/target}/release/compare"
$TIMED "$compare" --query depth --n 102,1002,10002 --models fat,plate --orbits deep --steps 0.1,1,10,random \
    --count 1800 --passes 5 --csv "$1"
$TIMED "$compare" --resting --count 1800 --csv "$2"
rm -rf build/hard
cargo run --locked --release --example hard_cases -- build/hard
python3 benches/stability/depths.py build/hard --compare "$compare" --csv "$3"
