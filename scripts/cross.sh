#!/bin/sh
# Checks the library for other systems, and tests it on other processors. What cannot be had here is said by name and left out.
#
#   cross.sh [PART ...]        check; macos and msvc, linked; aarch64, under qemu-user; i686, natively with a C library of its own;
#                              windows, under wine. No part: all of these. native: what hosts of other systems run, without an emulator
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
LEFT_OUT="$LEFT_OUT|command_lines|replay_page|reference|swiftprox-|newcomer|sample|man|doc|doxygen|crowd|tower|abi$|memory$|progress$)"

# Of 32 bits: these count on sizes of 64, and `depth` on other roundings, which the header keeps to x86-64 and AArch64.
LEFT_OUT_32='|^(depth|bad_input|mesh_reader|files)$'

# What of the C tests knows neither POSIX nor aligned_alloc; those of the second line are told where to write.
WINDOWS='scene/scene_use scene/sets scene/listener scene/many_objects pair/depth pair/cast pair/ray pair/bodies pair/compound
    pair/ground pair/point pair/pose pair/gradient pair/batch process/released process/threads'
WINDOWS_WRITING='process/bad_input shape/mesh_reader'

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
# GCC 12 for AArch64 takes what SWIFT.h writes to references for unset.
test_on() {
    has_target "$1-unknown-linux-gnu" || return 0
    cmake -S . -B "build/$1" -DBUILD_TESTING=ON -DCMAKE_BUILD_TYPE=Release -DSWIFTPROX_CARGO_PROFILE=checked \
        -DCMAKE_SYSTEM_NAME=Linux "-DCMAKE_SYSTEM_PROCESSOR=$1" "-DCMAKE_C_COMPILER=$2-gcc" "-DCMAKE_CXX_COMPILER=$2-g++" \
        "-DCMAKE_C_FLAGS=$5" "-DCMAKE_CXX_FLAGS=$5 -Wno-error=maybe-uninitialized" "-DCMAKE_CROSSCOMPILING_EMULATOR=$3" "-DCMAKE_FIND_ROOT_PATH=/usr/$2" \
        -DCMAKE_FIND_ROOT_PATH_MODE_PACKAGE=ONLY -DCMAKE_FIND_ROOT_PATH_MODE_LIBRARY=ONLY -DCMAKE_FIND_ROOT_PATH_MODE_INCLUDE=ONLY
    cmake --build "build/$1"
    ctest --test-dir "build/$1" --parallel 2 --output-on-failure --exclude-regex "$LEFT_OUT$4"
}

# Holds the digits of answers to those of other processors: TARGET, its linker, what starts its programs.
digits_on() {
    cargo test --locked --profile checked --target "$1" --config "target.$1.linker = '$2'" --config "target.$1.runner = '$3'" \
        --test determinism
}

# Builds the C tests with MinGW, each with the static library, and one with the DLL: the compiler, what starts programs.
c_tests_on_windows() {
    compiler=$1 runner=$2 made=target/x86_64-pc-windows-gnu/checked folder=build/windows
    cargo build --locked --profile checked --lib --features allocator --target x86_64-pc-windows-gnu
    mkdir -p "$folder"
    # Rust's random numbers come from a DLL of Windows that wine has from 9 on.
    echo '#include <windows.h>
        BOOLEAN NTAPI SystemFunction036(PVOID, ULONG);
        __declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE to, SIZE_T size) { return SystemFunction036(to, (ULONG)size); }' |
        "$compiler" -x c -shared - -ladvapi32 -o "$folder/bcryptprimitives.dll"
    export WINEPATH="$PWD/$folder"
    cp "$made/swiftprox.dll" "$folder"
    for program in $WINDOWS $WINDOWS_WRITING; do
        name=${program##*/}
        case $WINDOWS in *"$program"*) place= ;; *) place=. ;; esac
        "$compiler" -std=gnu11 -O1 -Iinclude -Ic_tests "c_tests/$program.c" "$made/libswiftprox.a" -Wl,--gc-sections -static \
            -lpthread -lkernel32 -lntdll -luserenv -lws2_32 -ldbghelp -o "$folder/$name.exe"
        (cd "$folder" && $runner "./$name.exe" $place) || { echo "windows: $name failed" >&2; return 1; }
    done
    "$compiler" -Iinclude examples/hello.c "$made/libswiftprox.dll.a" -o "$folder/hello.exe"
    (cd "$folder" && $runner ./hello.exe)
}

# Links the shared library for a system that nothing emulates here: TARGET, what links.
link_for() {
    cargo rustc --locked --quiet --profile checked --lib --features allocator --crate-type cdylib --target "$1" \
        --config "target.$1.linker = '$2'"
    echo "$1: linked"
}

# Writes a program of the shell that links: its name, its text.
write_linker() {
    mkdir -p build/link
    printf '#!/bin/sh\n%s\n' "$2" >"build/link/$1"
    chmod +x "build/link/$1"
}

# The library and the C tests, by zig, which has stubs of macOS's system libraries; not of iconv, which nothing here calls.
link_for_macos() {
    zig=$PWD/build/zig-venv/bin/python
    { [ -x "$zig" ] || python3 -m venv build/zig-venv; } &&
        { "$zig" -c 'import ziglang' 2>/dev/null || "$zig" -m pip install --quiet --retries 1 ziglang; } ||
        { echo 'macos: left out, as zig cannot be had' && return; }
    write_linker macos "for one; do shift; [ \"\$one\" = -liconv ] || set -- \"\$@\" \"\$one\"; done
        exec '$zig' -m ziglang cc -target aarch64-macos \"\$@\""
    link_for aarch64-apple-darwin "$PWD/build/link/macos"
    for program in $WINDOWS $WINDOWS_WRITING; do
        build/link/macos -std=gnu11 -Iinclude -Ic_tests "c_tests/$program.c" target/aarch64-apple-darwin/checked/libswiftprox.dylib \
            -o build/link/program
    done
    echo 'macos: C tests linked'
}

# The library by Rust's linker, with MinGW's import libraries, and stand-ins for what Microsoft's compiler brings to each program.
link_for_msvc() {
    linker=$(find "$(rustc --print sysroot)" -name rust-lld | head -n 1)
    [ "$linker" ] || { echo 'msvc: left out, as this Rust has no rust-lld' && return; }
    write_linker msvc "for one; do shift; case \$one in *.lib) [ ! -e \"\$one\" ] || set -- \"\$@\" \"\$one\" ;; *) set -- \"\$@\" \"\$one\" ;; esac; done
        cd /usr/x86_64-w64-mingw32/lib
        exec '$linker' -flavor link \"\$@\" /nodefaultlib /noentry '$PWD/build/link/msvc.o' libkernel32.a libntdll.a libws2_32.a \\
            libuserenv.a libmsvcr120.a"
    echo 'int _fltused, _tls_index; char _tls_used[40], of_types[1] __asm__("\"??_7type_info@@6B@\""); void __chkstk(void) {}' |
        x86_64-w64-mingw32-gcc -x c -c - -o build/link/msvc.o
    link_for x86_64-pc-windows-msvc "$PWD/build/link/msvc"
}

[ $# -gt 0 ] || set -- check macos msvc aarch64 i686 windows
for part in "$@"; do
    case $part in
    check) check ;;
    macos) ! has_target aarch64-apple-darwin || link_for_macos ;;
    msvc)
        scripts/require.sh x86_64-w64-mingw32-gcc=gcc-mingw-w64-x86-64 || continue
        ! has_target x86_64-pc-windows-msvc || link_for_msvc
        ;;
    aarch64)
        scripts/require.sh aarch64-linux-gnu-g++=g++-aarch64-linux-gnu qemu-aarch64=qemu-user cmake=cmake python3=python3 || continue
        test_on aarch64 aarch64-linux-gnu 'qemu-aarch64;-L;/usr/aarch64-linux-gnu' '' ''
        ! has_target aarch64-unknown-linux-gnu || digits_on aarch64-unknown-linux-gnu aarch64-linux-gnu-gcc \
            'qemu-aarch64 -L /usr/aarch64-linux-gnu'
        ;;
    i686)
        scripts/require.sh i686-linux-gnu-g++=g++-i686-linux-gnu cmake=cmake python3=python3 || continue
        # The tests compare doubles, which the x87 would hold with more bits.
        test_on i686 i686-linux-gnu '/usr/i686-linux-gnu/lib/ld-linux.so.2;--library-path;/usr/i686-linux-gnu/lib' "$LEFT_OUT_32" \
            '-msse2 -mfpmath=sse'
        ;;
    windows)
        scripts/require.sh x86_64-w64-mingw32-gcc=gcc-mingw-w64-x86-64 /usr/lib/wine/wine64=wine64 || continue
        has_target x86_64-pc-windows-gnu || continue
        c_tests_on_windows x86_64-w64-mingw32-gcc /usr/lib/wine/wine64
        ;;
    native) cargo test --locked --profile checked --lib --test determinism --test swept --test pair --test depth --test manifold ;;
    *)
        echo "cross.sh: no part $part" >&2
        exit 2
        ;;
    esac
done
