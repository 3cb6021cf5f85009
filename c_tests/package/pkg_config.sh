#!/bin/sh
# Builds and runs a program with what pkg-config says of an installed tree that was moved.
#
#   pkg_config.sh CC HELLO VERSION MOVED FOLDER STATIC_LIBC    MOVED: the tree's root; FOLDER: for the programs
#
# Status 77: pkg-config is not installed.
set -eu
cc=$1 hello=$2 version=$3 moved=$4 folder=$5 static_libc=$6
if ! command -v pkg-config >/dev/null; then
    echo "pkg-config is not installed"
    exit 77
fi
mkdir -p "$folder"
cd "$folder"
pc=$(find "$moved" -name swiftprox.pc)
export PKG_CONFIG_LIBDIR="${pc%/*}"
LD_LIBRARY_PATH=$(pkg-config --variable=libdir swiftprox | sed 's/\\//g')
export LD_LIBRARY_PATH

[ "$(pkg-config --modversion swiftprox)" = "$version" ]
# It escapes spaces, which only eval understands.
eval "'$cc' '$hello' $(pkg-config --cflags --libs swiftprox) -o with_shared"
./with_shared
eval "'$cc' '$hello' $(pkg-config --static --cflags --libs swiftprox | sed 's/-lswiftprox/-l:libswiftprox.a/') -o with_static"
LD_LIBRARY_PATH='' ./with_static
if [ -n "$static_libc" ]; then
    eval "'$cc' -static '$hello' $(pkg-config --static --cflags --libs swiftprox) -o static_altogether"
    ./static_altogether
fi
# A program in C++, and an old one, where there is a compiler.
if command -v c++ >/dev/null; then
    eval "c++ -std=c++17 '${hello%/*}/hello.cpp' $(pkg-config --cflags --libs swiftprox) -o with_cpp"
    ./with_cpp
    eval "c++ '${hello%/*}/legacy.cpp' $(pkg-config --cflags --libs swiftprox-legacy) -o with_legacy"
    ./with_legacy
fi

# The tree as the root of another system. pkg-config before pkgconf says that root twice, pkgconf where its name has a space.
case "$(pkg-config --version) $moved" in 0.* | *\ *\ *) exit 0 ;; esac
export PKG_CONFIG_SYSROOT_DIR="$moved"
eval "'$cc' '$hello' $(pkg-config --cflags --libs swiftprox) -o of_sysroot"
./of_sysroot
