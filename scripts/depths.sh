#!/bin/sh
# Times depths beside the peers, and asks all of them about the hard cases: TIMES.csv and FAILURES.csv. Peers that are not installed
# are left out; coal and MuJoCo come from PyPI into an environment in build/.
#
#   depths.sh TIMES.csv FAILURES.csv
#
# TIMED is a command that the timed program is run by.
set -e
cd "${0%/*}/.."
if [ ! -x build/peers/bin/python ]; then
    { python3 -m venv build/peers && build/peers/bin/pip install -q coal==3.0.3 mujoco==4.0.0; } || rm -rf build/peers
fi
if [ -x build/peers/bin/python ]; then export PEERS_PYTHON="$PWD/build/peers/bin/python"; fi
cargo build --locked --release --manifest-path benches/compare/Cargo.toml
compare="${CARGO_TARGET_DIR:-benches/compare/target}/release/compare"
$TIMED "$compare" --query depth --n 102,1002,10002 --models fat,plate --orbits deep --steps 0.1,1,10,random \
    --count 1800 --passes 5 --csv "$1"
rm -rf build/hard
cargo run --locked --release --example hard_cases -- build/hard
python3 benches/stability/depths.py build/hard --compare "$compare" --csv "$2"
