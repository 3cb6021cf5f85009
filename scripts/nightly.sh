#!/bin/sh
# Runs nightly Cargo; where that or a component of it is missing says so and does nothing, successfully: not every machine has what
# the sanitizers and Miri need.
#
#   nightly.sh "COMPONENT ..." CARGO-ARGUMENTS
#
# OTHERWISE, if set, is said there as well: what else would help.
components=$1
shift
if ! cargo +nightly --version >/dev/null 2>&1; then
    echo "skipped: no nightly Rust; rustup toolchain install nightly${components:+ --component $components}${OTHERWISE:+; $OTHERWISE}"
    exit 0
fi
for component in $components; do
    if ! rustup component list --toolchain nightly --installed 2>/dev/null | grep -q "^$component"; then
        echo "skipped: nightly Rust has no $component; rustup component add --toolchain nightly $component${OTHERWISE:+; $OTHERWISE}"
        exit 0
    fi
done
exec cargo +nightly "$@"
