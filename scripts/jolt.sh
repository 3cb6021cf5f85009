# Sourced from the root of the project: PEERS_JOLT is the folder of a release build of Jolt Physics with its jolt.pc, in build/ and of
# the sources in a crate of crates.io; empty where that cannot be had. Jolt is built for AVX2 unless told otherwise.
if [ ! -f build/jolt/libJolt.a ] && grep -qsw avx2 /proc/cpuinfo; then
    jolt=joltc-sys-0.3.1+Jolt-5.0.0
    {
        mkdir -p build/jolt &&
            curl -fsSL -o build/jolt/crate "https://static.crates.io/crates/joltc-sys/joltc-sys-0.3.1%2BJolt-5.0.0.crate" &&
            echo '846f2354e51c0a8214e687fc22a676e8cae894fd2ea647d3e5bb511583c4b297  build/jolt/crate' | sha256sum --check --quiet &&
            tar -xzf build/jolt/crate -C build/jolt &&
            cmake -S benches/compare/jolt -B build/jolt -D CMAKE_BUILD_TYPE=Distribution \
                -D JOLT="$PWD/build/jolt/$jolt/JoltC/JoltPhysics" >build/jolt/log &&
            cmake --build build/jolt --parallel "$(nproc)" >>build/jolt/log
    } || rm -rf build/jolt
fi
PEERS_JOLT=
if [ -f build/jolt/libJolt.a ]; then PEERS_JOLT="$PWD/build/jolt"; else echo 'Jolt cannot be had: compared without it' >&2; fi
