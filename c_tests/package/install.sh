#!/bin/sh
# Installs what stands in a build folder under a temporary root, moves the root, and looks at what lies there.
#
#   install.sh SOURCE BUILD PREFIX MOVED    the root goes to MOVED: what is installed lies in MOVED/PREFIX
set -eu
source=$1 build=$2 prefix=$3 moved=$4

complain() {
    echo "$1" >&2
    exit 1
}

rm -rf "$moved" "$moved.before"
DESTDIR="$moved.before" cmake --install "$build" --prefix "$prefix"
mv "$moved.before" "$moved"

shared=$(find "$moved$prefix" -name libswiftprox.so)
real=$(readlink -f "$shared")
soname=$(readelf -d "$real" | sed -n 's/.*(SONAME).*\[\(.*\)\]/\1/p')
[ "$(readlink "$shared")" = "$soname" ] || complain "$shared is no link to $soname"
[ "$(readlink "$(dirname "$shared")/$soname")" = "$(basename "$real")" ] || complain "$soname is no link to $real"
for file in include/swiftprox.h include/swiftprox/tuning.h include/swiftprox.hpp include/swiftprox/pair.hpp \
    include/swiftprox/legacy/SWIFT.h include/swiftprox/adapters/fcl.hpp \
    share/doc/swiftprox/LICENSE-MIT share/doc/swiftprox/conventions.md; do
    [ -s "$moved$prefix/$file" ] || complain "$file is missing"
done

# Nothing knows where it was built or installed to, nor the libraries where the crates were, unless flags of the environment take
# the place of those that see to it.
if found=$(grep -rIlF --exclude-dir=doc -e "$source" -e "$build" -e "$moved" -e "$prefix" "$moved"); then
    complain "these have folders of this machine in them: $found"
fi
if [ -z "${RUSTFLAGS+set}" ] && found=$(grep -rlF "${CARGO_HOME:-$HOME/.cargo}/registry" "$(dirname "$shared")"); then
    complain "these have folders of this machine in them: $found"
fi
if grep -q '^CMAKE_BUILD_TYPE:[A-Z]*=Release$' "$build/CMakeCache.txt"; then
    for library in "$real" "${shared%.so}.a"; do
        ! readelf -SW "$library" 2>&1 | grep -q '\.debug_info' || complain "$library has debug information"
    done
fi

# Programs find the library from where they are, and nothing is looked for in a folder of this machine.
! readelf -d "$real" "$moved$prefix"/bin/* | grep -E 'R(UN)?PATH' | grep -v '\[$ORIGIN/' || complain "these are looked in"
for program in "$moved$prefix"/bin/*; do
    "$program" --help >/dev/null || complain "$program does not run"
done
