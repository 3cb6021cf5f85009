#!/bin/sh
# Makes scripts of what the code computes, and has Gappa and Coq prove them: docs/proofs.md.
#
#   [PROFILE=daily] proofs.sh [--if-there]      --if-there: without Gappa, Coq or Flocq nothing is done
set -e
cd "${0%/*}/.."
folder=build/proofs
if [ "$1" = --if-there ] && ! { gappa --version && [ -e "$(coqc -where)/user-contrib/Flocq" ]; } >/dev/null 2>&1; then
    echo 'Gappa, Coq or Flocq is missing: bounds on rounding are not proved' >&2
    exit 0
fi
rm -rf "$folder"
cargo run --locked --quiet --profile "${PROFILE:-checked}" --package proofs -- "$folder"
cp proofs/coq/*.v "$folder"
cd "$folder"
for script in *.g; do
    if ! gappa -Eprecision=400 "$script" >"$script.out" 2>&1; then
        grep -v '^Warning' "$script.out" >&2
        echo "$script is not proved" >&2
        exit 1
    fi
done
for script in model lemmas constants words double_double identities assembly; do
    coqc -q "$script.v" || { echo "$script.v is not proved" >&2; exit 1; }
done
echo "$(ls ./*.g | wc -l) scripts are proved by Gappa, $(cat ./*.v | grep -c '^Lemma\|^Theorem') lemmas by Coq"
