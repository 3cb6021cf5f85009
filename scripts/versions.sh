#!/bin/sh
# One version everywhere: prints that of Cargo.toml, or what differs. CMake, Conan, Python and the recipes of packaging/ take
# it from there.
set -eu
cd "${0%/*}/.."
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)
minor=${version%.*}
case $version in
0.*) library=$minor ;;
*) library=${version%%.*} ;;
esac
good=yes
# says FILE FOUND EXPECTED
says() {
    [ "$2" = "$3" ] || { echo "$1 has version \"$2\", Cargo.toml has $version" >&2; good=; }
}
macro() {
    sed -n "s/^#define SWIFTPROX_VERSION_$1 //p" include/swiftprox.h
}
says Cargo.lock "$(sed -n '/^name = "swiftprox"$/{n;s/^version = "\(.*\)"/\1/p;}' Cargo.lock)" "$version"
says include/swiftprox.h "$(macro MAJOR).$(macro MINOR).$(macro PATCH)" "$version"
says packaging/debian/changelog "$(sed -n '1s/^swiftprox (\(.*\)-.*/\1/p' packaging/debian/changelog)" "$version"
says CITATION.cff "$(sed -n 's/^version: //p' CITATION.cff)" "$version"
says CHANGELOG.md "$(sed -n 's/^## \([0-9.]*\).*/\1/p' CHANGELOG.md | head -n 1)" "$version"
says docs/install.md "$(sed -n 's|.*`swiftprox/\([0-9.]*\)`.*|\1|p' docs/install.md)" "$version"
says 'docs/install.md (library)' "$(sed -n 's/.*`libswiftprox\.so\.\([0-9.]*\)`.*/\1/p' docs/install.md)" "$library"
says 'docs/install.md (CMake)' "$(sed -n 's/^find_package(swiftprox \([0-9.]*\) .*/\1/p' docs/install.md)" "$minor"
[ "$good" ] && echo "$version"
