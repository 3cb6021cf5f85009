#!/bin/sh
# Makes the Conan package, static and shared, and tries it with packaging/conan_test. Where Conan is missing it comes from PyPI, into
# build/conan-venv. What Conan keeps lies in build/conan-home: nothing of the user's is touched.
set -eu
cd "$(dirname "$0")/.."
scripts/require.sh cmake=cmake cc=gcc c++=g++ python3=python3 python3:venv=python3-venv
PATH=$PWD/.rust/bin:$PATH:$HOME/.cargo/bin:$PWD/build/conan-venv/bin
# Compiled crates are shared with other builds.
export PATH CONAN_HOME="$PWD/build/conan-home" CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-$PWD/target}"
if ! command -v conan >/dev/null 2>&1; then
    python3 -m venv build/conan-venv
    build/conan-venv/bin/pip install --quiet 'conan>=2,<3'
fi
[ -e "$CONAN_HOME/profiles/default" ] || conan profile detect
for shared in False True; do
    conan create . -o "swiftprox/*:shared=$shared"
done
