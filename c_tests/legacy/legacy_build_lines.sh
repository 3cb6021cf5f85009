#!/bin/sh
# Builds and runs a program of old by the lines of docs/migration.md that no other test takes: by hand, with a makefile that names
# SWIFT++ and cannot be changed, and with the header in a folder of its own.
#
#   legacy_build_lines.sh COMPILER SOURCE LIBRARY FOLDER
#
# SOURCE: the project's folder; LIBRARY: that of the library; FOLDER: for what is built.
set -eu
compiler=$1 source=$2 library=$3 folder=$4
rm -rf "$folder"
mkdir -p "$folder/lib" "$folder/include"
cd "$folder"
export LD_LIBRARY_PATH="$library"

"$compiler" "$source/examples/legacy.cpp" "-I$source/include/legacy" "-I$source/include" "-L$library" -lswiftprox -o by_hand
./by_hand > expected

echo 'INPUT(-lswiftprox)' > lib/libSWIFT++.so
"$compiler" "$source/examples/legacy.cpp" "-I$source/include/legacy" "-I$source/include" -Llib "-L$library" -lSWIFT++ -o unchanged_makefile
./unchanged_makefile | cmp - expected

ln -s "$source/include/legacy" include/SWIFT
sed 's,<SWIFT\.h>,<SWIFT/SWIFT.h>,' "$source/examples/legacy.cpp" > in_folder.cpp
grep -q '<SWIFT/SWIFT\.h>' in_folder.cpp
"$compiler" in_folder.cpp -Iinclude "-I$source/include" "-L$library" -lswiftprox -o in_folder
./in_folder | cmp - expected
