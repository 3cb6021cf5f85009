#!/bin/sh
# Cargo's RUSTC_WRAPPER for the fuzz targets: the library and the targets are compiled for libFuzzer and, by a nightly compiler,
# for the address sanitizer. Everything else is not: coverage of the oracle's arithmetic would only hide that of the library.
case " $* " in
*" --crate-name swiftprox "* | *" --crate-name swiftprox_fuzz "*)
    set -- "$@" -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
        -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
        -Cllvm-args=-sanitizer-coverage-trace-compares
    case $("$1" --version) in
    *nightly*)
        set -- "$@" -Zsanitizer=address -Cforce-frame-pointers
        ;;
    esac
    ;;
esac
exec "$@"
