#!/bin/sh
# Compiles the tests of SWIFT.h with one compiler by one standard, every warning an error; links and runs them, too, if it is told to.
#
#   legacy_compilers.sh compile|run COMPILER STANDARD SOURCE LIBRARY FOLDER [FLAG...]
#
# SOURCE: the project's folder; LIBRARY: that of the library; FOLDER: for the programs.
set -eu
what=$1 compiler=$2 standard=$3 source=$4 library=$5 folder=$6
shift 6
mkdir -p "$folder"

compile() {
    "$compiler" "-std=c++$standard" -O0 -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Werror \
        "-I$source/include/legacy" "-I$source/include" "-I$source/c_tests" "$@"
}

for test in "$source"/c_tests/legacy/legacy_*.cpp; do
    name=$(basename "$test" .cpp)
    more=''
    case $name in
    legacy_cost | legacy_bench | legacy_units_other) continue ;;
    legacy_units) more=$source/c_tests/legacy/legacy_units_other.cpp ;;
    legacy_macros) more=-DSWIFT_LEGACY_VERSION=2 ;;
    esac
    if [ "$what" = compile ]; then
        compile "$@" -fsyntax-only "$test" ${more:+"$more"}
    else
        compile "$@" "$test" ${more:+"$more"} -L"$library" -lswiftprox -Wl,-rpath,"$library" -o "$folder/$name"
        "$folder/$name" "$folder"
    fi
done
