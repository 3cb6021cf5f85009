#!/bin/sh
# Times every method on every family of bodies, in one run: NAME.csv; then counts the instructions of the strongest where valgrind is:
# NAME-instructions.csv. Peers that are not installed are left out.
#
#   bodies.sh NAME [--quick]
#
# With --quick it is a few bodies and poses, seconds once it is compiled. TIMED is a command that the timed program is run by; MESHES a
# folder of OFF files, in place of the hulls in benches/meshes.
set -e
cd "${0%/*}/.."
. scripts/peers.sh
. scripts/jolt.sh
export PEERS_PYTHON PEERS_JOLT
cargo build --locked --release --manifest-path benches/compare/Cargo.toml
compare="${CARGO_TARGET_DIR:-benches/compare/target}/release/compare"
bodies=all extent='--count 400 --passes 3'
if [ "$2" = --quick ]; then bodies=box+wedge,cylinder-16,panda/finger,long extent='--count 90 --passes 1'; fi
name=$1
set -- --bodies "$bodies" --steps 0.1,1,10,random --meshes "${MESHES:-benches/meshes}"
# Words of it are arguments of their own.
# shellcheck disable=SC2086
$TIMED "$compare" "$@" $extent --csv "$name.csv"

if ! command -v valgrind >/dev/null 2>&1; then
    echo 'no valgrind: no instructions are counted' >&2
    exit
fi
dumps=$(mktemp -d)
trap 'rm -rf "$dumps"' EXIT
valgrind --quiet --tool=callgrind --instr-atstart=no --callgrind-out-file="$dumps/out" \
    "$compare" "$@" --count 41 --instructions "$dumps/out" --csv "$name-instructions.csv"
