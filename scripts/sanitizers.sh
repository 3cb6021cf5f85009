#!/bin/sh
# Tests under a sanitizer: those of unsafe code and of everything that reads what others wrote. What needs nightly Rust, or a
# component of it, is skipped where that is missing; scripts/nightly.sh says so.
#
#   sanitizers.sh address        C programs too, which are compiled for it and for undefined behaviour; the library is not
#   sanitizers.sh thread         the tests that have threads, with a standard library built for it: else its locks look like races
#   sanitizers.sh miri           unit tests
#
# Where rustup's server is out of reach, packages of Debian 14 do for threads: rustc, cargo, rust-src, clang-22, libclang-rt-22-dev.
# Debian's rustc comes without sanitizers, so that of clang is linked, of the LLVM that `rustc -vV` names:
#
#   export RUSTC_BOOTSTRAP=1
#   export RUSTFLAGS="-Zsanitizer=thread -Zexternal-clangrt -Clinker=clang-22 -Clink-arg=-fsanitize=thread"
#   cargo test --locked --profile checked -Zbuild-std --target x86_64-unknown-linux-gnu --lib --test c_interface --test scene
set -e
cd "${0%/*}/.."
host=$(rustc -vV | sed -n 's/^host: //p')
case $1 in
address)
    export RUSTFLAGS=-Zsanitizer=address
    scripts/nightly.sh "" test --locked --profile checked --target "$host" --lib --test c_interface --test shape --test build
    scripts/nightly.sh "" test --locked --profile checked --target "$host" --test pair -- verify:: flat_edges::
    unset RUSTFLAGS
    cmake -S . -B build/asan -DCMAKE_BUILD_TYPE=Debug -DBUILD_TESTING=ON \
        -DCMAKE_C_FLAGS="-fsanitize=address,undefined -fno-sanitize-recover=all" \
        -DCMAKE_CXX_FLAGS="-fsanitize=address,undefined -fno-sanitize-recover=all"
    programs='scene_use results bad_input mesh_reader allocator memory files threads busy'
    if command -v c++ >/dev/null; then
        programs="$programs legacy_robot legacy_rigid_bodies legacy_modeller legacy_actor legacy_flat legacy_files legacy_methods"
        programs="$programs legacy_queries legacy_pieces legacy_edges legacy_units legacy_macros legacy_text_meshes legacy_strict legacy_planner"
        programs="$programs legacy_general legacy_boundary"
    fi
    # Unquoted: each word is a target.
    cmake --build build/asan --target $programs
    ctest --test-dir build/asan --output-on-failure --tests-regex "^($(echo $programs | tr ' ' '|'))\$"
    ;;
thread)
    export RUSTFLAGS=-Zsanitizer=thread
    export OTHERWISE="packages of Debian do, too: see scripts/sanitizers.sh"
    scripts/nightly.sh rust-src test --locked --profile checked -Zbuild-std --target "$host" \
        --lib --test c_interface --test scene
    scripts/nightly.sh rust-src test --locked --profile checked -Zbuild-std --target "$host" --test pair -- lookup::
    ;;
miri)
    MIRIFLAGS=-Zmiri-disable-isolation scripts/nightly.sh "miri rust-src" miri test --locked --lib
    ;;
*)
    echo 'sanitizers.sh address|thread|miri' >&2
    exit 2
    ;;
esac
