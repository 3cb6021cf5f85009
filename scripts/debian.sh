#!/bin/sh
# Builds the Debian packages of the files that git knows, as they are, reads what lintian says, and tries them as installed in fresh minimal systems.
#
#   debian.sh [SUITE ...]        the releases that they are tried in; none: those of SUITES below
#
# The packages lie in build/debian. They need a glibc no older than that of the machine that builds. The systems need root and
# mmdebstrap; crates come from CARGO_HOME or crates.io.
set -eu
cd "$(dirname "$0")/.."
SUITES='bookworm trixie'
[ $# -gt 0 ] || set -- $SUITES
scripts/require.sh dpkg-buildpackage=dpkg-dev dh=debhelper fakeroot=fakeroot cmake=cmake cc=gcc lintian=lintian mmdebstrap=mmdebstrap

# --- Build -----------------------------------------------------------------------------------------------------------------------

PATH=$PWD/.rust/bin:$PATH:$HOME/.cargo/bin
# Debhelper sets another HOME, where rustup and Cargo would look.
export PATH CARGO_HOME="${CARGO_HOME:-$HOME/.cargo}" RUSTUP_HOME="${RUSTUP_HOME:-$HOME/.rustup}"
place=$PWD/build/debian
target=${CARGO_TARGET_DIR:-$PWD/target}
rm -rf "$place"
mkdir -p "$place/source"
git ls-files -z | tar --null --files-from=- -c | tar -x -C "$place/source"
cp -r "$place/source/packaging/debian" "$place/source/debian"
# -d: Rust may be one that Debian's packages know nothing of. Compiled crates are shared with other builds.
(cd "$place/source" && CARGO_TARGET_DIR="$target" dpkg-buildpackage -us -uc -b -d)
rm -rf "$place/source"
(cd "$place" && lintian --fail-on error,warning --tag-display-limit 0 ./*.changes)
ls -l "$place"/*.deb

# --- Try -------------------------------------------------------------------------------------------------------------------------

# Runs in the system: packages and examples are in /tmp/packages.
trial='
set -eu
export DEBIAN_FRONTEND=noninteractive
apt-get update -qq
cd /tmp/packages
apt-get install -y -qq -o Dpkg::Use-Pty=0 --no-install-recommends gcc libc6-dev g++ pkg-config cmake make ./libswiftprox*.deb ./swiftprox-tools*.deb >/dev/null
cc hello.c $(pkg-config --cflags --libs swiftprox) -o hello
./hello
cc -static hello.c $(pkg-config --static --cflags --libs swiftprox) -o hello_static 2>/dev/null
./hello_static
c++ -std=c++17 hello.cpp $(pkg-config --cflags --libs swiftprox) -o hello_cpp
./hello_cpp
c++ legacy.cpp $(pkg-config --cflags --libs swiftprox-legacy) -o legacy
./legacy >/dev/null
version=$(pkg-config --modversion swiftprox)
major=${version%%.*} minor=${version#*.}
minor=${minor%%.*}
cmake -S consumer -B consumer/build -DLANGUAGE=C -DHELLO=/tmp/packages/hello.c -DVERSION=$major.$minor \
    -DNEXT_VERSION=$major.$((minor + 1)) -DSTATIC_LIBC=ON >/dev/null
cmake --build consumer/build >/dev/null
ctest --test-dir consumer/build --output-on-failure
for tool in swiftprox-query swiftprox-replay swiftprox-tune; do $tool --version; done
apt-get remove -y -qq -o Dpkg::Use-Pty=0 $(dpkg-query -W "libswiftprox[0-9]*" | cut -f1) >/dev/null
! swiftprox-query --version 2>/dev/null
'
root=$(mktemp -d)
trap 'for d in proc dev; do umount -l "$root/$d" 2>/dev/null || true; done; rm -rf --one-file-system "$root"' EXIT
for suite in "$@"; do
    rm -rf --one-file-system "$root"
    echo "== $suite"
    mmdebstrap --quiet --variant=minbase --include=ca-certificates "$suite" "$root" >/dev/null
    # As this machine reaches its mirrors.
    cp -r /etc/apt/apt.conf.d/. "$root/etc/apt/apt.conf.d/"
    cp -r /etc/ssl/certs/. "$root/etc/ssl/certs/"
    cp /etc/resolv.conf /etc/hosts "$root/etc/"
    mkdir "$root/tmp/packages"
    cp "$place"/*.deb examples/hello.c examples/hello.cpp examples/legacy.cpp "$root/tmp/packages/"
    cp -r c_tests/package/consumer "$root/tmp/packages/"
    for d in proc dev; do mount --bind "/$d" "$root/$d"; done
    env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 $(env | grep -i '^[a-z]*_proxy=' || true) \
        chroot "$root" sh -c "$trial" </dev/null
    for d in proc dev; do umount -l "$root/$d"; done
done
