#!/bin/sh
# Checks the library for other systems, and tests it on other processors. What cannot be had here is said by name and left out.
#
#   cross.sh [PART ...]        check; aarch64, under qemu-user; i686, natively with a C library of its own. No part: all
#
# rustup has the targets: without it only those are here that the system's Rust came with.
set -eu
cd "$(dirname "$0")/.."
PATH=$PWD/.rust/bin:$PATH:$HOME/.cargo/bin
CHECKED='x86_64-pc-windows-gnu x86_64-pc-windows-msvc x86_64-apple-darwin aarch64-apple-darwin
    aarch64-unknown-linux-gnu i686-unknown-linux-gnu wasm32-unknown-unknown'
# Tests whose programs are not started by CTest, and so not through the emulator; such as know nothing of the processor; and those
# that take minutes under an emulator.
LEFT_OUT='_under_|^(package|subdirectory|fetch_content|find_package|against|oracle|cpp_.*g|legacy_(cxx|clang|float)|instructions|ratios|setup'
LEFT_OUT="$LEFT_OUT|command_lines|replay_page|reference|swiftprox-|newcomer|sample|man|doc|doxygen|crowd|tower|memory$|progress$)"

# Of 32 bits: these count on sizes of 64, and `depth` on other roundings, which the header keeps to x86-64 and AArch64.
LEFT_OUT_32='|^(depth|bad_input|mesh_reader|files)$'

# Sees to the standard library for a target.
has_target() {
    [ ! -d "$(rustc --print sysroot)/lib/rustlib/$1/lib" ] || return 0
    command -v rustup >/dev/null 2>&1 && rustup target add "$1" >/dev/null 2>&1 && return
    echo "$1: left out, as rustup is missing or cannot fetch it"
    return 1
}

check() {
    for target in $CHECKED; do
        has_target "$target" || continue
        cargo check --locked --quiet --lib --features allocator --target "$target"
        echo "$target: checked"
    done
}

# Builds for a processor and runs the C tests: PROCESSOR, GNU's name of the system, what starts its programs, further tests to leave
# out, and flags of the compiler.
test_on() {
    has_target "$1-unknown-linux-gnu" || return 0
    cmake -S . -B "build/$1" -DBUILD_TESTING=ON -DCMAKE_BUILD_TYPE=Release -DSWIFTPROX_CARGO_PROFILE=checked \
        -DCMAKE_SYSTEM_NAME=Linux "-DCMAKE_SYSTEM_PROCESSOR=$1" "-DCMAKE_C_COMPILER=$2-gcc" "-DCMAKE_CXX_COMPILER=$2-g++" \
        "-DCMAKE_C_FLAGS=$5" "-DCMAKE_CXX_FLAGS=$5" "-DCMAKE_CROSSCOMPILING_EMULATOR=$3" "-DCMAKE_FIND_ROOT_PATH=/usr/$2" \
        -DCMAKE_FIND_ROOT_PATH_MODE_PACKAGE=ONLY -DCMAKE_FIND_ROOT_PATH_MODE_LIBRARY=ONLY -DCMAKE_FIND_ROOT_PATH_MODE_INCLUDE=ONLY
    cmake --build "build/$1"
    ctest --test-dir "build/$1" --parallel 2 --output-on-failure --exclude-regex "$LEFT_OUT$4"
}

[ $# -gt 0 ] || set -- check aarch64 i686
for part in "$@"; do
    case $part in
    check) check ;;
    aarch64)
        scripts/require.sh aarch64-linux-gnu-g++=g++-aarch64-linux-gnu qemu-aarch64=qemu-user cmake=cmake python3=python3
        test_on aarch64 aarch64-linux-gnu 'qemu-aarch64;-L;/usr/aarch64-linux-gnu' '' ''
        ;;
    i686)
        scripts/require.sh i686-linux-gnu-g++=g++-i686-linux-gnu cmake=cmake python3=python3
        # The tests compare doubles, which the x87 would hold with more bits.
        test_on i686 i686-linux-gnu '/usr/i686-linux-gnu/lib/ld-linux.so.2;--library-path;/usr/i686-linux-gnu/lib' "$LEFT_OUT_32" \
            '-msse2 -mfpmath=sse'
        ;;
    *)
        echo "cross.sh: no part $part" >&2
        exit 2
        ;;
    esac
done
