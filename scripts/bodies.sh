#!/bin/sh
# Times every method on every family of bodies, in one run: RESULTS.csv. Peers that are not installed are left out.
#
#   bodies.sh RESULTS.csv [--quick]
#
# With --quick it is a few bodies and poses, seconds once it is compiled. TIMED is a command that the timed program is run by; MESHES a
# folder of OFF files, in place of the hulls in benches/meshes.
set -e
cd "${0%/*}/.."
. scripts/peers.sh
if [ -n "$PEERS_PYTHON" ]; then export PEERS_PYTHON; else unset PEERS_PYTHON; fi
cargo build --locked --release --manifest-path benches/compare/Cargo.toml
compare="${CARGO_TARGET_DIR:-benches/compare/target}/release/compare"
extent='--bodies all --count 400 --passes 3'
if [ "$2" = --quick ]; then extent='--bodies box+wedge,cylinder-16,panda/finger,long --count 90 --passes 1'; fi
# Words of it are arguments of their own.
# shellcheck disable=SC2086
$TIMED "$compare" $extent --steps 0.1,1,10,random --meshes "${MESHES:-benches/meshes}" --csv "$1"
