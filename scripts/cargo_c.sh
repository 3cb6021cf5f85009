#!/bin/sh
# Installs the libraries by cargo-c into build/cargo-c and tries what is there: programs in C, C++ and over SWIFT.h, by pkg-config,
# shared and static. Where cargo-c is missing it comes from crates.io, into build/cargo-c-tool, the newest that this Rust can build.
# PROFILE=--debug makes the libraries in a sixth of the time.
set -eu
cd "$(dirname "$0")/.."
scripts/require.sh cc=gcc c++=g++ pkg-config=pkg-config readelf=binutils
scripts/rust.sh
PATH=$PWD/.rust/bin:$PATH:$HOME/.cargo/bin:$PWD/build/cargo-c-tool/bin
export PATH
install_tool() {
    cargo install cargo-c --debug --locked --root build/cargo-c-tool "$@"
}
if ! command -v cargo-cinstall >/dev/null; then
    if ! said=$(install_tool 2>&1); then
        # cargo names the newest version that supports this Rust.
        version=$(printf '%s\n' "$said" | sed -n 's/^ *`cargo-c \([0-9.]*\)[^`]*` supports rustc.*/\1/p')
        [ -n "$version" ] || { printf '%s\n' "$said" >&2; exit 1; }
        install_tool --version "$version"
    fi
fi

place=$PWD/build/cargo-c
rm -rf "$place"
cargo cinstall "${PROFILE:---release}" --locked --prefix=/usr --libdir=lib --destdir="$place" --target-dir build/cargo-c-target

export PKG_CONFIG_PATH="$place/usr/lib/pkgconfig" PKG_CONFIG_SYSROOT_DIR="$place" LD_LIBRARY_PATH="$place/usr/lib"
flags=$(pkg-config --cflags swiftprox)
libs=$(pkg-config --libs swiftprox)
legacy=-I$place/usr/include/swiftprox/legacy
archive=$place/usr/lib/libswiftprox.a
needs="-lutil -lrt -lpthread -lm -ldl"
readelf -d "$place/usr/lib/libswiftprox.so" | grep -qF "Library soname: [libswiftprox.so.$(scripts/versions.sh | cut -d. -f1,2)]"
# Flags are words.
# shellcheck disable=SC2086
{
    cc -std=c99 examples/hello.c $flags $libs -o "$place/hello"
    cc -std=c99 examples/hello.c $flags "$archive" $needs -o "$place/hello_static"
    c++ -std=c++17 examples/hello.cpp $flags $libs -o "$place/hello_cpp"
    c++ -std=c++98 examples/legacy.cpp $flags "$legacy" $libs -o "$place/legacy"
}
"$place/hello"
"$place/hello_static"
"$place/hello_cpp"
"$place/legacy" >/dev/null
echo "cargo-c: installed libraries, programs in C, C++ and over SWIFT.h run"
