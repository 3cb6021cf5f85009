#!/bin/sh
# Fills the recipes of packaging/ for a source archive, and tries each as far as it goes here:
#
#   recipes.sh ARCHIVE URL [RECIPE ...]    vcpkg, conda, spack, nix; none named: all
#
# build/recipes has them as they are handed in. A recipe whose package manager is missing is run by a stand-in of packaging/alone;
# docs/install.md tells how far. What is neither there nor can be had from PyPI is skipped, with the reason. PROFILE=daily makes the
# library of vcpkg's trial in a fraction of the time.
set -eu
archive=$(realpath "$1")
url=$2
cd "$(dirname "$0")/.."
shift 2
[ $# -gt 0 ] || set -- vcpkg conda spack nix
version=$(scripts/versions.sh)
place=$PWD/build/recipes
rm -rf "$place"
mkdir -p "$place"
sha256=$(sha256sum "$archive" | cut -d' ' -f1)
sha512=$(sha512sum "$archive" | cut -d' ' -f1)
for recipe in vcpkg conda spack; do
    mkdir "$place/$recipe"
    for file in packaging/"$recipe"/*; do
        sed "s|@VERSION@|$version|; s|@URL@|$url|; s|@SHA256@|$sha256|; s|@SHA512@|$sha512|" "$file" >"$place/$recipe/${file##*/}"
    done
done

try_vcpkg() {
    place_of_port=$place/try-vcpkg
    # The archive as it is here, whatever its address will be.
    mkdir -p "$place_of_port/port"
    cp "$place"/vcpkg/* "$place_of_port/port"
    sed "s|$url|file://$archive|" "$place/vcpkg/portfile.cmake" >"$place_of_port/port/portfile.cmake"
    python3 -m json.tool "$place/vcpkg/vcpkg.json" >"$place_of_port/log"
    cmake -D "PORT_DIR=$place_of_port/port" -D "VERSION=$version" -D "PLACE=$place_of_port" -D "PROFILE=${PROFILE:-}" \
        -P packaging/alone/vcpkg.cmake >>"$place_of_port/log" 2>&1 || { tail -n 30 "$place_of_port/log" >&2; return 1; }
    cmake -S c_tests/package/consumer -B "$place_of_port/consumer" -DCMAKE_PREFIX_PATH="$place_of_port/packages" -DLANGUAGE=C \
        -DHELLO="$PWD/examples/hello.c" -DVERSION="${version%.*}" -DNEXT_VERSION=99.0 >>"$place_of_port/log"
    cmake --build "$place_of_port/consumer" >>"$place_of_port/log"
    ctest --test-dir "$place_of_port/consumer" --output-on-failure >>"$place_of_port/log"
    # Where tools find the library vcpkg itself writes into them.
    LD_LIBRARY_PATH=$place_of_port/packages/lib "$place_of_port/packages/tools/swiftprox/swiftprox-query" --version >>"$place_of_port/log"
    echo "vcpkg: the port runs by a stand-in, programs find what it installs"
}

try_conda() {
    venv=$place/../recipes-venv
    if ! { [ -x "$venv/bin/pip" ] || python3 -m venv "$venv"; } ||
        ! "$venv/bin/pip" install --quiet --retries 1 py-rattler-build 2>/dev/null; then
        echo "conda: skipped: rattler-build cannot be had from PyPI"
        return
    fi
    "$venv/bin/python" packaging/alone/conda.py "$place/conda/recipe.yaml" >/dev/null
    echo "conda: the recipe is read and resolved by rattler-build, not built"
}

try_spack() {
    python3 packaging/alone/spack.py "$place/spack/package.py" "$version" "$sha256" >/dev/null
    echo "spack: the package runs by a stand-in, not built"
}

try_nix() {
    if ! command -v nix >/dev/null; then
        echo "nix: skipped: nix is not installed (Debian: nix-bin)"
        return
    fi
    # Flakes see what the archive has, not the folders of builds.
    tar -x -z -f "$archive" -C "$place"
    flake=$place/${archive##*/}
    flake=path:${flake%.tar.gz}
    nix --extra-experimental-features 'nix-command flakes' eval --impure --no-write-lock-file \
        --override-input nixpkgs "path:$PWD/packaging/alone/nixpkgs" "$flake#packages.x86_64-linux.default.drvPath" >/dev/null \
        2>"$place/nix.log" || { cat "$place/nix.log" >&2; return 1; }
    echo "nix: the flake is evaluated with a stand-in for nixpkgs, not built"
}

for recipe in "$@"; do
    "try_$recipe"
done
